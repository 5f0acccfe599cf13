//! State of all particles as structure of arrays, and what the stages leave for each other.

use crate::base::vectors::Vectors;
use crate::strand::assembly::Assembly;
use glam::DVec3;

/// Number of items that one task works on. Fixed, so that partial sums do not depend on the number of threads.
pub const CHUNK: usize = 256;

/// What a bond does to its two particles.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BondAction {
    /// Force on the first particle [N]; the second feels minus this.
    pub pull: DVec3,
    /// Moment on the first particle [N m]; the second feels minus this.
    pub moment: DVec3,
    /// Moment of the shear force about both particles, (l/2) n × pull [N m].
    pub arm: DVec3,
}

/// All particles.
pub struct State {
    /// Centres x_n [m].
    pub x: Vectors,
    /// Velocities v_{n−1/2} [m/s].
    pub v: Vectors,
    /// Spins ω_{n−1/2} [rad/s].
    pub w: Vectors,
    /// Forces F_n [N].
    pub force: Vectors,
    /// Torques about the centres [N m].
    pub torque: Vectors,
    /// Forces from contacts [N].
    pub contact_force: Vectors,
    /// Torques from contacts [N m].
    pub contact_torque: Vectors,
    /// What each bond slot does; zero where no bond is.
    pub bond: Vec<BondAction>,
    /// Whether each bond slot holds.
    pub whole: Vec<bool>,
    /// Factor on the radius of each bond, e^(−ε_p/2) [-].
    pub thinning: Vec<f64>,
    /// Current contact radii [m].
    pub radius: Vec<f64>,
    /// Undeformed radii [m].
    pub radius0: Vec<f64>,
    /// Masses [kg].
    pub mass: Vec<f64>,
    /// Rotational inertias [kg m²].
    pub inertia: Vec<f64>,
    /// Their inverses [1/kg], [1/(kg m²)]: multiplying is cheaper than dividing.
    pub inverse_mass: Vec<f64>,
    /// See `inverse_mass`.
    pub inverse_inertia: Vec<f64>,
    /// Hold that each particle belongs to, from 1; 0 when free. Two particles of one hold never need a contact.
    pub hold: Vec<u16>,
    /// Prescribed components of each particle, bits 0–2 for translation, 3–5 for rotation.
    pub fixed: Vec<u8>,
    /// Steps done.
    pub step: u64,
    /// Simulated time [s].
    pub time: f64,
    /// Step that led here [s].
    pub dt: f64,
}

impl State {
    /// From the assembly, at rest where the scene gives no velocity.
    pub fn new(a: &Assembly) -> Self {
        let n = a.len();
        Self {
            x: a.position.clone(),
            v: a.velocity.clone(),
            w: a.spin.clone(),
            force: Vectors::zeros(n),
            torque: Vectors::zeros(n),
            contact_force: Vectors::zeros(n),
            contact_torque: Vectors::zeros(n),
            bond: vec![BondAction::default(); n],
            whole: (0..n).map(|i| a.is_bond(i)).collect(),
            thinning: vec![1.0; n],
            radius: a.radius.clone(),
            radius0: a.radius.clone(),
            mass: a.mass.clone(),
            inertia: a.inertia.clone(),
            inverse_mass: a.mass.iter().map(|m| 1.0 / m).collect(),
            inverse_inertia: a.inertia.iter().map(|j| 1.0 / j).collect(),
            hold: vec![0; n],
            fixed: vec![0; n],
            step: 0,
            time: 0.0,
            dt: 0.0,
        }
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// True without particles.
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// Kinetic energy at the instant of the positions, ½ m v_{n−1/2}·v_{n+1/2} [J]; `load` is the applied force [N] and
    /// moment [N m] on each particle. Prescribed components do not follow forces.
    ///
    /// This is the form that leapfrog conserves together with the potential: exactly for linear springs, where
    /// ½ m |v_n|² swings with the square of the step times the stiffness, and is shaken by every rupture.
    pub fn kinetic(&self, load: impl Fn(usize) -> [DVec3; 2]) -> f64 {
        (0..self.len())
            .map(|i| {
                let ([push, turn], v, w) = (load(i), self.v.get(i), self.w.get(i));
                let v_next = v + self.free_part(i, 0, self.force.get(i) + push) * (self.dt / self.mass[i]);
                let w_next = w + self.free_part(i, 3, self.torque.get(i) + turn) * (self.dt / self.inertia[i]);
                0.5 * (self.mass[i] * v.dot(v_next) + self.inertia[i] * w.dot(w_next))
            })
            .sum()
    }

    /// Power of forces and torques in the prescribed components [W].
    pub fn held_power(&self) -> f64 {
        let power = |i: usize, first: u8, f: DVec3, v: DVec3| (f - self.free_part(i, first, f)).dot(v);
        (0..self.len())
            .filter(|i| self.fixed[*i] != 0)
            .map(|i| power(i, 0, self.force.get(i), self.v.get(i)) + power(i, 3, self.torque.get(i), self.w.get(i)))
            .sum()
    }

    /// `vector` without the prescribed components of particle `i`; `first` is 0 for translation, 3 for rotation.
    pub fn free_part(&self, i: usize, first: u8, vector: DVec3) -> DVec3 {
        let free = |k: u8| if self.fixed[i] >> (first + k) & 1 == 1 { 0.0 } else { 1.0 };
        vector * DVec3::new(free(0), free(1), free(2))
    }
}

/// Sums of one chunk each; added up in order.
#[derive(Debug, Clone, Copy, Default)]
pub struct Partial {
    /// Plastic work [J].
    pub plastic: f64,
    /// Viscous damping [J].
    pub damping: f64,
    /// Friction [J].
    pub friction: f64,
    /// Work of contact pressure on thinning wires [J].
    pub thinning: f64,
    /// Elastic energy of contacts on wires that broke under them [J].
    pub released: f64,
    /// The deepest contact.
    pub deepest: Deepest,
}

/// The deepest of some contacts.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Deepest {
    /// Overlap over the smaller of the two current radii [-].
    pub ratio: f64,
    /// The particle and the other one, or the first particle of the segment touched.
    pub pair: [u32; 2],
    /// Normal force [N].
    pub force: f64,
    /// Area πR*δ of the contact [m²].
    pub area: f64,
}

impl Deepest {
    /// Takes in a touching pair with its overlap, the smaller radius [m], R* [m] and the normal force [N]. No division
    /// unless it is the deepest so far: every contact comes by at every step.
    #[inline(always)]
    pub fn meet(&mut self, pair: [u32; 2], overlap: f64, radius: f64, reduced_radius: f64, force: f64) {
        if overlap > self.ratio * radius {
            let area = std::f64::consts::PI * reduced_radius * overlap;
            *self = Self { ratio: overlap / radius, pair, force, area };
        }
    }
}

impl Partial {
    /// Nothing yet, but a contact counts as deepest only beyond `deepest`: while a run has seen deeper ones, none does.
    pub fn beyond(deepest: Deepest) -> Self {
        Self { deepest, ..Self::default() }
    }

    /// Adds another partial sum.
    pub fn add(&mut self, other: &Partial) {
        self.plastic += other.plastic;
        self.damping += other.damping;
        self.friction += other.friction;
        self.thinning += other.thinning;
        self.released += other.released;
        // The first of equals wins, in the order of chunks.
        if other.deepest.ratio > self.deepest.ratio {
            self.deepest = other.deepest;
        }
    }

    /// All energies times `factor`.
    pub fn scaled(&self, factor: f64) -> Self {
        Self {
            plastic: self.plastic * factor,
            damping: self.damping * factor,
            friction: self.friction * factor,
            thinning: self.thinning * factor,
            released: self.released * factor,
            deepest: self.deepest,
        }
    }
}
