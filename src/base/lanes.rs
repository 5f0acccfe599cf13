//! Numbers that come one at a time or several at once, so that a formula is written once for both.
//!
//! [`Real`] is implemented by `f64` and by [`Lanes`], a register of the widest instruction set that the machine has
//! (found at run time by `pulp`); [`recorder`](super::recorder) implements it by writing down what is done. Every operation
//! rounds as IEEE 754 says, and what is fused into one rounding is written so, never left to the compiler; the functions of
//! [`Real`] are built from such operations alone: a lane has the same bits as an `f64`, on every machine.

mod real;
mod registers;

pub(super) use real::{EXPONENT_TO_BITS, INVERSE_BITS, INVERSE_SQRT_BITS, NUMBER_OF_BITS};
pub use real::{Mask, Real, Refinement};
pub use registers::{LaneMask, Lanes, register_width};

/// Lanes of one block: two of the widest registers have as many, narrower ones take a block in several goes.
pub const BLOCK: usize = 16;

#[cfg(test)]
mod tests {
    use super::*;
    use pulp::{Arch, Simd, WithSimd};

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

    const TABLE: [[f64; 2]; 4] = [[0.0, 1.0], [0.9, 2.5], [2.0, 3.0], [30.0, -7.0]];

    #[test]
    fn a_table_is_entered_between_its_rows_and_at_its_ends() {
        for (x, first) in [(-1.0, 0), (0.0, 0), (0.89, 0), (0.9, 1), (1.9, 1), (2.0, 2), (30.0, 2), (1e9, 2)] {
            assert_eq!(x.rows_around(&TABLE), [TABLE[first], TABLE[first + 1]], "{x}");
        }
    }

    #[test]
    fn whole_numbers_are_the_nearest_and_of_two_the_even_one() {
        for (x, whole) in
            [(0.5, 0.0), (1.5, 2.0), (2.5, 2.0), (-0.5, 0.0), (-1.5, -2.0), (-3.7, -4.0), (1e15 + 0.25, 1e15)]
        {
            assert_eq!(Real::round_ties_even(x), whole, "{x}");
        }
    }

    /// The root of a number, by Newton's rule; rounds are counted.
    struct Root<'a>(f64, &'a std::cell::Cell<u32>);

    impl Refinement<f64> for Root<'_> {
        type Point = f64;
        fn at(&self, number: f64) -> f64 {
            number * number - self.0
        }
        fn unsettled(&self, rest: &f64) -> bool {
            rest.abs() > 1e-12 * self.0
        }
        fn next(&self, number: f64, rest: &f64) -> f64 {
            self.1.set(self.1.get() + 1);
            number - 0.5 * rest / number
        }
    }

    #[test]
    fn a_number_is_refined_once_and_then_until_it_is_settled() {
        for (start, most, rounds) in [(3.0, 60, 1), (3.5, 60, 4), (3.5, 2, 2)] {
            let count = std::cell::Cell::new(0);
            let (root, rest) = start.refine(&Root(9.0, &count), true, most);
            assert_eq!((count.get(), rest), (rounds, root * root - 9.0), "from {start}");
            assert!(most < 10 || (root - 3.0).abs() < 1e-12);
        }
        let count = std::cell::Cell::new(0);
        assert_eq!(3.5.refine(&Root(9.0, &count), false, 60).0, 3.5);
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
                let [[_, low], [_, high]] = x.rows_around(&TABLE);
                let all = [x.ln(), (x * 1e-3).exp(), picked, high - low, x.inverse_sqrt()];
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
            let [[_, low], [_, high]] = x.rows_around(&TABLE);
            let own = [Real::ln(*x), Real::exp(x * 1e-3), picked, high - low, x.inverse_sqrt()];
            for lanes in [wide, narrow] {
                assert_eq!(own.map(f64::to_bits), lanes.map(f64::to_bits), "{x}");
            }
        }
    }
}
