//! One contact at one step: where two bodies meet, and how.

use super::curve::{Around, Chains, Foot, Other, Weights};
use super::{Contact, Kind};
use crate::base::triple::Triple;
use crate::engine::pair::{Laws, Meeting, meet, press};
use crate::engine::state::{Deepest, Partial, State};
use crate::law::contact::constants::reduced_mass;
use crate::law::contact::line::{LineResponse, LineStiffness, Stretch};
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::damping::viscous_coefficient;
use crate::law::tangential::TangentialLaw;
use glam::DVec3;
use std::f64::consts::PI;

/// sin² of the angle between two wires below which the gap is expanded around the particle, and above which around the
/// narrowest place [-]: 2.5° and 8°. Below, the gap of straight wires is a parabola to 1e-4 of the radius.
const CROSSING: [f64; 2] = [0.002, 0.02];
/// Bonds along the other wire per bond along this one, below which the end of the other wire cuts nothing off [-]: the
/// two cross.
const STEEP: f64 = 1e-3;

/// Bonds from the end of a piece of wire within which a place is at that end [-].
const EDGE: f64 = 0.05;

/// What contacts need to know.
#[derive(Clone, Copy)]
pub struct Meets<'a, N: NormalLaw, T: TangentialLaw> {
    pub laws: &'a Laws<N, T>,
    pub line: &'a LineStiffness,
    pub state: &'a State,
    pub chains: &'a Chains,
    /// See [`crate::engine::contacts::closing`].
    pub closing: f64,
}

/// Half the square of the distance between a point of the stretch and the other curve, along the stretch.
struct Gap {
    /// From the foot to the point [m].
    away: DVec3,
    /// First and second derivative of ½e² by the position along the bond [m²].
    first: f64,
    second: f64,
    /// Bonds that the foot moves per bond of the stretch [-].
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

/// How a stretch lies against the other wire.
struct Lie {
    stretch: Stretch,
    /// The wire around the particle.
    around: Around,
    /// Where the gap was expanded, in bonds from the particle, and the deepest place from there [m].
    u: f64,
    deepest: f64,
    /// Length of a bond there [m].
    bond: f64,
    /// Bonds that the foot moves per bond of the stretch [-].
    rate: f64,
    /// Sum of the radii [m].
    touching: f64,
    /// Whether the deepest place is at the end of one of the two pieces.
    at_end: bool,
}

/// Whether going forward along the stretch leads over the other wire, for a stretch with the tangent `along` [m] that
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

impl<N: NormalLaw, T: TangentialLaw> Meets<'_, N, T> {
    /// Reduced mass of what meets [kg].
    pub fn mass(&self, c: &Contact<N, T>) -> f64 {
        reduced_mass(self.state.mass[c.i as usize], c.place.between(&self.state.mass))
    }

    fn other(&self, c: &Contact<N, T>) -> Other<'_> {
        Other { chains: self.chains, state: self.state, i: c.i as usize, own: self.chains.one_wire(c.i, c.place.j) }
    }

    /// Overlap at the deepest place, counted in full [m]; negative where the bodies are apart.
    pub fn overlap(&self, c: &mut Contact<N, T>) -> f64 {
        match c.kind {
            Kind::Stretch => self.lie(c).map_or(0.0, |lie| lie.stretch.overlap + c.history.offset),
            _ => {
                let line = self.between(c);
                line.touching - line.distance
            }
        }
    }

    /// How a stretch lies; `None` where nothing of it lies beside the other wire.
    #[inline(always)]
    fn lie(&self, c: &mut Contact<N, T>) -> Option<Lie> {
        let i = c.i as usize;
        let other = self.other(c);
        let around = Around::new(self.state, self.chains, i);
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
            None => {
                let crossing = gap.second / at[1].length_squared();
                let t = ((crossing - CROSSING[0]) / (CROSSING[1] - CROSSING[0])).clamp(0.0, 1.0);
                let towards = || (-t * t * (3.0 - 2.0 * t) * gap.first / gap.second).clamp(ends[0], ends[1]);
                (t > 0.0).then(towards)
            }
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
        let (distance, bond) = (gap.away.length(), at[1].length());
        let rise = gap.first / distance;
        let slope = -rise / bond;
        let curvature = (gap.second - rise * rise) / (distance * bond * bond);
        let touching = self.state.radius[i] + c.place.between(&self.state.radius);
        let overlap = touching - c.history.offset - distance;
        let [mut from, mut to] = ends.map(|end| (end - u) * bond);
        if !foot.at_end && gap.rate.abs() > STEEP {
            // What lies beyond the end of the other wire does not count.
            let [one, two] = other.left(&c.place).map(|left| left * bond / gap.rate);
            (from, to) = (from.max(one.min(two)), to.min(one.max(two)));
        }
        if from > to {
            return None;
        }
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
            overlap: depth(deepest),
            slope: slope - curvature * deepest,
            curvature,
            ends: [from - deepest, to - deepest],
        };
        Some(Lie { stretch, around, u, deepest, bond, rate: gap.rate, touching, at_end })
    }

    /// The line between a ball, or an end, and the other body.
    #[inline(always)]
    fn between(&self, c: &mut Contact<N, T>) -> Line {
        let (i, x) = (c.i as usize, &self.state.x);
        let (point, touching) = if c.kind == Kind::Ends {
            (x.get(c.place.j as usize), self.state.parted[i])
        } else {
            let foot = self.other(c).foot(x.get(i), &mut c.place);
            (foot.point, self.state.radius[i] + c.place.between(&self.state.radius))
        };
        c.near = Weights { nodes: [c.i; 5], shares: [1.0, 0.0, 0.0, 0.0, 0.0] };
        c.far = c.place.weights(self.state);
        let d = point - x.get(i);
        let distance = d.length();
        Line { normal: d / distance, distance, touching }
    }

    /// Kinematics and response of one contact.
    #[inline(always)]
    pub fn contact(&self, c: &mut Contact<N, T>, deepest: &mut Deepest) -> Partial {
        match c.kind {
            Kind::Stretch => self.stretch(c, deepest),
            _ => self.ball(c, deepest),
        }
    }

    /// Books that the bodies are apart by `gap` [m], and tells whether there is nothing more to do.
    #[inline(always)]
    fn apart(&self, c: &mut Contact<N, T>, gap: f64) -> bool {
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

    #[inline(always)]
    fn stretch(&self, c: &mut Contact<N, T>, deepest: &mut Deepest) -> Partial {
        let lie = self.lie(c);
        if c.end_to_end {
            match &lie {
                Some(lie) if !lie.at_end => {
                    c.end_to_end = false;
                    c.history.offset = lie.stretch.overlap.max(0.0);
                }
                _ => {}
            }
            // The two ends have a contact of their own.
            return Partial::default();
        }
        let Some(mut lie) = lie else {
            // Beyond the end of the other wire; what was touching there has let go.
            if !c.history.touching() {
                return Partial::default();
            }
            let meeting = Meeting { dt: self.state.dt, ..Meeting::default() };
            let released = c.energy;
            c.energy = 0.0;
            let (_, given) = press(self.laws, &mut c.history, &meeting, &NormalResponse::default());
            return Partial { released, ..given.partial() };
        };
        if self.apart(c, -lie.stretch.overlap) {
            return Partial::default();
        }
        let modulus = self.laws.normal.effective_modulus();
        lie.stretch.stiffness = modulus * self.line.at(c.history.reduced_radius, lie.stretch.curvature);
        (c.curvature, c.length) = (lie.stretch.curvature, lie.stretch.ends[1] - lie.stretch.ends[0]);
        let answer = if lie.stretch.overlap > 0.0 {
            self.laws.normal.line_response(&mut c.history.normal, &lie.stretch)
        } else {
            LineResponse::default()
        };
        if answer.force == 0.0 && !c.history.touching() {
            c.overlap = lie.stretch.overlap.max(0.0);
            c.energy = 0.0;
            return Partial { plastic: answer.plastic_work, ..Partial::default() };
        }
        c.energy = answer.energy;
        let u = lie.u + (lie.deepest + answer.centre) / lie.bond;
        let mut far = c.place;
        if far.joined {
            far.t += (u - lie.u) * lie.rate;
            self.other(c).settle(&mut far);
        }
        c.near = lie.around.weights(u);
        c.far = far.weights(self.state);
        c.place = far;
        let d = c.far.mean(|p| self.state.x.get(p)) - lie.around.at(u)[0];
        let distance = d.length();
        let radius = answer.stiffness / (2.0 * modulus);
        let normal = NormalResponse {
            force: answer.force,
            stiffness: answer.stiffness,
            radius,
            inverse_radius: 1.0 / radius,
            plastic_work: answer.plastic_work,
        };
        let line = Line { normal: d / distance, distance, touching: lie.touching };
        let overlap = lie.stretch.overlap.max(0.0);
        self.act(c, &line, overlap, answer.area, deepest, Some(&normal))
    }

    #[inline(always)]
    fn ball(&self, c: &mut Contact<N, T>, deepest: &mut Deepest) -> Partial {
        let line = self.between(c);
        let overlap = line.touching - c.history.offset - line.distance;
        if self.apart(c, -overlap) {
            return Partial::default();
        }
        let overlap = overlap.max(0.0);
        let partial = self.act(c, &line, overlap, PI * c.history.reduced_radius * overlap, deepest, None);
        c.energy = self.laws.normal.elastic_energy(&c.history.normal, c.history.reduced_radius, overlap);
        partial
    }

    /// Lets two surfaces act on each other; the normal law is asked here unless `answer` has its answer.
    #[inline(always)]
    fn act(
        &self,
        c: &mut Contact<N, T>,
        line: &Line,
        overlap: f64,
        area: f64,
        deepest: &mut Deepest,
        answer: Option<&NormalResponse>,
    ) -> Partial {
        let state = self.state;
        let i = c.i as usize;
        let reach = line.touching - c.history.offset;
        // The arms meet where the surfaces do, so that they add up to the distance.
        let arm = state.radius[i] - 0.5 * (line.touching - line.distance);
        c.arm = [arm, line.distance - arm];
        let mut velocity = c.far.mean(|p| state.v.get(p)) - c.near.mean(|p| state.v.get(p));
        if T::ACTIVE {
            let spin = c.place.linear().into_iter().fold(DVec3::ZERO, |sum, (p, share)| sum + state.w.get(p) * share);
            velocity -= (state.w.get(i) * c.arm[0] + spin * c.arm[1]).cross(line.normal);
        }
        let viscosity = viscous_coefficient(self.laws.damping, self.mass(c), 1.0);
        let thinner = c.reach - reach;
        let normal = Triple::from(line.normal);
        let meeting = Meeting { normal, overlap, thinner, velocity: velocity.into(), viscosity, dt: state.dt };
        let (action, given) = match answer {
            Some(answer) => press(self.laws, &mut c.history, &meeting, answer),
            None => meet(self.laws, &mut c.history, &meeting),
        };
        (c.overlap, c.reach) = (overlap, reach);
        c.twist = normal.cross(action.friction);
        c.action = action;
        let least = state.radius[i].min(line.touching - state.radius[i]);
        deepest.meet([c.i, c.place.j], overlap, least, || area, c.history.normal_force);
        given.partial()
    }
}
