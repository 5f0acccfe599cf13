//! `elasto-plastic`: true stress, isotropic hardening, plastic incompressibility, coupled section plasticity.
//!
//! Axial stress σ = E(ε − ε_p) on log strain; the section is A = A₀e^(−ε_p) and the stress-free length l₀e^(ε_p), so
//! every stiffness follows the plastic stretch. Yield surface of the round section (physics of beams):
//! f = (N/N_p)² + |M|/M_p + (T/T_p)² + (V/V_p)² − 1 with N_p = σ_yA, M_p = (4/3)σ_yr³, T_p = (2π/3)(σ_y/√3)r³,
//! V_p = (σ_y/√3)A. The return is associative and implicit; the equivalent plastic strain grows with the plastic work,
//! dp = dW_p/(σ_yAl). At M = 0 the surface has a true apex: a return that would turn M's sign ends there.

use super::hardening::Hardening;
use super::return_mapping::Trial;
use super::{
    BondForce, BondIncrement, BondLaw, BondShape, BondStiffness, Moduli, Section, add_transverse, square,
    transverse_energy,
};
use crate::base::lanes::{Mask, Real};
use std::f64::consts::FRAC_1_PI;

/// Elastoplastic bond.
#[derive(Debug, Clone, PartialEq)]
pub struct ElastoPlastic {
    /// Elastic constants.
    pub moduli: Moduli,
    /// Hardening law.
    pub hardening: Hardening,
}

/// History of an elastoplastic bond; everything after `equivalent` is derived and kept because it is read every step
/// and changes only in plastic ones.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlasticState<R = f64> {
    /// Plastic log strain along the axis ε_p (-).
    pub axial: R,
    /// Equivalent plastic strain p (-).
    pub equivalent: R,
    /// e^(−ε_p/2), factor on the radius (-).
    pub thinning: R,
    /// e^(ε_p/2) (-).
    pub inverse_thinning: R,
    /// σ_y(p) (Pa).
    pub yield_stress: R,
    /// dσ_y/dp (Pa).
    pub slope: R,
}

impl<R: Real> PlasticState<R> {
    #[inline(always)]
    fn select(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        Self {
            axial: R::select(mask, yes.axial, no.axial),
            equivalent: R::select(mask, yes.equivalent, no.equivalent),
            thinning: R::select(mask, yes.thinning, no.thinning),
            inverse_thinning: R::select(mask, yes.inverse_thinning, no.inverse_thinning),
            yield_stress: R::select(mask, yes.yield_stress, no.yield_stress),
            slope: R::select(mask, yes.slope, no.slope),
        }
    }
}

impl ElastoPlastic {
    #[inline(always)]
    fn trial_axial<R: Real>(&self, stress: R, state: &PlasticState<R>) -> Trial<R> {
        let zero = stress.splat(0.0);
        let inverse_yield = state.yield_stress.inverse();
        let inverse2 = inverse_yield * inverse_yield;
        Trial {
            axial: stress * inverse_yield,
            bend: zero,
            twist: zero,
            shear: zero,
            axial_rate: inverse2 * (2.0 * self.moduli.young),
            bend_rate: zero,
            twist_rate: zero,
            shear_rate: zero,
            hardening_rate: state.slope * inverse2,
            inverse_yield,
        }
    }

    /// Books a return: plastic strains, hardening, section. What is outside `wanted` does not matter.
    #[inline(always)]
    fn advance<R: Real>(&self, state: &mut PlasticState<R>, plastic_axial: R, equivalent: R, wanted: R::Mask) {
        state.axial += plastic_axial;
        state.equivalent += equivalent;
        // e^(∓Δε_p/2) to the rounding of a double: the next term of a step of 1e-5 is 2e-17.
        let half = plastic_axial * 0.5;
        state.thinning -= state.thinning * (half * (half * -0.5 + 1.0));
        state.inverse_thinning += state.inverse_thinning * (half * (half * 0.5 + 1.0));
        let large = half.abs().simd_gt(half.splat(5e-6)) & wanted;
        if large.any() {
            let thinning = (state.axial * -0.5).exp();
            state.thinning = R::select(large, thinning, state.thinning);
            state.inverse_thinning = R::select(large, thinning.inverse(), state.inverse_thinning);
        }
        (state.yield_stress, state.slope) = self.hardening.evaluate(state.equivalent);
    }

    /// The trial point of all modes.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn trial<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &BondForce<R>,
        state: &PlasticState<R>,
        section: &Section<R>,
        k: &BondStiffness<R>,
        stress: R,
        length: R,
    ) -> Trial<R> {
        let axial = self.trial_axial(stress, state);
        let inverse_radius = shape.inverse_radius * state.inverse_thinning;
        // 1/(σ_y r³); the limits are its inverse times 4/3 and 2π/3/√3, and σ_yA/√3.
        let inverse_moment = axial.inverse_yield * inverse_radius * inverse_radius * inverse_radius;
        let bend = inverse_moment * 0.75;
        let twist = inverse_moment * (1.5 * FRAC_1_PI * SQRT_3);
        let shear = axial.inverse_yield * inverse_radius * inverse_radius * (SQRT_3 * FRAC_1_PI);
        let volume = section.area * length;
        Trial {
            bend: force.bend_size() * bend,
            twist: force.twist.abs() * twist,
            shear: force.shear_size() * shear,
            bend_rate: k.bend * volume * bend * bend,
            twist_rate: k.twist * volume * twist * twist * 2.0,
            shear_rate: k.shear * volume * shear * shear * 2.0,
            ..axial
        }
    }

    /// σ = E(ε − ε_p) on the section that plastic stretch leaves (N).
    #[inline(always)]
    fn axial_force<R: Real>(&self, shape: &BondShape<R>, state: &PlasticState<R>, log_strain: R) -> R {
        (log_strain - state.axial) * self.moduli.young * self.section(shape, state).area
    }
}

impl BondLaw for ElastoPlastic {
    type State<R: Real> = PlasticState<R>;

    const HISTORY: usize = 6;

    #[inline(always)]
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> PlasticState<R> {
        PlasticState {
            axial: numbers(0),
            equivalent: numbers(1),
            thinning: numbers(2),
            inverse_thinning: numbers(3),
            yield_stress: numbers(4),
            slope: numbers(5),
        }
    }

    #[inline(always)]
    fn each_number<R: Real>(s: &PlasticState<R>, mut put: impl FnMut(usize, R)) {
        put(0, s.axial);
        put(1, s.equivalent);
        put(2, s.thinning);
        put(3, s.inverse_thinning);
        put(4, s.yield_stress);
        put(5, s.slope);
    }

    fn initial(&self) -> PlasticState {
        let (yield_stress, slope) = self.hardening.evaluate(0.0);
        PlasticState { axial: 0.0, equivalent: 0.0, thinning: 1.0, inverse_thinning: 1.0, yield_stress, slope }
    }

    #[inline(always)]
    fn response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut PlasticState<R>,
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R {
        let section = self.section(shape, state);
        let compliance = Compliance::new(&self.moduli, shape, state);
        let k = compliance.stiffness(&self.moduli, &section, natural_length(shape, state));
        let before = *force;
        add_transverse(force, &k, step);
        let stress = (step.log_strain - state.axial) * self.moduli.young;
        let trial = self.trial(shape, force, state, &section, &k, stress, step.length);
        let outside = trial.outside() & live;
        force.axial = stress * section.area;
        let zero = stress.splat(0.0);
        if !outside.any() {
            return zero;
        }
        let end = trial.solve(outside);
        let (mut flowed, mut history) = (*force, *state);
        for axis in 0..2 {
            flowed.shear[axis] *= end.shear;
            flowed.bend[axis] *= end.bend;
        }
        flowed.twist *= end.twist;
        let plastic_axial = (stress - stress * end.axial) * self.moduli.compliance;
        // Both ends of the step on the section at its start.
        let work = (before.axial + stress * end.axial * section.area) * 0.5 * step.length * plastic_axial
            + transverse_plastic_work(&before, &flowed, &compliance, step);
        self.advance(&mut history, plastic_axial, end.equivalent, outside);
        flowed.axial = self.axial_force(shape, &history, step.log_strain);
        let thinner = history.thinning * state.inverse_thinning;
        let work = work + soften(&mut flowed, &compliance, &self.stiffness(shape, &history), thinner);
        *force = BondForce::select(outside, &flowed, force);
        *state = PlasticState::select(outside, &history, state);
        R::select(outside, work, zero)
    }

    #[inline(always)]
    fn axial_response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut PlasticState<R>,
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R {
        let section = self.section(shape, state);
        let stress = (step.log_strain - state.axial) * self.moduli.young;
        let trial = self.trial_axial(stress, state);
        let outside = trial.outside() & live;
        let before = force.axial;
        force.axial = stress * section.area;
        let zero = stress.splat(0.0);
        if !outside.any() {
            return zero;
        }
        let end = trial.solve(outside);
        let plastic_axial = (stress - stress * end.axial) * self.moduli.compliance;
        let work = (before + stress * end.axial * section.area) * 0.5 * step.length * plastic_axial;
        let mut history = *state;
        self.advance(&mut history, plastic_axial, end.equivalent, outside);
        force.axial = R::select(outside, self.axial_force(shape, &history, step.log_strain), force.axial);
        *state = PlasticState::select(outside, &history, state);
        R::select(outside, work, zero)
    }

    #[inline(always)]
    fn stiffness<R: Real>(&self, shape: &BondShape<R>, state: &PlasticState<R>) -> BondStiffness<R> {
        self.section(shape, state).stiffness(&self.moduli, natural_length(shape, state))
    }

    /// The axial part is exact for σ = E ε_e on the volume A₀l₀e^(ε_e): E A₀l₀[(ε_e − 1)e^(ε_e) + 1].
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, state: &PlasticState) -> f64 {
        let strain = force.axial / (self.moduli.young * self.section(shape, state).area);
        let volume = Section::round(shape.radius).area * shape.rest_length;
        let axial = self.moduli.young * volume * (strain * f64::exp(strain) - strain.exp_m1());
        axial + transverse_energy(force, &self.stiffness(shape, state))
    }

    #[inline(always)]
    fn section<R: Real>(&self, shape: &BondShape<R>, state: &PlasticState<R>) -> Section<R> {
        Section::round(shape.radius * state.thinning)
    }

    #[inline(always)]
    fn plastic_strain<R: Real>(&self, _: &BondShape<R>, state: &PlasticState<R>) -> R {
        state.equivalent
    }

    #[inline(always)]
    fn thinning<R: Real>(&self, _: &BondShape<R>, state: &PlasticState<R>) -> R {
        state.thinning
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Inverse of the stress-free length, e^(−ε_p)/l₀ (1/m).
#[inline(always)]
fn natural_length<R: Real>(shape: &BondShape<R>, state: &PlasticState<R>) -> R {
    shape.inverse_length * (state.thinning * state.thinning)
}

/// Inverses of the stiffnesses across.
struct Compliance<R> {
    shear: R,
    bend: R,
    twist: R,
}

impl<R: Real> Compliance<R> {
    /// l³/(12EI) + l/(κGA), l/(EI), l/(GJ): inverses of radius and length are at hand, so nothing is divided.
    #[inline(always)]
    fn new(moduli: &Moduli, shape: &BondShape<R>, state: &PlasticState<R>) -> Self {
        let wider = state.inverse_thinning;
        let inverse_radius = shape.inverse_radius * wider;
        let inverse_radius2 = inverse_radius * inverse_radius;
        // The stress-free length grows as the section thins: l₀e^(ε_p).
        let length = shape.rest_length * (wider * wider);
        let bend = length * inverse_radius2 * inverse_radius2 * (4.0 * FRAC_1_PI * moduli.compliance);
        let slide = length * inverse_radius2 * (FRAC_1_PI / (moduli.kappa * moduli.shear));
        let shear = bend * length * length * (1.0 / 12.0) + slide;
        // Torsion is GJ/l = 2GI/l, bending EI/l.
        Self { shear, bend, twist: bend * moduli.bend_over_twist }
    }

    /// The stiffnesses; those of [`Section::stiffness`].
    #[inline(always)]
    fn stiffness(&self, moduli: &Moduli, section: &Section<R>, inverse_length: R) -> BondStiffness<R> {
        BondStiffness { shear: self.shear.inverse(), ..section.stiffness(moduli, inverse_length) }
    }
}

/// Mean force times plastic displacement over shear, bending and torsion (J); the plastic displacement is what the
/// elastic change of force does not explain.
#[inline(always)]
fn transverse_plastic_work<R: Real>(
    before: &BondForce<R>,
    after: &BondForce<R>,
    c: &Compliance<R>,
    step: &BondIncrement<R>,
) -> R {
    mode(before.twist, after.twist, c.twist, step.twist)
        + mode(before.shear[0], after.shear[0], c.shear, step.shear[0])
        + mode(before.bend[0], after.bend[0], c.bend, step.bend[0])
        + mode(before.shear[1], after.shear[1], c.shear, step.shear[1])
        + mode(before.bend[1], after.bend[1], c.bend, step.bend[1])
}

/// The part of one mode, whose force goes from `f0` to `f1` over the displacement `total`.
#[inline(always)]
fn mode<R: Real>(f0: R, f1: R, compliance: R, total: R) -> R {
    (f0 + f1) * 0.5 * (total - (f1 - f0) * compliance)
}

/// Elastic shear, bending and torsion stay what they were while the section thins: forces follow the stiffness, and the
/// energy that goes counts as plastic work (J), which is returned. `thinner` is the ratio of the radii (-).
#[inline(always)]
fn soften<R: Real>(force: &mut BondForce<R>, c: &Compliance<R>, now: &BondStiffness<R>, thinner: R) -> R {
    // I/l goes with r⁴ and the length with r⁻².
    let thinner2 = thinner * thinner;
    let turning = thinner2 * thinner2 * thinner2;
    let shear = now.shear * c.shear;
    let lost = (square(force.shear) * c.shear * (-shear + 1.0)
        + (square(force.bend) * c.bend + force.twist * force.twist * c.twist) * (-turning + 1.0))
        * 0.5;
    for axis in 0..2 {
        force.shear[axis] *= shear;
        force.bend[axis] *= turning;
    }
    force.twist *= turning;
    lost
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    const SHAPE: BondShape = BondShape {
        rest_length: 0.39e-3,
        radius: 0.195e-3,
        inverse_length: 1.0 / 0.39e-3,
        inverse_radius: 1.0 / 0.195e-3,
    };

    fn copper(linear: f64) -> ElastoPlastic {
        ElastoPlastic {
            moduli: Moduli::new(115e9, 0.34),
            hardening: Hardening::Voce { yield_stress: 100e6, saturation: 180e6, rate: 12.0, linear },
        }
    }

    fn perfectly_plastic() -> ElastoPlastic {
        ElastoPlastic { moduli: Moduli::new(115e9, 0.34), hardening: Hardening::Table(vec![[0.0, 100e6]]) }
    }

    fn still() -> BondIncrement {
        BondIncrement { length: SHAPE.rest_length, ..Default::default() }
    }

    #[test]
    fn one_wire_pulled_follows_the_hardening_law() {
        let law = copper(450e6);
        let (mut force, mut state, mut work) = (BondForce::default(), law.initial(), 0.0);
        let (steps, last) = (20_000, 0.25);
        let mut done = 0.0;
        let mut length = SHAPE.rest_length;
        for k in 1..=steps {
            let log_strain = last * k as f64 / steps as f64;
            let next = SHAPE.rest_length * f64::exp(log_strain);
            let before = force.axial;
            let step = BondIncrement { log_strain, length: next, ..Default::default() };
            work += law.response(&SHAPE, &mut force, &mut state, &step, true);
            done += 0.5 * (before + force.axial) * (next - length);
            length = next;
        }
        let stress = force.axial / law.section(&SHAPE, &state).area;
        let exact = law.hardening.stress(state.equivalent);
        assert!((stress / exact - 1.0).abs() < 1e-6, "{stress} {exact}");
        assert!((state.axial - state.equivalent).abs() < 1e-6);
        let held = law.elastic_energy(&SHAPE, &force, &state);
        assert!(((work + held) / done - 1.0).abs() < 1e-4, "{work} {held} {done}");
    }

    /// Strain per step some tens of the elastic one, and a slope that is infinite at first yield.
    #[test]
    fn large_steps_on_a_steep_law_harden_and_stay_on_it() {
        let hardening = Hardening::Ludwik { yield_stress: 90e6, strength: 400e6, exponent: 0.5 };
        let law = ElastoPlastic { moduli: Moduli::new(115e9, 0.34), hardening };
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for k in 1..=40 {
            let log_strain = 0.009 * k as f64;
            let length = SHAPE.rest_length * f64::exp(log_strain);
            let before = state.equivalent;
            let step = BondIncrement { log_strain, length, bend: [1e-4, 0.0], ..Default::default() };
            let work = law.response(&SHAPE, &mut force, &mut state, &step, true);
            assert!(state.equivalent > before && work > 0.0, "step {k}: p {} after {before}", state.equivalent);
            if k > 10 {
                let stress = force.axial / law.section(&SHAPE, &state).area;
                let exact = law.hardening.stress(state.equivalent);
                assert!((stress / exact - 1.0).abs() < 0.02, "step {k}: {stress} instead of {exact}");
            }
        }
        assert!((state.equivalent / state.axial - 1.0).abs() < 0.05, "{state:?}");
    }

    #[test]
    fn a_bond_bent_and_one_twisted_past_yield_reach_the_plastic_moments() {
        let law = perfectly_plastic();
        let r3 = SHAPE.radius.powi(3);
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..4000 {
            let step = BondIncrement { bend: [1e-4, 0.5e-4], ..still() };
            law.response(&SHAPE, &mut force, &mut state, &step, true);
        }
        let exact = (4.0 / 3.0) * 100e6 * r3;
        assert!((force.bend_size() / exact - 1.0).abs() < 1e-9, "{}", force.bend_size() / exact);
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..4000 {
            let step = BondIncrement { twist: 1e-4, ..still() };
            law.response(&SHAPE, &mut force, &mut state, &step, true);
        }
        let exact = (2.0 * PI / 3.0) * (100e6 / 3f64.sqrt()) * r3;
        assert!((force.twist / exact - 1.0).abs() < 1e-9, "{}", force.twist / exact);
    }

    #[test]
    fn tension_straightens_a_bent_bond_and_stops_at_the_apex() {
        let law = perfectly_plastic();
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..200 {
            law.response(&SHAPE, &mut force, &mut state, &BondIncrement { bend: [1e-4, 0.0], ..still() }, true);
        }
        assert!(force.bend[0] > 0.0);
        for k in 1..=4000 {
            let log_strain = 1e-5 * k as f64;
            let length = SHAPE.rest_length * f64::exp(log_strain);
            law.response(
                &SHAPE,
                &mut force,
                &mut state,
                &BondIncrement { log_strain, length, ..Default::default() },
                true,
            );
            assert!(force.bend[0] >= 0.0);
        }
        assert_eq!(force.bend[0], 0.0);
        let stress = force.axial / law.section(&SHAPE, &state).area;
        assert!((stress / 100e6 - 1.0).abs() < 1e-9);
    }

    #[test]
    fn any_path_dissipates_and_closes_its_ledger() {
        use crate::base::random::uniform;
        let law = copper(450e6);
        for path in 0..8 {
            let (mut force, mut state) = (BondForce::default(), law.initial());
            let (mut log_strain, mut length) = (0.0f64, SHAPE.rest_length);
            let (mut done, mut plastic) = (0.0, 0.0);
            for k in 0..20_000u64 {
                // A direction is kept for 500 steps, then another is drawn.
                let draw = |c: u64| uniform(path, c, k / 500) - 0.5;
                log_strain += 4e-6 * draw(0);
                let next = SHAPE.rest_length * log_strain.exp();
                let step = BondIncrement {
                    log_strain,
                    length: next,
                    shear: [3e-9 * draw(1), 3e-9 * draw(2)],
                    bend: [2e-5 * draw(3), 2e-5 * draw(4)],
                    twist: 2e-5 * draw(5),
                };
                let before = force;
                let work = law.response(&SHAPE, &mut force, &mut state, &step, true);
                plastic += work;
                let mean = |a: f64, b: f64, by: f64| 0.5 * (a + b) * by;
                done += mean(before.axial, force.axial, next - length) + mean(before.twist, force.twist, step.twist);
                for axis in 0..2 {
                    done += mean(before.shear[axis], force.shear[axis], step.shear[axis])
                        + mean(before.bend[axis], force.bend[axis], step.bend[axis]);
                }
                length = next;
            }
            let held = law.elastic_energy(&SHAPE, &force, &state);
            assert!(plastic > 0.0 && held >= 0.0);
            assert!((done - plastic - held).abs() < 2e-3 * plastic, "path {path}: {done} {plastic} {held}");
        }
    }

    #[test]
    fn the_axial_path_has_the_bits_of_the_general_one() {
        let law = copper(450e6);
        let (mut a, mut sa) = (BondForce::default(), law.initial());
        let (mut b, mut sb) = (a, sa);
        for k in 1..=3000 {
            let log_strain = 2e-6 * k as f64;
            let step =
                BondIncrement { log_strain, length: SHAPE.rest_length * f64::exp(log_strain), ..Default::default() };
            let wa = law.response(&SHAPE, &mut a, &mut sa, &step, true);
            let wb = law.axial_response(&SHAPE, &mut b, &mut sb, &step, true);
            assert_eq!((a, sa, wa.to_bits()), (b, sb, wb.to_bits()));
        }
    }
}
