//! State of all particles as structure of arrays, and what the stages leave for each other.

use crate::base::vectors::Vectors;
use crate::strand::assembly::Assembly;
use glam::DVec3;
use serde::{Deserialize, Serialize};
use std::slice::ChunksMut;

/// Number of items that one task works on. Fixed, so that partial sums do not depend on the number of threads.
pub const CHUNK: usize = 256;

/// Rows of numbers of all particles, chunk by chunk: as many rows at a time, from the same particles.
pub struct RowChunks<'a, const N: usize>([ChunksMut<'a, f64>; N]);

impl<'a, const N: usize> RowChunks<'a, N> {
    /// Of `rows` that are all of one length.
    pub fn of(rows: [&'a mut [f64]; N]) -> Self {
        Self(rows.map(|row| row.chunks_mut(CHUNK)))
    }
}

impl<'a, const N: usize> Iterator for RowChunks<'a, N> {
    type Item = [&'a mut [f64]; N];

    fn next(&mut self) -> Option<Self::Item> {
        let next = self.0.each_mut().map(Iterator::next);
        next.iter().all(Option::is_some).then(|| next.map(Option::unwrap_or_default))
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let least = self.0.iter().map(ExactSizeIterator::len).min().unwrap_or(0);
        (least, Some(least))
    }
}

impl<const N: usize> ExactSizeIterator for RowChunks<'_, N> {}

/// What bonds do to their two particles, in blocks of [`CHUNK`] slots, field after field.
#[derive(Serialize, Deserialize)]
pub struct BondActions {
    /// Per block: the factor of the bond on the radius e^(−ε_p/2) (-), which it keeps when it breaks; its pull on the first
    /// particle (N), of which the second feels the opposite; and where particles turn its moments on the first and on the
    /// second (N m). All of them 0 where no bond has been.
    pub data: Vec<f64>,
    turn: bool,
}

impl BondActions {
    /// Places of the fields.
    pub const THINNING: usize = 0;
    /// Three of them.
    pub const PULL: usize = 1;
    /// Three of them.
    pub const NEAR: usize = 4;
    /// Three of them.
    pub const FAR: usize = 7;

    /// Nothing done yet to `n` particles.
    pub fn new(n: usize, turn: bool) -> Self {
        Self { data: vec![0.0; n.div_ceil(CHUNK) * CHUNK * Self::fields_of(turn)], turn }
    }

    /// Number of fields.
    pub fn fields(&self) -> usize {
        Self::fields_of(self.turn)
    }

    /// Number of fields with and without rotation.
    pub const fn fields_of(turn: bool) -> usize {
        if turn { Self::FAR + 3 } else { Self::NEAR }
    }

    /// A field of a slot.
    pub fn get(&self, slot: usize, field: usize) -> f64 {
        self.data[self.place(slot, field)]
    }

    fn place(&self, slot: usize, field: usize) -> usize {
        (slot / CHUNK * self.fields() + field) * CHUNK + slot % CHUNK
    }

    fn vector(&self, slot: usize, field: usize) -> DVec3 {
        DVec3::from_array([0, 1, 2].map(|k| self.get(slot, field + k)))
    }

    /// Pull of a bond on its first particle (N).
    pub fn pull(&self, slot: usize) -> DVec3 {
        self.vector(slot, Self::PULL)
    }

    /// Moments of a bond on its first and on its second particle (N m).
    pub fn moments(&self, slot: usize) -> [DVec3; 2] {
        if self.turn { [self.vector(slot, Self::NEAR), self.vector(slot, Self::FAR)] } else { [DVec3::ZERO; 2] }
    }

    /// Bending moment and torque of a bond (N m).
    pub fn moment(&self, slot: usize) -> DVec3 {
        let [near, far] = self.moments(slot);
        0.5 * (near - far)
    }

    /// The field of a name, and of a part of it.
    fn named(&self, name: &str) -> Option<usize> {
        let of = |field: &str, first: usize| {
            let axis = name.strip_prefix(field)?;
            ["_x", "_y", "_z"].iter().position(|part| *part == axis).map(|part| first + part)
        };
        let thinning = (name == "thinning").then_some(Self::THINNING);
        let turning = || of("moment_near", Self::NEAR).or(of("moment_far", Self::FAR)).filter(|_| self.turn);
        thinning.or(of("pull", Self::PULL)).or_else(turning)
    }

    /// A field of all slots, by its name in formulas.
    pub fn numbers(&self, name: &str) -> Option<impl Iterator<Item = f64> + '_> {
        let field = self.named(name)?;
        Some((0..self.data.len() / self.fields()).map(move |slot| self.get(slot, field)))
    }

    /// Writes a field of all slots; `false` where there is none of this name.
    pub fn set_numbers(&mut self, name: &str, numbers: &[f64]) -> bool {
        let Some(field) = self.named(name) else { return false };
        for (slot, number) in numbers.iter().enumerate() {
            let place = self.place(slot, field);
            self.data[place] = *number;
        }
        true
    }

    /// The bond has broken and pulls no more. What it has thinned stays thin.
    pub fn release(&mut self, slot: usize) {
        for field in Self::PULL..self.fields() {
            let place = self.place(slot, field);
            self.data[place] = 0.0;
        }
    }
}

/// All particles.
#[derive(Serialize, Deserialize)]
pub struct State {
    /// Centres x_n (m).
    pub x: Vectors,
    /// Velocities v_{n−1/2} (m/s).
    pub v: Vectors,
    /// Spins ω_{n−1/2} (rad/s).
    pub w: Vectors,
    /// Forces F_n (N).
    pub force: Vectors,
    /// Torques about the centres (N m).
    pub torque: Vectors,
    /// Forces from contacts that the contact stage has added up itself (N): spheres leave the second sides of pairs to
    /// the gathering of all forces. Empty while there is no contact stage.
    pub(super) contact_force: Vectors,
    /// The same for torques (N m).
    pub(super) contact_torque: Vectors,
    /// What bonds do.
    pub bond: BondActions,
    /// Whether each bond slot holds.
    pub whole: Vec<bool>,
    /// Length without stress that the bond of each slot had when it broke (m); 0 where none did.
    pub length_at_break: Vec<f64>,
    /// Current contact radii (m).
    pub radius: Vec<f64>,
    /// By how much each has shrunk in the last step (m).
    pub thinned: Vec<f64>,
    /// Undeformed radii (m).
    pub radius0: Vec<f64>,
    /// Masses (kg).
    pub mass: Vec<f64>,
    /// Rotational inertias (kg m²).
    pub inertia: Vec<f64>,
    /// Their inverses (1/kg), [1/(kg m²)]: multiplying is cheaper than dividing.
    pub inverse_mass: Vec<f64>,
    /// See `inverse_mass`.
    pub inverse_inertia: Vec<f64>,
    /// Hold that each particle belongs to, from 1; 0 when free. Two particles of one hold never need a contact.
    pub hold: Vec<u16>,
    /// Prescribed components of each particle, bits 0–2 for translation, 3–5 for rotation.
    pub fixed: Vec<u8>,
    /// Time integrals of the spins (rad), where a grip turns; empty elsewhere.
    pub turned: Vectors,
    /// Steps done.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Step that led here (s).
    pub dt: f64,
    /// Sum over the steps of the greatest displacement in each (m): no particle has gone further.
    pub travel: f64,
}

impl State {
    /// From the assembly, at rest where the scene gives no velocity; `turn` says whether particles turn.
    pub fn new(a: &Assembly, turn: bool) -> Self {
        let n = a.len();
        Self {
            x: a.position.clone(),
            v: a.velocity.clone(),
            w: a.spin.clone(),
            force: Vectors::zeros(n),
            torque: Vectors::zeros(n),
            contact_force: Vectors::default(),
            contact_torque: Vectors::default(),
            bond: BondActions::new(n, turn),
            whole: (0..n).map(|i| a.is_bond(i)).collect(),
            length_at_break: vec![0.0; n],
            radius: a.radius.clone(),
            thinned: vec![0.0; n],
            radius0: a.radius.clone(),
            mass: a.mass.clone(),
            inertia: a.inertia.clone(),
            inverse_mass: a.mass.iter().map(|m| 1.0 / m).collect(),
            inverse_inertia: a.inertia.iter().map(|j| 1.0 / j).collect(),
            hold: vec![0; n],
            fixed: vec![0; n],
            turned: Vectors::default(),
            step: 0,
            time: 0.0,
            dt: 0.0,
            travel: 0.0,
        }
    }

    /// Force of all contacts on particle `p` (N): the whole force less what the bonds do.
    pub fn force_from_contacts(&self, p: usize) -> DVec3 {
        let before = if p > 0 { self.bond.pull(p - 1) } else { DVec3::ZERO };
        self.force.get(p) - (self.bond.pull(p) - before)
    }

    /// Adds the turn of the last step to [`Self::turned`].
    pub(super) fn add_turn(&mut self) {
        for (turned, w) in self.turned.rows_mut().into_iter().zip(self.w.rows()) {
            turned.iter_mut().zip(w).for_each(|(turned, w)| *turned += w * self.dt);
        }
    }

    /// What contacts read, and what they write.
    pub fn split_contacts(&mut self) -> (ParticleView<'_>, ContactSides<'_>) {
        let (x, v, w) = (self.x.rows(), self.v.rows(), self.w.rows());
        let seen =
            ParticleView { x, v, w, radius: &self.radius, thinned: &self.thinned, dt: self.dt, travel: self.travel };
        let (f, t) = (&mut self.contact_force, &mut self.contact_torque);
        (seen, ContactSides { force: [&mut f.x, &mut f.y, &mut f.z], torque: [&mut t.x, &mut t.y, &mut t.z] })
    }

    /// Makes room for what contacts do.
    pub fn make_room_for_contacts(&mut self) {
        self.contact_force = Vectors::zeros(self.len());
        self.contact_torque = Vectors::zeros(self.len());
    }

    /// A number of every particle, by its name in formulas.
    pub fn row(&self, name: &str) -> Option<&[f64]> {
        let (list, axis) = name.split_once('_').unwrap_or((name, ""));
        let vectors = match list {
            "x" => Some(&self.x),
            "v" => Some(&self.v),
            "w" => Some(&self.w),
            "force" => Some(&self.force),
            "torque" => Some(&self.torque),
            _ => None,
        };
        match (vectors, axis) {
            (Some(vectors), "x") => Some(&vectors.x),
            (Some(vectors), "y") => Some(&vectors.y),
            (Some(vectors), "z") => Some(&vectors.z),
            _ => match name {
                "radius" => Some(&self.radius),
                "radius0" => Some(&self.radius0),
                "thinned" => Some(&self.thinned),
                "mass" => Some(&self.mass),
                "inertia" => Some(&self.inertia),
                "inverse_mass" => Some(&self.inverse_mass),
                "inverse_inertia" => Some(&self.inverse_inertia),
                _ => None,
            },
        }
    }

    /// Writes a number of every particle that changes in a step; `false` where there is none of this name.
    pub fn set_row(&mut self, name: &str, numbers: &[f64]) -> bool {
        let (list, axis) = name.split_once('_').unwrap_or((name, ""));
        let vectors = match list {
            "x" => &mut self.x,
            "v" => &mut self.v,
            "w" => &mut self.w,
            "force" => &mut self.force,
            "torque" => &mut self.torque,
            _ => {
                let row = match name {
                    "radius" => &mut self.radius,
                    "thinned" => &mut self.thinned,
                    _ => return false,
                };
                row.copy_from_slice(numbers);
                return true;
            }
        };
        let Some(at) = ["x", "y", "z"].iter().position(|part| *part == axis) else { return false };
        vectors.rows_mut()[at].copy_from_slice(numbers);
        true
    }

    /// Whether every list is one of `n` particles.
    pub(super) fn fits(&self, n: usize) -> bool {
        let vectors = [&self.x, &self.v, &self.w, &self.force, &self.torque];
        let numbers = [&self.length_at_break, &self.radius, &self.thinned, &self.radius0, &self.mass, &self.inertia];
        let inverses = [&self.inverse_mass, &self.inverse_inertia];
        let of_contacts = [&self.contact_force, &self.contact_torque, &self.turned];
        vectors.iter().flat_map(|v| v.rows()).all(|row| row.len() == n)
            && numbers.iter().chain(&inverses).all(|list| list.len() == n)
            && of_contacts.iter().flat_map(|v| v.rows()).all(|row| row.is_empty() || row.len() == n)
            && [self.whole.len(), self.hold.len(), self.fixed.len()] == [n; 3]
    }

    /// Number of particles.
    pub fn len(&self) -> usize {
        self.mass.len()
    }

    /// True without particles.
    pub fn is_empty(&self) -> bool {
        self.mass.is_empty()
    }

    /// Kinetic energy at the instant of the positions, ½ m v_{n−1/2}·v_{n+1/2} (J); `load` is the applied force (N) and
    /// moment (N m) on each particle. Prescribed components do not follow forces.
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

    /// Power of forces and torques in the prescribed components (W).
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

/// What contacts see of all particles; see [`State`].
pub struct ParticleView<'a> {
    /// Centres (m).
    pub x: [&'a [f64]; 3],
    /// Velocities (m/s).
    pub v: [&'a [f64]; 3],
    /// Spins (rad/s).
    pub w: [&'a [f64]; 3],
    /// Contact radii (m).
    pub radius: &'a [f64],
    /// By how much each has shrunk in the last step (m).
    pub thinned: &'a [f64],
    /// Step (s).
    pub dt: f64,
    /// See [`State::travel`].
    pub travel: f64,
}

/// Forces (N) and torques (N m) from contacts, of some particles.
pub struct ContactSides<'a> {
    /// Axis by axis.
    pub force: [&'a mut [f64]; 3],
    /// Axis by axis.
    pub torque: [&'a mut [f64]; 3],
}

impl ContactSides<'_> {
    /// The forces, and with `turn` the torques.
    pub fn rows(&mut self, turn: bool) -> impl Iterator<Item = &mut [f64]> {
        let torque = if turn { &mut self.torque[..] } else { &mut [] };
        self.force.iter_mut().chain(torque).map(|row| &mut **row)
    }
}

/// Sums of one chunk each; added up in order.
#[derive(Debug, Clone, Copy, Default)]
pub struct ChunkSums {
    /// Plastic work (J).
    pub plastic: f64,
    /// Viscous damping (J).
    pub damping: f64,
    /// Friction (J).
    pub friction: f64,
    /// Work of contact pressure on thinning wires (J).
    pub thinning: f64,
    /// Elastic energy of contacts on wires that broke under them (J).
    pub released: f64,
    /// The deepest contact.
    pub deepest: Deepest,
}

/// The deepest of some contacts.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub struct Deepest {
    /// Overlap over the smaller of the two current radii (-).
    pub ratio: f64,
    /// The particle and the other one, or the first particle of the segment touched.
    pub pair: [u32; 2],
    /// Normal force (N).
    pub force: f64,
    /// Area of the contact (m²): πR*δ of a circle, Σ √(2R*δ) ds of a patch along a wire.
    pub area: f64,
}

impl Deepest {
    /// Takes in a touching pair with its overlap, the smaller radius (m), the area (m²) and the normal force (N). No
    /// division unless it is the deepest so far: every contact comes by at every step.
    #[inline(always)]
    pub fn take_in(&mut self, pair: [u32; 2], overlap: f64, radius: f64, area: impl FnOnce() -> f64, force: f64) {
        if overlap > self.ratio * radius {
            *self = Self { ratio: overlap / radius, pair, force, area: area() };
        }
    }
}

impl ChunkSums {
    /// Nothing yet, but a contact counts as deepest only beyond `deepest`: while a run has seen deeper ones, none does.
    pub fn beyond(deepest: Deepest) -> Self {
        Self { deepest, ..Self::default() }
    }

    /// Adds another partial sum.
    pub fn add(&mut self, other: &ChunkSums) {
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
}
