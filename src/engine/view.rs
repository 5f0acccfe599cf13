//! What leaves the engine, in SI: samples (one row of the curve), snapshots (every particle, in single precision) and
//! ruptures. Whoever shows or writes it converts it, with [`crate::base::units`].

use crate::base::finding::{Body, StepLimit};
use serde::{Deserialize, Serialize};

/// Whether a bond holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[repr(u8)]
pub enum BondState {
    /// Never yielded.
    Whole = 0,
    /// Has plastic strain.
    Yielding = 1,
    /// Broken.
    Broken = 2,
    /// No bond: the slot after a wire's last particle, or a free sphere.
    Absent = 3,
}

/// What does not change during a run, for those who draw or record it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct RunInfo {
    /// Scene name.
    pub name: String,
    /// What the scene shows.
    pub about: String,
    /// Layer names, inside out.
    pub layers: Vec<String>,
    /// Names of the materials; one where all bodies are of the same.
    pub materials: Vec<String>,
    /// Index into `materials` of each free sphere.
    pub sphere_material: Vec<usize>,
    /// Wires in order; wire `w` is shown to people as number `w + 1`.
    pub wires: Vec<WireInfo>,
    /// Number of particles in wires; free spheres follow.
    pub wire_particles: usize,
    /// Number of particles, free spheres included.
    pub particles: usize,
    /// Rigid bodies.
    pub bodies: Vec<BodyInfo>,
    /// Initial particle radius (m).
    pub radius: Vec<f32>,
    /// Initial centre of each particle (m).
    pub rest_position: Vec<[f32; 3]>,
    /// z of the lower and upper grip face before loading (m); the gauge lies between. `None` for free bodies.
    pub gauge: Option<[f64; 2]>,
    /// A range of true axial stress that the run will not exceed, for a colour scale that is fixed
    /// over the whole sequence (Pa).
    pub stress_range: [f64; 2],
    /// The same for equivalent plastic strain (-).
    pub plastic_strain_range: [f64; 2],
    /// The same for particle speed (m/s).
    pub speed_range: [f64; 2],
    /// A range of contact pressure for a colour scale (Pa); single particles may exceed it.
    pub contact_pressure_range: [f64; 2],
    /// The strain at which the run is expected to end (-), for axes and progress; `None` when unknown.
    pub strain_end: Option<f64>,
    /// Greatest nominal stress that the body is expected to reach (Pa), where wires are of several materials; of one it
    /// follows from `stress_range`.
    pub body_stress_end: Option<f64>,
    /// An energy that is nothing (J): no ratio means anything of energies below it.
    pub negligible_energy: f64,
    /// Time in which an elastic wave runs along the body (s).
    pub wave_passage: f64,
}

/// A rigid body for those who draw or record it.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyInfo {
    /// Its name.
    pub name: String,
    /// Its shape.
    pub shape: BodyShape,
}

/// Shape of a rigid body.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum BodyShape {
    /// A half space.
    Plane {
        /// Unit normal out of it.
        normal: [f64; 3],
    },
    /// A cylinder.
    Cylinder {
        /// Unit vector along its axis.
        axis: [f64; 3],
        /// Radius (m).
        radius: f64,
        /// Length between the hemispheres in which it ends (m); `None` where it is endless.
        length: Option<f64>,
    },
    /// A sphere.
    Sphere {
        /// Radius (m).
        radius: f64,
    },
}

/// A rigid body at one instant, or its mean over a time.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct BodyState {
    /// Where it is (m): a point of a plane, the middle of a cylinder, the centre of a sphere.
    pub position: [f64; 3],
    /// By how much it has turned about its axis, or normal (rad).
    pub angle: f64,
    /// Force of all that touches it on it (N).
    pub force: [f64; 3],
    /// Moment of that about its position (N m).
    pub moment: [f64; 3],
}

impl BodyState {
    /// Its numbers, in this order.
    pub const NUMBERS: usize = 10;

    /// The numbers.
    pub fn numbers(&self) -> [f64; Self::NUMBERS] {
        let Self { position: [x, y, z], angle, force: [fx, fy, fz], moment: [mx, my, mz] } = *self;
        [x, y, z, angle, fx, fy, fz, mx, my, mz]
    }

    /// From the numbers.
    pub fn of(number: impl Fn(usize) -> f64) -> Self {
        let three = |first: usize| [number(first), number(first + 1), number(first + 2)];
        Self { position: three(0), angle: number(3), force: three(4), moment: three(7) }
    }
}

impl RunInfo {
    /// Whether grips strain the body towards an end that is known, so that strength and elongation mean something; a
    /// wire that is only turned has none.
    pub fn is_pulled(&self) -> bool {
        self.gauge.is_some() && self.strain_end.is_some()
    }

    /// Whether bodies are of more than one material.
    pub fn has_several_materials(&self) -> bool {
        self.materials.len() > 1
    }

    /// Whether particle `i` lies in a grip before loading.
    pub fn in_grip(&self, i: usize) -> bool {
        let z = self.rest_position[i][2];
        self.gauge.is_some_and(|[low, high]| z < low as f32 || z > high as f32)
    }

    /// Wires of a layer with their indices.
    pub fn wires_of(&self, layer: usize) -> impl Iterator<Item = (usize, &WireInfo)> {
        self.wires.iter().enumerate().filter(move |(_, wire)| wire.layer == layer)
    }
}

impl BondState {
    /// Whether there is a bond and it is not broken.
    pub fn holds(self) -> bool {
        matches!(self, Self::Whole | Self::Yielding)
    }
}

/// A wire for those who draw or record it.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct WireInfo {
    /// Index into [`RunInfo::layers`].
    pub layer: usize,
    /// Index into [`RunInfo::materials`].
    pub material: usize,
    /// First particle.
    pub first: usize,
    /// Number of particles.
    pub len: usize,
    /// Diameter (m).
    pub diameter: f64,
}

impl WireInfo {
    /// Its section before loading (m²).
    pub fn area(&self) -> f64 {
        std::f64::consts::FRAC_PI_4 * self.diameter * self.diameter
    }

    /// Its particles.
    pub fn particles(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.len
    }

    /// Its bond slots.
    pub fn bonds(&self) -> std::ops::Range<usize> {
        self.first..self.first + self.len.saturating_sub(1)
    }
}

/// One row of the stress–strain curve.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Sample {
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Grip displacement over the free length between the particles held (-); 0 without grips. Like stress, forces and torque it is a running mean over an eighth of an
    /// elastic wave's passage ([`crate::engine::measure::Measures`]): all of them lag alike, so none is shifted against
    /// another. Energies and counts are those of the instant.
    pub strain: f64,
    /// Nominal stress: upper grip force over ΣnA₀ (Pa).
    pub stress: f64,
    /// Force of the lower grip and of the upper grip, tension positive (N).
    pub grip_force: [f64; 2],
    /// Torque about z on the upper grip (N m).
    pub torque: f64,
    /// Mean nominal axial stress of the wires of each layer at mid-gauge (Pa), broken ones included.
    pub layer_stress: Vec<f64>,
    /// Nominal axial stress of each wire at mid-gauge (Pa): the mean over its bonds in the middle twentieth of the gauge, of
    /// which broken ones carry nothing.
    pub wire_stress: Vec<f64>,
    /// Part of the force of each wire along z at mid-gauge (N), a mean over the same time as the forces of the grips, where wires
    /// are of several materials; empty elsewhere.
    pub wire_pull: Vec<f64>,
    /// Wires broken so far.
    pub wires_broken: usize,
    /// Bonds broken so far.
    pub bonds_broken: usize,
    /// Active contacts.
    pub contacts: usize,
    /// Time step (s).
    pub time_step: f64,
    /// Energies (J).
    pub energy: Energy,
    /// Rigid bodies; means over the same time as the forces of the grips.
    pub bodies: Vec<BodyState>,
}

/// The energy ledger (J); every term is cumulative except `kinetic` and the two elastic ones.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Energy {
    /// Work done by grips, holds and applied loads, plus the energy that the run started with: of motion, and of
    /// bodies that overlap from the start.
    pub work: f64,
    /// Kinetic, translation and rotation: leapfrog's ½ m v_{n−1/2}·v_{n+1/2}, which can be negative where motion turns round
    /// at every step; zero where that is rounding.
    pub kinetic: f64,
    /// Elastic, in bonds.
    pub elastic_bonds: f64,
    /// Elastic, in contacts.
    pub elastic_contacts: f64,
    /// Plastic work in bonds.
    pub plastic_bonds: f64,
    /// Plastic work in contacts.
    pub plastic_contacts: f64,
    /// Work that contact pressure does as wires thin: it goes into their plastic flow.
    pub plastic_thinning: f64,
    /// Friction.
    pub friction: f64,
    /// Viscous damping.
    pub damping: f64,
    /// Released by rupture: what the broken bonds held.
    pub released: f64,
}

impl Energy {
    /// Elastic plus dissipated energy, without kinetic energy (J).
    pub fn internal(&self) -> f64 {
        self.elastic_bonds
            + self.elastic_contacts
            + self.plastic_bonds
            + self.plastic_contacts
            + self.plastic_thinning
            + self.friction
            + self.damping
            + self.released
    }

    /// What the ledger does not account for: work − kinetic − internal (J).
    pub fn residual(&self) -> f64 {
        self.work - self.kinetic - self.internal()
    }
}

/// Every particle at one instant, in single precision.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Snapshot {
    /// The curve's row at this instant.
    pub sample: Sample,
    /// Centres (m), one per particle.
    pub position: Vec<[f32; 3]>,
    /// Current radii (m) (wires thin as they stretch), one per particle.
    pub radius: Vec<f32>,
    /// Speed (m/s), one per particle.
    pub speed: Vec<f32>,
    /// State, one per bond slot (slot i joins particles i and i + 1; as many slots as particles).
    pub bond_state: Vec<BondState>,
    /// True axial stress (Pa), one per bond slot; 0 where no bond is.
    pub bond_stress: Vec<f32>,
    /// Equivalent plastic strain (-), one per bond slot.
    pub plastic_strain: Vec<f32>,
    /// Share of its rupture limit that a bond has reached (-), one per bond slot: it breaks at 1; 0 without a rupture
    /// criterion or without a bond.
    pub utilisation: Vec<f32>,
    /// Normal forces of a particle's contacts over the area that it shows to its neighbours (Pa), one per particle:
    /// ΣF_n / (d a) in a wire of diameter d with spacing a, ΣF_n / (π r²) for a free sphere.
    pub contact_pressure: Vec<f32>,
    /// By how much each particle has turned about its wire since the start (rad): the time integral of its spin, along the wire as
    /// it lies now. Empty where no grip turns.
    pub roll: Vec<f32>,
    /// What the scene asks for besides (`output.tables`).
    pub detail: Option<Box<Detail>>,
}

/// What a scene asks for beside the rest of a snapshot, in double precision; what it does not ask for is empty.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Detail {
    /// Centres (m), one per particle.
    pub position: Vec<[f64; 3]>,
    /// Velocities half a step before (m/s), one per particle.
    pub velocity: Vec<[f64; 3]>,
    /// Spins half a step before (rad/s), one per particle.
    pub spin: Vec<[f64; 3]>,
    /// What each hold does to the particles that it holds, in the scene's order.
    pub holds: Vec<Load>,
    /// Pairs that touch.
    pub contacts: Vec<Touch>,
    /// The grips, where there are any.
    pub grips: Option<GripState>,
}

/// A force and a moment.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Load {
    /// Force (N).
    pub force: [f64; 3],
    /// Moment about the middle of what is held (N m).
    pub moment: [f64; 3],
}

/// A contact at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Touch {
    /// The particle, and the other one, or the first one of the piece of wire that it touches.
    pub pair: [u32; 2],
    /// Half-way between the two surfaces (m).
    pub position: [f64; 3],
    /// Normal force (N).
    pub force: f64,
    /// Overlap, at its deepest (m).
    pub overlap: f64,
    /// Normal force over the area πR*δ (Pa); NaN for a patch along two wires, which is no circle.
    pub pressure: f64,
}

/// The grips at one instant.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct GripState {
    /// By how much the upper grip has moved along z (m).
    pub displacement: f64,
    /// By how much it has turned about z (rad).
    pub angle: f64,
    /// Lay length and lay radius between the grips (m), means over the whole wires of each layer; `None` of one on the axis, or all
    /// of whose wires are broken. A straight layer has an infinite lay length.
    pub lay: Vec<Option<[f64; 2]>>,
}

impl Snapshot {
    /// Mean true axial stress of the bonds that hold (Pa); 0 where none does.
    pub fn mean_stress(&self) -> f32 {
        let bonds = self.bond_stress.iter().zip(&self.bond_state).filter(|(_, state)| state.holds());
        let (sum, count) = bonds.fold((0.0, 0usize), |(sum, count), (stress, _)| (sum + f64::from(*stress), count + 1));
        if count == 0 { 0.0 } else { (sum / count as f64) as f32 }
    }
}

/// What an engine has seen of its own limits over a run.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Findings {
    /// The deepest contact; `None` when nothing touched.
    pub deepest: Option<DeepestContact>,
    /// The least time step.
    pub least_step: StepAt,
    /// The greatest time step.
    pub greatest_step: StepAt,
}

/// The deepest contact of a run, when it was deepest.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct DeepestContact {
    /// Overlap over the smaller of the two radii (-).
    pub ratio: f64,
    /// The two bodies.
    #[serde(with = "crate::base::finding::json")]
    pub bodies: [Body; 2],
    /// Where (m).
    pub position: [f64; 3],
    /// Normal force (N).
    pub force: f64,
    /// Force over the area of the contact (Pa): πR*δ of a circle, Σ √(2R*δ) ds of a patch along a smooth wire.
    pub pressure: f64,
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body (-); `None` without grips.
    pub strain: Option<f64>,
}

/// A time step, and when it was chosen.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StepAt {
    /// The time step (s).
    pub seconds: f64,
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body (-); `None` without grips.
    pub strain: Option<f64>,
    /// What limited it.
    #[serde(with = "crate::base::finding::json")]
    pub limit: StepLimit,
}

/// Why a bond broke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum RuptureCause {
    /// Equivalent plastic strain reached its limit.
    #[default]
    PlasticStrain,
    /// Tensile stress of the outermost fibre.
    Tension,
    /// Shear stress.
    Shear,
    /// Strain of the outermost fibre.
    FibreStrain,
}

/// A bond that broke.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct Rupture {
    /// Order of the rupture in the run, from 1.
    pub order: usize,
    /// Step.
    pub step: u64,
    /// Simulated time (s).
    pub time: f64,
    /// Strain of the body (-).
    pub strain: f64,
    /// Wire, from 0.
    pub wire: usize,
    /// Layer, from 0.
    pub layer: usize,
    /// Bond slot.
    pub bond: usize,
    /// Number of the bond along its wire, from 0.
    pub bond_in_wire: usize,
    /// Centre of the bond when it broke (m).
    pub position: [f64; 3],
    /// z of the bond's centre before loading (m).
    pub rest_z: f64,
    /// Cause.
    pub cause: RuptureCause,
    /// True axial stress just before (Pa).
    pub stress: f64,
    /// Nominal stress of the body just before (Pa).
    pub body_stress: f64,
    /// True when this is the wire's first rupture.
    pub first_of_wire: bool,
}
