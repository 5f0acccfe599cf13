//! Numbers that come one at a time or several at once, so that a formula is written once for both.
//!
//! [`Real`] is implemented by `f64` and by [`Lanes`], a register of the widest instruction set that the machine has
//! (found at run time by `pulp`). Every operation rounds as IEEE 754 says, without fused multiply-add, and the
//! functions below are built from such operations alone: a lane has the same bits as an `f64`, on every machine.

use pulp::Simd;
use std::fmt::Debug;
use std::ops::{Add, AddAssign, BitAnd, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

/// Lanes of one block: the widest register has as many, narrower ones take a block in several goes.
pub const BLOCK: usize = 8;

/// A number, or several.
pub trait Real:
    Copy
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
    fn like(self, value: f64) -> Self;
    /// Square root.
    fn sqrt(self) -> Self;
    /// Absolute value.
    fn abs(self) -> Self;
    /// The lesser; `other` where either is not a number.
    fn lesser(self, other: Self) -> Self;
    /// The greater; `other` where either is not a number.
    fn greater(self, other: Self) -> Self;
    /// Where `self` > `other`.
    fn above(self, other: Self) -> Self::Mask;
    /// `yes` where the mask holds, `no` elsewhere.
    fn choose(mask: Self::Mask, yes: Self, no: Self) -> Self;
    /// 2^k for whole k from −1022 to 1023.
    fn power_of_two(self) -> Self;
    /// Mantissa from 1 to below 2 and whole exponent of a positive normal number.
    fn split(self) -> (Self, Self);
    /// A function of each number by itself.
    fn each(self, f: impl Fn(f64) -> f64) -> Self;

    /// 1/`self`.
    #[inline(always)]
    fn inverse(self) -> Self {
        self.like(1.0) / self
    }

    /// e^`self`, to 1e-15 relative, from −700 to 700; the ends' values beyond.
    #[inline(always)]
    fn exp(self) -> Self {
        // ln 2 in two parts: whole multiples of the first are exact.
        const HIGH: f64 = 0.693_147_180_369_123_8;
        const LOW: f64 = 1.908_214_929_270_587_7e-10;
        /// Adding and taking it off again rounds to the next whole number.
        const ROUND: f64 = 6_755_399_441_055_744.0;
        let x = self.greater(self.like(-700.0)).lesser(self.like(700.0));
        let k = x * std::f64::consts::LOG2_E + ROUND - ROUND;
        let r = x - k * HIGH - k * LOW;
        // Taylor, |r| ≤ ln 2 / 2.
        let mut sum = self.like(1.0 / 6_227_020_800.0);
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
            sum = sum * r + inverse;
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
        let large = mantissa.above(self.like(std::f64::consts::SQRT_2));
        let m = Self::choose(large, mantissa * 0.5, mantissa);
        let k = Self::choose(large, exponent + 1.0, exponent);
        // 2 artanh s; |s| ≤ 0.172.
        let s = (m - 1.0) / (m + 1.0);
        let s2 = s * s;
        let mut sum = self.like(2.0 / 21.0);
        for odd in [2.0 / 19.0, 2.0 / 17.0, 2.0 / 15.0, 2.0 / 13.0, 2.0 / 11.0, 2.0 / 9.0, 2.0 / 7.0, 0.4, 2.0 / 3.0] {
            sum = sum * s2 + odd;
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
pub trait Mask: Copy + BitAnd<Output = Self> + Not<Output = Self> {
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
    fn like(self, value: f64) -> Self {
        value
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
    fn lesser(self, other: Self) -> Self {
        if self < other { self } else { other }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        if self > other { self } else { other }
    }
    #[inline(always)]
    fn above(self, other: Self) -> bool {
        self > other
    }
    #[inline(always)]
    fn choose(mask: bool, yes: Self, no: Self) -> Self {
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

/// A register of numbers.
#[derive(Debug, Clone, Copy)]
pub struct Lanes<S: Simd> {
    simd: S,
    value: S::f64s,
}

/// A register of answers.
#[derive(Debug, Clone, Copy)]
pub struct LaneMask<S: Simd> {
    simd: S,
    value: S::m64s,
}

impl<S: Simd> Lanes<S> {
    /// How many numbers there are.
    pub const LEN: usize = S::F64_LANES;

    /// `value` in every lane.
    #[inline(always)]
    pub fn splat(simd: S, value: f64) -> Self {
        Self { simd, value: simd.splat_f64s(value) }
    }

    /// The numbers from `slice[at]` on.
    ///
    /// # Panics
    /// When the slice ends before the register does.
    #[inline(always)]
    pub fn load(simd: S, slice: &[f64], at: usize) -> Self {
        Self { simd, value: S::as_simd_f64s(&slice[at..at + Self::LEN]).0[0] }
    }

    /// The numbers from `slice[at]` on, and zeros from its end.
    #[inline(always)]
    pub fn load_up_to_end(simd: S, slice: &[f64], at: usize) -> Self {
        if at + Self::LEN <= slice.len() {
            Self::load(simd, slice, at)
        } else {
            Self { simd, value: simd.partial_load_f64s(&slice[at.min(slice.len())..]) }
        }
    }

    /// Writes the numbers from `slice[at]` on.
    ///
    /// # Panics
    /// When the slice ends before the register does.
    #[inline(always)]
    pub fn store(self, slice: &mut [f64], at: usize) {
        S::as_mut_simd_f64s(&mut slice[at..at + Self::LEN]).0[0] = self.value;
    }

    /// Writes the numbers from `slice[at]` on, as far as the slice goes.
    #[inline(always)]
    pub fn store_up_to_end(self, slice: &mut [f64], at: usize) {
        if at + Self::LEN <= slice.len() {
            self.store(slice, at);
        } else {
            self.simd.partial_store_f64s(&mut slice[at..], self.value);
        }
    }

    /// A function of the bits of each number. The compiler makes vector instructions of shifts and masks over a whole
    /// register; `pulp` has no shifts of its own.
    #[inline(always)]
    fn bits(self, f: impl Fn(u64) -> u64) -> Self {
        self.each(|number| f64::from_bits(f(number.to_bits())))
    }
}

macro_rules! operator {
    ($($trait:ident $method:ident $call:ident, $assign:ident $assign_method:ident;)*) => {$(
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                Self { value: self.simd.$call(self.value, other.value), ..self }
            }
        }
        impl<S: Simd> $trait<f64> for Lanes<S> {
            type Output = Self;
            #[inline(always)]
            fn $method(self, other: f64) -> Self {
                Self { value: self.simd.$call(self.value, self.simd.splat_f64s(other)), ..self }
            }
        }
        impl<S: Simd> $assign for Lanes<S> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                self.value = self.simd.$call(self.value, other.value);
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
        Self { value: self.simd.div_f64s(self.value, other.value), ..self }
    }
}

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Self { value: self.simd.xor_f64s(self.value, self.simd.splat_f64s(-0.0)), ..self }
    }
}

impl<S: Simd> Real for Lanes<S> {
    type Mask = LaneMask<S>;

    #[inline(always)]
    fn like(self, value: f64) -> Self {
        Self::splat(self.simd, value)
    }
    #[inline(always)]
    fn sqrt(self) -> Self {
        Self { value: self.simd.sqrt_f64s(self.value), ..self }
    }
    #[inline(always)]
    fn abs(self) -> Self {
        Self { value: self.simd.abs_f64s(self.value), ..self }
    }
    #[inline(always)]
    fn lesser(self, other: Self) -> Self {
        Self { value: self.simd.min_f64s(self.value, other.value), ..self }
    }
    #[inline(always)]
    fn greater(self, other: Self) -> Self {
        Self { value: self.simd.max_f64s(self.value, other.value), ..self }
    }
    #[inline(always)]
    fn above(self, other: Self) -> LaneMask<S> {
        LaneMask { simd: self.simd, value: self.simd.greater_than_f64s(self.value, other.value) }
    }
    #[inline(always)]
    fn choose(mask: LaneMask<S>, yes: Self, no: Self) -> Self {
        Self { value: mask.simd.select_f64s(mask.value, yes.value, no.value), ..yes }
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
        let mut value = self.value;
        for number in bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut value)) {
            *number = f(*number);
        }
        Self { value, ..self }
    }
}

impl<S: Simd> BitAnd for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn bitand(self, other: Self) -> Self {
        Self { value: self.simd.and_m64s(self.value, other.value), ..self }
    }
}

impl<S: Simd> Not for LaneMask<S> {
    type Output = Self;
    #[inline(always)]
    fn not(self) -> Self {
        Self { value: self.simd.not_m64s(self.value), ..self }
    }
}

impl<S: Simd> Mask for LaneMask<S> {
    #[inline(always)]
    fn any(self) -> bool {
        self.simd.first_true_m64s(self.value) < S::F64_LANES
    }
}

/// Three numbers, or three registers of them.
#[derive(Debug, Clone, Copy)]
pub struct Triple<R> {
    /// First axis.
    pub x: R,
    /// Second axis.
    pub y: R,
    /// Third axis.
    pub z: R,
}

impl<R: Real> Triple<R> {
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> R {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self { x: self.y * o.z - o.y * self.z, y: self.z * o.x - o.z * self.x, z: self.x * o.y - o.x * self.y }
    }

    /// Square of the length.
    #[inline(always)]
    pub fn length_squared(self) -> R {
        self.dot(self)
    }

    /// All three through `f`.
    #[inline(always)]
    pub fn map(self, f: impl Fn(R) -> R) -> Self {
        Self { x: f(self.x), y: f(self.y), z: f(self.z) }
    }
}

impl<R: Real> Add for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<R: Real> Sub for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<R: Real> Mul<R> for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: R) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
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

    /// Every function of the numbers, as the widest register gives it.
    struct Wide<'a>(&'a [f64]);

    impl WithSimd for Wide<'_> {
        type Output = Vec<[f64; 4]>;
        #[inline(always)]
        fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
            let mut out = vec![[0.0; 4]; self.0.len()];
            for at in (0..self.0.len()).step_by(Lanes::<S>::LEN) {
                let x = Lanes::load_up_to_end(simd, self.0, at);
                let half = x.like(0.5);
                let picked = Lanes::choose(x.above(half), x.inverse(), half - x);
                assert!(!(x.above(half) & half.above(x)).any() && (!x.above(x)).any());
                let all = [x.ln(), (x * 1e-3).exp(), picked, x.each(f64::sqrt) - x.sqrt()];
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
            let picked = if *x > 0.5 { 1.0 / x } else { 0.5 - x };
            let own = [Real::ln(*x), Real::exp(x * 1e-3), picked, 0.0];
            for lanes in [wide, narrow] {
                assert_eq!(own.map(f64::to_bits), lanes.map(f64::to_bits), "{x}");
            }
        }
    }
}
