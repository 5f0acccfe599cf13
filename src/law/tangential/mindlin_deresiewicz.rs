//! Partial slip with loading, unloading and reloading (Mindlin & Deresiewicz 1953, J. Appl. Mech. 20, 327; in the
//! incremental form of Thornton, Cummins & Cleary 2011, Powder Technol. 210, 189):
//! ΔF = 8 G* a θ Δδ + (−1)^k μ (1 − θ) ΔF_n.
//!
//! # Slip under constant normal force
//!
//! Let m = μ F_n, k_t = 8 G* a and δ_c = 3m/(2k_t). The virgin curve is F = φ(δ) = m [1 − (1 − δ/δ_c)^(3/2)], whose
//! slope is k_t θ with θ³ = 1 − F/m. Unloading from F* follows F = F* − 2φ(h/2), h the slip since the reversal, with
//! θ³ = 1 − (F* − F)/(2m); reloading from F** follows F = F** + 2φ(h/2) with θ³ = 1 − (F − F**)/(2m) and joins the
//! virgin curve where it reaches F* again (Masing's rule). These are the three θ of the incremental form. The curves
//! are used themselves, not their tangents, so that a step may be of any length.
//!
//! # Two dimensions
//!
//! F, F* and F** are vectors in the tangent plane. The curves act along the vector from the point where the branch
//! began (the origin, F* or F**) to the present pull: the equivalent displacement e along it gets the slip added as a
//! vector and the force is φ(|e|) along the new e. Slip that lengthens e continues the branch, also when it turns it;
//! slip that shortens it is a reversal. Along one line this is the law above.
//!
//! # Normal force
//!
//! - It has risen by ΔF_n: pull and memory stay, and on first loading the new annulus sticks until the pull has
//!   changed by μ ΔF_n in this step. The published form has θ = 1 there; this one has the fresh curve
//!   θ³ = 1 − |ΔF|/m, θ from 1 to F_n,prev/F_n (Jäger 2005; Kuhn 2011), which is the same for small ΔF_n and exact
//!   for a contact that has just closed. Beyond it the branch goes on; the sum of both is
//!   8 G* a θ Δδ + μ (1 − θ) ΔF_n.
//! - It has fallen by ΔF_n: the annuli that slip lose traction with their limit, the others keep theirs. On the virgin
//!   curve that is the curve of the new load at the same displacement, ΔF = μ (1 − θ) ΔF_n. On unloading the curve of
//!   the new load at displacements of F* and since F* that are both shorter by the fall c of δ_c: that is the
//!   published F* + μ ΔF_n (here the exact F* of the new load) and the term −μ (1 − θ) ΔF_n, which raises the pull. On
//!   reloading the three displacements fall by c, 2c and c. A branch whose displacement is used up joins the one
//!   before it. (With tractions of slip ±μ p and load p(r) − p_c, all of this is exact; Jäger 2005.)
//!
//! Where such a step would store more than before (slip across the line of a loop, or a normal law that is no Hertzian
//! curve), pull and memory shrink with the radius and the cap instead, which cannot.
//!
//! # Energy
//!
//! Partial slip is a set of springs with friction elements side by side (Iwan 1967), so the stored energy, locked-in
//! parts included, has a closed form. With e(F) the inverse of φ and C(F) = ∫ e dF: U = C(|F|) on the virgin curve,
//! U = C(|F*|) − (F* + F)·q̂ e(|q|) with q = (F* − F)/2 on unloading, and U = U(F*, F**) + (F** + F)·q̂ e(|q|) with
//! q = (F − F**)/2 on reloading. Of all states with one pull the virgin one stores least, so a memory may be dropped
//! at any time, and dropping it is friction. It is dropped when a loop is reversed within itself (as in the published
//! law, which knows one F* and one F**) and where slip leaves the line of a loop so far that keeping it would create
//! energy. The mean pull of `friction_work` is the one over the slip: between the pull after the change of load and
//! the pull after the slip.

use super::curve::Curve;
pub use super::memory::{Branch, MindlinDeresiewiczState};
use super::memory::{Numbers, held_to};
use super::{TangentialInput, TangentialLaw, TangentialResponse};
use crate::base::lanes::Real;
use crate::base::triple::Triple;
use glam::DVec3;

/// Mindlin and Deresiewicz's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MindlinDeresiewicz {
    /// Effective shear modulus G* of the pair (Pa).
    pub shear_modulus_star: f64,
    /// Coefficient of friction μ (-).
    pub friction: f64,
}

/// `vector`, normal to the unit vector `from`, rotated as the shortest rotation takes `from` to `to`.
#[inline(always)]
fn rotated(vector: DVec3, from: DVec3, to: DVec3) -> DVec3 {
    let scale = 1.0 + from.dot(to);
    // A normal turned round (scale 0) leaves the tangent plane where it was.
    if scale > 1e-12 { vector - (from + to) * (vector.dot(to) / scale) } else { vector }
}

/// `vector` turned into the plane normal to `normal`, keeping its length.
#[inline(always)]
fn turn(vector: DVec3, normal: DVec3) -> DVec3 {
    super::turn(vector.into(), normal.into()).into()
}

impl MindlinDeresiewicz {
    /// Brings the state to the present normal load at no slip, and answers how far the pull may change before the new
    /// annulus slips (N).
    #[inline(always)]
    fn change_load(&self, state: &mut MindlinDeresiewiczState, curve: &Curve, radius: f64) -> f64 {
        let grown = curve.cap - state.cap;
        if state.cap > 0.0 && (grown < 0.0 || radius < state.radius) {
            self.unload(state, curve, radius);
        }
        (state.cap, state.radius) = (curve.cap, radius);
        if !state.can_hold_memory(curve) {
            state.branch = Branch::Loading;
        }
        grown.max(0.0)
    }

    /// Normal unloading at no slip: annulus by annulus, or by shrinking where that would create energy.
    #[inline(always)]
    fn unload(&self, state: &mut MindlinDeresiewiczState, curve: &Curve, radius: f64) {
        let old = Curve::new(state.cap, 8.0 * self.shear_modulus_star * state.radius);
        let fall = old.reach - curve.reach;
        if fall > 0.0 && state.branch != Branch::Loading {
            let mut shed = *state;
            shed.shed(&old, curve, fall);
            shed.forget_passed_turns();
            if shed.stored(curve) <= state.energy && shed.pull.length_squared() <= curve.cap * curve.cap {
                *state = shed;
                return;
            }
        }
        self.shrink(state, curve, radius);
    }

    /// Pull and memory shrink. The factor of the pull is the least of a/a_prev and (F_n/F_n,prev)^(1/3), which are
    /// equal on a Hertzian curve: with it the stored energy cannot grow, whatever the normal law.
    fn shrink(&self, state: &mut MindlinDeresiewiczState, curve: &Curve, radius: f64) {
        let reloading = matches!(state.branch, Branch::Reloading { .. });
        let ratio = (curve.cap / state.cap).min(1.0);
        let mut factor = ratio.cbrt().min(radius / state.radius);
        if state.branch == Branch::Loading {
            let length = state.pull.length();
            if length > 0.0 {
                let old = Curve::new(state.cap, 8.0 * self.shear_modulus_star * state.radius);
                factor = factor.min(curve.force(old.displacement(length)) / length);
            }
        }
        let pull = held_to(state.pull * factor, curve.cap);
        state.map(|vector| vector * ratio);
        state.pull = pull;
        state.forget_passed_turns();
        // Where a loop is not along one line, its locked-in energy need not shrink with the load.
        if reloading && state.stored(curve) > state.energy {
            state.branch = Branch::Loading;
        }
    }
}

impl MindlinDeresiewicz {
    /// The response of one contact.
    fn one(&self, state: &mut MindlinDeresiewiczState, input: &TangentialInput) -> TangentialResponse {
        let cap = self.friction * input.normal_force;
        let stiffness = 8.0 * self.shear_modulus_star * input.radius;
        if cap <= 0.0 || stiffness <= 0.0 {
            let friction_work = state.energy;
            *state = MindlinDeresiewiczState::default();
            return TangentialResponse { friction_work, ..Default::default() };
        }
        let curve = Curve::new(cap, stiffness);
        let energy = state.energy;
        let normal = DVec3::from(input.normal);
        let last = std::mem::replace(&mut state.normal, normal);
        state.map(|vector| turn(rotated(vector, last, normal), normal));
        let fresh = self.change_load(state, &curve, input.radius);
        let before = state.pull;
        let slipped = DVec3::from(input.slip);
        let slip = slipped.length();
        if slip > 0.0 {
            let stuck = if state.branch == Branch::Loading { curve.displacement(fresh).min(slip) } else { 0.0 };
            state.pull += slipped * (curve.force(stuck) / slip);
            if stuck < slip {
                state.slip(&curve, slipped * (1.0 - stuck / slip));
            }
        }
        state.energy = state.stored(&curve);
        let work = 0.5 * (before + state.pull).dot(slipped);
        TangentialResponse { pull: state.pull.into(), stiffness, friction_work: work - (state.energy - energy) }
    }
}

impl TangentialLaw for MindlinDeresiewicz {
    type State<R: Real> = Numbers<R>;

    const HISTORY: usize = 16;

    const ACTIVE: bool = true;

    #[inline(always)]
    fn history<R: Real>(numbers: impl Fn(usize) -> R) -> Numbers<R> {
        std::array::from_fn(numbers)
    }

    #[inline(always)]
    fn each_number<R: Real>(state: &Numbers<R>, mut put: impl FnMut(usize, R)) {
        state.iter().enumerate().for_each(|(k, number)| put(k, *number));
    }

    /// One contact after the other: their branches differ.
    #[inline(always)]
    fn response<R: Real>(&self, state: &mut Numbers<R>, input: &TangentialInput<R>) -> TangentialResponse<R> {
        let zero = input.radius.splat(0.0);
        let mut out = TangentialResponse { pull: Triple::zero(zero), stiffness: zero, friction_work: zero };
        for k in 0..R::COUNT {
            let mut own = MindlinDeresiewiczState::from_numbers(&state.map(|number| number.at(k)));
            let input = TangentialInput {
                normal: input.normal.at(k).into(),
                slip: input.slip.at(k).into(),
                normal_force: input.normal_force.at(k),
                radius: input.radius.at(k),
                inverse_radius: input.inverse_radius.at(k),
            };
            let answer = self.one(&mut own, &input);
            state.iter_mut().zip(own.numbers()).for_each(|(number, own)| number.put(k, own));
            out.pull.put(k, answer.pull.into());
            out.stiffness.put(k, answer.stiffness);
            out.friction_work.put(k, answer.friction_work);
        }
        out
    }

    #[inline(always)]
    fn elastic_energy(&self, state: &Numbers<f64>) -> f64 {
        state[15]
    }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{ball_on_ball, check_walk, walk};
    use super::*;
    use proptest::prelude::*;
    use std::f64::consts::TAU;

    const LAW: MindlinDeresiewicz = MindlinDeresiewicz { shear_modulus_star: 13e9, friction: 0.2 };
    const NORMAL_FORCE: f64 = 1.5;
    const CAP: f64 = 0.2 * NORMAL_FORCE;

    fn stiffness(normal_force: f64) -> f64 {
        8.0 * LAW.shear_modulus_star * ball_on_ball(normal_force).radius
    }

    /// δ_c at [`NORMAL_FORCE`].
    fn reach() -> f64 {
        1.5 * CAP / stiffness(NORMAL_FORCE)
    }

    /// μ F_n [1 − (1 − x)^(3/2)].
    fn backbone(part: f64) -> f64 {
        CAP * (1.0 - (1.0 - part).powf(1.5))
    }

    fn step(state: &mut MindlinDeresiewiczState, slip: f64, normal_force: f64) -> TangentialResponse {
        LAW.one(state, &TangentialInput { slip: (DVec3::X * slip).into(), ..ball_on_ball(normal_force) })
    }

    fn near(value: f64, expected: f64, tolerance: f64) {
        assert!((value - expected).abs() <= tolerance, "{value} is not {expected}");
    }

    #[test]
    fn growing_slip_under_constant_force_follows_the_closed_form() {
        for steps in [7, 1000] {
            let mut state = MindlinDeresiewiczState::default();
            for i in 1..=2 * steps {
                let pull = step(&mut state, reach() / steps as f64, NORMAL_FORCE).pull;
                near(pull.x, backbone((i as f64 / steps as f64).min(1.0)), 1e-9 * CAP);
                assert_eq!(state.branch, Branch::Loading);
            }
        }
    }

    #[test]
    fn it_starts_with_the_stiffness_without_slip_and_never_exceeds_it() {
        let mut state = MindlinDeresiewiczState::default();
        let small = 1e-6 * reach();
        let response = step(&mut state, small, NORMAL_FORCE);
        near(response.pull.x / (stiffness(NORMAL_FORCE) * small), 1.0, 1e-6);
        near(response.stiffness, stiffness(NORMAL_FORCE), 1e-9 * response.stiffness);
    }

    /// Load to 0.6 δ_c, back to −0.2 δ_c, up again to 0.9 δ_c, in units of δ_c: Masing's curves and the return to the
    /// virgin one.
    #[test]
    fn a_cycle_under_constant_force_is_the_hysteresis_of_mindlin_and_deresiewicz() {
        let (count, peak, valley) = (2000, 0.6, -0.2);
        let mut state = MindlinDeresiewiczState::default();
        let mut go = |from: f64, to: f64, expected: &dyn Fn(f64) -> f64| {
            let (mut area, mut friction, mut before) = (0.0, 0.0, state.pull.x);
            for i in 1..=count {
                let slip = (to - from) * reach() / count as f64;
                let response = step(&mut state, slip, NORMAL_FORCE);
                near(response.pull.x, expected(from + (to - from) * i as f64 / count as f64), 1e-3 * CAP);
                area += 0.5 * (before + response.pull.x) * slip;
                before = response.pull.x;
                friction += response.friction_work;
            }
            (area, friction, state)
        };
        go(0.0, peak, &backbone);
        let down = |x: f64| backbone(peak) - 2.0 * backbone(0.5 * (peak - x));
        let turn = down(valley);
        let (area_down, friction_down, state_down) = go(peak, valley, &down);
        assert!(matches!(state_down.branch, Branch::Unloading { .. }));
        let up = |x: f64| turn + 2.0 * backbone(0.5 * (x - valley));
        let (area_up, friction_up, _) = go(valley, peak, &up);
        near(friction_down + friction_up, area_down + area_up, 1e-3 * (area_down + area_up));
        let (_, _, last) = go(peak, 0.9, &backbone);
        assert_eq!(last.branch, Branch::Loading);
    }

    #[test]
    fn unloading_far_past_the_peak_is_loading_the_other_way() {
        let mut state = MindlinDeresiewiczState::default();
        let count = 4000;
        step(&mut state, 0.6 * reach(), NORMAL_FORCE);
        for _ in 0..count {
            step(&mut state, -1.5 * reach() / count as f64, NORMAL_FORCE);
        }
        near(state.pull.x, -backbone(0.9), 1e-3 * CAP);
        assert_eq!(state.branch, Branch::Loading);
    }

    /// The published increments with small steps: ΔF = k_t θ Δδ + μ (1 − θ) ΔF_n, θ³ = 1 − (F + μ ΔF_n)/(μ F_n), and
    /// θ = 1 where |ΔF| < μ ΔF_n.
    #[test]
    fn loading_under_a_changing_normal_force_follows_the_published_increments() {
        for (from, to, slip) in [(1.0, 2.0, 1.2), (1.0, 2.0, 0.3), (2.0, 1.0, 0.3), (2.0, 1.0, 0.0)] {
            let count = 20_000;
            let mut state = MindlinDeresiewiczState::default();
            let mut pull = step(&mut state, 0.3 * reach(), from).pull.x;
            let (rise, slip) = ((to - from) / count as f64, slip * reach() / count as f64);
            for i in 1..=count {
                let load = from + rise * i as f64;
                let cubed = 1.0 - (pull + LAW.friction * rise) / (LAW.friction * load);
                let stuck = stiffness(load) * slip;
                let theta = if stuck < LAW.friction * rise { 1.0 } else { cubed.max(0.0).cbrt() };
                let change = if theta == 1.0 { 0.0 } else { LAW.friction * (1.0 - theta) * rise };
                pull += stuck * theta + change;
                step(&mut state, slip, load);
            }
            near(state.pull.x, pull, 2e-3 * LAW.friction * to);
            assert_eq!(state.branch, Branch::Loading);
        }
    }

    #[test]
    fn an_oscillating_normal_force_never_raises_the_pull_above_its_peak() {
        let mut state = MindlinDeresiewiczState::default();
        let peak = DVec3::from(step(&mut state, 0.8 * reach(), NORMAL_FORCE).pull).length();
        step(&mut state, -0.5 * reach(), NORMAL_FORCE);
        assert!(matches!(state.branch, Branch::Unloading { .. }));
        for i in 0..200 {
            let response = step(&mut state, 0.0, NORMAL_FORCE * (1.0 - 0.01 * f64::from(i % 2)));
            assert!(DVec3::from(response.pull).length() <= peak);
            assert!(response.friction_work >= 0.0);
        }
    }

    /// Springs side by side, each held to its own limit, are the annuli of the contact: with the gap x² they have the
    /// load d − x², and k_t = 2√d, m = (4/3) d^(3/2), δ_c = d in units in which all else is 1. Loaded, turned, turned
    /// again and unloaded, they and the law keep the same pull.
    #[test]
    fn a_falling_normal_force_sheds_the_annuli_one_by_one() {
        let (law, count) = (MindlinDeresiewicz { shear_modulus_star: 0.25, friction: 1.0 }, 4000);
        let input = |depth: f64, slip: f64| TangentialInput {
            slip: (DVec3::X * slip).into(),
            ..TangentialInput::at_rest(4.0 / 3.0 * depth.powf(1.5), depth.sqrt())
        };
        // Slips at full load, then the slip while the load falls, and the depth at which it ends.
        let turned = ([0.7, -0.4, 0.0], -0.07, 0.5);
        let turned_far = ([0.5, -0.2, 0.0], 0.0, 0.2);
        let turned_twice = ([0.7, -0.9, 0.3], 0.07, 0.8);
        let turned_twice_far = ([0.7, -0.6, 0.3], 0.0, 0.3);
        // The loop closes when unloading, which falls twice as fast, has come down to reloading.
        let closed = ([0.7, -0.6, 0.5], 0.0, 0.4);
        // Reloading is undone first, then unloading goes on alone.
        let undone = ([0.7, -0.8, 0.2], 0.0, 0.5);
        let paths = [turned, turned_far, turned_twice, turned_twice_far, closed, undone];
        // Without slip a fall of the load is one step as well as many.
        for ((path, last, end), steps) in
            paths.map(|p| (p, 1000)).into_iter().chain([turned_twice_far, closed, undone].map(|p| (p, 1)))
        {
            let (mut state, mut springs) = (MindlinDeresiewiczState::default(), vec![0.0f64; count]);
            let mut go = |depth: f64, slip: f64| {
                let pull = law.one(&mut state, &input(depth, slip)).pull.x;
                let mut sum = 0.0;
                for (k, force) in springs.iter_mut().enumerate() {
                    let limit = (depth - ((k as f64 + 0.5) / count as f64).powi(2)).max(0.0);
                    *force = (*force + slip).clamp(-limit, limit);
                    sum += *force * 2.0 / count as f64;
                }
                (pull, sum)
            };
            for slip in path {
                go(1.0, slip);
            }
            for i in 1..=steps {
                let depth = 1.0 + (end - 1.0) * f64::from(i) / f64::from(steps);
                let (pull, sum) = go(depth, last / f64::from(steps));
                near(pull, sum, 2e-4);
            }
        }
    }

    #[test]
    fn turning_the_frame_turns_the_pull_and_keeps_the_energy() {
        let mut state = MindlinDeresiewiczState::default();
        for slip in [DVec3::new(0.8, 0.0, 0.0), DVec3::new(-0.3, 0.2, 0.0), DVec3::new(0.1, -0.1, 0.0)] {
            LAW.one(&mut state, &TangentialInput { slip: (slip * reach()).into(), ..ball_on_ball(NORMAL_FORCE) });
        }
        assert!(matches!(state.branch, Branch::Reloading { .. }), "{state:?}");
        let (length, energy) = (state.pull.length(), state.energy);
        for i in 1..=100 {
            let normal = DVec3::new((0.01 * f64::from(i)).sin(), 0.0, (0.01 * f64::from(i)).cos());
            let input = TangentialInput { normal: normal.into(), ..ball_on_ball(NORMAL_FORCE) };
            let pull = DVec3::from(LAW.one(&mut state, &input).pull);
            near(pull.length(), length, 1e-12 * length);
            near(pull.dot(normal), 0.0, 1e-12 * length);
            near(state.energy, energy, 1e-9 * energy);
        }
    }

    #[test]
    fn stored_energy_comes_back_as_friction_when_the_bodies_part() {
        let mut state = MindlinDeresiewiczState::default();
        step(&mut state, 0.5 * reach(), NORMAL_FORCE);
        let stored = state.energy;
        assert!(stored > 0.5 * state.pull.length_squared() / stiffness(NORMAL_FORCE));
        // Nothing presses, or on nothing.
        for (force, radius) in [(0.0, 0.0), (0.0, 1e-5), (1.0, 0.0)] {
            let mut state = state;
            let response = LAW.one(&mut state, &TangentialInput::at_rest(force, radius));
            assert_eq!(response, TangentialResponse { friction_work: stored, ..Default::default() });
            assert_eq!(state, MindlinDeresiewiczState::default());
        }
    }

    /// Radius and force go together on a Hertzian curve; a normal law may part them.
    #[test]
    fn a_radius_that_does_not_follow_the_force_creates_no_energy() {
        for slips in [[0.1, 0.0], [0.6, 0.0], [0.6, -0.3]] {
            let mut loaded = MindlinDeresiewiczState::default();
            for slip in slips {
                step(&mut loaded, slip * reach(), NORMAL_FORCE);
            }
            for (force, radius) in [(1.1, 0.8), (0.3, 1.1)] {
                let mut state = loaded;
                let (force, radius) = (force * NORMAL_FORCE, radius * ball_on_ball(NORMAL_FORCE).radius);
                let response = LAW.one(&mut state, &TangentialInput::at_rest(force, radius));
                assert!(response.friction_work >= 0.0 && state.energy <= loaded.energy, "{state:?}");
                assert!(state.pull.length() <= LAW.friction * force * (1.0 + 1e-12), "{state:?}");
            }
        }
    }

    #[test]
    fn numbers_hold_the_whole_history() {
        let mut state = MindlinDeresiewiczState::default();
        for slip in [0.8, -0.3, 0.1] {
            let numbers = state.numbers();
            assert_eq!(MindlinDeresiewiczState::from_numbers(&numbers), state);
            step(&mut state, slip * reach(), NORMAL_FORCE);
        }
        assert!(matches!(state.branch, Branch::Reloading { .. }) && state.energy > 0.0);
        assert_eq!(MindlinDeresiewiczState::from_numbers(&state.numbers()), state);
        assert_eq!(LAW.elastic_energy(&state.numbers()), state.energy);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]
        #[test]
        fn no_walk_creates_energy_or_passes_the_cap(steps in walk()) {
            check_walk(&LAW, LAW.friction, LAW.shear_modulus_star, &steps)?;
        }

        /// Also where a loop is not along one line: then it is forgotten.
        #[test]
        fn shrinking_never_stores_more(
            peak in 0.05..1.0f64, turns in [(0.0..1.0f64, 0.0..TAU), (0.0..1.0f64, 0.0..TAU)], left in 0.05..1.0f64,
        ) {
            let peak = DVec3::X * (peak * CAP);
            let [pull, valley] = turns.map(|(part, angle)| part * peak.length() * DVec3::new(angle.cos(), angle.sin(), 0.0));
            let old = Curve::new(CAP, stiffness(NORMAL_FORCE));
            let radius = ball_on_ball(NORMAL_FORCE).radius;
            let branch = Branch::Reloading { peak, valley };
            let mut state = MindlinDeresiewiczState { pull, branch, cap: CAP, radius, ..Default::default() };
            state.energy = state.stored(&old);
            prop_assume!(state.can_hold_memory(&old));
            let new = Curve::new(left * CAP, stiffness(left * NORMAL_FORCE));
            LAW.shrink(&mut state, &new, ball_on_ball(left * NORMAL_FORCE).radius);
            prop_assert!(state.stored(&new) <= state.energy * (1.0 + 1e-9), "{state:?}");
        }

        /// Of all states with one pull the virgin one stores least.
        #[test]
        fn what_is_remembered_is_worth_its_energy(slips in prop::collection::vec([-1.0..1.0f64, -1.0..1.0], 3..30)) {
            let mut state = MindlinDeresiewiczState::default();
            let curve = Curve::new(CAP, stiffness(NORMAL_FORCE));
            for [x, y] in slips {
                let slip = DVec3::new(x, y, 0.0) * 0.7 * reach();
                LAW.one(&mut state, &TangentialInput { slip: slip.into(), ..ball_on_ball(NORMAL_FORCE) });
                let least = curve.stored(state.pull.length());
                prop_assert!(state.energy >= least * (1.0 - 1e-9), "{} below {least}: {state:?}", state.energy);
            }
        }
    }
}
