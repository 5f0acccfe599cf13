//! One bond by itself, with numbers of any kind: the formulas of the stage, without its memory. The bench counts their
//! operations with numbers that count.

use super::kinematics::{Node, Step};
use crate::base::lanes::Real;
use crate::base::triple::Triple;
use crate::law::bond::{BondForce, BondLaw, BondShape};

/// A bond along x that is stretched step by step; of length and radius 1, up to the law's own units.
pub struct Trial<L: BondLaw, R: Real> {
    law: L,
    shape: BondShape<R>,
    force: BondForce<R>,
    history: L::State<R>,
    e1: Triple<R>,
    dashpot: R,
    turn: bool,
    damped: bool,
}

impl<L: BondLaw, R: Real> Trial<L, R> {
    /// A bond that was never loaded; `one` is the number 1 of the wanted kind. `turn` and `damped` as in the stage.
    pub fn new(law: L, one: R, turn: bool, damped: bool) -> Self {
        let zero = one.splat(0.0);
        let mut numbers = vec![0.0; L::HISTORY];
        L::each_number(&law.initial(), |k, number| numbers[k] = number);
        Self {
            history: L::history(|k| one.splat(numbers[k])),
            law,
            shape: BondShape { rest_length: one, radius: one, inverse_length: one, inverse_radius: one },
            force: BondForce { axial: zero, shear: [zero; 2], bend: [zero; 2], twist: zero },
            e1: Triple { x: zero, y: one, z: zero },
            dashpot: zero,
            turn,
            damped,
        }
    }

    /// Takes one step to the length `stretch`; returns the axial force.
    pub fn step(&mut self, stretch: f64) -> R {
        let zero = self.dashpot.splat(0.0);
        let none = Triple { x: zero, y: zero, z: zero };
        let far = Triple { x: zero.splat(stretch), y: zero, z: zero };
        let ends = [Node { x: none, v: none, w: none }, Node { x: far, v: none, w: none }];
        let live = zero.splat(1.0).simd_gt(zero);
        let one = zero.splat(1.0);
        let mut step = Step { law: &self.law, dt: one, per: one, live, plastic: zero, damping: zero };
        let viscosity = self.damped.then_some([one; 4]);
        let (shape, force, history) = (&self.shape, &mut self.force, &mut self.history);
        let acts = if self.turn {
            step.turning(&ends, shape, &mut self.e1, force, history, &mut self.dashpot, viscosity)
        } else {
            step.stretching(&ends, shape, force, history, &mut self.dashpot, viscosity)
        };
        // What the stage does besides: it asks for the thinning and for the plastic strain, and books the energies.
        let _ = (self.law.thinning(shape, history), self.law.plastic_strain(shape, history));
        acts.pull.x
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::bond::Moduli;
    use crate::law::bond::elastic::Elastic;

    #[test]
    fn a_trial_is_the_law_on_log_strain() {
        let moduli = Moduli::new(3.0, 0.25);
        for turn in [false, true] {
            let pull = Trial::new(Elastic { moduli }, 1.0, turn, false).step(1.1);
            let expected = 3.0 * std::f64::consts::PI * 1.1f64.ln();
            assert!((pull / expected - 1.0).abs() < 1e-14, "{pull} {expected}");
        }
    }
}
