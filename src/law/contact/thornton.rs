//! Elastic, perfectly plastic contact of two spheres with a limiting contact pressure p_y (Thornton 1997, J. Appl.
//! Mech. 64, 383).
//!
//! - Hertz up to yield: δ_y = (π p_y/2E*)² R*, F_y = π³ R*² p_y³/(6 E*²) = (2/3) π p_y R* δ_y.
//! - Plastic loading: F = F_y + π p_y R* (δ − δ_y) = π p_y R* (δ − δ_y/3).
//! - Unloading from (δ_m, F_m), and reloading up to it: F = (4/3) E* √R_p (δ − δ_p)^(3/2), none for δ ≤ δ_p.
//!
//! Thornton writes R_p = (4E*/3F_m) [(2F_m + F_y)/(2π p_y)]^(3/2) and δ_p = δ_m − (3F_m/(4E* √R_p))^(2/3). On the
//! plastic line the bracket is a_m² = R* δ_m, the square of the contact radius, so that these are
//! R_p = 4E* a_m³/(3F_m) and δ_p = δ_m − a_m²/R_p = δ_m − 3F_m/(4E* a_m): one square root and no other power.

use std::f64::consts::PI;

use super::hertz::{hertzian, hertzian_energy};
use super::{NormalLaw, NormalResponse};
use crate::base::lanes::{Mask, Real};

/// Thornton's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Thornton {
    /// Effective modulus E* of the pair (Pa).
    pub effective_modulus: f64,
    /// Limiting contact pressure p_y: hardness factor times yield stress (Pa).
    pub limiting_pressure: f64,
}

/// The curve on which a contact that has yielded unloads and reloads; all zero before yield.
///
/// It lasts as long as the contact's history: the dent stays when the bodies part.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct ThorntonState<R = f64> {
    /// Greatest overlap δ_m so far (m).
    pub greatest_overlap: R,
    /// Radius R_p of the dent, in which it unloads (m).
    pub dent_radius: R,
    /// Overlap δ_p that remains when the force is gone (m).
    pub residual_overlap: R,
}

impl<R: Real> ThorntonState<R> {
    #[inline(always)]
    fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            greatest_overlap: R::select(mask, yes.greatest_overlap, no.greatest_overlap),
            dent_radius: R::select(mask, yes.dent_radius, no.dent_radius),
            residual_overlap: R::select(mask, yes.residual_overlap, no.residual_overlap),
        }
    }
}

impl Thornton {
    /// Overlap at first yield δ_y = (π p_y/2E*)² R* (m).
    #[inline(always)]
    pub fn yield_overlap<R: Real>(&self, reduced_radius: R) -> R {
        let strain = PI * self.limiting_pressure / (2.0 * self.effective_modulus);
        reduced_radius * (strain * strain)
    }

    /// Slope of the plastic line π p_y R* (N/m).
    #[inline(always)]
    fn slope<R: Real>(&self, reduced_radius: R) -> R {
        reduced_radius * (PI * self.limiting_pressure)
    }

    /// Force on the plastic line (N).
    #[inline(always)]
    fn plastic_force<R: Real>(&self, reduced_radius: R, overlap: R) -> R {
        self.slope(reduced_radius) * (overlap - self.yield_overlap(reduced_radius) * (1.0 / 3.0))
    }

    /// The unloading curve from a point of the plastic line at `overlap` > δ_y with its force (N); the square of the
    /// contact radius there is `a2` (m²), its inverse `inverse_a` (1/m).
    #[inline(always)]
    fn curve_from<R: Real>(&self, overlap: R, force: R, a2: R, inverse_a: R) -> ThorntonState<R> {
        let recovery = force * inverse_a * (0.75 / self.effective_modulus);
        ThorntonState {
            greatest_overlap: overlap,
            dent_radius: a2 * recovery.inverse(),
            residual_overlap: overlap - recovery,
        }
    }

    /// Energy that unloading from δ_m, with the force F_m there, gives back: (2/5) F_m (δ_m − δ_p) (J).
    #[inline(always)]
    fn recoverable<R: Real>(state: &ThorntonState<R>, force: R) -> R {
        force * 0.4 * (state.greatest_overlap - state.residual_overlap)
    }

    /// Work that is not stored while a contact loads from `before` to `after` along the plastic line, where the force is
    /// `force` (N); through Hertz's curve if `before` has not yielded (J).
    #[inline(always)]
    fn lost<R: Real>(&self, before: &ThorntonState<R>, after: &ThorntonState<R>, force: R, reduced_radius: R) -> R {
        let zero = reduced_radius.splat(0.0);
        let dented = before.greatest_overlap.simd_gt(zero);
        // The plastic line begins at first yield, where everything is stored.
        let from = R::select(dented, before.greatest_overlap, self.yield_overlap(reduced_radius));
        let force_there = self.plastic_force(reduced_radius, from);
        let stored = R::select(dented, Self::recoverable(before, force_there), force_there * from * 0.4);
        let work = (force_there + force) * 0.5 * (after.greatest_overlap - from);
        work - (Self::recoverable(after, force) - stored)
    }

    /// Whether the contact loads plastically at `overlap` with this history.
    #[inline(always)]
    fn yields<R: Real>(&self, state: &ThorntonState<R>, reduced_radius: R, overlap: R) -> R::Mask {
        overlap.simd_gt(state.greatest_overlap) & overlap.simd_gt(self.yield_overlap(reduced_radius))
    }

    /// Radius and shift of the Hertzian curve on which the contact moves while it does not yield: (R*, 0) before
    /// first yield, (R_p, δ_p) after it.
    #[inline(always)]
    fn elastic_curve<R: Real>(state: &ThorntonState<R>, reduced_radius: R) -> (R, R) {
        let zero = reduced_radius.splat(0.0);
        let dented = state.greatest_overlap.simd_gt(zero);
        (R::select(dented, state.dent_radius, reduced_radius), R::select(dented, state.residual_overlap, zero))
    }
}

impl NormalLaw for Thornton {
    type State<R: Real> = ThorntonState<R>;

    const HISTORY: usize = 3;

    #[inline(always)]
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> ThorntonState<R> {
        ThorntonState { greatest_overlap: numbers(0), dent_radius: numbers(1), residual_overlap: numbers(2) }
    }

    #[inline(always)]
    fn each_number<R: Real>(s: &ThorntonState<R>, mut put: impl FnMut(usize, R)) {
        put(0, s.greatest_overlap);
        put(1, s.dent_radius);
        put(2, s.residual_overlap);
    }

    #[inline(always)]
    fn response<R: Real>(&self, state: &mut ThorntonState<R>, reduced_radius: R, overlap: R) -> NormalResponse<R> {
        let zero = overlap.splat(0.0);
        let yields = self.yields(state, reduced_radius, overlap);
        let (radius, shift) = Self::elastic_curve(state, reduced_radius);
        let elastic = (overlap - shift).simd_max(zero);
        // One root serves both branches.
        let a2 = R::select(yields, reduced_radius * overlap, radius * elastic);
        let answer = hertzian(self.effective_modulus, a2, elastic);
        if !yields.any() {
            return answer;
        }
        let force = self.plastic_force(reduced_radius, overlap);
        let after = self.curve_from(overlap, force, a2, answer.inverse_radius);
        let plastic_work = self.lost(state, &after, force, reduced_radius);
        *state = ThorntonState::select(yields, &after, state);
        NormalResponse {
            force: R::select(yields, force, answer.force),
            stiffness: R::select(yields, self.slope(reduced_radius), answer.stiffness),
            plastic_work: R::select(yields, plastic_work, zero),
            ..answer
        }
    }

    #[inline(always)]
    fn limiting_pressure(&self) -> f64 {
        self.limiting_pressure
    }

    fn effective_modulus(&self) -> f64 {
        self.effective_modulus
    }

    #[inline(always)]
    fn elastic_energy(&self, state: &ThorntonState, reduced_radius: f64, overlap: f64) -> f64 {
        if self.yields(state, reduced_radius, overlap) {
            let (a2, force) = (reduced_radius * overlap, self.plastic_force(reduced_radius, overlap));
            return Self::recoverable(&self.curve_from(overlap, force, a2, a2.inverse_sqrt()), force);
        }
        let (radius, shift) = Self::elastic_curve(state, reduced_radius);
        hertzian_energy(self.effective_modulus, radius, (overlap - shift).max(0.0))
    }

    /// 2E* a_m, the slope with which it unloads from the greatest overlap: it is at least that of the plastic line,
    /// π p_y R* = 2E* a_y, because a_m ≥ a_y.
    #[inline(always)]
    fn greatest_stiffness(&self, state: &ThorntonState, reduced_radius: f64, overlap: f64) -> f64 {
        let contact_radius_squared = if self.yields(state, reduced_radius, overlap) {
            reduced_radius * overlap
        } else {
            let (radius, shift) = Self::elastic_curve(state, reduced_radius);
            radius * (overlap.max(state.greatest_overlap) - shift).max(0.0)
        };
        2.0 * self.effective_modulus * contact_radius_squared.sqrt()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Two copper wires of 0.39 mm: E = 115 GPa, ν = 0.34, p_y = 2.8 × 90 MPa.
    const LAW: Thornton = Thornton { effective_modulus: 65.0e9, limiting_pressure: 252e6 };
    const RADIUS: f64 = 0.0975e-3;

    fn near(value: f64, expected: f64, tolerance: f64) {
        assert!((value / expected - 1.0).abs() <= tolerance, "{value} is not {expected}");
    }

    fn yield_force() -> f64 {
        PI.powi(3) * RADIUS.powi(2) * LAW.limiting_pressure.powi(3) / (6.0 * LAW.effective_modulus.powi(2))
    }

    fn loaded_to(overlap: f64) -> (ThorntonState, NormalResponse) {
        let mut state = ThorntonState::default();
        let response = LAW.response(&mut state, RADIUS, overlap);
        (state, response)
    }

    #[test]
    fn the_curve_is_the_one_that_thornton_wrote() {
        let overlap = 40.0 * LAW.yield_overlap(RADIUS);
        let (state, response) = loaded_to(overlap);
        let (e, p, force) = (LAW.effective_modulus, LAW.limiting_pressure, response.force);
        near(force, yield_force() + PI * p * RADIUS * (overlap - LAW.yield_overlap(RADIUS)), 1e-13);
        let dent = 4.0 * e / (3.0 * force) * ((2.0 * force + yield_force()) / (2.0 * PI * p)).powf(1.5);
        near(state.dent_radius, dent, 1e-13);
        near(state.residual_overlap, overlap - (3.0 * force / (4.0 * e * dent.sqrt())).powf(2.0 / 3.0), 1e-13);
    }

    #[test]
    fn force_stiffness_and_radius_are_continuous_at_yield() {
        let at = LAW.yield_overlap(RADIUS);
        let (below, above) = (loaded_to(at * (1.0 - 1e-9)), loaded_to(at * (1.0 + 1e-9)));
        assert_eq!(below.0, ThorntonState::default());
        assert!(above.0.greatest_overlap > 0.0);
        near(below.1.force, above.1.force, 1e-8);
        near(below.1.stiffness, above.1.stiffness, 1e-8);
        near(below.1.radius, above.1.radius, 1e-8);
        near(below.1.force, yield_force(), 1e-8);
    }

    #[test]
    fn force_and_radius_are_continuous_where_unloading_begins() {
        for multiple in [1.01, 3.0, 1e3, 1e5] {
            let overlap = multiple * LAW.yield_overlap(RADIUS);
            let (mut state, plastic) = loaded_to(overlap);
            let elastic = LAW.response(&mut state, RADIUS, overlap * (1.0 - 1e-12));
            near(elastic.force, plastic.force, 1e-8);
            near(elastic.radius, plastic.radius, 1e-8);
            assert!(elastic.stiffness >= plastic.stiffness);
        }
    }

    #[test]
    fn on_elastic_branches_force_is_the_slope_of_the_energy() {
        let greatest = 500.0 * LAW.yield_overlap(RADIUS);
        let (dented, _) = loaded_to(greatest);
        let span = greatest - dented.residual_overlap;
        let on_dent = [0.1, 0.5, 0.9].map(|x| (dented, dented.residual_overlap + x * span, x * span));
        let virgin = [0.1, 0.5, 0.9].map(|x| x * LAW.yield_overlap(RADIUS));
        let virgin = virgin.map(|overlap| (ThorntonState::default(), overlap, overlap));
        for (mut state, overlap, scale) in on_dent.into_iter().chain(virgin) {
            let h = 1e-3 * scale;
            let energy = |d| LAW.elastic_energy(&state, RADIUS, d);
            let slope = (energy(overlap + h) - energy(overlap - h)) / (2.0 * h);
            near(slope, LAW.response(&mut state, RADIUS, overlap).force, 1e-5);
            let mut force = |d| LAW.response(&mut state, RADIUS, d).force;
            let slope = (force(overlap + h) - force(overlap - h)) / (2.0 * h);
            near(slope, LAW.response(&mut state, RADIUS, overlap).stiffness, 1e-5);
        }
    }

    #[test]
    fn a_history_is_its_numbers_and_constants_are_told() {
        let mut seen = Vec::new();
        Thornton::each_number(&Thornton::history(|k| 1.5 + k as f64), |k, number| seen.push((k, number)));
        assert_eq!(seen, [(0, 1.5), (1, 2.5), (2, 3.5)]);
        assert_eq!((LAW.effective_modulus(), LAW.limiting_pressure()), (65.0e9, 252e6));
    }

    #[test]
    fn a_dent_stays_and_never_pulls() {
        let (mut state, _) = loaded_to(300.0 * LAW.yield_overlap(RADIUS));
        let dent = state;
        for overlap in [dent.residual_overlap, 0.5 * dent.residual_overlap, 0.0, -1e-3] {
            let answer = LAW.response(&mut state, RADIUS, overlap);
            assert_eq!([answer.force, answer.stiffness, answer.radius, answer.plastic_work], [0.0; 4]);
            assert_eq!(LAW.elastic_energy(&state, RADIUS, overlap), 0.0);
        }
        assert_eq!(state, dent);
    }

    #[test]
    fn the_loop_integral_is_the_plastic_work() {
        let unit = LAW.yield_overlap(RADIUS);
        let turns = [0.0, 50.0, 20.0, 80.0, 30.0, 200.0, 0.0, 150.0, 0.0].map(|x| x * unit);
        let mut state = ThorntonState::default();
        let (mut work, mut plastic, mut before) = (0.0, 0.0, 0.0);
        for pair in turns.windows(2) {
            let steps = 20_000;
            let step = (pair[1] - pair[0]) / steps as f64;
            for i in 1..=steps {
                let response = LAW.response(&mut state, RADIUS, pair[0] + i as f64 * step);
                assert!(response.force >= 0.0);
                assert!(response.plastic_work >= -1e-12 * response.force * unit);
                work += 0.5 * (before + response.force) * step;
                plastic += response.plastic_work;
                before = response.force;
            }
            let stored = LAW.elastic_energy(&state, RADIUS, pair[1]);
            near(work, plastic + stored, 1e-5);
        }
        let one_stroke = loaded_to(200.0 * unit).1.plastic_work;
        near(plastic, one_stroke, 1e-9);
    }

    #[test]
    fn greatest_stiffness_bounds_every_slope_on_the_way_back() {
        for multiple in [0.5, 1.0, 1.2, 30.0, 1e4] {
            let overlap = multiple * LAW.yield_overlap(RADIUS);
            let virgin = LAW.greatest_stiffness(&ThorntonState::default(), RADIUS, overlap);
            let (mut state, first) = loaded_to(overlap);
            let bound = LAW.greatest_stiffness(&state, RADIUS, overlap);
            near(bound, virgin, 1e-12);
            // It is the slope where unloading begins, and the energy there the same before and after.
            let stored = LAW.elastic_energy(&ThorntonState::default(), RADIUS, overlap);
            near(stored, LAW.elastic_energy(&state, RADIUS, overlap), 1e-12);
            let unloading = LAW.response(&mut { state }, RADIUS, overlap * (1.0 - 1e-9)).stiffness;
            near(bound, unloading, 1e-6);
            assert!(first.stiffness <= bound * (1.0 + 1e-12));
            for i in 0..=1000 {
                let slope = LAW.response(&mut state, RADIUS, overlap * i as f64 / 1000.0).stiffness;
                assert!(slope <= bound * (1.0 + 1e-12));
            }
        }
    }

    /// Speed of rebound over speed of approach of a mass that meets the contact, by velocity Verlet.
    fn restitution(speed: f64, mass: f64) -> f64 {
        // Two time scales: a quarter period on the plastic line, and the way to first yield.
        let slope = PI * LAW.limiting_pressure * RADIUS;
        let dt = 1e-4 * (mass / slope).sqrt().min(1e3 * LAW.yield_overlap(RADIUS) / speed);
        let mut state = ThorntonState::default();
        let (mut x, mut v, mut force) = (0.0, speed, 0.0);
        loop {
            v -= 0.5 * dt * force / mass;
            x += dt * v;
            force = LAW.response(&mut state, RADIUS, x).force;
            v -= 0.5 * dt * force / mass;
            if force == 0.0 && v < 0.0 {
                return -v / speed;
            }
        }
    }

    #[test]
    fn two_spheres_rebound_as_thornton_says() {
        let mass = 1e-7;
        let p = LAW.limiting_pressure;
        let yield_speed = (PI / (2.0 * LAW.effective_modulus)).powi(2)
            * (8.0 * PI * RADIUS.powi(3) / (15.0 * mass)).sqrt()
            * p.powf(2.5);
        for (ratio, expected) in [(1.5, 0.971239), (3.0, 0.862740), (10.0, 0.658558), (100.0, 0.374299)] {
            near(restitution(ratio * yield_speed, mass), expected, 1e-3);
        }
        near(restitution(0.9 * yield_speed, mass), 1.0, 1e-6);
    }

    proptest! {
        #[test]
        fn no_walk_of_the_overlap_creates_energy(walk in prop::collection::vec(-20.0..300.0f64, 2..60)) {
            let unit = LAW.yield_overlap(RADIUS);
            let mut state = ThorntonState::default();
            for multiple in walk {
                let before = state;
                let response = LAW.response(&mut state, RADIUS, multiple * unit);
                prop_assert!(response.force >= 0.0 && response.stiffness >= 0.0);
                prop_assert!(response.plastic_work >= 0.0);
                prop_assert!(state.greatest_overlap >= before.greatest_overlap);
                prop_assert!(state.residual_overlap >= before.residual_overlap);
            }
        }
    }
}
