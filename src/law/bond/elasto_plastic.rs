//! `elasto-plastic`: true stress, isotropic hardening, plastic incompressibility, coupled section plasticity.
//!
//! Axial stress σ = E(ε − ε_p) on log strain; the section is A = A₀e^(−ε_p) and the stress-free length l₀e^(ε_p), so
//! every stiffness follows the plastic stretch. Yield surface of the round section (physics of beams):
//! f = (N/N_p)² + |M|/M_p + (T/T_p)² + (V/V_p)² − 1 with N_p = σ_yA, M_p = (4/3)σ_yr³, T_p = (2π/3)(σ_y/√3)r³,
//! V_p = (σ_y/√3)A. The return is associative and implicit; the equivalent plastic strain grows with the plastic work,
//! dp = dW_p/(σ_yAl). At M = 0 the surface has a true apex: a return that would turn M's sign ends there.

use super::hardening::Hardening;
use super::{
    BondForce, BondIncrement, BondLaw, BondShape, BondStiffness, Moduli, Section, add_transverse, transverse_energy,
};
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
pub struct PlasticState {
    /// Plastic log strain along the axis ε_p [-].
    pub axial: f64,
    /// Equivalent plastic strain p [-].
    pub equivalent: f64,
    /// e^(−ε_p/2), factor on the radius [-].
    pub thinning: f64,
    /// e^(ε_p/2) [-].
    pub inverse_thinning: f64,
    /// σ_y(p) [Pa].
    pub yield_stress: f64,
    /// dσ_y/dp [Pa].
    pub slope: f64,
}

/// Where a return ends: factors on the trial values, and the plastic multiplier.
struct Return {
    /// σ/σ* [-].
    axial: f64,
    /// M/M*, T/T*, V/V* [-].
    bend: f64,
    twist: f64,
    shear: f64,
    /// Increment of p [-].
    equivalent: f64,
}

/// Trial point and compliances of the return, all relative to the yield values at the start of the step.
#[derive(Default)]
struct Trial {
    /// σ*/σ_y, |M*|/M_p, T*/T_p, |V*|/V_p [-].
    axial: f64,
    bend: f64,
    twist: f64,
    shear: f64,
    /// What one unit of x takes off each of them [1/Pa].
    axial_rate: f64,
    bend_rate: f64,
    twist_rate: f64,
    shear_rate: f64,
    /// Growth of σ_y/σ_y₀ with x at unit plastic work [1/Pa].
    hardening_rate: f64,
    /// 1/σ_y at the start [1/Pa].
    inverse_yield: f64,
}

impl Trial {
    fn outside(&self) -> bool {
        self.axial * self.axial + self.bend + self.twist * self.twist + self.shear * self.shear > 1.0
    }

    /// Newton on z = x (σ_y₀/σ_y)², in which the return has no division by the growth of σ_y: 1/growth is 1 − hz.
    ///
    /// The start is the root for tension alone, good to the square of the step; one round always follows, so that the
    /// answer depends smoothly on the trial, and more where that was not enough.
    #[inline(always)]
    fn solve(&self) -> Return {
        // Plastic work per x is 2 − m on the surface. Hardening within the step takes m from the trial: what that
        // leaves out is of second order in the step, and the next step starts from σ_y(p) again.
        let h = self.hardening_rate * (2.0 - self.bend.min(1.0));
        let square = |value: f64, rate: f64| [value * value, value * value * (h + rate)];
        let (n, t, v) = (
            square(self.axial, self.axial_rate),
            square(self.twist, self.twist_rate),
            square(self.shear, self.shear_rate),
        );
        let size2 = n[0] + t[0] + v[0];
        let mut z = ((size2.sqrt() - 1.0) * size2 / (n[1] + t[1] + v[1])).max(0.0);
        for round in 0.. {
            let shrink = 1.0 - h * z;
            // Each mode apart, so that the axial one has the same bits without the others.
            let soft = |rate: f64| 1.0 / (1.0 + z * rate);
            let (axial, twist, shear) = (soft(self.axial_rate), soft(self.twist_rate), soft(self.shear_rate));
            let (n, t, v) = (self.axial * shrink * axial, self.twist * shrink * twist, self.shear * shrink * shear);
            let bend = (self.bend * shrink - z * self.bend_rate).max(0.0);
            let f = n * n + bend + t * t + v * v - 1.0;
            if round > 0 && (f.abs() < 1e-10 || round == 60) {
                let growth = 1.0 / shrink;
                let kept = if bend > 0.0 { bend * growth / self.bend } else { 0.0 };
                let equivalent = z * (2.0 - bend) * self.inverse_yield * growth;
                return Return { axial, bend: kept, twist, shear, equivalent };
            }
            let fall = |value: f64, rate: f64, soft: f64| value * value * (h + rate * soft);
            let mut slope =
                fall(n, self.axial_rate, axial) + fall(t, self.twist_rate, twist) + fall(v, self.shear_rate, shear);
            slope *= -2.0;
            if bend > 0.0 {
                slope -= self.bend * h + self.bend_rate;
            }
            z = (z - f / slope).max(0.0);
        }
        unreachable!("the last round returns")
    }
}

impl ElastoPlastic {
    fn trial_axial(&self, stress: f64, state: &PlasticState) -> Trial {
        let inverse_yield = 1.0 / state.yield_stress;
        let inverse2 = inverse_yield * inverse_yield;
        Trial {
            axial: stress * inverse_yield,
            axial_rate: 2.0 * self.moduli.young * inverse2,
            hardening_rate: state.slope * inverse2,
            inverse_yield,
            ..Default::default()
        }
    }

    /// Books a return: plastic strains, hardening, section.
    #[inline(always)]
    fn advance(&self, state: &mut PlasticState, plastic_axial: f64, equivalent: f64) {
        state.axial += plastic_axial;
        state.equivalent += equivalent;
        // e^(∓Δε_p/2) to the rounding of a double: the next term of a step of 1e-5 is 2e-17.
        let half = 0.5 * plastic_axial;
        if half.abs() < 5e-6 {
            state.thinning *= 1.0 - half * (1.0 - 0.5 * half);
            state.inverse_thinning *= 1.0 + half * (1.0 + 0.5 * half);
        } else {
            state.thinning = (-0.5 * state.axial).exp();
            state.inverse_thinning = 1.0 / state.thinning;
        }
        (state.yield_stress, state.slope) = self.hardening.evaluate(state.equivalent);
    }

    /// The trial point of all modes.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn trial(
        &self,
        shape: &BondShape,
        force: &BondForce,
        state: &PlasticState,
        section: &Section,
        k: &BondStiffness,
        stress: f64,
        length: f64,
    ) -> Trial {
        let axial = self.trial_axial(stress, state);
        let inverse_radius = shape.inverse_radius * state.inverse_thinning;
        // 1/(σ_y r³); the limits are its inverse times 4/3 and 2π/3/√3, and σ_yA/√3.
        let inverse_moment = axial.inverse_yield * inverse_radius * inverse_radius * inverse_radius;
        let bend = 0.75 * inverse_moment;
        let twist = 1.5 * FRAC_1_PI * SQRT_3 * inverse_moment;
        let shear = SQRT_3 * FRAC_1_PI * axial.inverse_yield * inverse_radius * inverse_radius;
        let volume = section.area * length;
        Trial {
            bend: force.bend_size() * bend,
            twist: force.twist.abs() * twist,
            shear: force.shear_size() * shear,
            bend_rate: k.bend * volume * bend * bend,
            twist_rate: 2.0 * k.twist * volume * twist * twist,
            shear_rate: 2.0 * k.shear * volume * shear * shear,
            ..axial
        }
    }
}

impl BondLaw for ElastoPlastic {
    type State = PlasticState;

    fn initial(&self) -> PlasticState {
        let (yield_stress, slope) = self.hardening.evaluate(0.0);
        PlasticState { axial: 0.0, equivalent: 0.0, thinning: 1.0, inverse_thinning: 1.0, yield_stress, slope }
    }

    #[inline(always)]
    fn response(
        &self,
        shape: &BondShape,
        force: &mut BondForce,
        state: &mut PlasticState,
        step: &BondIncrement,
    ) -> f64 {
        let section = self.section(shape, state);
        let k = section.stiffness(&self.moduli, natural_length(shape, state));
        let before = *force;
        add_transverse(force, &k, step);
        let stress = self.moduli.young * (step.log_strain - state.axial);
        let trial = self.trial(shape, force, state, &section, &k, stress, step.length);
        if !trial.outside() {
            force.axial = stress * section.area;
            return 0.0;
        }
        let end = trial.solve();
        for axis in 0..2 {
            force.shear[axis] *= end.shear;
            force.bend[axis] *= end.bend;
        }
        force.twist *= end.twist;
        let compliance = Compliance::new(&k, &self.moduli);
        let plastic_axial = stress * (1.0 - end.axial) * self.moduli.compliance;
        // Both ends of the step on the section at its start.
        let work = 0.5 * (before.axial + stress * end.axial * section.area) * step.length * plastic_axial
            + transverse_plastic_work(&before, force, &compliance, step);
        let thinning_before = state.inverse_thinning;
        self.advance(state, plastic_axial, end.equivalent);
        force.axial = self.moduli.young * (step.log_strain - state.axial) * self.section(shape, state).area;
        work + soften(force, &compliance, &self.stiffness(shape, state), state.thinning * thinning_before)
    }

    #[inline(always)]
    fn axial_response(
        &self,
        shape: &BondShape,
        force: &mut BondForce,
        state: &mut PlasticState,
        step: &BondIncrement,
    ) -> f64 {
        let section = self.section(shape, state);
        let stress = self.moduli.young * (step.log_strain - state.axial);
        let trial = self.trial_axial(stress, state);
        if !trial.outside() {
            force.axial = stress * section.area;
            return 0.0;
        }
        let end = trial.solve();
        let plastic_axial = stress * (1.0 - end.axial) * self.moduli.compliance;
        let work = 0.5 * (force.axial + stress * end.axial * section.area) * step.length * plastic_axial;
        self.advance(state, plastic_axial, end.equivalent);
        force.axial = self.moduli.young * (step.log_strain - state.axial) * self.section(shape, state).area;
        work
    }

    #[inline(always)]
    fn stiffness(&self, shape: &BondShape, state: &PlasticState) -> BondStiffness {
        self.section(shape, state).stiffness(&self.moduli, natural_length(shape, state))
    }

    /// The axial part is exact for σ = E ε_e on the volume A₀l₀e^(ε_e): E A₀l₀[(ε_e − 1)e^(ε_e) + 1].
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, state: &PlasticState) -> f64 {
        let strain = force.axial / (self.moduli.young * self.section(shape, state).area);
        let volume = Section::round(shape.radius).area * shape.rest_length;
        let axial = self.moduli.young * volume * (strain * strain.exp() - strain.exp_m1());
        axial + transverse_energy(force, &self.stiffness(shape, state))
    }

    #[inline(always)]
    fn section(&self, shape: &BondShape, state: &PlasticState) -> Section {
        Section::round(shape.radius * state.thinning)
    }

    fn plastic_strain(&self, state: &PlasticState) -> f64 {
        state.equivalent
    }

    #[inline(always)]
    fn thinning(&self, state: &PlasticState) -> f64 {
        state.thinning
    }
}

const SQRT_3: f64 = 1.732_050_807_568_877_2;

/// Inverse of the stress-free length, e^(−ε_p)/l₀ [1/m].
#[inline(always)]
fn natural_length(shape: &BondShape, state: &PlasticState) -> f64 {
    shape.inverse_length * (state.thinning * state.thinning)
}

/// Inverses of the stiffnesses across.
struct Compliance {
    shear: f64,
    bend: f64,
    twist: f64,
}

impl Compliance {
    #[inline(always)]
    fn new(k: &BondStiffness, moduli: &Moduli) -> Self {
        let bend = 1.0 / k.bend;
        // Torsion is GJ/l = 2GI/l, bending EI/l.
        Self { shear: 1.0 / k.shear, bend, twist: bend * moduli.bend_over_twist }
    }
}

/// Mean force times plastic displacement over shear, bending and torsion [J]; the plastic displacement is what the
/// elastic change of force does not explain.
#[inline(always)]
fn transverse_plastic_work(before: &BondForce, after: &BondForce, c: &Compliance, step: &BondIncrement) -> f64 {
    let mode = |f0: f64, f1: f64, c: f64, total: f64| 0.5 * (f0 + f1) * (total - (f1 - f0) * c);
    let mut work = mode(before.twist, after.twist, c.twist, step.twist);
    for axis in 0..2 {
        work += mode(before.shear[axis], after.shear[axis], c.shear, step.shear[axis]);
        work += mode(before.bend[axis], after.bend[axis], c.bend, step.bend[axis]);
    }
    work
}

/// Elastic shear, bending and torsion stay what they were while the section thins: forces follow the stiffness, and the
/// energy that goes counts as plastic work [J], which is returned. `thinner` is the ratio of the radii [-].
#[inline(always)]
fn soften(force: &mut BondForce, c: &Compliance, now: &BondStiffness, thinner: f64) -> f64 {
    // I/l goes with r⁴ and the length with r⁻².
    let thinner2 = thinner * thinner;
    let turning = thinner2 * thinner2 * thinner2;
    let shear = now.shear * c.shear;
    let square = |v: [f64; 2]| v[0] * v[0] + v[1] * v[1];
    let lost = 0.5
        * (square(force.shear) * c.shear * (1.0 - shear)
            + (square(force.bend) * c.bend + force.twist * force.twist * c.twist) * (1.0 - turning));
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
            work += law.response(&SHAPE, &mut force, &mut state, &step);
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

    #[test]
    fn a_bond_bent_and_one_twisted_past_yield_reach_the_plastic_moments() {
        let law = perfectly_plastic();
        let r3 = SHAPE.radius.powi(3);
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..4000 {
            let step = BondIncrement { bend: [1e-4, 0.5e-4], ..still() };
            law.response(&SHAPE, &mut force, &mut state, &step);
        }
        let exact = (4.0 / 3.0) * 100e6 * r3;
        assert!((force.bend_size() / exact - 1.0).abs() < 1e-9, "{}", force.bend_size() / exact);
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..4000 {
            let step = BondIncrement { twist: 1e-4, ..still() };
            law.response(&SHAPE, &mut force, &mut state, &step);
        }
        let exact = (2.0 * PI / 3.0) * (100e6 / 3f64.sqrt()) * r3;
        assert!((force.twist / exact - 1.0).abs() < 1e-9, "{}", force.twist / exact);
    }

    #[test]
    fn tension_straightens_a_bent_bond_and_stops_at_the_apex() {
        let law = perfectly_plastic();
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..200 {
            law.response(&SHAPE, &mut force, &mut state, &BondIncrement { bend: [1e-4, 0.0], ..still() });
        }
        assert!(force.bend[0] > 0.0);
        for k in 1..=4000 {
            let log_strain = 1e-5 * k as f64;
            let length = SHAPE.rest_length * f64::exp(log_strain);
            law.response(&SHAPE, &mut force, &mut state, &BondIncrement { log_strain, length, ..Default::default() });
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
                let work = law.response(&SHAPE, &mut force, &mut state, &step);
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
            let wa = law.response(&SHAPE, &mut a, &mut sa, &step);
            let wb = law.axial_response(&SHAPE, &mut b, &mut sb, &step);
            assert_eq!((a, sa, wa.to_bits()), (b, sb, wb.to_bits()));
        }
    }
}
