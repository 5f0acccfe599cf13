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

use crate::base::lanes::Real;
use crate::base::triple::Triple;
use crate::engine::pair::{Given, History, Laws, Meeting, press};
use crate::law::contact::line::{CELLS, CellGap, CellResponse, respond_cells};
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::tangential::TangentialLaw;

/// Rounds of Newton's method for the foot, from the last one.
const ROUNDS: usize = 2;

/// Two wires near a stretch.
#[derive(Debug, Clone, Copy)]
pub struct Beside<R> {
    /// The stretch: point, and first and second derivative by the position in bonds, at the middle of the stretch [m].
    pub near: [Triple<R>; 3],
    /// Its velocity, in the same way [m/s].
    pub near_velocity: [Triple<R>; 3],
    /// The cubic of the other wire's bond, by powers [m].
    pub far: [Triple<R>; 4],
    /// Its velocity, in the same way [m/s].
    pub far_velocity: [Triple<R>; 4],
    /// Spin of the stretch's particle, and of the two of the other bond [rad/s].
    pub spin: [Triple<R>; 3],
    /// Radii of the three [m].
    pub radius: [R; 3],
    /// Where on the other bond the foot was at the last step [-].
    pub t: R,
    /// 0 where the foot is the end of a wire and stays there, 1 elsewhere.
    pub moves: R,
    /// Where the first cell begins, and the length of a cell, in bonds from the expansion [-].
    pub first: R,
    /// See `first`.
    pub width: R,
    /// Length of a cell along the undeformed wire [m].
    pub length: R,
    /// Stiffness per length [Pa].
    pub per_length: R,
    /// Sum of the radii at the last step, less the overlap that does not count [m].
    pub reach: R,
    /// 2ξ√m* [√kg].
    pub viscosity: R,
}

/// The gap to the second order.
#[derive(Debug, Clone, Copy)]
pub struct Expansion<R> {
    /// The foot [-].
    pub t: R,
    /// Bonds that it moves per bond of the stretch, and how that changes [-].
    pub rate: R,
    /// See `rate`.
    pub bend: R,
    /// Normal from the foot to the point, and its derivatives [-].
    pub normal: [Triple<R>; 3],
    /// Distance and its derivatives [m].
    pub distance: [R; 3],
    /// Sum of the radii [m].
    pub touching: R,
}

/// What a stretch does to the two wires: a force per length over u with the moments that `near` and `far` stand for.
#[derive(Debug, Clone, Copy)]
pub struct Act<R> {
    /// On the stretch, per power of u [N].
    pub near: [Triple<R>; 3],
    /// On the other bond, per power of t [N].
    pub far: [Triple<R>; 4],
    /// Moments on the stretch's particle, on the first of the other two, and on both [N m].
    pub twist: [Triple<R>; 3],
}

/// The answer for a stretch.
#[derive(Debug, Clone, Copy)]
pub struct Answer<R> {
    /// What it does.
    pub act: Act<R>,
    /// Energies that it gives off.
    pub given: Given<R>,
    /// What its cells said.
    pub cells: CellResponse<R>,
    /// Overlap of the deepest cell, positive or not [m].
    pub deepest: R,
    /// Sum of the radii less what does not count [m].
    pub reach: R,
    /// Lever arms of the two sides [m].
    pub arms: [R; 2],
}

#[inline(always)]
fn polynomial<R: Real>(powers: &[Triple<R>; 4], t: R) -> Triple<R> {
    ((powers[3] * t + powers[2]) * t + powers[1]) * t + powers[0]
}

impl<R: Real> Beside<R> {
    /// Point and derivatives of the other curve.
    #[inline(always)]
    fn foot(&self, t: R) -> [Triple<R>; 3] {
        let [_, b, c, d] = self.far;
        let bend = d * (t * 6.0);
        [polynomial(&self.far, t), (d * (t * 3.0) + c * t.like(2.0)) * t + b, bend + c * t.like(2.0)]
    }

    /// Follows the foot and expands the gap around the middle of the stretch.
    #[inline(always)]
    pub fn expand(&self) -> Expansion<R> {
        let [p, p1, p2] = self.near;
        let mut t = self.t;
        for _ in 0..ROUNDS {
            let [q, q1, q2] = self.foot(t);
            let (away, square) = (q - p, q1.length_squared());
            // Far from the foot the distance may be concave; then the straight line decides.
            let rise = square + away.dot(q2).greater(square * -0.5);
            t -= away.dot(q1) * rise.inverse() * self.moves;
        }
        let [q, q1, q2] = self.foot(t);
        let e = p - q;
        let inverse_rise = (q1.length_squared() - e.dot(q2)).inverse();
        let cross = p1.dot(q1);
        let rate = cross * inverse_rise * self.moves;
        let e1 = p1 - q1 * rate;
        let square = rate * rate;
        let bend = (p2.dot(q1) - square * q2.dot(q1) + rate * 2.0 * e1.dot(q2) + square * 6.0 * e.dot(self.far[3]))
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
        let between = t.greater(t.like(0.0)).lesser(t.like(1.0));
        let touching = self.radius[0] + (self.radius[2] - self.radius[1]).mul_add(between, self.radius[1]);
        Expansion { t, rate, bend, normal: [n, n1, n2], distance: [distance, r1, r2], touching }
    }

    /// The cells over an expansion, where `offset` of the overlap does not count [m].
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

    /// Overlap of the deepest of the cells of which `share` counts something [m].
    #[inline(always)]
    pub fn deepest(gap: &CellGap<R>, share: &[R; CELLS]) -> R {
        let mut deepest = gap.overlap.like(f64::NEG_INFINITY);
        for (q, share) in share.iter().enumerate() {
            let counts = share.above(share.like(0.0));
            deepest = R::choose(counts, deepest.greater(gap.depth(gap.place(q))), deepest);
        }
        deepest
    }

    /// What the stretch does at this step of `dt` [s].
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
        let zero = self.t.like(0.0);
        let gap = self.gap(at, history.offset, history.reduced_radius);
        let deepest = Self::deepest(&gap, share);
        let cells = respond_cells(&gap, laws.normal.limiting_pressure(), share, greatest);
        let [force, first, second] = cells.moments;
        let pushes = force.above(zero);
        let inverse_force = R::choose(pushes, force, force.like(1.0)).inverse();
        // Mean of u and u² where the force acts.
        let (mean, square) = (first * inverse_force, second * inverse_force);
        let [n, n1, n2] = at.normal;
        // The mean normal, from the stretch to the other wire.
        let toward = (n + n1 * mean + n2 * (square * 0.5)) * zero.like(-1.0);
        let normal = toward * toward.length_squared().inverse_sqrt();
        let mean_distance = at.distance[0] + at.distance[1] * mean + at.distance[2] * (square * 0.5);
        let arm = self.radius[0] - (at.touching - mean_distance) * 0.5;
        let arms = [arm, mean_distance - arm];
        let velocity = self.velocity(at, mean, square, normal, arms, T::ACTIVE);
        let stiffness = cells.stiffness;
        let radius = stiffness * (0.5 / laws.normal.effective_modulus());
        let answer = NormalResponse {
            force,
            stiffness,
            radius,
            inverse_radius: R::choose(pushes, radius, radius.like(1.0)).inverse(),
            plastic_work: cells.plastic_work,
        };
        let reach = at.touching - history.offset;
        let overlap = deepest.greater(zero);
        let thinner = self.reach - reach;
        let meeting = Meeting { normal, overlap, thinner, velocity, viscosity: self.viscosity, dt };
        let (pair, given) = press(laws, history, &meeting, &answer);
        // All that pushes along the normal is spread as the force of the cells is.
        let scale = (pair.friction - pair.force).dot(normal) * inverse_force;
        let (force, first, second) = (force * scale, first * scale, second * scale);
        let friction = pair.friction;
        let a = n * force + n1 * first + n2 * (second * 0.5) + friction;
        let b = n * first + n1 * second + friction * mean;
        let c = n * (second * 0.5) + friction * (square * 0.5);
        let act = self.act(at, [a, b, c], normal.cross(friction), arms);
        Answer { act, given, cells, deepest, reach, arms }
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
        let [_, b, c, d] = self.far_velocity;
        let (t, two) = (at.t, at.t.like(2.0));
        let along = (d * (t * 3.0) + c * two) * t + b;
        let bend = d * (t * 6.0) + c * two;
        let far = polynomial(&self.far_velocity, t)
            + along * (at.rate * mean + at.bend * square * 0.5)
            + bend * (at.rate * at.rate * square * 0.5);
        let slide = far - near;
        if !turns {
            return slide;
        }
        let spin = self.spin[1] + (self.spin[2] - self.spin[1]) * self.between(t);
        slide - (self.spin[0] * arms[0] + spin * arms[1]).cross(normal)
    }

    #[inline(always)]
    fn between(&self, t: R) -> R {
        t.greater(t.like(0.0)).lesser(t.like(1.0))
    }

    /// Spreads a force per length with the moments `a`, `b`, 2`c` over the particles' polynomials.
    #[inline(always)]
    fn act(&self, at: &Expansion<R>, [a, b, c]: [Triple<R>; 3], twist: Triple<R>, arms: [R; 2]) -> Act<R> {
        let two = at.t.like(2.0);
        let (t, square) = (at.t, at.t * at.t);
        let once = b * at.rate + c * at.bend;
        let twice = c * (at.rate * at.rate);
        let minus = t.like(-1.0);
        let far = [
            a * minus,
            (a * t + once) * minus,
            (a * square + (once * t + twice) * two) * minus,
            (a * (square * t) + once * (square * 3.0) + twice * (t * 6.0)) * minus,
        ];
        let other = twist * arms[1];
        Act {
            near: [a, b, c * two],
            far,
            twist: [twist * arms[0], other * (t.like(1.0) - self.between(t)), other * self.between(t)],
        }
    }
}

