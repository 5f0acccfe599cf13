//! The speed of an adaptive pull: slow while loading begins and layers close upon each other, and where a rupture is near;
//! fast in between.
//!
//! What flows smoothly does so in the affine velocity field of the pull, z/L times its speed, which needs no force to keep
//! going: its speed matters little there. A change of speed does. Pushed by the grip alone it would cross the strand as a
//! wave, slow where wires flow, and leave plastic strain uneven behind it. So the whole field is sped up and slowed down
//! together, as it is started, and the work of that is booked ([`super::grips::Holds`]).

use super::estimates::passage;
use super::state::State;
use crate::scene::spec::{AdaptiveSpec, DriveSpec, Spec};

/// Least time in which the pull changes by its fastest speed, in passages of an elastic wave from grip to grip (-).
pub const RISE_PASSAGES: f64 = 10.0;
/// Parts into which a pull is divided to foretell how long it takes.
const PARTS: u32 = 500;

/// How fast a state may be pulled.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Speed at the start and near ruptures (m/s).
    slow: f64,
    /// Strain up to which it stays slow (-).
    from: f64,
    /// Greatest speed (m/s).
    fastest: f64,
    /// Greatest kinetic energy of the affine field over the work done (-).
    share: f64,
    /// Kinetic energy of the affine field over half the square of its speed, Σ m s² (kg).
    inertia: f64,
    /// Length between the grips (m).
    length: f64,
    /// Least time to the next rupture at the speed of any moment (s).
    settling: f64,
    /// Greatest acceleration (m/s²).
    acceleration: f64,
}

/// What decides on the speed.
#[derive(Debug, Clone, Copy)]
pub struct Ahead {
    /// Work done so far (J).
    pub work: f64,
    /// Strain so far (-).
    pub strain: f64,
    /// Strain left until the next rupture (-); 0 from the first rupture on.
    pub left: f64,
}

impl Rule {
    /// The rule of a scene that pulls adaptively; `inertia` is Σ m s² of its affine field (kg), `length` that between
    /// the grips (m).
    pub fn new(spec: &Spec, inertia: f64, length: f64) -> Option<Self> {
        let grip = spec.grip.as_ref()?;
        let (AdaptiveSpec { from, fastest, kinetic, passages }, DriveSpec::Speed(slow)) =
            (grip.adaptive.as_ref()?, grip.drive)
        else {
            return None;
        };
        let passage = passage(spec, length);
        Some(Self {
            slow,
            from: *from,
            fastest: *fastest,
            share: *kinetic,
            inertia,
            length,
            settling: passages * passage,
            acceleration: fastest / (RISE_PASSAGES * passage),
        })
    }

    /// Speed that a state allows (m/s).
    pub fn speed(&self, ahead: Ahead) -> f64 {
        if ahead.strain < self.from {
            return self.slow;
        }
        let by_energy = (2.0 * self.share * ahead.work.max(0.0) / self.inertia).sqrt();
        let by_rupture = ahead.left * self.length / self.settling;
        self.fastest.min(by_energy).min(by_rupture).max(self.slow)
    }
}

/// The speed of the pull, and where it is going.
#[derive(Debug, Clone)]
pub struct LoadingRate {
    /// Speed now (m/s).
    pub speed: f64,
    /// Its change in the last step (m/s).
    pub change: f64,
    /// Speed that it heads for (m/s).
    target: f64,
    /// How fast it does (m/s²).
    acceleration: f64,
    rule: Rule,
}

impl LoadingRate {
    /// At its slow speed.
    pub fn new(rule: Rule) -> Self {
        Self { speed: rule.slow, change: 0.0, target: rule.slow, acceleration: 0.0, rule }
    }

    /// Speed, its last change, the speed that it heads for (m/s), and how fast it does (m/s²).
    pub(super) fn now(&self) -> [f64; 4] {
        [self.speed, self.change, self.target, self.acceleration]
    }

    /// Goes on from what [`Self::now`] gave.
    pub(super) fn resume(&mut self, now: [f64; 4]) {
        [self.speed, self.change, self.target, self.acceleration] = now;
    }

    /// Goes on by `time` (s).
    pub fn advance(&mut self, time: f64) {
        let (left, most) = (self.target - self.speed, self.acceleration * time);
        self.change = left.clamp(-most, most);
        // It stops at its target to the bit, so that a steady pull has nothing to change.
        self.speed = if left.abs() <= most { self.target } else { self.speed + self.change };
    }

    /// Heads for the speed that is right now, to be reached in `interval` (s), when it is asked again, if it can be.
    pub fn aim(&mut self, ahead: Ahead, interval: f64) {
        self.target = self.rule.speed(ahead);
        // A hair more than needed, so that rounding does not keep it from arriving.
        let needed = (1.0 + 1e-6) * (self.target - self.speed).abs() / interval;
        self.acceleration = needed.min(self.rule.acceleration);
    }

    /// Time that the pull is expected to take from here to `strain` (s), by the laws of the bonds alone: each wire strained as
    /// the body, the first rupture at the strain `breaks` (-). `now` is where it stands, `force` what the body carries at a
    /// strain (N).
    pub fn time_to(&self, strain: f64, now: Ahead, breaks: f64, force: impl Fn(f64) -> f64) -> f64 {
        let rule = &self.rule;
        let part = (strain - now.strain) / f64::from(PARTS);
        let (mut work, mut time) = (now.work, 0.0);
        for k in 0..PARTS {
            let middle = now.strain + (f64::from(k) + 0.5) * part;
            let left = (breaks - middle).max(0.0);
            time += (part * rule.length).abs() / rule.speed(Ahead { work, strain: middle, left });
            work += force(middle) * part * rule.length;
        }
        time
    }
}

/// Σ m s² over the particles, `share` of their z their share s of the pull's speed (kg).
pub fn inertia(state: &State, share: impl Fn(f64) -> f64) -> f64 {
    (0..state.len()).map(|p| state.mass[p] * share(state.x.z[p]).powi(2)).sum()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::quality::Quality;

    fn rule() -> Rule {
        Rule {
            slow: 5.0,
            from: 0.01,
            fastest: 20.0,
            share: 0.02,
            inertia: 2e-3,
            length: 0.1,
            settling: 5e-4,
            acceleration: 1e5,
        }
    }

    #[test]
    fn the_start_and_the_last_strain_before_a_rupture_are_slow() {
        let speed = |work, left| rule().speed(Ahead { work, strain: 0.02, left });
        assert_eq!(speed(0.0, 1.0), 5.0, "nothing is stored yet");
        assert_eq!(speed(10.0, 0.0), 5.0, "a rupture is there");
        assert_eq!(speed(1e3, f64::INFINITY), 20.0);
        // Half m s² v² = 2 % of 5 J; and 5 % of 0.1 m in 0.5 ms.
        for tenth in [speed(5.0, 1.0), speed(1e3, 0.05)] {
            assert!((tenth - 10.0).abs() < 1e-12, "{tenth}");
        }
        assert_eq!(rule().speed(Ahead { work: 1e3, strain: 0.0099, left: 1.0 }), 5.0, "layers may still close");
    }

    /// Whatever limits the pull, `--quality fine` halves its speed and draft doubles it.
    #[test]
    fn quality_turns_the_speed_at_every_moment() {
        let rule = |quality: Quality| {
            let mut scene = crate::scene::load("ka4", &[]).unwrap();
            quality.apply(&mut scene).unwrap();
            Rule::new(&scene.spec, 1.5e-3, 0.1).unwrap()
        };
        let [draft, standard, fine] = Quality::ALL.map(rule);
        for work in [0.0, 1.0, 5.0, 1e3] {
            for left in [0.0, 0.02, 0.1, f64::INFINITY] {
                let ahead = Ahead { work, strain: 0.1, left };
                let speed = standard.speed(ahead);
                assert!((draft.speed(ahead) / speed - 2.0).abs() < 1e-12, "{ahead:?}");
                assert!((fine.speed(ahead) / speed - 0.5).abs() < 1e-12, "{ahead:?}");
            }
        }
    }

    #[test]
    fn speed_changes_steadily_and_never_faster_than_allowed() {
        let mut rate = LoadingRate::new(rule());
        let (fast, interval) = (Ahead { work: 1e3, strain: 0.1, left: 1.0 }, 4e-6);
        let mut before = rate.speed;
        for _ in 0..100 {
            rate.aim(fast, interval);
            (0..64).for_each(|_| rate.advance(interval / 64.0));
            assert!(rate.speed >= before && rate.speed - before <= 1e5 * interval * (1.0 + 1e-9));
            before = rate.speed;
        }
        assert_eq!(rate.speed, 20.0);
        rate.aim(Ahead { left: 0.0, ..fast }, interval);
        rate.advance(interval);
        assert!((rate.change + 1e5 * interval).abs() < 1e-12, "{}", rate.change);
    }
}
