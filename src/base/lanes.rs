//! Numbers that come one at a time or several at once, so that a formula is written once for both.
//!
//! [`Real`] is implemented by `f64` and by [`Lanes`], a register of the widest instruction set that the machine has
//! (found at run time by `pulp`). Every operation rounds as IEEE 754 says, and what is fused into one rounding is
//! written so, never left to the compiler; the functions below are built from such operations alone: a lane has the same
//! bits as an `f64`, on every machine.

use pulp::Simd;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// Lanes of one block: two of the widest registers have as many, narrower ones take a block in several goes.
pub const BLOCK: usize = 16;

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
    /// A function of each number by itself.
    fn each(self, f: impl Fn(f64) -> f64) -> Self;
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
        /// Adding and taking it off again rounds to the next whole number.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let x = self.simd_max(self.splat(-700.0)).simd_min(self.splat(700.0));
        let k = x * std::f64::consts::LOG2_E + ROUND - ROUND;
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
    /// Whether any answer is yes.
    fn any(self) -> bool;
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
    fn each(self, f: impl Fn(f64) -> f64) -> Self {
        f(self)
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
const EXPONENT_TO_BITS: f64 = 6_755_399_441_055_744.0 + 1023.0;
/// 2⁵² + 1023: what [`exponent`] has added.
const NUMBER_OF_BITS: f64 = 4_503_599_627_370_496.0 + 1023.0;

/// Bits of 2^k from those of k + [`EXPONENT_TO_BITS`].
#[inline(always)]
fn exponent_bits(bits: u64) -> u64 {
    bits << 52
}

/// Bits of the mantissa, as a number from 1 to below 2.
#[inline(always)]
fn mantissa(bits: u64) -> u64 {
    bits & 0x000F_FFFF_FFFF_FFFF | 0x3FF0_0000_0000_0000
}

/// Bits of the exponent + [`NUMBER_OF_BITS`], for a positive number: 2⁵² with a small whole number in its last bits.
#[inline(always)]
fn exponent(bits: u64) -> u64 {
    bits >> 52 | 0x4330_0000_0000_0000
}

/// Bits of a number near 1/x from those of x: the exponent turned round, with a mantissa that errs least.
#[inline(always)]
fn inverse_bits(bits: u64) -> u64 {
    0x7FDE_6238_22FC_16E6_u64.wrapping_sub(bits)
}

/// Bits of a number near 1/√x from those of x: half the exponent, turned round, with a mantissa that errs least.
#[inline(always)]
fn inverse_sqrt_bits(bits: u64) -> u64 {
    0x5FE6_EB50_C7B5_37A9_u64.wrapping_sub(bits >> 1)
}

/// Two registers of numbers: what one of them waits for, the other fills. A contact or a bond is a long chain of
/// operations, each of which takes several times as long as it keeps its unit busy.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    low: S::f64s,
    high: S::f64s,
}

/// Two registers of answers.
#[derive(Debug, Clone, Copy)]
pub struct LaneMask<S: Simd> {
    simd: S,
    low: S::m64s,
    high: S::m64s,
}

impl<S: Simd> Lanes<S> {
    /// How many numbers there are.
    pub const LEN: usize = 2 * S::F64_LANES;

    /// `value` in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        let low = simd.splat_f64s(value);
        Self { simd, low, high: low }
    }

    /// The numbers from `slice[at]` on.
    ///
    /// # Panics
    /// When the slice ends before the registers do.
    #[inline(always)]
    pub fn load(simd: S, slice: &[f64], at: usize) -> Self {
        let both = S::as_simd_f64s(&slice[at..at + Self::LEN]).0;
        Self { simd, low: both[0], high: both[1] }
    }

    /// The numbers from `slice[at]` on, and zeros from its end.
    #[inline(always)]
    pub fn load_up_to_end(simd: S, slice: &[f64], at: usize) -> Self {
        if at + Self::LEN <= slice.len() {
            Self::load(simd, slice, at)
        } else {
            let part = |at: usize| simd.partial_load_f64s(&slice[at.min(slice.len())..]);
            Self { simd, low: part(at), high: part(at + S::F64_LANES) }
        }
    }

    /// Writes the numbers from `slice[at]` on.
    ///
    /// # Panics
    /// When the slice ends before the registers do.
    #[inline(always)]
    pub fn store(self, slice: &mut [f64], at: usize) {
        let both = S::as_mut_simd_f64s(&mut slice[at..at + Self::LEN]).0;
        both[0] = self.low;
        both[1] = self.high;
    }

    /// Writes the numbers from `slice[at]` on, as far as the slice goes.
    #[inline(always)]
    pub fn store_up_to_end(self, slice: &mut [f64], at: usize) {
        if at + Self::LEN <= slice.len() {
            self.store(slice, at);
        } else {
            let (end, half) = (slice.len(), at + S::F64_LANES);
            self.simd.partial_store_f64s(&mut slice[at.min(end)..], self.low);
            self.simd.partial_store_f64s(&mut slice[half.min(end)..], self.high);
        }
    }

    /// A function of the bits of each number. The compiler makes vector instructions of shifts and masks over a whole
    /// register; `pulp` has no shifts of its own.
    #[inline(always)]
    fn bits(self, f: impl Fn(u64) -> u64) -> Self {
        self.each(|number| f64::from_bits(f(number.to_bits())))
    }

    #[inline(always)]
    fn both(self, f: impl Fn(S::f64s) -> S::f64s) -> Self {
        Self { low: f(self.low), high: f(self.high), ..self }
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $call:ident, $assign:ident $assign_method:ident;)*) => {$(
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                let simd = self.simd;
                Self { simd, low: simd.$call(self.low, other.low), high: simd.$call(self.high, other.high) }
            }
        }
        impl<S: Simd> $trait<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                let (simd, other) = (self.simd, self.simd.splat_f64s(other));
                Self { simd, low: simd.$call(self.low, other), high: simd.$call(self.high, other) }
            }
        }
        impl<S: Simd> $assign for Lanes<S> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                self.low = self.simd.$call(self.low, other.low);
                self.high = self.simd.$call(self.high, other.high);
            }
        }
    )*};
}

operator! {
    Add add add_f64s, AddAssign add_assign;
    Sub sub sub_f64s, SubAssign sub_assign;
    Mul mul mul_f64s, MulAssign mul_assign;
}

impl<S: Simd> Div for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn div(self, other: Self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.div_f64s(self.low, other.low), high: simd.div_f64s(self.high, other.high) }
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        let (simd, sign) = (self.simd, self.simd.splat_f64s(-0.0));
        self.both(|value| simd.xor_f64s(value, sign))
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = LaneMask<S>;

    #[inline(always)]
    fn splat(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }
    #[inline(always)]
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        let simd = self.simd;
        let low = simd.mul_add_f64s(self.low, factor.low, addend.low);
        Self { simd, low, high: simd.mul_add_f64s(self.high, factor.high, addend.high) }
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        self.both(|value| self.simd.sqrt_f64s(value))
    }
    #[inline(always)]
    fn abs(self) -> Self {
        self.both(|value| self.simd.abs_f64s(value))
    }
    #[inline(always)]
    fn simd_min(self, other: Self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.min_f64s(self.low, other.low), high: simd.min_f64s(self.high, other.high) }
    }
    #[inline(always)]
    fn simd_max(self, other: Self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.max_f64s(self.low, other.low), high: simd.max_f64s(self.high, other.high) }
    }
    #[inline(always)]
    fn simd_gt(self, other: Self) -> LaneMask<S> {
        let simd = self.simd;
        let low = simd.greater_than_f64s(self.low, other.low);
        LaneMask { simd, low, high: simd.greater_than_f64s(self.high, other.high) }
    }
    #[inline(always)]
    fn select(mask: LaneMask<S>, yes: Self, no: Self) -> Self {
        let simd = mask.simd;
        let low = simd.select_f64s(mask.low, yes.low, no.low);
        Self { simd, low, high: simd.select_f64s(mask.high, yes.high, no.high) }
    }
    #[inline(always)]
    fn power_of_two(self) -> Self {
        (self + EXPONENT_TO_BITS).bits(exponent_bits)
    }
    #[inline(always)]
    fn split(self) -> (Self, Self) {
        (self.bits(mantissa), self.bits(exponent) - NUMBER_OF_BITS)
    }
    #[inline(always)]
    fn each(self, f: impl Fn(f64) -> f64) -> Self {
        self.both(|mut value| {
            for number in bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut value)) {
                *number = f(*number);
            }
            value
        })
    }
    #[inline(always)]
    fn inverse_sqrt_guess(self) -> Self {
        self.bits(inverse_sqrt_bits)
    }
    #[inline(always)]
    fn inverse_guess(self) -> Self {
        self.bits(inverse_bits)
    }
    const COUNT: usize = Self::LEN;
    #[inline(always)]
    fn at(self, k: usize) -> f64 {
        let half = if k < S::F64_LANES { &self.low } else { &self.high };
        bytemuck::cast_slice::<S::f64s, f64>(std::slice::from_ref(half))[k % S::F64_LANES]
    }
    #[inline(always)]
    fn put(&mut self, k: usize, value: f64) {
        let half = if k < S::F64_LANES { &mut self.low } else { &mut self.high };
        bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(half))[k % S::F64_LANES] = value;
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.and_m64s(self.low, other.low), high: simd.and_m64s(self.high, other.high) }
    }
}

impl<S: Simd> BitOr for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitor(self, other: Self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.or_m64s(self.low, other.low), high: simd.or_m64s(self.high, other.high) }
    }
}

impl<S: Simd> Not for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        let simd = self.simd;
        Self { simd, low: simd.not_m64s(self.low), high: simd.not_m64s(self.high) }
    }
}

impl<S: Simd> Mask for LaneMask<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.simd.first_true_m64s(self.simd.or_m64s(self.low, self.high)) < S::F64_LANES
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, WithSimd};

    fn numbers() -> Vec<f64> {
        let mut all = vec![1.0, 1.0 + 1e-15, 0.999_999, 1.004, 2.0, 0.5, 3e-300, 7e300];
        all.extend((1..200).map(|k| 0.37 * f64::from(k)));
        all
    }

    #[test]
    fn exponential_and_logarithm_are_those_of_the_library() {
        for x in numbers() {
            let (own, library) = (Real::ln(x), x.ln());
            assert!((own - library).abs() <= 1e-15 * library.abs(), "ln {x}: {own} {library}");
            for y in [x, -x, 1e-3 * x] {
                if y.abs() < 700.0 {
                    let (own, library) = (Real::exp(y), y.exp());
                    assert!((own / library - 1.0).abs() <= 1e-15, "exp {y}: {own} {library}");
                }
            }
        }
        assert!((Real::powf(2.5, 0.31) / 2.5f64.powf(0.31) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn inverses_are_those_of_the_library() {
        for x in numbers().into_iter().chain([1e-12, 4e-9, 1.0 - 1e-16]) {
            let errors = [x.inverse_sqrt() * x.sqrt() - 1.0, x.inverse() * x - 1.0];
            assert!(errors.iter().all(|error| error.abs() <= 4e-16), "{x}: {errors:?}");
        }
        assert!(0.0.inverse_sqrt().is_finite() && 0.0 * 0.0.inverse_sqrt() == 0.0);
    }

    /// Every function of the numbers, as the widest register gives it.
    struct Wide<'a>(&'a [f64]);

    impl WithSimd for Wide<'_> {
        type Output = Vec<[f64; 5]>;
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut out = vec![[0.0; 5]; self.0.len()];
            for at in (0..self.0.len()).step_by(Lanes::<S>::LEN) {
                let x = Lanes::load_up_to_end(simd, self.0, at);
                let half = x.splat(0.5);
                let picked = Lanes::select(x.simd_gt(half), x.inverse(), half - x);
                assert!(!(x.simd_gt(half) & half.simd_gt(x)).any() && (!x.simd_gt(x)).any());
                let roots = x.each(f64::sqrt) - x.sqrt();
                let all = [x.ln(), (x * 1e-3).exp(), picked, roots, x.inverse_sqrt()];
                for (k, y) in all.into_iter().enumerate() {
                    let mut lanes = vec![0.0; Lanes::<S>::LEN];
                    y.store(&mut lanes, 0);
                    for (out, value) in out[at..].iter_mut().zip(lanes) {
                        out[k] = value;
                    }
                }
            }
            out
        }
    }

    #[test]
    fn a_lane_has_the_bits_of_a_number_by_itself() {
        let numbers = numbers();
        let (widest, narrowest) = (Arch::new().dispatch(Wide(&numbers)), Wide(&numbers).with_simd(pulp::Scalar));
        for ((x, wide), narrow) in numbers.iter().zip(widest).zip(narrowest) {
            let picked = if *x > 0.5 { x.inverse() } else { 0.5 - x };
            let own = [Real::ln(*x), Real::exp(x * 1e-3), picked, 0.0, x.inverse_sqrt()];
            for lanes in [wide, narrow] {
                assert_eq!(own.map(f64::to_bits), lanes.map(f64::to_bits), "{x}");
            }
        }
    }
}
