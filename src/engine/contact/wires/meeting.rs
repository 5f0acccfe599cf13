//! One contact at one step: where two bodies meet, and how.

use super::beside::Beside;
use super::chains::Chains;
use super::curve::{Arc, Around, Foot, Other, blend, shifted};
use super::record::{Contact, Kind, Mode, Touch};
use super::spread::{FarSum, NearSum};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use crate::engine::contact::law_table::LawTable;
use crate::engine::contact::pair::{ContactKinematics, Laws, contact_response, press};
use crate::engine::state::{ChunkSums, Deepest, State};
use crate::law::contact::line::{CELLS, LineResponse, LineStiffness, Stretch, respond, respond_cells};
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::tangential::TangentialLaw;
use glam::DVec3;
use std::f64::consts::PI;

/// Bonds along the other wire per bond along this one, below which the end of the other wire cuts nothing off (-): the
/// two cross.
const STEEP: f64 = 1e-3;

/// Bonds from the end of a piece of wire within which a place is at that end (-).
const EDGE: f64 = 0.05;

/// What one contact does to its two sides.
#[derive(Clone, Copy, Default)]
pub struct Sides {
    pub near: NearSum,
    pub far: FarSum,
}

/// What contacts need to know.
#[derive(Clone, Copy)]
pub struct Meets<'a, N: NormalLaw, T: TangentialLaw> {
    pub laws: &'a LawTable<N, T>,
    pub line: &'a LineStiffness,
    pub state: &'a State,
    pub chains: &'a Chains,
    /// See [`crate::engine::contacts::closing`].
    pub closing: f64,
}

/// Half the square of the distance between a point of the stretch and the other curve, along the stretch.
struct Gap {
    /// From the foot to the point (m).
    away: DVec3,
    /// First and second derivative of ½e² by the position along the bond (m²).
    first: f64,
    second: f64,
    /// Bonds that the foot moves per bond of the stretch (-).
    rate: f64,
}

impl Gap {
    #[inline(always)]
    fn new([point, along, bend]: [DVec3; 3], foot: &Foot) -> Self {
        let away = point - foot.point;
        let (mut rate, mut second) = (0.0, away.dot(bend) + along.length_squared());
        if !foot.at_end {
            let cross = along.dot(foot.along);
            rate = cross / (foot.along.length_squared() - away.dot(foot.bend));
            second -= cross * rate;
        }
        Self { away, first: away.dot(along), second, rate }
    }
}

/// Where a stretch is looked at.
struct Look {
    /// The wire around the particle.
    around: Around,
    /// Where the gap is expanded, in bonds from the particle; point and derivatives there.
    u: f64,
    at: [DVec3; 3],
    foot: Foot,
    gap: Gap,
    /// What counts of the stretch, in bonds from there.
    from: f64,
    to: f64,
}

/// How a stretch that crosses another wire lies against it.
struct Lie {
    stretch: Stretch,
    /// The wire around the particle.
    around: Around,
    /// Where the gap was expanded, in bonds from the particle, and the deepest place from there (m).
    u: f64,
    deepest: f64,
    /// Length of a bond there (m).
    bond: f64,
    /// Bonds that the foot moves per bond of the stretch (-).
    rate: f64,
    /// Sum of the radii (m).
    touching: f64,
    /// Whether the deepest place is at the end of one of the two pieces.
    at_end: bool,
}

/// Whether going forward along the stretch leads over the other wire, for a stretch with the tangent `along` (m) that
/// runs beside the other wire's end and whose foot lies beyond it; `None` for any other.
#[inline(always)]
fn along_the_end(foot: &Foot, along: DVec3) -> Option<bool> {
    let cosine = along.dot(foot.along);
    let beside = cosine * cosine > 0.25 * along.length_squared() * foot.along.length_squared();
    (foot.at_end && beside).then_some((cosine > 0.0) == foot.before)
}

/// Where the force acts, and the unit normal from the first body to the second.
struct Line {
    normal: DVec3,
    distance: f64,
    touching: f64,
}

impl<'a, N: NormalLaw, T: TangentialLaw> Meets<'a, N, T> {
    /// Finds the foot of a stretch, and tells whether it crosses the other wire so steeply that its cells would not
    /// resolve the patch in which they touch; see [`super::RESOLVED`].
    pub fn crosses(&self, c: &mut Contact<N, T>, resolved: f64) -> bool {
        let at = Around::new(&self.state.x, self.state, self.chains, c.i as usize).at(0.0);
        let foot = self.other(c).foot(at[0], &mut c.place);
        let gap = Gap::new(at, &foot);
        let touching = self.state.radius[c.i as usize] + c.place.between(&self.state.radius);
        let sine = gap.second.max(0.0).sqrt() / at[1].length();
        sine * CELLS as f64 * c.cell_length > resolved * touching
    }

    fn other(&self, c: &Contact<N, T>) -> Other<'_> {
        Other { chains: self.chains, state: self.state, i: c.i as usize, own: self.chains.one_wire(c.i, c.place.j) }
    }

    /// Overlap at the deepest place, counted in full (m); negative where the bodies are apart.
    pub fn overlap(&self, c: &mut Contact<N, T>) -> f64 {
        match c.kind {
            Kind::Stretch if c.mode == Mode::Line => self.beside(c).map_or(0.0, |(beside, shares, _)| {
                let gap = beside.gap(&beside.expand(0), 0.0, c.history.reduced_radius);
                Beside::deepest(&gap, &shares)
            }),
            Kind::Stretch => self.lie(c).map_or(0.0, |lie| lie.stretch.overlap + c.history.offset),
            _ => {
                let line = self.between(c);
                line.touching - line.distance
            }
        }
    }

    /// Where a stretch that crosses the other wire, or lies near an end, is looked at; `None` where nothing of it lies
    /// beside the other wire.
    fn look(&self, c: &mut Contact<N, T>) -> Option<Look> {
        let i = c.i as usize;
        let other = self.other(c);
        let around = Around::new(&self.state.x, self.state, self.chains, i);
        let ends = self.chains.reach(i);
        let (mut u, mut at) = (0.0, around.at(0.0));
        let mut foot = other.foot(at[0], &mut c.place);
        let mut gap = Gap::new(at, &foot);
        let moved = match along_the_end(&foot, at[1]) {
            // Side by side beyond the end of the other wire: only what lies before the end counts.
            Some(forward) => {
                let end = -gap.first / gap.second;
                let last = if forward { ends[1] } else { ends[0] };
                if (last > end) != forward {
                    return None;
                }
                Some(0.5 * (end.clamp(ends[0], ends[1]) + last))
            }
            // Where wires cross, what counts is near their narrowest place.
            None if c.mode == Mode::Point => Some((-gap.first / gap.second).clamp(ends[0], ends[1])),
            None => None,
        };
        if let Some(to) = moved {
            u = to;
            at = around.at(u);
            if c.place.joined {
                c.place.t += u * gap.rate;
                other.settle(&mut c.place);
            }
            foot = other.foot(at[0], &mut c.place);
            gap = Gap::new(at, &foot);
        }
        let [mut from, mut to] = ends.map(|end| end - u);
        if !foot.at_end && gap.rate.abs() > STEEP {
            // What lies beyond the end of the other wire does not count.
            let [one, two] = other.left(&c.place).map(|left| left / gap.rate);
            (from, to) = (from.max(one.min(two)), to.min(one.max(two)));
        }
        (from <= to).then_some(Look { around, u, at, foot, gap, from, to })
    }

    /// How a stretch that crosses the other wire lies.
    fn lie(&self, c: &mut Contact<N, T>) -> Option<Lie> {
        let i = c.i as usize;
        let Look { around, u, at, foot, gap, from, to } = self.look(c)?;
        let (other, ends) = (self.other(c), self.chains.reach(i));
        let (distance, bond) = (gap.away.length(), at[1].length());
        let rise = gap.first / distance;
        let slope = -rise / bond;
        let curvature = (gap.second - rise * rise) / (distance * bond * bond);
        let touching = self.state.radius[i] + c.place.between(&self.state.radius);
        let reach = touching - c.history.offset;
        let overlap = reach - distance;
        let (from, to) = (from * bond, to * bond);
        let depth = |x: f64| overlap + x * (slope - 0.5 * curvature * x);
        let deepest = if curvature > 0.0 {
            (slope / curvature).clamp(from, to)
        } else if depth(from) > depth(to) {
            from
        } else {
            to
        };
        let reached = u + deepest / bond;
        let near_end = |[low, high]: [f64; 2]| low > -EDGE || high < EDGE;
        let at_end = foot.at_end || near_end([ends[0] - reached, ends[1] - reached]) || near_end(other.left(&c.place));
        let stretch = Stretch {
            reduced_radius: c.history.reduced_radius,
            stiffness: 0.0,
            // No two centrelines are nearer than 0, whatever the parabola says.
            overlap: depth(deepest).min(reach),
            slope: slope - curvature * deepest,
            curvature,
            ends: [from - deepest, to - deepest],
        };
        Some(Lie { stretch, around, u, deepest, bond, rate: gap.rate, touching, at_end })
    }

    /// A stretch beside the other wire near an end of one of them: what the lanes of a batch take, one by one; with the
    /// shares of the cells that count.
    fn beside(&self, c: &mut Contact<N, T>) -> Option<(Beside<f64>, [f64; CELLS], Look)> {
        let (state, i) = (self.state, c.i as usize);
        let look = self.look(c)?;
        let ends = self.chains.reach(i);
        let width = (ends[1] - ends[0]) / CELLS as f64;
        let first = ends[0] - look.u;
        let share = |q: usize| {
            let begin = first + q as f64 * width;
            (((begin + width).min(look.to) - begin.max(look.from)) / width).clamp(0.0, 1.0)
        };
        let velocity = Around::new(&state.v, state, self.chains, i).at(look.u);
        let far = |vectors: &Vectors| match c.place.joined {
            true => Arc::new(vectors, state, c.place.j as usize).coefficients,
            false => [vectors.get(c.place.j as usize), DVec3::ZERO, DVec3::ZERO, DVec3::ZERO],
        };
        let j = c.place.j as usize;
        let next = j + usize::from(c.place.joined);
        let triples = |v: [DVec3; 3]| v.map(Triple::from);
        let beside = Beside {
            near: triples(look.at),
            near_velocity: triples(velocity),
            far: far(&state.x).map(Triple::from),
            far_velocity: far(&state.v).map(Triple::from),
            spin: [i, j, next].map(|p| state.w.get(p).into()),
            radius: [i, j, next].map(|p| state.radius[p]),
            t: if c.place.joined { c.place.t } else { 0.0 },
            moves: if look.foot.at_end || !c.place.joined { 0.0 } else { 1.0 },
            first,
            width,
            length: c.cell_length,
            per_length: c.per_length,
            reach: c.reach,
            viscosity: c.viscosity,
        };
        Some((beside, std::array::from_fn(share), look))
    }

    /// Takes a stretch beside the other wire through the laws by itself.
    fn line(&self, c: &mut Contact<N, T>, act: &mut Sides, deepest: &mut Deepest) -> ChunkSums {
        let Some((mut beside, shares, look)) = self.beside(c) else { return self.let_go(c) };
        let at = beside.expand(0);
        let reach = at.touching - c.history.offset;
        // No two centrelines are nearer than 0, whatever the parabola says.
        let overlap = Beside::deepest(&beside.gap(&at, c.history.offset, c.history.reduced_radius), &shares).min(reach);
        let bond = look.at[1].length();
        if c.end_to_end {
            return self.passing(c, overlap, look.foot.at_end || self.near_end(c, look.u));
        }
        if overlap <= 0.0 && !c.history.touching() {
            return self.finish(c, &Touch::Apart { t: at.t, gap: -overlap }, look.u, act, deepest);
        }
        if !c.history.touching() {
            let curvature = at.distance[2] / (bond * bond);
            beside.per_length = self.per_length(self.law(c), c.history.reduced_radius, curvature);
        }
        let (mut dents, mut history) = (c.dents, c.history);
        // What slides beyond an end takes with it what it had stored. What slides in is left to the ledger: no work was done
        // for it.
        let mut released = 0.0;
        let law = self.law(c);
        if c.history.touching() && shares != c.shares {
            let gap = beside.gap(&at, c.history.offset, c.history.reduced_radius);
            let stored = |share: &[f64; CELLS]| {
                respond_cells(&gap, law.normal.limiting_pressure(), share, &mut dents.clone()).energy
            };
            released = (stored(&c.shares) - stored(&shares)).max(0.0);
        }
        c.shares = shares;
        let answer = beside.respond(law, &at, &shares, &mut dents, &mut history, self.state.dt);
        let touch = Touch::Here {
            answer,
            t: at.t,
            touching: at.touching,
            per_length: beside.per_length,
            curvature: at.distance[2] / (bond * bond),
        };
        (c.dents, c.history) = (dents, history);
        let partial = self.finish(c, &touch, look.u, act, deepest);
        ChunkSums { released, ..partial }
    }

    /// Law of a contact.
    #[inline(always)]
    fn law(&self, c: &Contact<N, T>) -> &'a Laws<N, T> {
        self.laws.between(c.i as usize, c.place.j as usize)
    }

    /// Stiffness per length (Pa) under `law` where the gap has this curvature (1/m).
    #[inline(always)]
    pub fn per_length(&self, law: &Laws<N, T>, reduced_radius: f64, curvature: f64) -> f64 {
        law.normal.effective_modulus() * self.line.at(reduced_radius, curvature)
    }

    /// Books what came out for a stretch beside another wire, expanded at `u` bonds from its particle.
    pub fn finish(
        &self,
        c: &mut Contact<N, T>,
        touch: &Touch,
        u: f64,
        act: &mut Sides,
        deepest: &mut Deepest,
    ) -> ChunkSums {
        match *touch {
            Touch::Apart { t, gap } => {
                c.place.t = t;
                self.apart(c, gap);
                ChunkSums::default()
            }
            Touch::Here { ref answer, t, touching, per_length, curvature } => {
                (c.place.t, c.per_length) = (t, per_length);
                (c.overlap, c.reach, c.energy) = (answer.deepest.max(0.0), answer.reach, answer.energy);
                (c.curvature, c.length) = (curvature, CELLS as f64 * c.cell_length);
                if answer.force > 0.0 {
                    c.u = u + answer.mean;
                    c.arm = answer.arms;
                    let [a, b, c2] = answer.act.near.map(DVec3::from);
                    let moments = [a, b, c2, DVec3::ZERO, DVec3::ZERO];
                    let near = if u == 0.0 { moments } else { shifted(&moments, u) };
                    let twist = answer.act.twist.map(DVec3::from);
                    *act = Sides {
                        near: NearSum { force: near, moment: twist[0], acts: true },
                        far: FarSum {
                            force: answer.act.far.map(DVec3::from),
                            moment: [twist[1], twist[2]],
                            bond: c.place.j,
                            acts: true,
                        },
                    };
                    let least = self.state.radius[c.i as usize].min(touching - self.state.radius[c.i as usize]);
                    let area = || {
                        let width = (2.0 * c.history.reduced_radius * c.overlap).sqrt();
                        width * answer.stiffness / c.per_length
                    };
                    deepest.take_in([c.i, c.place.j], c.overlap, least, area, answer.force);
                }
                answer.given.partial()
            }
        }
    }

    /// A place on either wire that lies near an end of a piece.
    fn near_end(&self, c: &Contact<N, T>, u: f64) -> bool {
        let near = |[low, high]: [f64; 2]| low > -EDGE || high < EDGE;
        near(self.chains.reach(c.i as usize).map(|end| end - u)) || near(self.other(c).left(&c.place))
    }

    /// Two ends of one wire that broke, of which one has not yet passed the other: they have a contact of their own.
    fn passing(&self, c: &mut Contact<N, T>, overlap: f64, at_end: bool) -> ChunkSums {
        if !at_end {
            c.end_to_end = false;
            c.history.offset = overlap.max(0.0);
        }
        ChunkSums::default()
    }

    /// Beyond the end of the other wire: what was touching there has let go.
    fn let_go(&self, c: &mut Contact<N, T>) -> ChunkSums {
        if c.end_to_end || !c.history.touching() {
            return ChunkSums::default();
        }
        let meeting = ContactKinematics { dt: self.state.dt, ..ContactKinematics::default() };
        let released = c.energy;
        c.energy = 0.0;
        let (_, given) = press(self.law(c), &mut c.history, &meeting, &NormalResponse::default());
        ChunkSums { released, ..given.partial() }
    }

    /// The line between a ball, or an end, and the other body.
    fn between(&self, c: &mut Contact<N, T>) -> Line {
        let (i, x) = (c.i as usize, &self.state.x);
        let (point, touching) = if c.kind == Kind::Ends {
            (x.get(c.place.j as usize), self.state.length_at_break[i])
        } else {
            let foot = self.other(c).foot(x.get(i), &mut c.place);
            (foot.point, self.state.radius[i] + c.place.between(&self.state.radius))
        };
        c.u = 0.0;
        let d = point - x.get(i);
        let distance = d.length();
        Line { normal: d / distance, distance, touching }
    }

    /// Kinematics and response of one contact.
    #[inline(always)]
    pub fn contact(&self, c: &mut Contact<N, T>, act: &mut Sides, deepest: &mut Deepest) -> ChunkSums {
        match (c.kind, c.mode) {
            (Kind::Stretch, Mode::Line) => self.line(c, act, deepest),
            (Kind::Stretch, Mode::Point) => self.crossing(c, act, deepest),
            _ => self.ball(c, act, deepest),
        }
    }

    /// Books that the bodies are apart by `gap` (m), and tells whether there is nothing more to do.
    #[inline(always)]
    pub fn apart(&self, c: &mut Contact<N, T>, gap: f64) -> bool {
        if gap < 0.0 {
            return false;
        }
        c.history.offset = c.history.offset.min((c.history.offset - gap).max(0.0));
        if c.history.touching() {
            return false;
        }
        if c.history.offset == 0.0 {
            c.quiet_until = self.state.travel + gap / self.closing;
        }
        true
    }

    /// A stretch that crosses the other wire.
    #[inline(always)]
    fn crossing(&self, c: &mut Contact<N, T>, act: &mut Sides, deepest: &mut Deepest) -> ChunkSums {
        let Some(mut lie) = self.lie(c) else { return self.let_go(c) };
        if c.end_to_end {
            return self.passing(c, lie.stretch.overlap, lie.at_end);
        }
        if self.apart(c, -lie.stretch.overlap) {
            return ChunkSums::default();
        }
        if !c.history.touching() {
            c.per_length = self.per_length(self.law(c), c.history.reduced_radius, lie.stretch.curvature);
        }
        lie.stretch.stiffness = c.per_length;
        (c.curvature, c.length) = (lie.stretch.curvature, lie.stretch.ends[1] - lie.stretch.ends[0]);
        let answer = if lie.stretch.overlap > 0.0 {
            respond(&lie.stretch, self.law(c).normal.limiting_pressure(), &mut c.dents[0])
        } else {
            LineResponse::default()
        };
        if answer.force == 0.0 && !c.history.touching() {
            c.overlap = lie.stretch.overlap.max(0.0);
            c.energy = 0.0;
            return ChunkSums { plastic: answer.plastic_work, ..ChunkSums::default() };
        }
        c.energy = answer.energy;
        let u = lie.u + (lie.deepest + answer.centre) / lie.bond;
        let mut far = c.place;
        if far.joined {
            far.t += (u - lie.u) * lie.rate;
            self.other(c).settle(&mut far);
        }
        (c.u, c.place) = (u, far);
        let d = far.weights(self.state).mean(|p| self.state.x.get(p)) - lie.around.at(u)[0];
        let distance = d.length();
        let radius = answer.stiffness / (2.0 * self.law(c).normal.effective_modulus());
        let normal = NormalResponse {
            force: answer.force,
            stiffness: answer.stiffness,
            radius,
            inverse_radius: 1.0 / radius,
            plastic_work: answer.plastic_work,
        };
        let line = Line { normal: d / distance, distance, touching: lie.touching };
        let overlap = lie.stretch.overlap.max(0.0);
        self.act(c, &line, overlap, answer.area, Some(&normal), act, deepest)
    }

    #[inline(always)]
    fn ball(&self, c: &mut Contact<N, T>, act: &mut Sides, deepest: &mut Deepest) -> ChunkSums {
        let line = self.between(c);
        let overlap = line.touching - c.history.offset - line.distance;
        if self.apart(c, -overlap) {
            return ChunkSums::default();
        }
        let overlap = overlap.max(0.0);
        let partial = self.act(c, &line, overlap, PI * c.history.reduced_radius * overlap, None, act, deepest);
        c.energy = self.law(c).normal.elastic_energy(&c.history.normal, c.history.reduced_radius, overlap);
        partial
    }

    /// Lets two surfaces act on each other at `c.u` and `c.place`; the normal law is asked here unless `answer` has its answer.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    fn act(
        &self,
        c: &mut Contact<N, T>,
        line: &Line,
        overlap: f64,
        area: f64,
        answer: Option<&NormalResponse>,
        act: &mut Sides,
        deepest: &mut Deepest,
    ) -> ChunkSums {
        let state = self.state;
        let i = c.i as usize;
        let reach = line.touching - c.history.offset;
        // The arms meet where the surfaces do, so that they add up to the distance.
        let arm = state.radius[i] - 0.5 * (line.touching - line.distance);
        c.arm = [arm, line.distance - arm];
        let near = Around::new(&state.v, state, self.chains, i).at(c.u)[0];
        let mut velocity = c.place.weights(state).mean(|p| state.v.get(p)) - near;
        if T::ACTIVE {
            let spin = c.place.linear().into_iter().fold(DVec3::ZERO, |sum, (p, share)| sum + state.w.get(p) * share);
            velocity -= (state.w.get(i) * c.arm[0] + spin * c.arm[1]).cross(line.normal);
        }
        let thinner = c.reach - reach;
        let normal = Triple::from(line.normal);
        let viscosity = c.viscosity;
        let meeting =
            ContactKinematics { normal, overlap, thinner, velocity: velocity.into(), viscosity, dt: state.dt };
        let (action, given) = match answer {
            Some(answer) => press(self.law(c), &mut c.history, &meeting, answer),
            None => contact_response(self.law(c), &mut c.history, &meeting),
        };
        (c.overlap, c.reach) = (overlap, reach);
        if c.history.touching() {
            let (force, twist) = (DVec3::from(action.force), DVec3::from(normal.cross(action.friction)));
            let (t, [(_, one), (_, two)]) = (c.place.t, c.place.linear());
            let powers = |u: f64| [1.0, u, u * u, u * u * u];
            let [a, b, c2, d] = powers(c.u).map(|power| force * power);
            *act = Sides {
                near: NearSum { force: [a, b, c2, d, d * c.u], moment: twist * c.arm[0], acts: true },
                far: FarSum {
                    force: if c.place.joined { [1.0, t, t * t, blend(t)[0]] } else { [1.0, 0.0, 0.0, 0.0] }
                        .map(|power| force * -power),
                    moment: [twist * (c.arm[1] * one), twist * (c.arm[1] * two)],
                    bond: c.place.j,
                    acts: true,
                },
            };
        }
        let least = state.radius[i].min(line.touching - state.radius[i]);
        deepest.take_in([c.i, c.place.j], overlap, least, || area, c.history.normal_force);
        given.partial()
    }
}
