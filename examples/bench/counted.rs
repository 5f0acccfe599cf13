//! Numbers that count what is done with them, so that operations per bond follow the formulas.

use std::cell::Cell;
use std::ops::{Add, AddAssign, Div, Mul, MulAssign, Neg, Sub, SubAssign};
use strandsnap::base::lanes::Real;

/// Floating-point operations. Comparisons and choices count as none.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Operations {
    /// Additions, subtractions, multiplications, and multiplications with an addition in one: each keeps a unit of the
    /// processor busy once.
    pub simple: f64,
    /// Divisions.
    pub divisions: f64,
    /// Square roots.
    pub roots: f64,
}

impl Operations {
    /// The operations of `count` items.
    pub fn times(self, count: usize) -> Self {
        let n = count as f64;
        Self { simple: self.simple * n, divisions: self.divisions * n, roots: self.roots * n }
    }

    /// Both together.
    pub fn plus(self, other: Self) -> Self {
        Self {
            simple: self.simple + other.simple,
            divisions: self.divisions + other.divisions,
            roots: self.roots + other.roots,
        }
    }
}

thread_local! {
    static DONE: Cell<Operations> = const { Cell::new(Operations { simple: 0.0, divisions: 0.0, roots: 0.0 }) };
}

fn done(simple: f64, divisions: f64, roots: f64) {
    DONE.set(DONE.get().plus(Operations { simple, divisions, roots }));
}

/// What `work` does with [`Counted`] numbers.
pub fn count(work: impl FnOnce()) -> Operations {
    DONE.set(Operations::default());
    work();
    DONE.get()
}

/// An `f64` that counts.
#[derive(Debug, Clone, Copy)]
pub struct Counted(pub f64);

macro_rules! simple {
    ($trait:ident, $method:ident, $op:tt) => {
        impl $trait for Counted {
            type Output = Self;
            fn $method(self, other: Self) -> Self {
                done(1.0, 0.0, 0.0);
                Self(self.0 $op other.0)
            }
        }
        impl $trait<f64> for Counted {
            type Output = Self;
            fn $method(self, other: f64) -> Self {
                self $op Self(other)
            }
        }
    };
}
simple!(Add, add, +);
simple!(Sub, sub, -);
simple!(Mul, mul, *);

impl Div for Counted {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        done(0.0, 1.0, 0.0);
        Self(self.0 / other.0)
    }
}

impl Neg for Counted {
    type Output = Self;
    fn neg(self) -> Self {
        Self(-self.0)
    }
}

impl AddAssign for Counted {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Counted {
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl MulAssign for Counted {
    fn mul_assign(&mut self, other: Self) {
        *self = *self * other;
    }
}

impl Real for Counted {
    type Mask = bool;

    fn splat(self, value: f64) -> Self {
        Self(value)
    }
    fn mul_add(self, factor: Self, addend: Self) -> Self {
        done(1.0, 0.0, 0.0);
        Self(self.0.mul_add(factor.0, addend.0))
    }
    fn sqrt(self) -> Self {
        done(0.0, 0.0, 1.0);
        Self(self.0.sqrt())
    }
    fn abs(self) -> Self {
        Self(self.0.abs())
    }
    fn simd_min(self, other: Self) -> Self {
        Self(Real::simd_min(self.0, other.0))
    }
    fn simd_max(self, other: Self) -> Self {
        Self(Real::simd_max(self.0, other.0))
    }
    fn simd_gt(self, other: Self) -> bool {
        self.0 > other.0
    }
    fn select(mask: bool, yes: Self, no: Self) -> Self {
        if mask { yes } else { no }
    }
    fn power_of_two(self) -> Self {
        done(1.0, 0.0, 0.0);
        Self(self.0.power_of_two())
    }
    fn split(self) -> (Self, Self) {
        done(1.0, 0.0, 0.0);
        let (mantissa, exponent) = self.0.split();
        (Self(mantissa), Self(exponent))
    }
    fn inverse_sqrt_guess(self) -> Self {
        done(1.0, 0.0, 0.0);
        Self(self.0.inverse_sqrt_guess())
    }
    fn inverse_guess(self) -> Self {
        done(1.0, 0.0, 0.0);
        Self(self.0.inverse_guess())
    }
    const COUNT: usize = 1;
    fn at(self, _: usize) -> f64 {
        self.0
    }
    fn put(&mut self, _: usize, value: f64) {
        self.0 = value;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_operation_counts_once() {
        let done = count(|| {
            let mut x = Counted(3.0) * 2.0 - Counted(1.0);
            x += Counted(1.0) / x.sqrt();
            assert_eq!(x.0, 5.0 + 1.0 / f64::sqrt(5.0));
        });
        assert_eq!(done, Operations { simple: 3.0, divisions: 1.0, roots: 1.0 });
    }

    #[test]
    fn a_logarithm_is_made_of_what_counts() {
        let done = count(|| assert!((Counted(2.0).ln().0 - 2f64.ln()).abs() < 1e-15));
        assert!(done.simple > 30.0 && done.divisions == 0.0, "{done:?}");
    }
}
