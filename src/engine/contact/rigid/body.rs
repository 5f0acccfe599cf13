//! One rigid body: where it is, how it moves, what presses on it.

use crate::engine::contact::pair::Laws;
use crate::engine::state::State;
use crate::engine::view::BodyState;
use crate::law::contact::NormalLaw;
use crate::law::contact::line::CELLS;
use crate::law::tangential::TangentialLaw;
use crate::scene::rigid::{RigidMotion, RigidSpec};
use crate::strand::surface::Surface;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// Cells over the half length √(2δ(R + r)) of a patch δ = 1 % of the wire's radius deep across a cylinder (-).
const CELL: f64 = 0.2;

/// A rigid body with the laws by which it touches.
pub(super) struct Body<N, T> {
    pub surface: Surface,
    /// Where it was at the start (m).
    start: DVec3,
    /// Unit vector about which it spins.
    pub axis: DVec3,
    motion: RigidMotion,
    /// With each material.
    laws: Vec<Laws<N, T>>,
    /// Where it is (m).
    pub place: DVec3,
    /// How far it has come from the start (m), and turned (rad).
    offset: DVec3,
    angle: f64,
    /// The same in the last step.
    step: DVec3,
    turn: f64,
    /// Its velocity (m/s) and spin (rad/s) in the last step.
    pub velocity: DVec3,
    spin: DVec3,
    /// Length of its way so far (m).
    way: f64,
    /// Force on it (N), and moment about its place (N m).
    pub load: [DVec3; 2],
}

/// What a body remembers: offset, angle, way, load.
#[derive(Serialize, Deserialize)]
pub(super) struct Saved([f64; 3], f64, f64, [[f64; 3]; 2]);

impl<N: NormalLaw, T: TangentialLaw> Body<N, T> {
    /// At the start; `laws` with each material.
    pub fn new(spec: &RigidSpec, laws: Vec<Laws<N, T>>) -> Self {
        Self {
            surface: Surface::of(spec),
            start: spec.position,
            axis: spec.shape.axis(),
            motion: spec.motion,
            laws,
            place: spec.position,
            offset: DVec3::ZERO,
            angle: 0.0,
            step: DVec3::ZERO,
            turn: 0.0,
            velocity: DVec3::ZERO,
            spin: DVec3::ZERO,
            way: 0.0,
            load: [DVec3::ZERO; 2],
        }
    }

    /// Moves it to where it is at `time` (s), `dt` (s) after the last step.
    pub fn move_to(&mut self, time: f64, dt: f64) {
        if !self.motion.moves() {
            return;
        }
        let progress = self.motion.progress(time);
        let (offset, angle) = (self.motion.velocity * progress, self.motion.spin * progress);
        (self.step, self.turn) = (offset - self.offset, angle - self.angle);
        (self.offset, self.angle, self.place) = (offset, angle, self.start + offset);
        let rate = if dt > 0.0 { 1.0 / dt } else { 0.0 };
        (self.velocity, self.spin) = (self.step * rate, self.axis * (self.turn * rate));
        self.way += self.step.length();
    }

    /// Velocity of its surface (m/s) at `arm` from its place (m).
    pub fn velocity_at(&self, arm: DVec3) -> DVec3 {
        self.velocity + self.spin.cross(arm)
    }

    /// How far particles and the body have gone together (m): nothing comes nearer than that.
    pub fn gone(&self, state: &State) -> f64 {
        state.travel + self.way
    }

    /// Whether nothing can touch it yet that is `quiet_until` then ([`Self::gone`]) (m).
    pub fn quiet(&self, quiet_until: f64, state: &State) -> bool {
        self.gone(state) < quiet_until
    }

    /// Its greatest speed at `time` (s) or later (m/s).
    pub fn speed_from(&self, time: f64) -> f64 {
        let over = self.motion.duration.is_some_and(|end| time >= end);
        if over { 0.0 } else { self.motion.velocity.length() }
    }

    /// Law by which it touches particles of a material.
    pub fn law(&self, material: usize) -> &Laws<N, T> {
        &self.laws[material]
    }

    /// Blocks of [`CELLS`] cells into which the stretch of a particle of radius `r` (m) is cut, of `length` (m).
    pub fn blocks(&self, length: f64, r: f64) -> usize {
        let cell = CELL * (0.02 * r * (self.surface.radius() + r)).sqrt();
        ((length / (CELLS as f64 * cell)).ceil() as usize).max(1)
    }

    /// Work that it did in the last step (J), with the load before it (N, N m).
    pub fn work(&self, before: &[DVec3; 2]) -> f64 {
        let [force, moment] = [0, 1].map(|k| 0.5 * (before[k] + self.load[k]));
        -(force.dot(self.step) + moment.dot(self.axis) * self.turn)
    }

    /// As it is now.
    pub fn state(&self) -> BodyState {
        let [force, moment] = self.load.map(|load| load.to_array());
        BodyState { position: self.place.to_array(), angle: self.angle, force, moment }
    }

    /// What it remembers.
    pub fn saved(&self) -> Saved {
        Saved(self.offset.to_array(), self.angle, self.way, self.load.map(|load| load.to_array()))
    }

    /// Takes up what it remembered.
    pub fn take_up(&mut self, Saved(offset, angle, way, load): Saved) {
        (self.offset, self.angle, self.way) = (offset.into(), angle, way);
        self.place = self.start + self.offset;
        self.load = load.map(DVec3::from);
    }
}
