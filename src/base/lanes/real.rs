//! What can be done to a number, or to several, and how one by itself does it.

use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// A number, or several.
pub trait Real:
    Copy
    + Send
    + Sync
    + Debug
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Neg<Output = Self>
    + AddAssign
    + SubAssign
    + MulAssign
{
    /// One answer per number.
    type Mask: Mask;

    /// `value`, as many times as there are numbers in `self`.
    fn splat(self, value: f64) -> Self;
    /// `self` × `factor` + `addend`, rounded once: by a library function, slowly, where there is no such instruction.
    fn mul_add(self, factor: Self, addend: Self) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The lesser; `other` where either is not a number.
    fn simd_min(self, other: Self) -> Self;
    /// The greater; `other` where either is not a number.
    fn simd_max(self, other: Self) -> Self;
    /// Where `self` > `other`.
    fn simd_gt(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, `no` elsewhere.
    fn select(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// 2^k for whole k from −1022 to 1023.
    fn power_of_two(self) -> Self;
    /// Mantissa from 1 to below 2 and whole exponent of a positive normal number.
    fn split(self) -> (Self, Self);
    /// 1/√`self` to 4 %, for [`Real::inverse_sqrt`] to begin with.
    fn inverse_sqrt_guess(self) -> Self;
    /// 1/`self` to 5 %, for [`Real::inverse`] to begin with.
    fn inverse_guess(self) -> Self;
    /// How many numbers there are.
    const COUNT: usize;
    /// Number `k`.
    fn at(self, k: usize) -> f64;
    /// Puts `value` in the place of number `k`.
    fn put(&mut self, k: usize, value: f64);

    /// The nearest whole number, of two the even one, of a number below 2⁵¹ in size.
    #[inline(always)]
    fn round_ties_even(self) -> Self {
        /// Adding and taking it off again leaves no bits for a fraction.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        self + ROUND - ROUND
    }

    /// The two rows that follow each other in a table, the last number of the first column at or below `self` and the
    /// next; the first two below that column, the last two above it. The first column increases; there are two rows or
    /// more.
    #[inline(always)]
    fn rows_around<const COLUMNS: usize>(self, table: &[[f64; COLUMNS]]) -> [[Self; COLUMNS]; 2] {
        let mut rows = [[self; COLUMNS]; 2];
        for k in 0..Self::COUNT {
            let number = self.at(k);
            let upper = table.partition_point(|row| row[0] <= number).clamp(1, table.len() - 1);
            for (row, values) in rows.iter_mut().zip(&table[upper - 1..]) {
                row.iter_mut().zip(values).for_each(|(number, value)| number.put(k, *value));
            }
        }
        rows
    }

    /// The number that `method` comes to from `self`, and what is known there: one round, and more, up to `most`, as
    /// long as a number within `wanted` is unsettled. One that is settled stays while others go on. Only numbers within
    /// `wanted` mean something.
    #[inline(always)]
    fn refine<M: Refinement<Self>>(self, method: &M, wanted: Self::Mask, most: u32) -> (Self, M::Point) {
        let (mut number, mut open) = (self, wanted);
        for round in 0..most {
            let point = method.at(number);
            if round > 0 {
                open = open & method.unsettled(&point);
                if !open.any() {
                    return (number, point);
                }
            }
            number = Self::select(open, method.next(number, &point), number);
        }
        (number, method.at(number))
    }

    /// 1/`self` to 3e-16 relative, for positive normal numbers up to 1e300.
    ///
    /// Newton's rounds take less than a division does, and other work fits between them.
    #[inline(always)]
    fn inverse(self) -> Self {
        let (minus, one) = (-self, self.splat(1.0));
        let mut y = self.inverse_guess();
        for _ in 0..4 {
            y = y.mul_add(minus.mul_add(y, one), y);
        }
        y
    }

    /// 1/√`self` to 4e-16 relative, for positive normal numbers; large and finite at 0.
    ///
    /// Two rounds of Newton's and one of third order (Halley) take a third of the time of a root and a division: those
    /// keep one unit of the processor busy for longer than all else in a contact.
    #[inline(always)]
    fn inverse_sqrt(self) -> Self {
        let (half, three_halves) = (self * -0.5, self.splat(1.5));
        let mut y = self.inverse_sqrt_guess();
        for _ in 0..2 {
            y = y * (half * y).mul_add(y, three_halves);
        }
        // In this order nothing overflows at 0.
        let rest = (-self * y).mul_add(y, self.splat(1.0));
        (y * rest).mul_add(rest.mul_add(self.splat(0.375), self.splat(0.5)), y)
    }

    /// e^`self`, to 1e-15 relative, from −700 to 700; the ends' values beyond.
    #[inline(always)]
    fn exp(self) -> Self {
        // ln 2 in two parts: whole multiples of the first are exact.
        const HIGH: f64 = 0.693_147_180_369_123_8;
        const LOW: f64 = 1.908_214_929_270_587_7e-10;
        let x = self.simd_max(self.splat(-700.0)).simd_min(self.splat(700.0));
        let k = (x * std::f64::consts::LOG2_E).round_ties_even();
        let r = x - k * HIGH - k * LOW;
        // Taylor, |r| ≤ ln 2 / 2.
        let mut sum = self.splat(1.0 / 6_227_020_800.0);
        for inverse in [
            1.0 / 479_001_600.0,
            1.0 / 39_916_800.0,
            1.0 / 3_628_800.0,
            1.0 / 362_880.0,
            1.0 / 40_320.0,
            1.0 / 5040.0,
            1.0 / 720.0,
            1.0 / 120.0,
            1.0 / 24.0,
            1.0 / 6.0,
            0.5,
            1.0,
            1.0,
        ] {
            sum = sum.mul_add(r, r.splat(inverse));
        }
        sum * k.power_of_two()
    }

    /// Natural logarithm of a positive normal number, to 1e-15 relative also near 1.
    #[inline(always)]
    fn ln(self) -> Self {
        const HIGH: f64 = 0.693_147_180_369_123_8;
        const LOW: f64 = 1.908_214_929_270_587_7e-10;
        let (mantissa, exponent) = self.split();
        // From √½ to √2, so that the exponent is 0 near 1.
        let large = mantissa.simd_gt(self.splat(std::f64::consts::SQRT_2));
        let m = Self::select(large, mantissa * 0.5, mantissa);
        let k = Self::select(large, exponent + 1.0, exponent);
        // 2 artanh s; |s| ≤ 0.172.
        let s = (m - 1.0) * (m + 1.0).inverse();
        let s2 = s * s;
        let mut sum = self.splat(2.0 / 21.0);
        for odd in [2.0 / 19.0, 2.0 / 17.0, 2.0 / 15.0, 2.0 / 13.0, 2.0 / 11.0, 2.0 / 9.0, 2.0 / 7.0, 0.4, 2.0 / 3.0] {
            sum = sum.mul_add(s2, s2.splat(odd));
        }
        k * HIGH + (k * LOW + (s * 2.0 + s * s2 * sum))
    }

    /// `self`^`exponent` for positive `self`.
    #[inline(always)]
    fn powf(self, exponent: f64) -> Self {
        (self.ln() * exponent).exp()
    }
}

/// Yes or no for each number.
pub trait Mask: Copy + BitAnd<Output = Self> + BitOr<Output = Self> + Not<Output = Self> {
    /// Whether any answer is yes. A formula may leave out work where none is, if doing that work would change nothing
    /// (its results are taken through [`Real::select`] with the same mask): while a formula is recorded
    /// ([`recorder`](crate::base::recorder)) the answer is always yes.
    fn any(self) -> bool;
}

/// A way to better a number round by round; see [`Real::refine`].
pub trait Refinement<R: Real> {
    /// What is known at a number.
    type Point;

    /// What is known at `number`.
    fn at(&self, number: R) -> Self::Point;

    /// Where it is not good enough.
    fn unsettled(&self, point: &Self::Point) -> R::Mask;

    /// A better number than `number`, from what is known there.
    fn next(&self, number: R, point: &Self::Point) -> R;
}

impl Mask for bool {
    #[inline(always)]
    fn any(self) -> bool {
        self
    }
}

impl Real for f64 {
    type Mask = bool;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        value
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        f64::mul_add(self, factor, addend)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        f64::sqrt(self)
    }
    #[inline(always)]
    fn abs(self) -> Self {
        f64::abs(self)
    }
    #[inline(always)]
    fn simd_min(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn simd_max(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn simd_gt(self, other: Self) -> bool {
        self > other
    }
    #[inline(always)]
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        f64::from_bits(exponent_bits((self + EXPONENT_TO_BITS).to_bits()))
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        let bits = self.to_bits();
        (f64::from_bits(mantissa(bits)), f64::from_bits(exponent(bits)) - NUMBER_OF_BITS)
    }
    #[inline(always)]
    fn inverse_sqrt_guess(self) -> Self {
        f64::from_bits(inverse_sqrt_bits(self.to_bits()))
    }
    #[inline(always)]
    fn inverse_guess(self) -> Self {
        f64::from_bits(inverse_bits(self.to_bits()))
    }
    const COUNT: usize = 1;
    #[inline(always)]
    fn at(self, _: usize) -> f64 {
        self
    }
    #[inline(always)]
    fn put(&mut self, _: usize, value: f64) {
        *self = value;
    }
}

/// 1.5 · 2⁵² + 1023: the last bits of a whole number added to it are the biased exponent.
pub const EXPONENT_TO_BITS: f64 = 6_755_399_441_055_744.0 + 1023.0;
/// 2⁵² + 1023: what [`exponent`] has added.
pub const NUMBER_OF_BITS: f64 = 4_503_599_627_370_496.0 + 1023.0;

/// See [`inverse_bits`] and [`inverse_sqrt_bits`].
pub const INVERSE_BITS: u64 = 0x7FDE_6238_22FC_16E6;
pub const INVERSE_SQRT_BITS: u64 = 0x5FE6_EB50_C7B5_37A9;

/// Bits of 2^k from those of k + [`EXPONENT_TO_BITS`].
#[inline(always)]
pub(super) fn exponent_bits(bits: u64) -> u64 {
    bits << 52
}

/// Bits of the mantissa, as a number from 1 to below 2.
#[inline(always)]
pub(super) fn mantissa(bits: u64) -> u64 {
    bits & 0x000F_FFFF_FFFF_FFFF | 0x3FF0_0000_0000_0000
}

/// Bits of the exponent + [`NUMBER_OF_BITS`], for a positive number: 2⁵² with a small whole number in its last bits.
#[inline(always)]
pub(super) fn exponent(bits: u64) -> u64 {
    bits >> 52 | 0x4330_0000_0000_0000
}

/// Bits of a number near 1/x from those of x: the exponent turned round, with a mantissa that errs least.
#[inline(always)]
pub(super) fn inverse_bits(bits: u64) -> u64 {
    INVERSE_BITS.wrapping_sub(bits)
}

/// Bits of a number near 1/√x from those of x: half the exponent, turned round, with a mantissa that errs least.
#[inline(always)]
pub(super) fn inverse_sqrt_bits(bits: u64) -> u64 {
    INVERSE_SQRT_BITS.wrapping_sub(bits >> 1)
}
