//! Smooth centrelines through the particles of a wire.
//!
//! Between two bonded particles the centreline is a Catmull-Rom cubic: its tangents are half the way between the
//! neighbours, so that it has no corners, and points of it are weighted means of four particles. Around a particle the
//! wire of that particle is the parabola through it and its two neighbours. On a circle of radius R with an angle φ from
//! one particle to the next the cubic lies (3/8) t²(1 − t)² R φ⁴ inside, the parabola (1/8)(u² − u⁴) R φ⁴ (a chord:
//! ½ t(1 − t) R φ²). Both are moved outwards by that much of their own curvature, the parabola but for u⁴: what is left
//! is of the order φ⁶, and 0.008 R φ⁴ of gap at half a bond.
//!
//! Where a neighbour is missing, the parabola of the three last particles goes on; two particles make a straight piece.
//!
//! A force at a point of a centreline goes to the particles with the weights of the point, so that its power is that of
//! the particles, and neither momentum nor energy is lost.

use crate::engine::bytes::behind;
use crate::engine::state::State;
use crate::strand::assembly::Assembly;
use glam::DVec3;

/// Longest walk of a foot from bond to bond in one search.
const HOPS: usize = 8;
/// A foot is found when it moves by less than this share of a bond [-]; the distance is stationary there, so that it is
/// then known to the square of this.
const CLOSE: f64 = 1e-5;

/// Which particles are joined to which.
pub struct Chains {
    /// Wire of each particle; `u32::MAX` for free spheres.
    pub wire_of: Vec<u32>,
    /// Per wire, the number of bonds within which it cannot touch itself.
    pub apart: Vec<u32>,
    /// Whether each slot had a bond at the start.
    bonded: Vec<bool>,
}

/// A point of the centreline nearest to another point.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// The point [m].
    pub point: DVec3,
    /// First and second derivative by the position along the bond [m].
    pub along: DVec3,
    /// See `along`.
    pub bend: DVec3,
    /// Whether the piece of wire ends here, and the true foot lies beyond.
    pub at_end: bool,
}

/// Particles with weights, whose mean is a point of a centreline; places beyond the count are 0.
#[derive(Debug, Clone, Copy)]
pub struct Weights<const N: usize> {
    /// The particles.
    pub nodes: [u32; N],
    /// Their weights; the sum is 1.
    pub shares: [f64; N],
}

impl<const N: usize> Default for Weights<N> {
    fn default() -> Self {
        Self { nodes: [0; N], shares: [0.0; N] }
    }
}

impl<const N: usize> Weights<N> {
    /// The weighted mean of what `value` says of each particle.
    #[inline(always)]
    pub fn mean(&self, value: impl Fn(usize) -> DVec3) -> DVec3 {
        (0..N).fold(DVec3::ZERO, |sum, k| sum + value(self.nodes[k] as usize) * self.shares[k])
    }

    /// Σ |weight| [-].
    pub fn sum(&self) -> f64 {
        self.shares.iter().map(|s| s.abs()).sum()
    }
}

impl Chains {
    /// Of `assembly`; `apart` per wire as [`crate::engine::neighbours::apart`] gives it.
    pub fn new(assembly: &Assembly, apart: Vec<u32>) -> Self {
        let bonded = (0..assembly.len()).map(|slot| assembly.is_bond(slot)).collect();
        Self { wire_of: assembly.wire_of.clone(), apart, bonded }
    }

    /// Whether two particles belong to one wire.
    pub fn one_wire(&self, a: u32, b: u32) -> bool {
        let wire = self.wire_of[a as usize];
        wire != u32::MAX && wire == self.wire_of[b as usize]
    }

    /// Whether two particles belong to one wire and all bonds between them hold.
    pub fn one_piece(&self, a: u32, b: u32, state: &State) -> bool {
        let (first, last) = (a.min(b) as usize, a.max(b) as usize);
        self.one_wire(a, b) && state.whole[first..last].iter().all(|w| *w)
    }

    /// Whether bond `k` belongs to the surroundings of particle `i` on its own wire, which it never touches. A contact of
    /// a wire with itself would otherwise walk home along the wire.
    fn beside(&self, i: usize, k: usize, state: &State) -> bool {
        let apart = self.apart[self.wire_of[i] as usize] as usize;
        let between = if k < i { k + 1..i } else { i..k };
        between.len() < apart && state.whole[between].iter().all(|w| *w)
    }

    /// Memory that it keeps [bytes].
    pub fn bytes(&self) -> usize {
        behind(&self.wire_of) + behind(&self.apart) + behind(&self.bonded)
    }

    /// Slots whose bond broke.
    pub fn broken<'a>(&'a self, state: &'a State) -> impl Iterator<Item = usize> + 'a {
        (0..self.bonded.len()).filter(|slot| self.bonded[*slot] && !state.whole[*slot])
    }

    /// Whether a particle has no bond: a free sphere, or what two breaks have left.
    pub fn alone(&self, p: usize, state: &State) -> bool {
        !state.whole[p] && !before(state, p)
    }

    /// How far the length that particle `p` stands for reaches to either side, in bonds [-]: half a bond, also where it
    /// broke, and nothing beyond the ends that the wire has had from the start.
    pub fn reach(&self, p: usize) -> [f64; 2] {
        let half = |bonded: bool| if bonded { 0.5 } else { 0.0 };
        [-half(p > 0 && self.bonded[p - 1]), half(self.bonded[p])]
    }
}

/// Whether the bond before particle `p` holds.
fn before(state: &State, p: usize) -> bool {
    p > 0 && state.whole[p - 1]
}

/// The wire around a particle: a parabola.
#[derive(Debug, Clone, Copy)]
pub struct Around {
    nodes: [u32; 3],
    /// Place of the particle, from the middle node [-].
    shift: f64,
    /// Position of the middle node, and derivatives there [m].
    middle: DVec3,
    along: DVec3,
    bend: DVec3,
    /// By how much the second derivative is less than that of the parabola [-].
    rounding: f64,
}

impl Around {
    /// Around particle `i`, which has a bond.
    #[inline(always)]
    pub fn new(state: &State, i: usize) -> Self {
        let (left, right) = (before(state, i), state.whole[i]);
        // The middle of three that are joined; of two, the first twice.
        let middle = match (left, right) {
            (true, true) => i,
            (false, _) => i + 1,
            (true, false) => i - 1,
        };
        let whole = before(state, middle) && state.whole[middle];
        let at = |p: usize| state.x.get(p);
        if whole {
            let (a, b, c) = (at(middle - 1), at(middle), at(middle + 1));
            let nodes = [middle - 1, middle, middle + 1].map(|p| p as u32);
            let shift = i as f64 - middle as f64;
            let (along, bend) = ((c - a) * 0.5, a - b * 2.0 + c);
            let rounding = 1.0 - 0.25 * bend.length_squared() / along.length_squared();
            return Self { nodes, shift, middle: b, along, bend: bend * rounding, rounding };
        }
        let first = if left { i - 1 } else { i };
        let (a, b) = (at(first), at(first + 1));
        let nodes = [first, first, first + 1].map(|p| p as u32);
        Self { nodes, shift: (i - first) as f64, middle: a, along: b - a, bend: DVec3::ZERO, rounding: 1.0 }
    }

    /// The point at `u` bonds from the particle, and the first derivative there [m].
    #[inline(always)]
    pub fn at(&self, u: f64) -> [DVec3; 2] {
        let u = u + self.shift;
        [self.middle + (self.along + self.bend * (0.5 * u)) * u, self.along + self.bend * u]
    }

    /// Second derivative [m].
    #[inline(always)]
    pub fn bend(&self) -> DVec3 {
        self.bend
    }

    /// The weights of the point at `u` bonds from the particle.
    #[inline(always)]
    pub fn weights(&self, u: f64) -> Weights<3> {
        let u = u + self.shift;
        let shares = if self.nodes[0] == self.nodes[1] {
            [0.0, 1.0 - u, u]
        } else {
            let square = u * u * self.rounding;
            [0.5 * (square - u), 1.0 - square, 0.5 * (square + u)]
        };
        Weights { nodes: self.nodes, shares }
    }
}

/// The cubic of one bond.
#[derive(Clone, Copy)]
struct Cubic {
    coefficients: [DVec3; 4],
}

impl Cubic {
    #[inline(always)]
    fn new(state: &State, slot: usize) -> Self {
        let (x1, x2) = (state.x.get(slot), state.x.get(slot + 1));
        let (left, right) = (before(state, slot), state.whole[slot + 1]);
        // Beyond an end: see `cubic_weights`.
        let (x0, x3) = match (left, right) {
            (true, true) => (state.x.get(slot - 1), state.x.get(slot + 2)),
            (true, false) => {
                let x0 = state.x.get(slot - 1);
                (x0, x0 + (x2 - x1) * 3.0)
            }
            (false, true) => {
                let x3 = state.x.get(slot + 2);
                (x3 - (x2 - x1) * 3.0, x3)
            }
            (false, false) => (x1 * 2.0 - x2, x2 * 2.0 - x1),
        };
        let coefficients = [
            x1,
            (x2 - x0) * 0.5,
            x0 - x1 * 2.5 + x2 * 2.0 - x3 * 0.5,
            ((x1 - x2) * 3.0 + x3 - x0) * 0.5,
        ];
        Self { coefficients }
    }

    #[inline(always)]
    fn at(&self, t: f64) -> [DVec3; 3] {
        let [a, b, c, d] = self.coefficients;
        [a + (b + (c + d * t) * t) * t, b + (c * 2.0 + d * (3.0 * t)) * t, c * 2.0 + d * (6.0 * t)]
    }

    /// How much of its second derivative a point lies too far inside [-]. Beyond the ends of the bond the curve goes on
    /// by itself.
    #[inline(always)]
    fn inside(t: f64, along: DVec3, bend: DVec3) -> f64 {
        let bulge = (t * (1.0 - t)).max(0.0);
        0.375 * bulge * bulge * bend.length_squared() / along.length_squared()
    }
}

/// The weights of the point `t` of bond `slot`.
#[inline(always)]
pub fn cubic_weights(state: &State, slot: usize, t: f64) -> Weights<4> {
    let (t2, t3) = (t * t, t * t * t);
    let mut shares = [
        0.5 * (2.0 * t2 - t3 - t),
        0.5 * (3.0 * t3 - 5.0 * t2 + 2.0),
        0.5 * (4.0 * t2 - 3.0 * t3 + t),
        0.5 * (t3 - t2),
    ];
    let [_, along, bend] = Cubic::new(state, slot).at(t);
    let inside = Cubic::inside(t, along, bend);
    let second = [2.0 - 3.0 * t, 9.0 * t - 5.0, 4.0 - 9.0 * t, 3.0 * t - 1.0];
    shares.iter_mut().zip(second).for_each(|(share, second)| *share -= inside * second);
    let (left, right) = (before(state, slot), state.whole[slot + 1]);
    let mut nodes = [slot.saturating_sub(1), slot, slot + 1, slot + 2].map(|p| p as u32);
    let [first, last] = [shares[0], shares[3]];
    match (left, right) {
        (true, true) => {}
        // x₃ = x₀ − 3x₁ + 3x₂: the parabola goes on.
        (true, false) => shares = [first + last, shares[1] - 3.0 * last, shares[2] + 3.0 * last, 0.0],
        (false, true) => shares = [0.0, shares[1] + 3.0 * first, shares[2] - 3.0 * first, last + first],
        (false, false) => shares = [0.0, shares[1] + 2.0 * first - last, shares[2] - first + 2.0 * last, 0.0],
    }
    if !left {
        nodes[0] = slot as u32;
    }
    if !right {
        nodes[3] = slot as u32 + 1;
    }
    Weights { nodes, shares }
}

/// A place on the other wire: `t` along the bond from particle `j`, or particle `j` alone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Place {
    /// First particle of the bond.
    pub j: u32,
    /// Position along it, 0 at `j`, 1 at the next [-].
    pub t: f64,
    /// Whether there is a bond.
    pub joined: bool,
}

impl Place {
    /// The weights of this place.
    #[inline(always)]
    pub fn weights(&self, state: &State) -> Weights<4> {
        if self.joined {
            cubic_weights(state, self.j as usize, self.t)
        } else {
            Weights { nodes: [self.j; 4], shares: [1.0, 0.0, 0.0, 0.0] }
        }
    }

    /// The two particles with their shares in linear interpolation.
    #[inline(always)]
    pub fn linear(&self) -> [(usize, f64); 2] {
        let j = self.j as usize;
        let t = if self.joined { self.t.clamp(0.0, 1.0) } else { 0.0 };
        [(j, 1.0 - t), (j + usize::from(self.joined), t)]
    }

    /// Linear interpolation of a number between the two particles.
    #[inline(always)]
    pub fn between(&self, values: &[f64]) -> f64 {
        let [(a, first), (b, second)] = self.linear();
        values[a] * first + values[b] * second
    }
}

/// The other wire as particle `i` sees it.
pub struct Other<'a> {
    /// Which particles are joined.
    pub chains: &'a Chains,
    /// All particles.
    pub state: &'a State,
    /// The particle that looks.
    pub i: usize,
    /// Whether it is its own wire.
    pub own: bool,
}

impl Other<'_> {
    #[inline(always)]
    fn holds(&self, slot: usize) -> bool {
        self.state.whole[slot] && !(self.own && self.chains.beside(self.i, slot, self.state))
    }

    /// Where a place may go on its bond [-]: a break leaves half a bond on either side.
    #[inline(always)]
    fn range(&self, slot: usize) -> [f64; 2] {
        // A bond that holds ends the range even where it is out of bounds for a wire that looks at itself.
        let low = if before(self.state, slot) { 0.0 } else { self.chains.reach(slot)[0] };
        let high = if self.state.whole[slot + 1] { 1.0 } else { 1.0 + self.chains.reach(slot + 1)[1] };
        [low, high]
    }

    /// Takes a place that has left its bond to the next one, as far as there is one.
    #[inline(always)]
    pub fn settle(&self, place: &mut Place) {
        for _ in 0..HOPS {
            let slot = place.j as usize;
            if place.t > 1.0 && self.holds(slot + 1) {
                (place.j, place.t) = (place.j + 1, place.t - 1.0);
            } else if place.t < 0.0 && slot > 0 && self.holds(slot - 1) {
                (place.j, place.t) = (place.j - 1, place.t + 1.0);
            } else {
                break;
            }
        }
        let [low, high] = self.range(place.j as usize);
        place.t = place.t.clamp(low, high);
    }

    /// How far the piece of wire goes from a place, in bonds [-]; what lies beyond the next bond is not looked at.
    #[inline(always)]
    pub fn left(&self, place: &Place) -> [f64; 2] {
        let slot = place.j as usize;
        let [low, high] = self.range(slot);
        let more = |there: bool| if there { f64::INFINITY } else { 0.0 };
        let (before, after) = (slot > 0 && self.holds(slot - 1), self.holds(slot + 1));
        [low - place.t - more(before), high - place.t + more(after)]
    }

    /// The foot of `p`, from `place` on, which is moved there (Newton's method on the square of the distance).
    #[inline(always)]
    pub fn foot(&self, p: DVec3, place: &mut Place) -> Foot {
        let slot = place.j as usize;
        if !self.holds(slot) {
            // The end of a piece, or a particle alone.
            if slot > 0 && self.holds(slot - 1) {
                *place = Place { j: place.j - 1, t: 1.0, joined: true };
            } else {
                *place = Place { j: place.j, t: 0.0, joined: false };
                let point = self.state.x.get(slot);
                return Foot { point, along: DVec3::ZERO, bend: DVec3::ZERO, at_end: true };
            }
        }
        place.joined = true;
        let mut cubic = Cubic::new(self.state, place.j as usize);
        for _ in 0..HOPS {
            let [point, along, bend] = cubic.at(place.t);
            let (away, square) = (point - p, along.length_squared());
            let fall = away.dot(along);
            // Far from the foot the distance may be concave; then the straight line decides.
            let rise = square + away.dot(bend).max(-0.5 * square);
            let from = *place;
            place.t -= fall / rise;
            self.settle(place);
            if place.j != from.j {
                cubic = Cubic::new(self.state, place.j as usize);
            } else if (place.t - from.t).abs() < CLOSE {
                break;
            }
        }
        let [point, along, bend] = cubic.at(place.t);
        let point = point - bend * Cubic::inside(place.t, along, bend);
        let slip = (p - point).dot(along) / along.length_squared();
        let [low, high] = self.range(place.j as usize);
        let at_end = place.t <= low && slip < -CLOSE || place.t >= high && slip > CLOSE;
        Foot { point, along, bend, at_end }
    }
}
