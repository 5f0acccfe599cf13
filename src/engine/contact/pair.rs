//! A touching pair, or several at once: normal law, friction, damping, thinning. Shared by spheres and smooth wires.

use crate::base::lanes::Real;
use crate::base::triple::Triple;
use crate::engine::state::ChunkSums;
use crate::engine::view::Touch;
use crate::law::contact::{NormalLaw, NormalResponse};
use crate::law::tangential::{TangentialInput, TangentialLaw};
use glam::DVec3;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// The laws of a run.
#[derive(Debug, Clone, Copy)]
pub struct Laws<N, T> {
    /// Normal law.
    pub normal: N,
    /// Tangential law.
    pub tangential: T,
    /// Viscous damping, fraction of critical (-).
    pub damping: f64,
}

/// Where and how two surfaces meet at this step.
#[derive(Debug, Clone, Copy, Default)]
pub struct ContactKinematics<R = f64> {
    /// Unit normal from the first body to the second.
    pub normal: Triple<R>,
    /// Overlap δ (m); 0 where the surfaces are apart.
    pub overlap: R,
    /// By how much the sum of the radii has shrunk in the last step (m).
    pub thinner: R,
    /// Velocity of the second surface relative to the first at the contact point (m/s).
    pub velocity: Triple<R>,
    /// 2ξ√m* with the damping fraction ξ and the reduced mass m* (√kg).
    pub viscosity: R,
    /// Step (s).
    pub dt: R,
}

/// What a contact remembers. All of it but the radius is 0 where nothing touched yet, unless the overlap does not count.
pub struct History<N: NormalLaw, T: TangentialLaw, R: Real = f64> {
    /// Reduced radius R* (m), undeformed.
    pub reduced_radius: R,
    /// Overlap that does not count (m): two parts of a wire that a bond held until it broke may overlap. Negative where
    /// they meet before their surfaces do; 0 for everything else.
    pub offset: R,
    /// Normal law's state.
    pub normal: N::State<R>,
    /// Tangential law's state.
    pub tangential: T::State<R>,
    /// Elastic normal force at the last step (N).
    pub normal_force: R,
    /// Force of the dashpot at the last step (N).
    pub viscous: R,
}

impl<N: NormalLaw, T: TangentialLaw, R: Real> Clone for History<N, T, R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<N: NormalLaw, T: TangentialLaw, R: Real> Copy for History<N, T, R> {}

impl<N: NormalLaw, T: TangentialLaw, R: Real> History<N, T, R> {
    /// Numbers of a history, besides the radius.
    pub const NUMBERS: usize = 3 + N::HISTORY + T::HISTORY;
    /// Place of [`Self::offset`] among them.
    pub const OFFSET: usize = 0;
    /// Place of [`Self::normal_force`].
    pub const FORCE: usize = 1;
    const VISCOUS: usize = 2;
    const NORMAL: usize = 3;
    const TANGENTIAL: usize = Self::NORMAL + N::HISTORY;

    /// The history from its radius and its numbers.
    #[inline(always)]
    pub fn of(reduced_radius: R, numbers: impl Fn(usize) -> R) -> Self {
        Self {
            reduced_radius,
            offset: numbers(Self::OFFSET),
            normal_force: numbers(Self::FORCE),
            viscous: numbers(Self::VISCOUS),
            normal: N::history(|k| numbers(Self::NORMAL + k)),
            tangential: T::history(|k| numbers(Self::TANGENTIAL + k)),
        }
    }

    /// The numbers, each with its place.
    #[inline(always)]
    pub fn each_number(&self, mut put: impl FnMut(usize, R)) {
        put(Self::OFFSET, self.offset);
        put(Self::FORCE, self.normal_force);
        put(Self::VISCOUS, self.viscous);
        N::each_number(&self.normal, |k, number| put(Self::NORMAL + k, number));
        T::each_number(&self.tangential, |k, number| put(Self::TANGENTIAL + k, number));
    }

    /// Contacts that push: surfaces that lie in a dent without a force count as apart.
    #[inline(always)]
    pub fn touching(&self) -> R::Mask {
        self.normal_force.simd_gt(self.normal_force.splat(0.0))
    }
}

impl<N: NormalLaw, T: TangentialLaw> History<N, T> {
    /// A contact that never touched.
    pub fn new(reduced_radius: f64) -> Self {
        Self::of(reduced_radius, |_| 0.0)
    }
}

impl<N: NormalLaw, T: TangentialLaw> Serialize for History<N, T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut numbers = vec![0.0; Self::NUMBERS];
        self.each_number(|k, number| numbers[k] = number);
        (self.reduced_radius, numbers).serialize(serializer)
    }
}

impl<'de, N: NormalLaw, T: TangentialLaw> Deserialize<'de> for History<N, T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let (reduced_radius, numbers): (f64, Vec<f64>) = Deserialize::deserialize(deserializer)?;
        if numbers.len() != Self::NUMBERS {
            return Err(serde::de::Error::custom("the history of a contact belongs to other laws"));
        }
        Ok(Self::of(reduced_radius, |k| numbers[k]))
    }
}

/// Force on the first body (N) and the friction in it (the tangential part, which has a lever arm).
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PairForce<R = f64> {
    /// Whole force on the first body; the second feels minus this.
    pub force: Triple<R>,
    /// Its tangential part.
    pub friction: Triple<R>,
}

/// Energies that contacts give off in a step (J); see [`ChunkSums`].
#[derive(Debug, Clone, Copy)]
pub struct Dissipated<R = f64> {
    /// Plastic work.
    pub plastic: R,
    /// Work of contact pressure on thinning wires.
    pub thinning: R,
    /// Friction.
    pub friction: R,
    /// Viscous damping.
    pub damping: R,
}

impl Dissipated {
    /// As a partial sum.
    pub fn partial(&self) -> ChunkSums {
        let Self { plastic, thinning, friction, damping } = *self;
        ChunkSums { plastic, thinning, friction, damping, ..ChunkSums::default() }
    }
}

/// Response of pairs, of those that touch and of those that have just parted: what friction had stored is then lost.
#[inline(always)]
pub fn contact_response<N: NormalLaw, T: TangentialLaw, R: Real>(
    laws: &Laws<N, T>,
    history: &mut History<N, T, R>,
    meeting: &ContactKinematics<R>,
) -> (PairForce<R>, Dissipated<R>) {
    let answer = laws.normal.response(&mut history.normal, history.reduced_radius, meeting.overlap);
    press(laws, history, meeting, &answer)
}

/// What follows from the normal law's answer: thinning, friction, damping.
#[inline(always)]
pub fn press<N: NormalLaw, T: TangentialLaw, R: Real>(
    laws: &Laws<N, T>,
    history: &mut History<N, T, R>,
    meeting: &ContactKinematics<R>,
    answer: &NormalResponse<R>,
) -> (PairForce<R>, Dissipated<R>) {
    let zero = meeting.overlap.splat(0.0);
    let touches = meeting.overlap.simd_gt(zero);
    let mean = (history.normal_force + answer.force) * 0.5;
    let thinner = R::select(touches & history.touching(), meeting.thinner, zero);
    let mut given =
        Dissipated { plastic: answer.plastic_work, thinning: mean * thinner, friction: zero, damping: zero };
    history.normal_force = answer.force;

    let approach = meeting.velocity.dot(meeting.normal);
    let mut push = answer.force;
    let mut friction = Triple::zero(zero);
    if T::ACTIVE {
        let across = meeting.velocity - meeting.normal * approach;
        let input = TangentialInput {
            normal: meeting.normal,
            slip: across * meeting.dt,
            normal_force: answer.force,
            radius: answer.radius,
            inverse_radius: answer.inverse_radius,
        };
        let pull = laws.tangential.response(&mut history.tangential, &input);
        given.friction = pull.friction_work;
        friction = pull.pull;
    }
    if laws.damping > 0.0 {
        // √k from one root; 0 where nothing pushes. Damping never turns the push into a pull.
        let root = answer.stiffness * answer.stiffness.inverse_sqrt();
        let damper = -(meeting.viscosity * root * approach);
        let viscous = R::select(answer.force.simd_gt(zero), damper.simd_max(-answer.force), zero);
        push += viscous;
        given.damping = -((history.viscous + viscous) * approach * (meeting.dt * 0.5));
        history.viscous = viscous;
    }
    (PairForce { force: friction - meeting.normal * push, friction }, given)
}

/// Greatest normal and tangential stiffness (N/m) that a touching pair can reach within `horizon` (s) if it goes on
/// approaching at `approach` (m/s) from `overlap` (m); `None` when it has parted.
#[inline(always)]
pub fn foreseen_stiffness<N: NormalLaw, T: TangentialLaw>(
    laws: &Laws<N, T>,
    history: &History<N, T>,
    overlap: f64,
    approach: f64,
    horizon: f64,
) -> Option<[f64; 2]> {
    let deepest = overlap + approach.max(0.0) * horizon;
    if deepest <= 0.0 {
        return None;
    }
    let at = |overlap: f64| {
        let (mut normal, mut tangential) = (history.normal, history.tangential);
        let answer = laws.normal.response(&mut normal, history.reduced_radius, overlap);
        let stiffness = laws.normal.greatest_stiffness(&normal, history.reduced_radius, overlap).max(answer.stiffness);
        let mut across = 0.0;
        if T::ACTIVE && answer.force > 0.0 {
            let input = TangentialInput::at_rest(answer.force, answer.radius);
            across = laws.tangential.response(&mut tangential, &input).stiffness;
        }
        [stiffness, across]
    };
    let (then, now) = (at(deepest), at(overlap));
    Some([then[0].max(now[0]), then[1].max(now[1])])
}

/// A pair leaves the list: what friction had stored is lost, and returned (J).
pub fn leave<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>, history: &History<N, T>) -> f64 {
    if history.touching() { laws.tangential.elastic_energy(&history.tangential) } else { 0.0 }
}

/// Recoverable energy of the normal force at `overlap` (J).
fn normal_energy<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>, history: &History<N, T>, overlap: f64) -> f64 {
    if history.touching() { laws.normal.elastic_energy(&history.normal, history.reduced_radius, overlap) } else { 0.0 }
}

/// Recoverable energy of a contact at `overlap` (J).
pub fn elastic_energy<N: NormalLaw, T: TangentialLaw>(laws: &Laws<N, T>, history: &History<N, T>, overlap: f64) -> f64 {
    normal_energy(laws, history, overlap) + leave(laws, history)
}

/// A contact as a table has it: between two places (m) with their radii (m), of a normal force (N); `reduced` is R* (m), where it is
/// a circle.
pub fn touch(pair: [u32; 2], [(a, r), (b, s)]: [(DVec3, f64); 2], force: f64, reduced: Option<f64>) -> Touch {
    let apart = (b - a).length();
    let overlap = r + s - apart;
    let position = a + (b - a) * (0.5 * (apart + r - s) / apart);
    let pressure = reduced.map_or(f64::NAN, |reduced| force / (std::f64::consts::PI * reduced * overlap));
    Touch { pair, position: position.to_array(), force, overlap, pressure }
}
