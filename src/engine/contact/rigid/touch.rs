//! One particle against one rigid body at one step: where they meet, and how.

use super::body::Body;
use crate::engine::contact::pair::{
    ContactKinematics, Dissipated, History, Laws, PairForce, contact_response, foreseen_stiffness, leave, press,
};
use crate::engine::contact::wires::chains::Chains;
use crate::engine::contact::wires::curve::{Around, shifted};
use crate::engine::state::{ChunkSums, State};
use crate::engine::time_step::Element;
use crate::law::contact::line::{CELLS, CellGap, LINE, LineStiffness, patch_length, respond_cells};
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::damping::{HERTZIAN, viscous_coefficient};
use crate::law::tangential::{TangentialInput, TangentialLaw};
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::f64::consts::PI;
use std::ops::Range;

/// How far a stretch may reach from its particle, over the longer of the bonds beside it (-): half of it, and what the
/// curve is longer than its chord.
const REACH: f64 = 0.6;

/// What a contact remembers.
#[derive(Clone, Serialize, Deserialize)]
#[serde(bound = "")]
pub(super) struct Touch<N: NormalLaw, T: TangentialLaw> {
    /// The particle.
    pub i: u32,
    /// Whether it is a ball, or a stretch of wire.
    pub ball: bool,
    pub history: History<N, T>,
    /// Greatest overlap of each cell of each block so far (m); none of a ball.
    pub dents: Vec<[f64; CELLS]>,
    /// Stiffness per length (Pa), of the curvature at which they came to touch: what is stored changes by work alone.
    per_length: f64,
    /// 2ξ√m (√kg).
    viscosity: f64,
    /// Radius at the last step (m).
    reach: f64,
    /// Overlap at the last step, at its deepest (m), and curvature of the gap there (1/m).
    overlap: f64,
    curvature: f64,
    /// Elastic energy of the normal force (J).
    pub energy: f64,
    /// Where the force acts, in bonds from the particle (-), and its lever arm (m).
    u: f64,
    arm: f64,
}

/// Contacts of one chunk with one body.
pub(super) struct Near<N: NormalLaw, T: TangentialLaw> {
    /// Nothing touches until particles and the body together have gone so far (m).
    pub quiet_until: f64,
    /// In the order of particles.
    pub touches: Vec<Touch<N, T>>,
    /// Force (N) on the body, and moment (N m) about its place, at this step.
    pub load: [DVec3; 2],
}

/// What a body does to a particle or its stretch.
pub(super) struct Act {
    pub i: u32,
    pub ball: bool,
    /// Force times each power of the place along the stretch (N); the first is the force.
    pub force: [DVec3; 5],
    /// Moment on the particle (N m).
    pub twist: DVec3,
}

/// What contacts need to know.
pub(super) struct Meets<'a> {
    pub state: &'a State,
    pub chains: &'a Chains,
    pub line: &'a LineStiffness,
    pub smooth: bool,
    pub material_of: &'a [u32],
    pub restitution: bool,
    pub damping: f64,
    pub skin: f64,
    pub closing: f64,
}

/// A stretch of wire as it lies against a body.
struct Stretch {
    around: Around,
    /// Where it begins and ends, in bonds from the particle (-).
    ends: [f64; 2],
    /// Its length along the undeformed wire (m).
    length: f64,
    blocks: usize,
}

/// A block of cells of a stretch.
struct Block {
    /// Its middle, in bonds from the particle (-).
    middle: f64,
    gap: CellGap<f64>,
    /// Gradient of the distance at the middle, and how it turns along the stretch, per bond.
    outward: DVec3,
    turn: DVec3,
    /// Curvature of the gap (1/m), and the deepest overlap of a cell, positive or not (m).
    curvature: f64,
    deepest: f64,
}

/// Sums over the blocks of a stretch.
#[derive(Default)]
struct Sums {
    /// Force per length times powers of the place, from the particle (N).
    moments: [DVec3; 5],
    force: f64,
    first: f64,
    stiffness: f64,
    energy: f64,
    plastic_work: f64,
    /// Rate at which the gap opens, as the force sees it, times force (W).
    opening: f64,
}

/// Looks at all `particles` of a chunk; gives one whose centre lies inside the body.
pub(super) fn look<N: NormalLaw, T: TangentialLaw>(
    meets: &Meets,
    body: &Body<N, T>,
    number: usize,
    particles: Range<usize>,
    near: &mut Near<N, T>,
    acts: &mut Vec<Act>,
    sums: &mut ChunkSums,
) -> Option<usize> {
    let state = meets.state;
    let mut old = std::mem::take(&mut near.touches).into_iter().peekable();
    let (mut least, mut passed) = (f64::INFINITY, None);
    for i in particles {
        let mut known = old.next_if(|touch| touch.i as usize == i);
        let ball = meets.is_ball(i);
        let distance = body.surface.distance(state.x.get(i) - body.place).value;
        if distance < 0.0 {
            passed = passed.or(Some(i));
        }
        if let Some(other) = known.take_if(|touch| touch.ball != ball) {
            // Two breaks have left it alone.
            sums.released += other.energy;
            sums.friction += leave(body.law(meets.material(i)), &other.history);
        }
        let gap = distance - state.radius[i] - if ball { 0.0 } else { meets.reach(i) };
        if gap > 0.0 && known.is_none() {
            least = least.min(gap);
            continue;
        }
        let mut job = Job { meets, body, number, i, acts: &mut *acts, sums: &mut *sums, load: &mut near.load };
        let gap = if ball { job.ball(&mut known) } else { job.stretch(&mut known) };
        match known.filter(|touch| touch.history.touching() || gap < meets.skin) {
            Some(touch) => {
                near.touches.push(touch);
                least = 0.0;
            }
            None => least = least.min(gap.max(0.0)),
        }
    }
    near.quiet_until = body.gone(state) + least / meets.closing;
    passed
}

impl Meets<'_> {
    fn material(&self, i: usize) -> usize {
        self.material_of.get(i).map_or(0, |material| *material as usize)
    }

    fn is_ball(&self, i: usize) -> bool {
        !self.smooth || self.chains.wire_of[i] == u32::MAX || self.chains.alone(i, self.state)
    }

    /// How far the stretch of particle `i` reaches from it (m).
    fn reach(&self, i: usize) -> f64 {
        let (x, whole) = (&self.state.x, &self.state.whole);
        let bond = |slot: usize| if whole[slot] { (x.get(slot + 1) - x.get(slot)).length_squared() } else { 0.0 };
        let longer = bond(i).max(if i > 0 { bond(i - 1) } else { 0.0 });
        REACH * longer.sqrt()
    }

    /// The contact as the bound on the time step sees it, as it can become within `horizon` (s).
    pub fn element<N: NormalLaw, T: TangentialLaw>(
        &self,
        body: &Body<N, T>,
        touch: &Touch<N, T>,
        horizon: f64,
    ) -> Option<Element> {
        let (state, i) = (self.state, touch.i as usize);
        let law = body.law(self.material(i));
        let arm = state.x.get(i) - body.place;
        let outward = body.surface.distance(arm).outward;
        let approach = (body.velocity_at(arm) - state.v.get(i)).dot(outward);
        let (weight, stiffness) = if touch.ball {
            (1.0, foreseen_stiffness(law, &touch.history, touch.overlap, approach, horizon)?)
        } else {
            let length = self.chains.cell_length(i) * CELLS as f64;
            let overlap = touch.overlap + approach.max(0.0) * horizon;
            let normal = touch.per_length * patch_length(overlap, touch.curvature, length);
            let mut across = 0.0;
            if T::ACTIVE {
                let mut tangential = touch.history.tangential;
                let radius = normal / (2.0 * law.normal.effective_modulus());
                let input = TangentialInput::at_rest(touch.history.normal_force, radius);
                across = law.tangential.response(&mut tangential, &input).stiffness;
            }
            let around = Around::new(&state.x, state, self.chains, i);
            (around.weights(touch.u).sum(), [normal, across])
        };
        let viscosity = touch.viscosity * stiffness[0].sqrt();
        Some(Element::contact([touch.i; 3], [weight, 0.0, 0.0], stiffness, [touch.arm, 0.0], viscosity))
    }
}

/// A particle that is looked at, and where what comes of it goes.
struct Job<'a, N: NormalLaw, T: TangentialLaw> {
    meets: &'a Meets<'a>,
    body: &'a Body<N, T>,
    number: usize,
    i: usize,
    acts: &'a mut Vec<Act>,
    sums: &'a mut ChunkSums,
    /// Force (N) on the body, and moment (N m) about its place.
    load: &'a mut [DVec3; 2],
}

impl<N: NormalLaw, T: TangentialLaw> Job<'_, N, T> {
    fn law(&self) -> &Laws<N, T> {
        self.body.law(self.meets.material(self.i))
    }

    /// A contact that has just come to touch.
    fn fresh(&self, ball: bool, reduced_radius: f64, blocks: usize) -> Touch<N, T> {
        Touch {
            i: self.i as u32,
            ball,
            history: History::new(reduced_radius),
            dents: vec![[0.0; CELLS]; blocks],
            per_length: 0.0,
            viscosity: viscous_coefficient(self.meets.damping, self.meets.state.mass[self.i], 1.0),
            reach: self.meets.state.radius[self.i],
            overlap: 0.0,
            curvature: 0.0,
            energy: 0.0,
            u: 0.0,
            arm: 0.0,
        }
    }

    /// Lets a ball act; gives its gap (m), below 0 where they touch.
    fn ball(&mut self, known: &mut Option<Touch<N, T>>) -> f64 {
        let (state, i, body) = (self.meets.state, self.i, self.body);
        let from = state.x.get(i) - body.place;
        let distance = body.surface.distance(from);
        let overlap = state.radius[i] - distance.value;
        if overlap <= 0.0 && known.as_ref().is_none_or(|touch| !touch.history.touching()) {
            return -overlap;
        }
        let reduced = body.surface.reduced_radius(state.radius0[i]);
        let touch = known.get_or_insert_with(|| self.fresh(true, reduced, 0));
        let normal = -distance.outward;
        touch.overlap = overlap.max(0.0);
        touch.arm = state.radius[i] - 0.5 * touch.overlap;
        let at = from + normal * (distance.value + 0.5 * touch.overlap);
        let slide = self.slide(at, state.v.get(i), normal, touch.arm);
        let meeting = self.meeting(touch, normal, slide);
        let law = self.law();
        let (force, given) = contact_response(law, &mut touch.history, &meeting);
        touch.energy = law.normal.elastic_energy(&touch.history.normal, reduced, touch.overlap);
        let area = PI * reduced * touch.overlap;
        self.act(touch, at, normal, &force, given, area, |force| [force.force.into(); 5]);
        -overlap
    }

    /// Velocity of the body's surface relative to that of a particle (m/s), where they meet: `at` from the body's place (m),
    /// the particle's axis moving at `v` (m/s).
    fn slide(&self, at: DVec3, v: DVec3, normal: DVec3, arm: f64) -> DVec3 {
        let slide = self.body.velocity_at(at) - v;
        if T::ACTIVE { slide - (self.meets.state.w.get(self.i) * arm).cross(normal) } else { slide }
    }

    fn meeting(&self, touch: &mut Touch<N, T>, normal: DVec3, velocity: DVec3) -> ContactKinematics {
        let state = self.meets.state;
        let thinner = touch.reach - state.radius[self.i];
        touch.reach = state.radius[self.i];
        ContactKinematics {
            normal: normal.into(),
            overlap: touch.overlap,
            thinner,
            velocity: velocity.into(),
            viscosity: touch.viscosity,
            dt: state.dt,
        }
    }

    /// Books what came out, and hands it on: `spread` gives the force with its moments along the stretch (N).
    #[allow(clippy::too_many_arguments)]
    fn act(
        &mut self,
        touch: &Touch<N, T>,
        at: DVec3,
        normal: DVec3,
        force: &PairForce,
        given: Dissipated,
        area: f64,
        spread: impl FnOnce(&PairForce) -> [DVec3; 5],
    ) {
        self.sums.add(&given.partial());
        if !touch.history.touching() {
            return;
        }
        let moments = spread(force);
        let friction = DVec3::from(force.friction);
        let twist = normal.cross(friction) * touch.arm;
        // What presses along the normals of a surface does not turn it about its own axis.
        let pressed = at.cross(moments[0] - friction);
        self.load[0] -= moments[0];
        self.load[1] -= pressed - self.body.axis * self.body.axis.dot(pressed) + at.cross(friction);
        let least = self.meets.state.radius[self.i].min(self.body.surface.radius());
        let pair = [touch.i, (self.meets.state.len() + self.number) as u32];
        self.sums.deepest.take_in(pair, touch.overlap, least, || area, touch.history.normal_force);
        self.acts.push(Act { i: touch.i, ball: touch.ball, force: moments, twist });
    }

    /// How the stretch of the particle is cut.
    fn cut(&self) -> Stretch {
        let Meets { state, chains, .. } = *self.meets;
        let ends = chains.reach(self.i);
        let length = CELLS as f64 * chains.cell_length(self.i);
        let blocks = self.body.blocks(length, state.radius0[self.i]);
        Stretch { around: Around::new(&state.x, state, chains, self.i), ends, length, blocks }
    }

    /// Block `b` of a stretch.
    fn block(&self, stretch: &Stretch, b: usize, reduced_radius: f64, per_length: f64) -> Block {
        let width = (stretch.ends[1] - stretch.ends[0]) / stretch.blocks as f64;
        let middle = stretch.ends[0] + (b as f64 + 0.5) * width;
        let [p, along, bend] = stretch.around.at(middle);
        let distance = self.body.surface.distance(p - self.body.place);
        let turn = distance.hessian(along);
        let rise = distance.outward.dot(along);
        let second = distance.outward.dot(bend) + along.dot(turn);
        let cells = (stretch.blocks * CELLS) as f64;
        let gap = CellGap {
            reduced_radius,
            stiffness: per_length,
            overlap: self.meets.state.radius[self.i] - distance.value,
            rise,
            bend: second,
            first: -0.5 * width,
            width: width / CELLS as f64,
            length: stretch.length / cells,
        };
        let deepest = (0..CELLS).map(|q| gap.depth(gap.place(q))).fold(f64::NEG_INFINITY, f64::max);
        let curvature = second / along.length_squared();
        Block { middle, gap, outward: distance.outward, turn, curvature, deepest }
    }

    /// Lets a stretch act; gives its gap (m), below 0 where they touch.
    fn stretch(&mut self, known: &mut Option<Touch<N, T>>) -> f64 {
        let body = self.body;
        let stretch = self.cut();
        let reduced = body.surface.section_radius(self.meets.state.radius0[self.i]);
        let per_length = known.as_ref().map_or(0.0, |touch| touch.per_length);
        let blocks: Vec<Block> = (0..stretch.blocks).map(|b| self.block(&stretch, b, reduced, per_length)).collect();
        let deepest = blocks.iter().max_by(|a, b| a.deepest.total_cmp(&b.deepest)).expect("there is a block");
        let (overlap, curvature) = (deepest.deepest, deepest.curvature);
        if overlap <= 0.0 && known.as_ref().is_none_or(|touch| !touch.history.touching()) {
            return -overlap;
        }
        let touch = known.get_or_insert_with(|| self.fresh(false, reduced, stretch.blocks));
        if !touch.history.touching() {
            touch.per_length = self.law().normal.effective_modulus() * self.meets.line.at(reduced, curvature);
            // Side by side the stiffness is constant, elsewhere Hertzian.
            let linear = self.meets.restitution && touch.per_length == self.law().normal.effective_modulus() * LINE;
            let fraction = self.meets.damping * if linear { HERTZIAN } else { 1.0 };
            touch.viscosity = viscous_coefficient(fraction, self.meets.state.mass[self.i], 1.0);
        }
        (touch.overlap, touch.curvature) = (overlap.max(0.0), curvature);
        let sums = self.push(&blocks, touch);
        touch.energy = sums.energy;
        if sums.force > 0.0 {
            touch.u = sums.first / sums.force;
        }
        let p = stretch.around.at(touch.u)[0] - body.place;
        let distance = body.surface.distance(p);
        let normal = -distance.outward;
        let sunk = 0.5 * (self.meets.state.radius[self.i] - distance.value);
        touch.arm = self.meets.state.radius[self.i] - sunk;
        let at = p + normal * touch.arm;
        let v = Around::new(&self.meets.state.v, self.meets.state, self.meets.chains, self.i).at(touch.u)[0];
        let slide = self.slide(at, v, normal, touch.arm);
        // The dashpot takes what the spread force does.
        let opening = if sums.force > 0.0 { sums.opening / sums.force } else { 0.0 };
        let velocity = slide + normal * (opening - slide.dot(normal));
        let meeting = self.meeting(touch, normal, velocity);
        let law = self.law();
        let radius = sums.stiffness / (2.0 * law.normal.effective_modulus());
        let answer = NormalResponse {
            force: sums.force,
            stiffness: sums.stiffness,
            radius,
            inverse_radius: if radius > 0.0 { 1.0 / radius } else { 1.0 },
            plastic_work: sums.plastic_work,
        };
        let (force, given) = press(law, &mut touch.history, &meeting, &answer);
        let area = (2.0 * reduced * touch.overlap).sqrt() * sums.stiffness / touch.per_length;
        let u = touch.u;
        self.act(touch, at, normal, &force, given, area, |force| {
            // All that pushes along the normal is spread as the force of the cells is.
            let friction = DVec3::from(force.friction);
            let share = (friction - DVec3::from(force.force)).dot(normal) / sums.force;
            std::array::from_fn(|k| sums.moments[k] * share + friction * u.powi(k as i32))
        });
        -overlap
    }

    /// The normal force of all blocks, without damping.
    fn push(&self, blocks: &[Block], touch: &mut Touch<N, T>) -> Sums {
        let Meets { state, chains, .. } = *self.meets;
        let velocity = Around::new(&state.v, state, chains, self.i);
        let pressure = self.law().normal.limiting_pressure();
        let mut sums = Sums::default();
        for (block, dents) in blocks.iter().zip(&mut touch.dents) {
            let gap = CellGap { stiffness: touch.per_length, ..block.gap };
            let cells = respond_cells(&gap, pressure, &[1.0; CELLS], dents);
            sums.plastic_work += cells.plastic_work;
            let [m0, m1, m2] = cells.moments;
            if m0 == 0.0 {
                continue;
            }
            let (n, g) = (block.outward, block.turn);
            let [a, b, c] = [n * m0 + g * m1, n * m1 + g * m2, n * m2];
            let spread = shifted(&[a, b, c, DVec3::ZERO, DVec3::ZERO], block.middle);
            sums.moments.iter_mut().zip(spread).for_each(|(sum, part)| *sum += part);
            sums.force += m0;
            sums.first += block.middle * m0 + m1;
            sums.stiffness += cells.stiffness;
            sums.energy += cells.energy;
            let [v, along, bend] = velocity.at(block.middle);
            // No spin about its axis moves a surface along its normal.
            sums.opening += a.dot(v - self.body.velocity) + b.dot(along) + 0.5 * c.dot(bend);
        }
        sums
    }
}
