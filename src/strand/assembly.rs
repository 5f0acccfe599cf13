//! `Assembly`: wires, particles and bonds, ready for the engine.

use crate::base::vectors::Vectors;
use std::ops::Range;

/// Everything that is discretised, particles ordered wire by wire along each wire, then free spheres.
///
/// Bond slot `i` joins particles `i` and `i + 1`; it exists when both belong to the same wire
/// ([`Assembly::is_bond`]). Slots between wires are never used, so bonds need no index list.
#[derive(Debug, Clone, PartialEq)]
pub struct Assembly {
    /// Layers, inside out; wires given one by one are grouped by their layer name.
    pub layers: Vec<Layer>,
    /// Wires; wire `w` is number `w + 1` for people.
    pub wires: Vec<Wire>,
    /// Number of particles that belong to wires; free spheres follow.
    pub wire_particles: usize,
    /// Particle centres (m).
    pub position: Vectors,
    /// Initial velocities (m/s) (those that the scene gives; the affine field of a pull is added by the engine).
    pub velocity: Vectors,
    /// Initial spins (rad/s).
    pub spin: Vectors,
    /// Particle radii (m).
    pub radius: Vec<f64>,
    /// Particle masses (kg): ρ A a for wire particles (half of it at wire ends), 4/3 π r³ ρ for free spheres.
    pub mass: Vec<f64>,
    /// Rotational inertia (kg m²): 1/2 m r² in wires, 2/5 m r² for free spheres, scaled if the scene asks.
    pub inertia: Vec<f64>,
    /// Stress-free length of each bond slot (m); 0 where no bond is.
    pub rest_length: Vec<f64>,
    /// Wire of each particle; `u32::MAX` for free spheres.
    pub wire_of: Vec<u32>,
    /// Number of the material of each free sphere.
    pub sphere_material: Vec<usize>,
    /// Length of the body along z (m) (z from 0 to this when a strand; the extent of the wires otherwise).
    pub length: f64,
    /// Total area ΣnA₀ of metal over all wires (m²).
    pub area: f64,
}

/// A layer of wires.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Name.
    pub name: String,
    /// Lay radius (m); 0 for straight wires given one by one.
    pub lay_radius: f64,
    /// Pitch (m); infinite when straight.
    pub pitch: f64,
    /// Lay direction, ±1; 0 when straight.
    pub lay: f64,
}

/// A wire: a contiguous range of particles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wire {
    /// Index into [`Assembly::layers`].
    pub layer: usize,
    /// First particle.
    pub first: usize,
    /// Number of particles.
    pub len: usize,
    /// Number of its material ([`crate::scene::spec::Spec::materials`]).
    pub material: usize,
    /// Diameter (m).
    pub diameter: f64,
}

impl Wire {
    /// Particle indices.
    pub fn particles(&self) -> Range<usize> {
        self.first..self.first + self.len
    }

    /// Bond slots.
    pub fn bonds(&self) -> Range<usize> {
        self.first..self.first + self.len.saturating_sub(1)
    }

    /// Cross-section A₀ = π d² / 4 (m²).
    pub fn area(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.diameter * self.diameter
    }
}

impl Assembly {
    /// Number of particles.
    pub fn len(&self) -> usize {
        self.radius.len()
    }

    /// True without particles.
    pub fn is_empty(&self) -> bool {
        self.radius.is_empty()
    }

    /// Radius of the thinnest particle (m).
    pub fn least_radius(&self) -> f64 {
        self.radius.iter().copied().fold(f64::MAX, f64::min)
    }

    /// Number of bonds.
    pub fn bond_count(&self) -> usize {
        self.wires.iter().map(|w| w.bonds().len()).sum()
    }

    /// Particles of each body: wires in order, then free spheres, one particle each. Index = body number of
    /// [`crate::scene::spec::HoldSpec::body`].
    pub fn bodies(&self) -> Vec<Range<usize>> {
        let wires = self.wires.iter().map(Wire::particles);
        let spheres = (self.wire_particles..self.len()).map(|i| i..i + 1);
        wires.chain(spheres).collect()
    }

    /// Number of the material of particle `i`.
    pub fn material_of(&self, i: usize) -> usize {
        match self.wires.get(self.wire_of[i] as usize) {
            Some(wire) => wire.material,
            None => self.sphere_material[i - self.wire_particles],
        }
    }

    /// Whether slot `i` is a bond.
    pub fn is_bond(&self, i: usize) -> bool {
        self.rest_length[i] > 0.0
    }
}
