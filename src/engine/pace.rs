//! The speed of an adaptive pull: fast while the strand flows smoothly, slow from the start of loading until much energy
//! is stored and dissipated, and where a rupture is near.
//!
//! What flows smoothly does so in the affine velocity field of the pull (z/L times its speed), which needs no force to
//! keep going, so the speed there matters little. A change of speed does: pushed by the grip alone it would cross the
//! strand as a wave, and plastic strain would be left uneven behind it. So the whole affine field is sped up and slowed
//! down together, as it is started ([`super::grips::Holds`]); the work of that is booked.

use super::Engine;
use super::state::State;
use crate::scene::spec::{AdaptiveSpec, DriveSpec, Spec};

/// Least time in which the pull changes by its fastest speed, in passages of an elastic wave through the strand [-].
const RISE_PASSAGES: f64 = 10.0;

/// The speed of the pull, and where it is going.
#[derive(Debug, Clone)]
pub struct Pace {
    /// Speed now [m/s].
    pub speed: f64,
    /// Change of speed per time until the next look [m/s²].
    acceleration: f64,
    rule: Rule,
    /// Time until which a rupture keeps the pull slow [s].
    quiet_until: f64,
}

/// How fast a state may be pulled.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Speed at the start and near ruptures [m/s].
    pub slow: f64,
    /// Greatest speed [m/s].
    pub fastest: f64,
    /// Greatest kinetic energy of the affine field over the work done [-].
    share: f64,
    /// Kinetic energy of the affine field over half the square of its speed, Σ m s² [kg].
    inertia: f64,
    /// Length between the grips [m].
    length: f64,
    /// Least time from any moment to the next rupture, at the speed of that moment, as far as the slow speed allows [s].
    settling: f64,
    /// Greatest acceleration [m/s²].
    pub acceleration: f64,
}

/// What decides on the speed.
#[derive(Debug, Clone, Copy)]
pub struct Ahead {
    /// Work done [J].
    pub work: f64,
    /// Strain to the next rupture [-].
    pub strain: f64,
}

impl Rule {
    /// The rule of a scene that pulls adaptively; `inertia` is Σ m s² of its affine field [kg], `length` that between
    /// the grips [m].
    pub fn new(spec: &Spec, inertia: f64, length: f64) -> Option<Self> {
        let grip = spec.grip.as_ref()?;
        let (AdaptiveSpec { fastest, kinetic, passages }, DriveSpec::Speed(slow)) = (grip.adaptive.clone()?, grip.drive)
        else {
            return None;
        };
        let wave = (spec.material.young / (spec.material.density * spec.time.mass_scale)).sqrt();
        let passage = length / wave;
        Some(Self {
            slow,
            fastest,
            share: kinetic,
            inertia,
            length,
            settling: passages * passage,
            acceleration: fastest / (RISE_PASSAGES * passage),
        })
    }

    /// Speed that a state allows [m/s].
    pub fn speed(&self, ahead: Ahead) -> f64 {
        let by_energy = (2.0 * self.share * ahead.work.max(0.0) / self.inertia).sqrt();
        let by_rupture = ahead.strain * self.length / self.settling;
        self.fastest.min(by_energy).min(by_rupture).max(self.slow)
    }
}

impl Pace {
    /// At its slow speed.
    pub fn new(rule: Rule) -> Self {
        Self { speed: rule.slow, acceleration: 0.0, rule, quiet_until: 0.0 }
    }

    /// Goes on by `time` [s]; returns the change of speed [m/s].
    pub fn advance(&mut self, time: f64) -> f64 {
        let change = self.acceleration * time;
        self.speed += change;
        change
    }

    /// Heads for the speed that is right now, to be reached by the next look in `interval` [s].
    fn look(&mut self, ahead: Ahead, now: f64, interval: f64) {
        let ahead = if now < self.quiet_until { Ahead { strain: 0.0, ..ahead } } else { ahead };
        let wanted = (self.rule.speed(ahead) - self.speed) / interval;
        self.acceleration = wanted.clamp(-self.rule.acceleration, self.rule.acceleration);
    }

    /// A bond broke.
    fn rupture(&mut self, now: f64) {
        self.quiet_until = now + self.rule.settling;
    }
}

impl Engine {
    /// Decides how fast to pull until the next look, `steps` from now.
    pub(super) fn choose_pace(&mut self, steps: u64) {
        let Some(mut pace) = self.holds.pace.take() else { return };
        let ahead = Ahead { work: self.holds.work, strain: self.strain_to_rupture() };
        pace.look(ahead, self.state.time, steps as f64 * self.next_dt);
        self.holds.pace = Some(pace);
    }

    /// A bond broke: the pull stays slow until its load has found other ways.
    pub(super) fn slow_down(&mut self) {
        let now = self.state.time;
        if let Some(pace) = &mut self.holds.pace {
            pace.rupture(now);
        }
    }

    /// Strain until the bond nearest to its limit reaches it, if it goes on as fast as on the mean so far [-].
    fn strain_to_rupture(&self) -> f64 {
        let Some(bonds) = &self.bonds else { return f64::INFINITY };
        let whole = (0..self.state.len()).filter(|slot| self.state.whole[*slot]);
        let most = whole.map(|slot| bonds.utilisation(slot, &self.state)).fold(0.0, f64::max);
        self.strain() * (1.0 - most).max(0.0) / most
    }
}

/// Σ m s² over the particles, s their share of the pull's speed [kg].
pub fn inertia(state: &State, share: impl Fn(f64) -> f64) -> f64 {
    (0..state.len()).map(|p| state.mass[p] * share(state.x.z[p]).powi(2)).sum()
}
