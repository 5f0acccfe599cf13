//! Smooth centrelines through the particles of a wire.
//!
//! Between two bonded particles the centreline passes from the parabola through the first and its neighbours to that of the
//! second, P₁ + (3t² − 2t³)(P₂ − P₁): points of it are weighted means of four particles, and tangent and curvature go on
//! from bond to bond, so that nothing jumps where a contact walks over a particle (a Catmull-Rom cubic, which passes with t,
//! has a jump of curvature there). On a helix that goes by an angle φ from one particle to the next it departs from the lay
//! radius R by 0.023 R φ⁴ at most (a chord: 0.125 R φ²), and sideways by 0.025 R φ³.
//! Around a particle the wire of that particle is the quartic through it and its four next neighbours, good to R φ⁶/700.
//!
//! Where neighbours are missing, the parabola of the three last particles goes on; two particles make a straight piece.
//!
//! A force at a point of a centreline goes to the particles with the weights of the point, so that its power is that of
//! the particles, and neither momentum nor energy is lost.

use super::chains::{Chains, before};
use crate::base::lanes::Real;
use crate::base::vectors::Vectors;
use crate::engine::state::State;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Longest walk of a foot from bond to bond in one search.
const HOPS: usize = 8;
/// Steps of Newton's method from the foot on the chord to that on the curve: chord and curve are within per cents, which
/// two steps take to rounding.
const STEPS: usize = 3;
/// A foot that is cut off by an end lies further than this beyond it (-).
const CLOSE: f64 = 1e-5;

/// A point of the centreline nearest to another point.
#[derive(Debug, Clone, Copy)]
pub struct Foot {
    /// The point (m).
    pub point: DVec3,
    /// First and second derivative by the position along the bond (m).
    pub along: DVec3,
    /// See `along`.
    pub bend: DVec3,
    /// Whether the piece of wire ends here, and the true foot lies beyond.
    pub at_end: bool,
    /// Whether it lies beyond the beginning of the piece.
    pub before: bool,
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

    /// Σ |weight| (-).
    pub fn sum(&self) -> f64 {
        self.shares.iter().map(|s| s.abs()).sum()
    }
}

/// The wire around a particle: a quartic, or less where neighbours are missing.
#[derive(Debug, Clone, Copy)]
pub struct Around {
    /// The first of the particles that it goes through, and their number.
    first: u32,
    count: u32,
    /// Place of the particle, from the middle one of these (-).
    shift: f64,
    /// Coefficients of its powers (m).
    powers: [DVec3; 5],
}

impl Around {
    /// Around particle `i`, from its own and its neighbours' `vectors`: positions, or velocities. A particle without a bond
    /// stays where it is.
    #[inline(always)]
    pub fn new(vectors: &Vectors, state: &State, chains: &Chains, i: usize) -> Self {
        let whole = &state.whole;
        let inner = i >= 2 && whole.get(i - 2..i + 2).is_some_and(|near| near.iter().all(|w| *w));
        // Bonds that hold one after the other to either side, as far as they matter.
        let before = || whole[..i].iter().rev().take(4).take_while(|w| **w).count();
        let after = || whole[i..].iter().take(4).take_while(|w| **w).count();
        let (left, right) = if inner { (2, 2) } else { (before(), after()) };
        // Beyond a break the curve goes on for half a bond: a quartic would swing there.
        let [low, high] = chains.reach(i);
        let swings = left == 0 && low < 0.0 || right == 0 && high > 0.0;
        let half = if left + right >= 4 && !swings { 2 } else { usize::from(left + right >= 2) };
        let first = if right < half { i + right - 2 * half } else { i - left.min(half) };
        let zero = DVec3::ZERO;
        if left + right == 0 {
            let powers = [vectors.get(i), zero, zero, zero, zero];
            return Self { first: i as u32, count: 1, shift: 0.0, powers };
        }
        if half == 0 {
            let first = i - left.min(1);
            let (a, b) = (vectors.get(first), vectors.get(first + 1));
            return Self {
                first: first as u32,
                count: 2,
                shift: (i - first) as f64,
                powers: [a, b - a, zero, zero, zero],
            };
        }
        let shift = i as f64 - (first + half) as f64;
        let x = |k: usize| vectors.get(first + k);
        let powers = if half == 1 {
            let (a, b, c) = (x(0), x(1), x(2));
            [b, (c - a) * 0.5, (a + c) * 0.5 - b, DVec3::ZERO, DVec3::ZERO]
        } else {
            let (b, near, far) = (x(2), [x(1), x(3)], [x(0), x(4)]);
            let (odd, even) = ([near[1] - near[0], far[1] - far[0]], [near[0] + near[1], far[0] + far[1]]);
            [
                b,
                (odd[0] * 8.0 - odd[1]) * (1.0 / 12.0),
                (even[0] * 16.0 - even[1] - b * 30.0) * (1.0 / 24.0),
                (odd[1] - odd[0] * 2.0) * (1.0 / 12.0),
                (even[1] - even[0] * 4.0 + b * 6.0) * (1.0 / 24.0),
            ]
        };
        Self { first: first as u32, count: 2 * half as u32 + 1, shift, powers }
    }

    /// The point at `u` bonds from the particle, and the first and second derivative there (m).
    #[inline(always)]
    pub fn at(&self, u: f64) -> [DVec3; 3] {
        let u = u + self.shift;
        let [a, b, c, d, e] = self.powers;
        [
            a + (b + (c + (d + e * u) * u) * u) * u,
            b + (c * 2.0 + (d * 3.0 + e * (4.0 * u)) * u) * u,
            c * 2.0 + (d * 6.0 + e * (12.0 * u)) * u,
        ]
    }

    /// The weights of the point at `u` bonds from the particle.
    #[inline(always)]
    pub fn weights(&self, u: f64) -> Weights<5> {
        let u = u + self.shift;
        let square = u * u;
        let shares = match self.count {
            1 => [1.0, 0.0, 0.0, 0.0, 0.0],
            2 => [1.0 - u, u, 0.0, 0.0, 0.0],
            3 => [0.5 * (square - u), 1.0 - square, 0.5 * (square + u), 0.0, 0.0],
            _ => {
                let (near, far) = (square - 1.0, square - 4.0);
                [
                    u * (u - 2.0) * near * (1.0 / 24.0),
                    -u * (u - 1.0) * far * (1.0 / 6.0),
                    near * far * 0.25,
                    -u * (u + 1.0) * far * (1.0 / 6.0),
                    u * (u + 2.0) * near * (1.0 / 24.0),
                ]
            }
        };
        let last = self.count - 1;
        Weights { nodes: [0, 1, 2, 3, 4].map(|k: u32| self.first + k.min(last)), shares }
    }

    /// Hands forces at places `u` from particle `i`, given as sums of force times each power of u, to the particles.
    #[inline(always)]
    pub fn spread(&self, i: usize, moments: &[DVec3; 5], add: &mut impl FnMut(usize, DVec3)) {
        let first = self.first as usize;
        if self.count == 1 {
            return add(i, moments[0]);
        }
        let [a, b, c, d, e] = if self.shift == 0.0 { *moments } else { shifted(moments, self.shift) };
        // The coefficients are those of `new`, particle by particle.
        match self.count {
            2 => {
                add(first, a - b);
                add(first + 1, b);
            }
            3 => {
                add(first, (c - b) * 0.5);
                add(first + 1, a - c);
                add(first + 2, (c + b) * 0.5);
            }
            _ => {
                let (odd, even) = ((b * 4.0 - d) * (1.0 / 6.0), (c * 4.0 - e) * (1.0 / 6.0));
                let (far_odd, far_even) = ((d - b) * (1.0 / 12.0), (e - c) * (1.0 / 24.0));
                add(first, far_even - far_odd);
                add(first + 1, even - odd);
                add(first + 2, a + (e - c * 5.0) * 0.25);
                add(first + 3, even + odd);
                add(first + 4, far_even + far_odd);
            }
        }
    }
}

/// Sums of force times powers of u + `shift`, from those of u.
pub fn shifted(moments: &[DVec3; 5], shift: f64) -> [DVec3; 5] {
    let mut out = *moments;
    // (u + s)ⁿ by Horner's scheme in all powers at once.
    for n in (1..5).rev() {
        let mut sum = moments[0];
        let mut row = [1.0f64; 5];
        for k in 0..n {
            row[k + 1] = row[k] * (n - k) as f64 / (k + 1) as f64;
        }
        sum *= shift.powi(n as i32);
        for k in 1..=n {
            sum += moments[k] * (row[k] * shift.powi((n - k) as i32));
        }
        out[n] = sum;
    }
    out
}

/// The curve of one bond, a + b t + c t² + d h(t); see [`blend`].
#[derive(Clone, Copy)]
pub struct Arc {
    /// The coefficients (m).
    pub coefficients: [DVec3; 4],
}

impl Arc {
    /// Of bond `slot`, from its own and its neighbours' `vectors`.
    #[inline(always)]
    pub fn new(vectors: &Vectors, state: &State, slot: usize) -> Self {
        let (x1, x2) = (vectors.get(slot), vectors.get(slot + 1));
        let (left, right) = (before(state, slot), state.whole[slot + 1]);
        // Beyond an end: see `arc_weights`.
        let (x0, x3) = match (left, right) {
            (true, true) => (vectors.get(slot - 1), vectors.get(slot + 2)),
            (true, false) => {
                let x0 = vectors.get(slot - 1);
                (x0, x0 + (x2 - x1) * 3.0)
            }
            (false, true) => {
                let x3 = vectors.get(slot + 2);
                (x3 - (x2 - x1) * 3.0, x3)
            }
            (false, false) => (x1 * 2.0 - x2, x2 * 2.0 - x1),
        };
        let coefficients = [x1, (x2 - x0) * 0.5, (x0 - x1 * 2.0 + x2) * 0.5, (x3 - x0 + (x1 - x2) * 3.0) * 0.5];
        Self { coefficients }
    }

    /// Where the foot of `p` on the chord lies (-).
    #[inline(always)]
    fn on_chord(&self, state: &State, slot: usize, p: DVec3) -> f64 {
        let chord = state.x.get(slot + 1) - self.coefficients[0];
        (p - self.coefficients[0]).dot(chord) / chord.length_squared()
    }

    #[inline(always)]
    fn at(&self, t: f64) -> [DVec3; 3] {
        let [a, b, c, d] = self.coefficients;
        let [h, h1, h2, _] = blend(t);
        [a + (b + c * t) * t + d * h, b + c * (2.0 * t) + d * h1, c * 2.0 + d * h2]
    }
}

/// h(t) = (t² − t)(3t² − 2t³) and its derivatives.
#[inline(always)]
pub fn blend<R: Real>(t: R) -> [R; 4] {
    let one = |value: f64| t.splat(value);
    let square = t * t;
    [
        square * t * ((one(5.0) - t * 2.0) * t - 3.0),
        square * ((one(20.0) - t * 10.0) * t - 9.0),
        t * ((one(60.0) - t * 40.0) * t - 18.0),
        (one(120.0) - t * 120.0) * t - 18.0,
    ]
}

/// The weights of the point `t` of bond `slot`.
#[inline(always)]
fn arc_weights(state: &State, slot: usize, t: f64) -> Weights<4> {
    let (t2, h) = (t * t, blend(t)[0]);
    let mut shares = [0.5 * (t2 - t - h), 1.0 - t2 + 1.5 * h, 0.5 * (t2 + t) - 1.5 * h, 0.5 * h];
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

/// Hands forces on bond `slot`, given as sums of force times 1, t, t² and h(t), to the particles; where there is no bond, to
/// its first particle.
#[inline(always)]
pub fn spread_arc(state: &State, slot: usize, moments: &[DVec3; 4], add: &mut impl FnMut(usize, DVec3)) {
    let [a, b, c, d] = *moments;
    if !state.whole[slot] {
        return add(slot, a);
    }
    let (x0, x3) = ((c - b - d) * 0.5, d * 0.5);
    let (mut x1, mut x2) = (a - c + d * 1.5, (b + c) * 0.5 - d * 1.5);
    let (left, right) = (before(state, slot), state.whole[slot + 1]);
    // Beyond an end: see `arc_weights`.
    match (left, right) {
        (true, true) => {
            add(slot - 1, x0);
            add(slot + 2, x3);
        }
        (true, false) => {
            (x1, x2) = (x1 - x3 * 3.0, x2 + x3 * 3.0);
            add(slot - 1, x0 + x3);
        }
        (false, true) => {
            (x1, x2) = (x1 + x0 * 3.0, x2 - x0 * 3.0);
            add(slot + 2, x3 + x0);
        }
        (false, false) => (x1, x2) = (x1 + x0 * 2.0 - x3, x2 - x0 + x3 * 2.0),
    }
    add(slot, x1);
    add(slot + 1, x2);
}

/// A place on the other wire: `t` along the bond from particle `j`, or particle `j` alone.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Place {
    /// First particle of the bond.
    pub j: u32,
    /// Position along it, 0 at `j`, 1 at the next (-).
    pub t: f64,
    /// Whether there is a bond.
    pub joined: bool,
}

impl Place {
    /// The weights of this place.
    #[inline(always)]
    pub fn weights(&self, state: &State) -> Weights<4> {
        if self.joined {
            arc_weights(state, self.j as usize, self.t)
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

    /// Where a place may go on its bond (-): a break leaves half a bond on either side.
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

    /// How far the piece of wire goes from a place, in bonds (-); what lies beyond the next bond is not looked at.
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
                return Foot { point, along: DVec3::ZERO, bend: DVec3::ZERO, at_end: true, before: false };
            }
        }
        place.joined = true;
        let mut arc = Arc::new(&self.state.x, self.state, place.j as usize);
        for _ in 0..HOPS {
            // From the foot on the chord and with a fixed number of steps, so that it depends on the positions alone.
            place.t = arc.on_chord(self.state, place.j as usize, p);
            for _ in 0..STEPS {
                let [point, along, bend] = arc.at(place.t);
                let (away, square) = (point - p, along.length_squared());
                // Far from the foot the distance may be concave; then the straight line decides.
                let rise = square + away.dot(bend).max(-0.5 * square);
                place.t -= away.dot(along) / rise;
            }
            let from = place.j;
            self.settle(place);
            if place.j == from {
                break;
            }
            arc = Arc::new(&self.state.x, self.state, place.j as usize);
        }
        let [point, along, bend] = arc.at(place.t);
        let slip = (p - point).dot(along) / along.length_squared();
        let [low, high] = self.range(place.j as usize);
        let before = place.t <= low && slip < -CLOSE;
        let at_end = before || place.t >= high && slip > CLOSE;
        Foot { point, along, bend, at_end, before }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;
    use crate::strand::assembly::Assembly;
    use proptest::prelude::*;

    /// One crooked wire of nine particles, of whose bonds those in `broken` are broken.
    fn wire(broken: &[usize]) -> (Chains, State) {
        let n = 9;
        let position: Vectors = (0..n as u64)
            .map(|i| DVec3::new(uniform(7, i, 0), uniform(7, i, 1), i as f64 + 0.3 * uniform(7, i, 2)))
            .collect();
        let mut rest_length = vec![1.0; n];
        rest_length[n - 1] = 0.0;
        let assembly = Assembly {
            layers: Vec::new(),
            wires: Vec::new(),
            wire_particles: n,
            velocity: Vectors::zeros(n),
            spin: Vectors::zeros(n),
            radius: vec![0.5; n],
            mass: vec![1.0; n],
            inertia: vec![1.0; n],
            rest_length,
            wire_of: vec![0; n],
            sphere_material: Vec::new(),
            length: 0.0,
            area: 0.0,
            position,
        };
        let mut state = State::new(&assembly, true);
        broken.iter().for_each(|slot| state.whole[*slot] = false);
        (Chains::new(&assembly, vec![2]), state)
    }

    /// Breaks that leave ends, pairs and single particles.
    const BREAKS: [&[usize]; 5] = [&[], &[3], &[2, 4], &[1, 2, 5], &[0, 1, 2, 3, 4, 5, 6, 7]];

    #[test]
    fn tangent_and_curvature_go_on_from_bond_to_bond() {
        let (_, state) = wire(&[]);
        for slot in 0..7 {
            let end = Arc::new(&state.x, &state, slot).at(1.0);
            let next = Arc::new(&state.x, &state, slot + 1).at(0.0);
            for (one, other) in end.into_iter().zip(next) {
                assert!((one - other).length() < 1e-12, "after bond {slot}: {one} {other}");
            }
        }
    }

    proptest! {
        /// The power of the particles is that of the points at which forces act.
        #[test]
        fn forces_do_the_work_of_the_points(u in -0.5..0.5f64, t in 0.0..1.0f64, case in 0..BREAKS.len(), i in 0..9usize) {
            let (chains, state) = wire(BREAKS[case]);
            let force = DVec3::new(1.0, -2.0, 0.5);
            let mut power = 0.0;
            let mut sum = DVec3::ZERO;
            let around = Around::new(&state.x, &state, &chains, i);
            let powers = [1.0, u, u * u, u * u * u, u * u * u * u].map(|power| force * power);
            let moments = if chains.alone(i, &state) { [force, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO, DVec3::ZERO] } else { powers };
            around.spread(i, &moments, &mut |node, f| {
                power += f.dot(state.x.get(node));
                sum += f;
            });
            let point = if chains.alone(i, &state) { state.x.get(i) } else { around.at(u)[0] };
            prop_assert!((power - force.dot(point)).abs() < 1e-12 && (sum - force).length() < 1e-12);
            let weighted = around.weights(u).mean(|p| state.x.get(p));
            prop_assert!((weighted - point).length() < 1e-12);

            let (mut power, mut sum) = (0.0, DVec3::ZERO);
            let functions = [1.0, t, t * t, blend(t)[0]].map(|value| force * value);
            spread_arc(&state, i, &functions, &mut |node, f| {
                power += f.dot(state.x.get(node));
                sum += f;
            });
            let point = if state.whole[i] { Arc::new(&state.x, &state, i).at(t)[0] } else { state.x.get(i) };
            prop_assert!((power - force.dot(point)).abs() < 1e-12 && (sum - force).length() < 1e-12);
            if state.whole[i] {
                prop_assert!((arc_weights(&state, i, t).mean(|p| state.x.get(p)) - point).length() < 1e-12);
            }
        }
    }
}
