//! Neighbour search: candidate pairs within reach plus a skin, and the criterion that says when they must be found anew.
//!
//! The whole strand stretches by a third, so displacements are measured against the affine stretch of the gauge: a
//! pair stays covered while 2 max|u − u_affine| + Δε (reach + skin) < skin.

use super::bytes::{behind, behind_all};
use super::motion::residual;
use super::saved::{Reader, Unfit, Writer};
use super::state::{CHUNK, State};
use super::team::Team;
use crate::base::vectors::Vectors;
use crate::scene::spec::Shape;
use crate::strand::assembly::Assembly;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// The search follows bonds up to this multiple of the longest stress-free length (-): one bond that necks without end
/// must not make every particle a neighbour of every other.
pub const MOST_STRETCH: f64 = 3.0;
/// Bonds from a particle to the furthest one that moves its stretch of smooth wire.
const EDGE: usize = 3;
const SQRT_HALF: f64 = std::f64::consts::FRAC_1_SQRT_2;

/// Candidate pairs (i < j), sorted.
#[derive(Debug, Default)]
pub struct PairList {
    /// The pairs.
    pub pairs: Vec<(u32, u32)>,
}

/// The affine stretch that grips impose: u_z = displacement × clamp((z − z₀)/(z₁ − z₀)).
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Stretch {
    /// Gauge before loading (m); z₁ = z₀ when there are no grips.
    pub gauge: [f64; 2],
    /// Displacement of the upper grip since the start (m).
    pub displacement: f64,
}

/// Candidate search with its skin.
pub struct Neighbours {
    /// Skin beyond the sum of the undeformed radii (m).
    skin: f64,
    /// Extra reach, for contacts that are not between particle centres (m); from the bonds at the last search.
    margin: f64,
    /// What touches.
    shape: Shape,
    /// Largest and least undeformed radius (m).
    largest: f64,
    least: f64,
    /// Longest stress-free bond, and longest bond at the last search (m).
    rest: f64,
    longest: f64,
    /// Bonded neighbours along a wire that cannot touch: |i − j| below this per wire.
    apart: Vec<u32>,
    wire_of: Vec<u32>,
    reference: Vectors,
    stretch: Stretch,
    list: PairList,
    /// No pair can come within reach unseen until [`State::travel`] has reached this (m).
    safe_until: f64,
    /// Number of searches so far.
    pub rebuilds: u64,
}

/// Cell grid by counting sort, made for one search.
struct Cells {
    start: Vec<u32>,
    order: Vec<u32>,
    of_particle: Vec<u32>,
    origin: DVec3,
    size: f64,
    shape: [usize; 3],
}

/// Per wire, the number of bonds below which its particles cannot touch: a bent chain cannot touch itself within a
/// quarter turn of the tightest bend, a circle of the wire's diameter.
pub fn apart(assembly: &Assembly) -> Vec<u32> {
    let bonds = |diameter: f64, spacing: f64| {
        if spacing > 0.0 { (1.6 * diameter / spacing).ceil().max(2.0) as u32 } else { 2 }
    };
    assembly.wires.iter().map(|w| bonds(w.diameter, assembly.rest_length[w.first])).collect()
}

impl Neighbours {
    /// For `assembly`; `skin` in m.
    pub fn new(assembly: &Assembly, skin: f64, shape: Shape) -> Self {
        Self {
            skin,
            margin: 0.0,
            shape,
            largest: assembly.radius.iter().copied().fold(0.0, f64::max),
            least: assembly.radius.iter().copied().fold(f64::MAX, f64::min),
            rest: assembly.rest_length.iter().copied().fold(0.0, f64::max),
            longest: 0.0,
            apart: apart(assembly),
            wire_of: assembly.wire_of.clone(),
            reference: Vectors::default(),
            stretch: Stretch::default(),
            list: PairList::default(),
            safe_until: 0.0,
            rebuilds: 0,
        }
    }

    /// Whether a pair may have come within reach unseen. Particles are looked at only once [`State::travel`] allows that
    /// one has: a search lasts for hundreds of steps.
    pub fn stale(&mut self, state: &State, now: &Stretch, team: &Team) -> bool {
        if self.rebuilds == 0 {
            return true;
        }
        if state.travel < self.safe_until {
            return false;
        }
        let (length, reach) = (self.length(), self.reach());
        let left = self.skin - 2.0 * self.residual(state, now, team) - self.strain(now) * reach;
        // While no particle goes further than 1, held ones included, a residual grows by 2 and the strain by 1/length.
        let closing = 4.0 + if length > 0.0 { reach / length } else { 0.0 };
        self.safe_until = state.travel + left / closing;
        left <= 0.0
    }

    /// How far the upper face has moved since the last search (m), and of the length between the faces its lower end (m) and
    /// its inverse (1/m).
    fn moved(&self, now: &Stretch) -> (f64, [f64; 2]) {
        let (low, length) = (self.stretch.gauge[0], self.length());
        let moved = now.displacement - self.stretch.displacement;
        if length > 0.0 { (moved, [low, 1.0 / length]) } else { (0.0, [low, 0.0]) }
    }

    /// Length between the faces at the last search (m).
    fn length(&self) -> f64 {
        self.stretch.gauge[1] + self.stretch.displacement - self.stretch.gauge[0]
    }

    /// Greatest distance at which a pair is a candidate (m).
    fn reach(&self) -> f64 {
        2.0 * self.largest + self.margin + self.skin
    }

    /// Strain since the last search (-).
    fn strain(&self, now: &Stretch) -> f64 {
        let length = self.length();
        if length > 0.0 { ((now.displacement - self.stretch.displacement) / length).abs() } else { 0.0 }
    }

    /// Numbers by which every particle sees by itself whether it is time for a search: of [`residual`], and the square that
    /// must not be passed (m²), below zero where it is time in any case.
    pub fn watch(&self, now: &Stretch) -> [(&'static str, f64); 4] {
        let (moved, [low, per_length]) = self.moved(now);
        let left = 0.5 * (self.skin - self.strain(now) * self.reach());
        let most = if self.rebuilds > 0 && left > 0.0 { left * left } else { -1.0 };
        [("search_moved", moved), ("search_low", low), ("search_per_length", per_length), ("search_most", most)]
    }

    /// Forgets how far particles may go unseen: they have moved elsewhere.
    pub fn look_anew(&mut self) {
        self.safe_until = 0.0;
    }

    /// Greatest distance of a particle from where the affine stretch since the last search would have it (m).
    fn residual(&self, state: &State, now: &Stretch, team: &Team) -> f64 {
        let (moved, face) = self.moved(now);
        let square = |p: usize| residual::<f64>(state.x.get(p).into(), self.reference.get(p).into(), moved, face);
        let greatest =
            |chunk: usize| (chunk * CHUNK..state.len().min((chunk + 1) * CHUNK)).map(square).fold(0.0, f64::max);
        let found = team.map(0..state.len().div_ceil(CHUNK), |chunk, _| greatest(chunk));
        found.into_iter().fold(0.0, f64::max).sqrt()
    }

    /// Puts in the last search.
    pub fn save(&self, out: &mut Writer) {
        out.put(&(self.margin, self.longest, self.safe_until, self.rebuilds));
        out.put(&self.stretch);
        out.put(&self.reference);
        out.put(&self.list.pairs);
    }

    /// Takes up what [`Self::save`] has put in.
    ///
    /// # Errors
    /// [`Unfit`] when it is of other particles.
    pub fn restore(&mut self, from: &mut Reader) -> Result<(), Unfit> {
        (self.margin, self.longest, self.safe_until, self.rebuilds) = from.take()?;
        self.stretch = from.take()?;
        self.reference = from.take()?;
        self.list.pairs = from.take()?;
        let count = self.wire_of.len();
        let searched = self.rebuilds == 0 || self.reference.rows().iter().all(|row| row.len() == count);
        let known = |p: u32| (p as usize) < count;
        if !searched || !self.list.pairs.iter().all(|(i, j)| known(*i) && known(*j)) {
            return Err(Unfit("its pairs are those of other particles".into()));
        }
        Ok(())
    }

    /// Finds all candidate pairs anew.
    pub fn search(&mut self, state: &State, now: Stretch, team: &Team) -> &PairList {
        self.reference.clone_from(&state.x);
        self.stretch = now;
        self.safe_until = 0.0;
        self.rebuilds += 1;
        self.longest = longest_bond(state);
        self.margin = self.needed_margin(state);
        // The last list goes before this one comes, so that there is memory for one of them alone.
        self.list.pairs = Vec::new();
        let cells = Cells::of(state, 2.0 * self.largest + self.margin + self.skin);
        let chunks = state.len().div_ceil(CHUNK);
        let broken = broken_before(state);
        let around = |chunk: usize| {
            let mut out = Vec::new();
            let last = ((chunk + 1) * CHUNK).min(state.len());
            for i in chunk * CHUNK..last {
                let from = out.len();
                cells.around(i, |j| {
                    if (j as usize) > i && self.can_touch(i, j as usize, state, &broken) {
                        out.push((i as u32, j));
                    }
                });
                out[from..].sort_unstable();
            }
            out
        };
        let found = team.map(0..chunks, |chunk, _| around(chunk));
        self.list.pairs = found.concat();
        self.add_parted(state);
        &self.list
    }

    /// Pairs across a break that were too near along the wire to touch before it, however far apart: where they meet
    /// again is said once, when they part, and must not depend on when a search sees them.
    fn add_parted(&mut self, state: &State) {
        let wire = |p: usize| self.wire_of[p];
        let last = state.len().saturating_sub(1);
        let broken = (0..last).filter(|s| !state.whole[*s] && wire(*s) != u32::MAX && wire(*s) == wire(*s + 1));
        let before = self.list.pairs.len();
        for slot in broken {
            let apart = self.apart[wire(slot) as usize] as usize;
            for i in (slot + 2).saturating_sub(apart)..=slot {
                let ends =
                    (slot + 1..(i + apart).min(state.len())).filter(|j| wire(*j) == wire(i) && wire(i) == wire(slot));
                self.list.pairs.extend(ends.map(|j| (i as u32, j as u32)));
            }
        }
        if self.list.pairs.len() > before {
            self.list.pairs.sort_unstable();
            self.list.pairs.dedup();
        }
    }

    /// Extra reach for what touches between particle centres, until the next search (m).
    ///
    /// Smooth wires that cross may meet half a bond from the nearest particle of either: √(D² + l²/2) − D at touching
    /// distance D, most for the thinnest pair; of broken ones the last half bonds may lie side by side beyond the last
    /// particles, a whole bond apart. Spheres need none of that, but two bonds that cross in the middle have
    /// their ends √½ l apart, and must be seen to cross ([`super::crossing`]).
    fn needed_margin(&self, state: &State) -> f64 {
        // Until it is time for the next search the affine strain grows by less than skin over reach, and particles move
        // by less than the skin beside it.
        let reach = 2.0 * self.least;
        let grown = self.longest * (1.0 + self.skin / (reach + self.skin)) + self.skin;
        match self.shape {
            Shape::Wire => {
                let broken = state.length_at_break.iter().any(|length| *length > 0.0);
                let aside = if broken { 1.0 } else { SQRT_HALF };
                reach.hypot(aside * grown.min(MOST_STRETCH * self.rest)) - reach
            }
            Shape::Sphere => (SQRT_HALF * self.longest.min(MOST_STRETCH * self.rest) - reach).max(0.0),
        }
    }

    /// Memory that it keeps (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.wire_of) + behind_all(&self.reference) + behind(&self.list.pairs)
    }

    /// The list, and the positions, of the last search.
    pub fn last(&self) -> (&PairList, &Vectors) {
        (&self.list, &self.reference)
    }

    /// What touches.
    pub fn shape(&self) -> Shape {
        self.shape
    }

    /// Skin (m).
    pub fn skin(&self) -> f64 {
        self.skin
    }

    /// Longest bond at the last search (m).
    pub fn longest(&self) -> f64 {
        self.longest
    }

    /// Longest bond at the last search over the longest stress-free one (-); contacts on bonds beyond [`MOST_STRETCH`]
    /// are not all found.
    pub fn stretched(&self) -> f64 {
        if self.rest > 0.0 { self.longest / self.rest } else { 0.0 }
    }

    fn can_touch(&self, i: usize, j: usize, state: &State, broken: &[u32]) -> bool {
        let reach = state.radius0[i] + state.radius0[j] + self.margin + self.skin;
        if (state.x.get(j) - state.x.get(i)).length_squared() >= reach * reach {
            return false;
        }
        if state.hold[i] != 0 && state.hold[i] == state.hold[j] {
            // Points between particles move where one of the two is free, so particles at the edge of a hold count.
            let edge = self.shape == Shape::Wire && (on_edge(state, i) || on_edge(state, j));
            if !edge {
                return false;
            }
        }
        let wire = self.wire_of[i];
        if wire != u32::MAX && wire == self.wire_of[j] {
            let close = ((j - i) as u32) < self.apart[wire as usize];
            return !close || broken[j] > broken[i];
        }
        true
    }
}

/// Length of the longest bond that holds (m).
fn longest_bond(state: &State) -> f64 {
    let bonds = (0..state.len()).filter(|slot| state.whole[*slot]);
    bonds.map(|slot| (state.x.get(slot + 1) - state.x.get(slot)).length_squared()).fold(0.0, f64::max).sqrt()
}

/// Whether a particle is within [`EDGE`] bonds of one that is not in the same hold.
fn on_edge(state: &State, p: usize) -> bool {
    let leaves = |q: usize| state.hold[q] != state.hold[p];
    let after = (p..state.len()).take(EDGE).take_while(|slot| state.whole[*slot]).any(|slot| leaves(slot + 1));
    let before = (0..p).rev().take(EDGE).take_while(|slot| state.whole[*slot]).any(leaves);
    after || before
}

/// Number of broken slots before each particle; two particles of a wire are in one piece when theirs agree.
fn broken_before(state: &State) -> Vec<u32> {
    let mut sum = 0;
    state
        .whole
        .iter()
        .map(|whole| {
            let before = sum;
            sum += u32::from(!whole);
            before
        })
        .collect()
}

impl Cells {
    /// All particles in cells of `size` (m).
    fn of(state: &State, size: f64) -> Self {
        let n = state.len();
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for p in state.x.iter() {
            low = low.min(p);
            high = high.max(p);
        }
        // A far-flung fragment must not blow up the grid: cells grow until there are at most eight per particle.
        let shape = |size: f64| ((high - low) / size).to_array().map(|c| c.floor() + 1.0);
        let mut size = size;
        while shape(size).iter().product::<f64>() > 8.0 * n as f64 + 64.0 {
            size *= 1.25;
        }
        let shape = shape(size).map(|c| c as usize);
        let count: usize = shape.iter().product();
        let mut cells = Self {
            start: vec![0; count + 1],
            order: vec![0; n],
            of_particle: Vec::with_capacity(n),
            origin: low,
            size,
            shape,
        };
        for p in state.x.iter() {
            let cell = cells.cell(p);
            let index = ((cell[0] * shape[1]) + cell[1]) * shape[2] + cell[2];
            cells.of_particle.push(index as u32);
            cells.start[index + 1] += 1;
        }
        for c in 0..count {
            cells.start[c + 1] += cells.start[c];
        }
        // Filling moves every start on to its end, which is the start of the next: so they are put back by one.
        for (i, cell) in cells.of_particle.iter().enumerate() {
            let at = &mut cells.start[*cell as usize];
            cells.order[*at as usize] = i as u32;
            *at += 1;
        }
        cells.start.rotate_right(1);
        cells.start[0] = 0;
        cells
    }

    fn cell(&self, p: DVec3) -> [usize; 3] {
        let c = ((p - self.origin) / self.size).to_array();
        std::array::from_fn(|k| (c[k] as usize).min(self.shape[k] - 1))
    }

    fn around(&self, i: usize, mut visit: impl FnMut(u32)) {
        let index = self.of_particle[i] as usize;
        let [_, ny, nz] = self.shape;
        let (cx, cy, cz) = (index / (ny * nz), index / nz % ny, index % nz);
        for x in cx.saturating_sub(1)..=(cx + 1).min(self.shape[0] - 1) {
            for y in cy.saturating_sub(1)..=(cy + 1).min(ny - 1) {
                let row = (x * ny + y) * nz;
                let (first, last) = (row + cz.saturating_sub(1), row + (cz + 1).min(nz - 1));
                // Cells of one row are neighbours in memory.
                let (from, to) = (self.start[first] as usize, self.start[last + 1] as usize);
                self.order[from..to].iter().for_each(|j| visit(*j));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::base::random::uniform;

    fn cloud(n: usize, box_size: f64, radius: f64) -> (Assembly, State) {
        let position: Vectors = (0..n as u64)
            .map(|i| DVec3::new(uniform(1, i, 0), uniform(1, i, 1), uniform(1, i, 2)) * box_size)
            .collect();
        let assembly = Assembly {
            layers: Vec::new(),
            wires: Vec::new(),
            wire_particles: 0,
            velocity: Vectors::zeros(n),
            spin: Vectors::zeros(n),
            radius: vec![radius; n],
            mass: vec![1.0; n],
            inertia: vec![1.0; n],
            rest_length: vec![0.0; n],
            wire_of: vec![u32::MAX; n],
            sphere_material: vec![0; n],
            length: 0.0,
            area: 0.0,
            position,
        };
        let state = State::new(&assembly, true);
        (assembly, state)
    }

    #[test]
    fn search_finds_what_brute_force_finds() {
        let (assembly, state) = cloud(700, 1.0, 0.04);
        let mut neighbours = Neighbours::new(&assembly, 0.01, Shape::Sphere);
        let found = neighbours.search(&state, Stretch::default(), &Team::alone()).pairs.clone();
        let mut expected = Vec::new();
        for i in 0..state.len() {
            for j in i + 1..state.len() {
                if (state.x.get(i) - state.x.get(j)).length() < 0.09 {
                    expected.push((i as u32, j as u32));
                }
            }
        }
        assert_eq!(found, expected);
        assert!(found.len() > 300);
    }

    /// A thin wire's particle rests on the middle of a bond that is three times as long as at rest: as far from both ends
    /// as can be.
    #[test]
    fn a_stretched_segment_is_found_from_its_middle() {
        let (mut assembly, _) = cloud(3, 1.0, 0.1);
        assembly.radius[2] = 0.02;
        assembly.rest_length[0] = 0.2;
        assembly.position =
            [0.0, 0.6, 0.3].map(|x| DVec3::new(x, if x == 0.3 { 0.119 } else { 0.0 }, 0.0)).into_iter().collect();
        let state = State::new(&assembly, true);
        let found = |shape| {
            Neighbours::new(&assembly, 0.01, shape).search(&state, Stretch::default(), &Team::alone()).pairs.clone()
        };
        assert!(found(Shape::Wire).contains(&(0, 2)) && found(Shape::Wire).contains(&(1, 2)));
    }

    #[test]
    fn a_far_flung_particle_does_not_blow_up_the_grid() {
        let (_, mut state) = cloud(200, 1.0, 0.04);
        state.x.set(0, DVec3::splat(1e6));
        assert!(Cells::of(&state, 0.09).start.len() < 8 * 200 + 128);
    }

    #[test]
    fn affine_stretch_alone_needs_few_searches() {
        let stretch = |d: f64| Stretch { gauge: [0.01, 0.11], displacement: d };
        let (assembly, mut state) = cloud(50, 0.1, 0.0002);
        let start = state.x.clone();
        let mut neighbours = Neighbours::new(&assembly, 6e-5, Shape::Sphere);
        for k in 0..=270 {
            let d = k as f64 * 1e-4;
            let now = stretch(d);
            for i in 0..state.len() {
                let z0 = start.z[i];
                state.x.z[i] = z0 + d * ((z0 - 0.01) / 0.1).clamp(0.0, 1.0);
            }
            // What the motion until here amounts to.
            state.travel = d;
            if neighbours.stale(&state, &now, &Team::alone()) {
                neighbours.search(&state, now, &Team::alone());
            }
        }
        // Each search lasts for a strain of about skin / (diameter + skin) = 13 %.
        assert!(neighbours.rebuilds <= 4, "{}", neighbours.rebuilds);
    }
}
