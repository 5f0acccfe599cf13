//! Numbers by the register.

use super::real::{EXPONENT_TO_BITS, Mask, NUMBER_OF_BITS, Real};
use super::real::{exponent, exponent_bits, inverse_bits, inverse_sqrt_bits, mantissa};
use pulp::{Arch, Simd, WithSimd};
use std::ops::{Add, AddAssign, BitAnd, BitOr, Div, Mul, MulAssign, Neg, Not, Sub, SubAssign};

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
        self.both(|mut value| {
            for number in bytemuck::cast_slice_mut::<S::f64s, f64>(std::slice::from_mut(&mut value)) {
                *number = f64::from_bits(f(number.to_bits()));
            }
            value
        })
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

/// How many numbers the widest register of this machine holds.
pub fn register_width() -> usize {
    struct Width;
    impl WithSimd for Width {
        type Output = usize;
        #[inline(always)]
        fn with_simd<S: Simd>(self, _: S) -> usize {
            S::F64_LANES
        }
    }
    Arch::new().dispatch(Width)
}
