//! Tests of the flow rule of [`super::elasto_plastic`] in closed form. Plastic displacements are normal to the yield
//! surface, per unit of the multiplier 2N/N_p², 1/M_p along M, 2T/T_p² and 2V/V_p² along V, on the section and the
//! length that plastic stretch has left. No formula here is taken from the law; all follow from that sentence.

use super::elasto_plastic::{ElastoPlastic, PlasticState};
use super::hardening::Hardening;
use super::{BondForce, BondIncrement, BondLaw, BondShape, Moduli};
use std::f64::consts::PI;

const RADIUS: f64 = 0.195e-3;
const LENGTH: f64 = 0.5e-3;
const YOUNG: f64 = 115e9;
const POISSON: f64 = 0.34;
const SHEAR: f64 = YOUNG / (2.0 * (1.0 + POISSON));

fn shape() -> BondShape {
    BondShape::new(LENGTH, RADIUS)
}

/// Perfectly plastic at `stress` (Pa).
fn law(stress: f64) -> ElastoPlastic {
    ElastoPlastic { moduli: Moduli::new(YOUNG, POISSON), hardening: Hardening::Table(vec![[0.0, stress]]) }
}

/// Limits and stiffnesses of a round bond of a yield stress (Pa) at the plastic stretch ε_p (-).
struct Bond {
    length: f64,
    area: f64,
    /// N_p (N), M_p (N m), T_p (N m), V_p (N).
    limits: [f64; 4],
    /// EI/l (N m), GJ/l (N m), Timoshenko's shear stiffness (N/m).
    bend: f64,
    twist: f64,
    shear: f64,
}

fn bond(stress: f64, stretch: f64) -> Bond {
    let (r, l) = (RADIUS * (-0.5 * stretch).exp(), LENGTH * stretch.exp());
    let (area, inertia) = (PI * r * r, 0.25 * PI * r.powi(4));
    let kappa = 6.0 * (1.0 + POISSON) / (7.0 + 6.0 * POISSON);
    Bond {
        length: l,
        area,
        limits: [
            stress * area,
            4.0 / 3.0 * stress * r.powi(3),
            2.0 * PI / 3.0 * stress / 3f64.sqrt() * r.powi(3),
            stress / 3f64.sqrt() * area,
        ],
        bend: YOUNG * inertia / l,
        twist: SHEAR * 2.0 * inertia / l,
        shear: 1.0 / (l.powi(3) / (12.0 * YOUNG * inertia) + l / (kappa * SHEAR * area)),
    }
}

fn near(value: f64, expected: f64, tolerance: f64, what: &str) {
    assert!((value / expected - 1.0).abs() <= tolerance, "{what}: {value} instead of {expected}");
}

/// A bond that flows under the same displacements at every step comes to the point of the yield surface where they are
/// normal to it, before and after it was stretched.
#[test]
fn steady_flow_is_normal_to_the_yield_surface() {
    const STRESS: f64 = 100e6;
    let law = law(STRESS);
    for stretch in [0.0, 0.15] {
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for k in 1..=3000 {
            let log_strain = (stretch + STRESS / YOUNG) * f64::from(k) / 3000.0;
            let step = BondIncrement { log_strain, length: LENGTH * log_strain.exp(), ..Default::default() };
            law.response(&shape(), &mut force, &mut state, &step, true);
        }
        near(state.axial + 1.0, stretch + 1.0, 1e-9, "stretch");
        let bond = bond(STRESS, state.axial);
        let [_, bending, twisting, shearing] = bond.limits;
        // Of the limits, with f = |m| + t² + v² − 1 = 0.
        let (t, v) = (0.5f64, -0.4f64);
        let m = 1.0 - t * t - v * v;
        for multiplier in [0.01, 0.3].map(|part| part * bending * bending / bond.bend) {
            let (bend, twist, shear) =
                (multiplier / bending, 2.0 * t * multiplier / twisting, 2.0 * v * multiplier / shearing);
            let step = BondIncrement {
                log_strain: state.axial,
                length: bond.length,
                bend: [0.6 * bend, -0.8 * bend],
                twist,
                shear: [0.8 * shear, 0.6 * shear],
            };
            let (mut work, mut before) = (0.0, state);
            for _ in 0..5000 {
                before = state;
                work = law.response(&shape(), &mut force, &mut state, &step, true);
            }
            near(force.bend[0], 0.6 * m * bending, 1e-8, "M₁");
            near(force.bend[1], -0.8 * m * bending, 1e-8, "M₂");
            near(force.twist, t * twisting, 1e-8, "T");
            near(force.shear[0], 0.8 * v * shearing, 1e-8, "V₁");
            near(force.shear[1], 0.6 * v * shearing, 1e-8, "V₂");
            assert_eq!(force.axial, 0.0);
            // Forces times displacements; and dp = dW_p/(σ_y A l).
            let done = multiplier * (m + 2.0 * t * t + 2.0 * v * v);
            near(work, done, 1e-8, "plastic work");
            let grown = state.equivalent - before.equivalent;
            near(grown, done / (STRESS * bond.area * bond.length), 1e-6, "p");
        }
    }
}

/// Shear, bending and torsion that a bond holds while it is pulled along: the flow takes them off, and what elastic
/// displacement is left acts on the section that thins. With the force along the axis near its limit N = nN_p, the
/// elastic displacement x of a mode goes with the plastic stretch as dx/dε_p = −l N_p/(2n) ∂f/∂F; the ledger closes.
#[test]
fn a_bond_pulled_out_sheds_what_it_holds_across() {
    // High, so that the modes last while the section thins by some per cent.
    const STRESS: f64 = 10e9;
    const STEPS: u32 = 20_000;
    let law = law(STRESS);
    let virgin = bond(STRESS, 0.0);
    let [_, bending, twisting, shearing] = virgin.limits;
    // Bending, torsion, shear.
    for mode in 0..3 {
        let held = [0.4 * bending / virgin.bend, 0.5 * twisting / virgin.twist, 0.5 * shearing / virgin.shear][mode];
        let (mut force, mut state) = (BondForce::default(), law.initial());
        let mut step = BondIncrement { length: LENGTH, ..Default::default() };
        match mode {
            0 => step.bend = [0.8 * held, 0.6 * held],
            1 => step.twist = held,
            _ => step.shear = [-0.6 * held, 0.8 * held],
        }
        assert_eq!(law.response(&shape(), &mut force, &mut state, &step, true), 0.0);
        let (mut done, mut plastic) = (law.elastic_energy(&shape(), &force, &state), 0.0);
        let (mut elastic, mut length) = (held, LENGTH);
        // The elastic strain is 0.087.
        let last = [0.11, 0.13, 0.13][mode];
        for k in 1..=STEPS {
            let log_strain = last * f64::from(k) / f64::from(STEPS);
            let next = LENGTH * log_strain.exp();
            let (before, pull) = (state.axial, force.axial);
            let step = BondIncrement { log_strain, length: next, ..Default::default() };
            plastic += law.response(&shape(), &mut force, &mut state, &step, true);
            done += 0.5 * (pull + force.axial) * (next - length);
            length = next;
            let rate = |elastic: f64, stretch: f64| {
                let b = bond(STRESS, stretch);
                let [along, bending, twisting, shearing] = b.limits;
                let (share, normal) = match mode {
                    0 => (b.bend * elastic / bending, 1.0 / bending),
                    1 => ((b.twist * elastic / twisting).powi(2), 2.0 * b.twist * elastic / twisting.powi(2)),
                    _ => ((b.shear * elastic / shearing).powi(2), 2.0 * b.shear * elastic / shearing.powi(2)),
                };
                // The plastic displacement along the axis is that of the stretch over the length now.
                -next * along / (2.0 * (1.0 - share).sqrt()) * normal
            };
            let grown = state.axial - before;
            let half = elastic + 0.5 * grown * rate(elastic, before);
            elastic += grown * rate(half, before + 0.5 * grown);
        }
        let b = bond(STRESS, state.axial);
        assert!(state.axial > 0.02 && elastic > 0.1 * held && elastic < 0.8 * held, "{mode}: {elastic} of {held}");
        let (value, expected) = match mode {
            0 => (0.8 * force.bend[0] + 0.6 * force.bend[1], b.bend * elastic),
            1 => (force.twist, b.twist * elastic),
            _ => (-0.6 * force.shear[0] + 0.8 * force.shear[1], b.shear * elastic),
        };
        near(value, expected, 2e-4, ["M", "T", "V"][mode]);
        let stored = law.elastic_energy(&shape(), &force, &state);
        near(plastic + stored, done, 2e-5, "ledger");
        let PlasticState { thinning, inverse_thinning, .. } = state;
        near(thinning, (-0.5 * state.axial).exp(), 1e-12, "thinning");
        near(inverse_thinning, (0.5 * state.axial).exp(), 1e-12, "its inverse");
    }
}

/// With linear hardening one mode ends each step, however long, on the surface of the yield stress that the step itself
/// has brought: the plastic work per multiplier is 2 in torsion and shear, 1 in bending.
#[test]
fn a_long_step_ends_on_the_surface_that_it_has_hardened_to() {
    let hardening = Hardening::Table(vec![[0.0, 100e6], [1.0, 5100e6]]);
    let law = ElastoPlastic { moduli: Moduli::new(YOUNG, POISSON), hardening: hardening.clone() };
    let virgin = bond(100e6, 0.0);
    for mode in 0..3 {
        let (mut force, mut state) = (BondForce::default(), law.initial());
        for _ in 0..20 {
            let mut step = BondIncrement { length: LENGTH, ..Default::default() };
            match mode {
                0 => step.bend = [virgin.limits[1] / virgin.bend, 0.0],
                1 => step.twist = virgin.limits[2] / virgin.twist,
                _ => step.shear = [0.0, virgin.limits[3] / virgin.shear],
            }
            law.response(&shape(), &mut force, &mut state, &step, true);
        }
        assert!(state.equivalent > 1e-3, "{state:?}");
        let [_, bending, twisting, shearing] = bond(hardening.stress(state.equivalent), 0.0).limits;
        let reached = [force.bend[0] / bending, force.twist / twisting, force.shear[1] / shearing][mode];
        near(reached, 1.0, 1e-6, ["M", "T", "V"][mode]);
    }
}
