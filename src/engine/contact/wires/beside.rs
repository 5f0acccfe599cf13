//! Stretches beside another wire, several at once: where the gap between two smooth centrelines opens and closes along
//! the stretch, and what its cells push with.
//!
//! With the point p(u) of the stretch, its foot q(t(u)) and e = p − q, e·q' = 0, the distance r = |e| and the normal
//! n = e/r are taken to the second order of u:
//! t' = p'·q'/(q'² − e·q''),
//! t'' = [p''·q' − t'² q''·q' + 2t' (p' − t'q')·q'' + t'² e·q''']/(q'² − e·q'').
//! The gradient of that expansion is the expansion of the gradient. So the cells' forces on particles follow from their
//! moments ∫ f uⁿ ds up to n = 2, and are the gradient of the energy that the cells store: what pushes takes exactly as
//! much from the motion as it keeps.

use super::curve::blend;
use crate::base::lanes::Real;
use crate::base::triple::Triple;
use crate::engine::contact::pair::{ContactKinematics, Dissipated, History, Laws, press};
use crate::law::contact::line::{CELLS, CellGap, respond_cells};
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::tangential::TangentialLaw;

/// Rounds of Newton's method for the foot, from that of the last step.
pub const ROUNDS: usize = 2;
/// Share of the square of the tangent below which the denominator of t' does not fall (-): beside a wire that is bent more
/// sharply than it is away, the foot jumps.
const STIFF: f64 = 0.1;

/// Two wires near a stretch.
#[derive(Debug, Clone, Copy)]
pub struct Beside<R> {
    /// The stretch: point, and first and second derivative by the position in bonds, at the middle of the stretch (m).
    pub near: [Triple<R>; 3],
    /// Its velocity, in the same way (m/s).
    pub near_velocity: [Triple<R>; 3],
    /// The other wire's bond; see [`Arc`](super::curve::Arc) (m).
    pub far: [Triple<R>; 4],
    /// Its velocity, in the same way (m/s).
    pub far_velocity: [Triple<R>; 4],
    /// Spin of the stretch's particle, and of the two of the other bond (rad/s).
    pub spin: [Triple<R>; 3],
    /// Radii of the three (m).
    pub radius: [R; 3],
    /// Where on the other bond the foot was at the last step (-).
    pub t: R,
    /// 0 where the foot is the end of a wire and stays there, 1 elsewhere.
    pub moves: R,
    /// Where the first cell begins, and the length of a cell, in bonds from the expansion (-).
    pub first: R,
    /// See `first`.
    pub width: R,
    /// Length of a cell along the undeformed wire (m).
    pub length: R,
    /// Stiffness per length (Pa).
    pub per_length: R,
    /// Sum of the radii at the last step, less the overlap that does not count (m).
    pub reach: R,
    /// 2ξ√m* (√kg).
    pub viscosity: R,
}

/// The gap to the second order.
#[derive(Debug, Clone, Copy)]
pub struct Expansion<R> {
    /// The foot (-).
    pub t: R,
    /// Bonds that it moves per bond of the stretch, and how that changes (-).
    pub rate: R,
    /// See `rate`.
    pub bend: R,
    /// From the foot to the point, and its derivatives (m).
    pub away: [Triple<R>; 3],
    /// Unit normal along it, and its derivatives (-).
    pub normal: [Triple<R>; 3],
    /// Distance and its derivatives (m).
    pub distance: [R; 3],
    /// Sum of the radii (m).
    pub touching: R,
}

/// What a stretch does to the two wires: a force per length over u with the moments that `near` and `far` stand for.
#[derive(Debug, Clone, Copy)]
pub struct Act<R> {
    /// On the stretch, per power of u (N).
    pub near: [Triple<R>; 3],
    /// On the other bond, times 1, t, t² and h(t) (N).
    pub far: [Triple<R>; 4],
    /// Moments on the stretch's particle, on the first of the other two, and on both (N m).
    pub twist: [Triple<R>; 3],
}

/// The answer for a stretch.
#[derive(Debug, Clone, Copy)]
pub struct Answer<R> {
    /// What it does.
    pub act: Act<R>,
    /// Energies that it gives off.
    pub given: Dissipated<R>,
    /// Normal force of its cells (N), and where it acts, in bonds from the expansion (-).
    pub force: R,
    /// See `force`.
    pub mean: R,
    /// Elastic stiffness (N/m).
    pub stiffness: R,
    /// Elastic energy (J).
    pub energy: R,
    /// Overlap of the deepest cell, positive or not (m).
    pub deepest: R,
    /// Sum of the radii less what does not count (m).
    pub reach: R,
    /// Lever arms of the two sides (m).
    pub arms: [R; 2],
}

/// A curve with the coefficients of [`Arc`](super::curve::Arc), and its derivatives at `t`.
#[inline(always)]
fn arc<R: Real>([a, b, c, d]: [Triple<R>; 4], t: R) -> [Triple<R>; 3] {
    let [h, h1, h2, _] = blend(t);
    let two = t.splat(2.0);
    [a + (b + c * t) * t + d * h, b + c * (t * two) + d * h1, c * two + d * h2]
}

impl<R: Real> Beside<R> {
    /// Follows the foot in `rounds` of Newton's method and expands the gap around the middle of the stretch.
    #[inline(always)]
    pub fn expand(&self, rounds: usize) -> Expansion<R> {
        let [p, p1, p2] = self.near;
        let mut t = self.t;
        for _ in 0..rounds {
            let [q, q1, q2] = arc(self.far, t);
            let (away, square) = (q - p, q1.length_squared());
            // Far from the foot the distance may be concave; then the straight line decides.
            let rise = square + away.dot(q2).simd_max(square * -0.5);
            t -= away.dot(q1) * rise.inverse() * self.moves;
        }
        let [q, q1, q2] = arc(self.far, t);
        let e = p - q;
        let square = q1.length_squared();
        let inverse_rise = (square - e.dot(q2)).simd_max(square * STIFF).inverse();
        let cross = p1.dot(q1);
        let rate = cross * inverse_rise * self.moves;
        let e1 = p1 - q1 * rate;
        let square = rate * rate;
        let bend =
            (p2.dot(q1) - square * q2.dot(q1) + rate * 2.0 * e1.dot(q2) + square * blend(t)[3] * e.dot(self.far[3]))
                * inverse_rise
                * self.moves;
        let e2 = p2 - q2 * square - q1 * bend;
        let inverse = e.length_squared().inverse_sqrt();
        let distance = e.length_squared() * inverse;
        let n = e * inverse;
        let r1 = n.dot(e1);
        let n1 = (e1 - n * r1) * inverse;
        let half = e1.length_squared() + e.dot(e2);
        let r2 = (half - r1 * r1) * inverse;
        let n2 = (e2 - n1 * (r1 * 2.0) - n * r2) * inverse;
        let touching = self.radius[0] + (self.radius[2] - self.radius[1]).mul_add(self.between(t), self.radius[1]);
        Expansion { t, rate, bend, away: [e, e1, e2], normal: [n, n1, n2], distance: [distance, r1, r2], touching }
    }

    /// The cells over an expansion, where `offset` of the overlap does not count (m).
    #[inline(always)]
    pub fn gap(&self, at: &Expansion<R>, offset: R, reduced_radius: R) -> CellGap<R> {
        CellGap {
            reduced_radius,
            stiffness: self.per_length,
            overlap: at.touching - offset - at.distance[0],
            rise: at.distance[1],
            bend: at.distance[2],
            first: self.first,
            width: self.width,
            length: self.length,
        }
    }

    /// Overlap of the deepest of the cells of which `share` counts something (m).
    #[inline(always)]
    pub fn deepest(gap: &CellGap<R>, share: &[R; CELLS]) -> R {
        let mut deepest = gap.overlap.splat(f64::NEG_INFINITY);
        for (q, share) in share.iter().enumerate() {
            let counts = share.simd_gt(share.splat(0.0));
            deepest = R::select(counts, deepest.simd_max(gap.depth(gap.place(q))), deepest);
        }
        deepest
    }

    /// What the stretch does at this step of `dt` (s).
    #[inline(always)]
    pub fn respond<N: NormalLaw, T: TangentialLaw>(
        &self,
        laws: &Laws<N, T>,
        at: &Expansion<R>,
        share: &[R; CELLS],
        greatest: &mut [R; CELLS],
        history: &mut History<N, T, R>,
        dt: f64,
    ) -> Answer<R> {
        let zero = self.t.splat(0.0);
        let gap = self.gap(at, history.offset, history.reduced_radius);
        let deepest = Self::deepest(&gap, share);
        let cells = respond_cells(&gap, laws.normal.limiting_pressure(), share, greatest);
        let [force, first, second] = cells.moments;
        let pushes = force.simd_gt(zero);
        let inverse_force = R::select(pushes, force, force.splat(1.0)).inverse();
        // Mean of u and u² where the force acts.
        let (mean, square) = (first * inverse_force, second * inverse_force);
        let [n, n1, n2] = at.normal;
        // The mean line from the stretch to the other wire: friction along it would turn the two.
        let [e, e1, e2] = at.away;
        let toward = (e + e1 * mean + e2 * (square * 0.5)) * zero.splat(-1.0);
        let apart = toward.length_squared();
        let inverse = apart.inverse_sqrt();
        let (normal, mean_distance) = (toward * inverse, apart * inverse);
        let arm = self.radius[0] - (at.touching - mean_distance) * 0.5;
        let arms = [arm, mean_distance - arm];
        // The normal force spread over the particles' polynomials, per force.
        let push_a = n + n1 * mean + n2 * (square * 0.5);
        let push = [push_a, n * mean + n1 * square, n * (square * 0.5)];
        let slide = self.velocity(at, mean, square, normal, arms, T::ACTIVE);
        // The dashpot takes what the spread force does.
        let velocity = slide - normal * (self.power(at, &push) + slide.dot(normal));
        let stiffness = cells.stiffness;
        let radius = stiffness * (0.5 / laws.normal.effective_modulus());
        let answer = NormalResponse {
            force,
            stiffness,
            radius,
            inverse_radius: R::select(pushes, radius, radius.splat(1.0)).inverse(),
            plastic_work: cells.plastic_work,
        };
        let reach = at.touching - history.offset;
        let overlap = deepest.simd_max(zero);
        let thinner = self.reach - reach;
        let (viscosity, dt) = (self.viscosity, zero.splat(dt));
        let meeting = ContactKinematics { normal, overlap, thinner, velocity, viscosity, dt };
        let (pair, given) = press(laws, history, &meeting, &answer);
        // All that pushes along the normal is spread as the force of the cells is.
        let whole = (pair.friction - pair.force).dot(normal);
        let friction = pair.friction;
        let a = push[0] * whole + friction;
        let b = push[1] * whole + friction * mean;
        let c = push[2] * whole + friction * (square * 0.5);
        let act = self.act(at, [a, b, c], normal.cross(friction), arms);
        Answer { act, given, force, mean, stiffness, energy: cells.energy, deepest, reach, arms }
    }

    /// Velocity of the other wire's surface relative to the stretch's, as the force sees it.
    #[inline(always)]
    fn velocity(
        &self,
        at: &Expansion<R>,
        mean: R,
        square: R,
        normal: Triple<R>,
        arms: [R; 2],
        turns: bool,
    ) -> Triple<R> {
        let [v, v1, v2] = self.near_velocity;
        let near = v + v1 * mean + v2 * (square * 0.5);
        let t = at.t;
        let [there, along, bend] = arc(self.far_velocity, t);
        let far = there + along * (at.rate * mean + at.bend * square * 0.5) + bend * (at.rate * at.rate * square * 0.5);
        let slide = far - near;
        if !turns {
            return slide;
        }
        let spin = self.spin[1] + (self.spin[2] - self.spin[1]) * self.between(t);
        slide - (self.spin[0] * arms[0] + spin * arms[1]).cross(normal)
    }

    /// Velocity of the other wire relative to the stretch along a force that is spread as [`Self::act`] does (m/s), per
    /// force.
    #[inline(always)]
    fn power(&self, at: &Expansion<R>, [a, b, c]: &[Triple<R>; 3]) -> R {
        let [v, v1, v2] = self.near_velocity;
        let [far, along, bend] = arc(self.far_velocity, at.t);
        let once = *b * at.rate + *c * at.bend;
        let twice = *c * (at.rate * at.rate);
        a.dot(far - v) + once.dot(along) + twice.dot(bend) - b.dot(v1) - c.dot(v2)
    }

    #[inline(always)]
    fn between(&self, t: R) -> R {
        t.simd_max(t.splat(0.0)).simd_min(t.splat(1.0))
    }

    /// Spreads a force per length with the moments `a`, `b`, 2`c` over the particles' polynomials.
    #[inline(always)]
    fn act(&self, at: &Expansion<R>, [a, b, c]: [Triple<R>; 3], twist: Triple<R>, arms: [R; 2]) -> Act<R> {
        let two = at.t.splat(2.0);
        let (t, square) = (at.t, at.t * at.t);
        let [h, h1, h2, _] = blend(t);
        let once = b * at.rate + c * at.bend;
        let twice = c * (at.rate * at.rate);
        let minus = t.splat(-1.0);
        let far = [
            a * minus,
            (a * t + once) * minus,
            (a * square + (once * t + twice) * two) * minus,
            (a * h + once * h1 + twice * h2) * minus,
        ];
        let other = twist * arms[1];
        Act {
            near: [a, b, c * two],
            far,
            twist: [twist * arms[0], other * (t.splat(1.0) - self.between(t)), other * self.between(t)],
        }
    }
}
