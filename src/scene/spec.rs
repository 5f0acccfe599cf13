//! `Spec`: a scene after resolution, all SI, nothing left to guess. It is what every later floor reads.

/// Pictures are described by the words that people write.
pub use super::look::{ColourBy, Format, Table, Theme, View};
/// Elastic constants are those of rigid bodies too.
pub use super::material::Material;
pub use super::picture::PictureSpec;
/// Rigid bodies.
pub use super::rigid::{RigidMotion, RigidShape, RigidSpec};
/// The hardening law is stated as it is computed.
pub use crate::law::bond::hardening::Hardening as HardeningSpec;
use glam::DVec3;
use std::path::PathBuf;

/// A resolved scene. Units are SI throughout.
#[derive(Debug, Clone, PartialEq)]
pub struct Spec {
    /// Name: the file's stem or the built-in name; also the default folder under `out/`.
    pub name: String,
    /// One or more sentences saying what the scene shows.
    pub about: String,
    /// Seed of the scatter (-).
    pub seed: u64,
    /// Name of the first material; `None` for that of `[material]` and `[bond]`.
    pub material_name: Option<String>,
    /// The first material, of most scenes the only one ([`Spec::materials`]).
    pub material: Material,
    /// Bonds along wires of it.
    pub bond: BondSpec,
    /// The other materials of which there are bodies.
    pub further: Vec<MaterialSpec>,
    /// Contacts; `None` when the scene says `contact.normal = "none"`.
    pub contact: Option<ContactSpec>,
    /// A strand laid up in helical layers.
    pub strand: Option<StrandSpec>,
    /// Wires given one by one.
    pub wires: Vec<WireSpec>,
    /// Free spheres (each its own body, its own mass 4/3 π r³ ρ).
    pub spheres: Vec<SphereSpec>,
    /// Rigid bodies; none where the scene has no contacts.
    pub rigids: Vec<RigidSpec>,
    /// Particle spacing over wire diameter (-); 1 is touching spheres.
    pub spacing: f64,
    /// The two grips of a strand or of a set of wires along z; `None` for free bodies.
    pub grip: Option<GripSpec>,
    /// Extra holds and loads on single bodies.
    pub holds: Vec<HoldSpec>,
    /// Time stepping.
    pub time: TimeSpec,
    /// When to stop.
    pub stop: StopSpec,
    /// What to write and how often.
    pub output: OutputSpec,
    /// `auto`: only the stages that the scene needs; `general`: every stage, needed or not.
    pub plan: PlanMode,
}

/// See [`Spec::plan`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlanMode {
    /// Only what the scene needs.
    Auto,
    /// Everything, for comparison.
    General,
}

/// A material beside the first one of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct MaterialSpec {
    /// Its name; `None` for that of `[material]` and `[bond]`.
    pub name: Option<String>,
    /// Elastic constants and density.
    pub material: Material,
    /// What bonds of it do.
    pub bond: BondSpec,
    /// Limiting contact pressure p_y (Pa); `None` where contacts are elastic, or where there are none.
    pub limiting_pressure: Option<f64>,
    /// By which rule that comes from the hardening law; `None` where it is given.
    pub hardness: Option<Hardness>,
}

/// Friction between bodies of two materials, which may be the same.
#[derive(Debug, Clone, PartialEq)]
pub struct PairSpec {
    /// Numbers of the two materials, the lower one first.
    pub materials: [usize; 2],
    /// Coulomb friction coefficient (-).
    pub friction: f64,
}

/// One of the materials of a scene, wherever it stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneMaterial<'a> {
    /// Its name; `None` for that of `[material]` and `[bond]`.
    pub name: Option<&'a str>,
    /// Elastic constants and density.
    pub material: &'a Material,
    /// What bonds of it do.
    pub bond: &'a BondSpec,
    /// Limiting contact pressure p_y (Pa); `None` where contacts are elastic, or where there are none.
    pub limiting_pressure: Option<f64>,
}

/// Bonds: law, rupture, damping.
#[derive(Debug, Clone, PartialEq)]
pub struct BondSpec {
    /// Force–displacement law.
    pub law: BondLawSpec,
    /// Rupture; `None` for bonds that never break.
    pub rupture: Option<RuptureSpec>,
    /// Viscous damping as a fraction of critical, per mode (-): axial, shear, bending, torsion.
    pub damping: [f64; 4],
}

/// Bond law by name.
#[derive(Debug, Clone, PartialEq)]
pub enum BondLawSpec {
    /// `elastic`: linear in all modes.
    Elastic,
    /// `elasto-plastic`: isotropic hardening, coupled section plasticity.
    ElastoPlastic(HardeningSpec),
}

/// Rupture criterion with its scatter.
#[derive(Debug, Clone, PartialEq)]
pub struct RuptureSpec {
    /// The criterion.
    pub criterion: RuptureCriterion,
    /// Weibull modulus m of the per-bond factor on the rupture value (-); infinite means no scatter.
    pub weibull_modulus: f64,
}

/// When a bond breaks.
#[derive(Debug, Clone, PartialEq)]
pub enum RuptureCriterion {
    /// p ≥ p_f.
    PlasticStrain {
        /// p_f (-).
        strain: f64,
    },
    /// N/A + β_m |M| r/I ≥ σ_c or |V|/A + β_m |T| r/J ≥ τ_c (Potyondy & Cundall 2004).
    BeamStress {
        /// σ_c (Pa).
        tensile: f64,
        /// τ_c (Pa).
        shear: f64,
        /// β_m, 0 to 1 (-).
        moment_share: f64,
    },
    /// Axial + bending strain at the outermost fibre ≥ ε_f.
    FibreStrain {
        /// ε_f (-).
        strain: f64,
    },
}

/// Contacts between surfaces.
#[derive(Debug, Clone, PartialEq)]
pub struct ContactSpec {
    /// Normal law, with the limiting pressure of the first material.
    pub normal: NormalSpec,
    /// Where the limiting pressure comes from the hardening law of the bonds: by which rule; `None` where it is given.
    pub hardness: Option<Hardness>,
    /// Tangential law; `None` means frictionless.
    pub tangential: Option<TangentialSpec>,
    /// Coulomb friction coefficient (-) of pairs of materials that have none of their own.
    pub friction: f64,
    /// Pairs of materials with a friction of their own.
    pub pairs: Vec<PairSpec>,
    /// Shape of a wire in contact.
    pub shape: Shape,
    /// Viscous damping of the normal contact motion, fraction of critical (-); friction damps the tangential one.
    /// Where `restitution` is given, that of a Hertzian contact with this coefficient.
    pub damping: f64,
    /// Coefficient of restitution of an elastic contact (-), where it is what was given.
    pub restitution: Option<f64>,
    /// Skin of the neighbour list over the largest particle diameter (-).
    pub skin: f64,
}

/// Limiting contact pressure as a multiple of the flow stress (Tabor 1951).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hardness {
    /// Pressure over flow stress (-).
    pub factor: f64,
    /// Plastic strain at which the flow stress is taken (-).
    pub strain: f64,
}

impl Hardness {
    /// The limiting pressure (Pa) under a hardening law.
    pub fn limiting_pressure(&self, law: &HardeningSpec) -> f64 {
        self.factor * law.stress(self.strain)
    }
}

/// Normal contact law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum NormalSpec {
    /// Hertz, elastic.
    Hertz,
    /// Thornton 1997, elastoplastic.
    Thornton {
        /// Limiting contact pressure p_y (Pa).
        limiting_pressure: f64,
    },
}

/// Tangential contact law.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum TangentialSpec {
    /// No-slip Mindlin with Coulomb cap.
    Mindlin,
    /// Mindlin & Deresiewicz 1953.
    MindlinDeresiewicz,
}

/// Shape of a wire in contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// A chain of spheres.
    Sphere,
    /// Smooth: the centreline runs through the particles without corners.
    Wire,
}

/// A strand: helical layers around the z axis, from z = 0 to z = length.
#[derive(Debug, Clone, PartialEq)]
pub struct StrandSpec {
    /// Length L (m).
    pub length: f64,
    /// Layers from the inside out.
    pub layers: Vec<LayerSpec>,
}

/// One layer of a strand.
#[derive(Debug, Clone, PartialEq)]
pub struct LayerSpec {
    /// Name: "inner", "middle", "outer", "core" or the scene's own.
    pub name: String,
    /// Number of wires n_k.
    pub wires: usize,
    /// Wire diameter d (m).
    pub wire_diameter: f64,
    /// Lay radius R_k (m); `None` means `auto`: the least radius without overlap (found by `strand::lay_radius`).
    pub lay_radius: Option<f64>,
    /// Pitch h_k (m); infinite for straight wires.
    pub pitch: f64,
    /// Lay direction s_k: +1 right (Z), −1 left (S).
    pub lay: f64,
    /// Phase φ_k (rad).
    pub phase: f64,
    /// Number of its material ([`Spec::materials`]).
    pub material: usize,
}

/// A wire on its own.
#[derive(Debug, Clone, PartialEq)]
pub struct WireSpec {
    /// Name of the layer the wire is counted in.
    pub layer: String,
    /// Number of its material ([`Spec::materials`]).
    pub material: usize,
    /// Wire diameter d (m).
    pub diameter: f64,
    /// Its centre line.
    pub path: PathSpec,
    /// Initial velocity (m/s).
    pub velocity: DVec3,
    /// Initial spin (rad/s).
    pub spin: DVec3,
}

/// Centre line of a wire.
#[derive(Debug, Clone, PartialEq)]
pub enum PathSpec {
    /// Straight from → to (m).
    Straight {
        /// First point (m).
        from: DVec3,
        /// Last point (m).
        to: DVec3,
    },
    /// Wire `index` (from 0) of a centreline text file.
    File {
        /// The file as given, resolved against the scene's folder.
        file: PathBuf,
        /// Which wire of it.
        index: usize,
        /// Its points (m).
        points: Vec<DVec3>,
    },
}

/// A free sphere.
#[derive(Debug, Clone, PartialEq)]
pub struct SphereSpec {
    /// Number of its material ([`Spec::materials`]).
    pub material: usize,
    /// Diameter (m).
    pub diameter: f64,
    /// Centre (m).
    pub position: DVec3,
    /// Velocity (m/s).
    pub velocity: DVec3,
    /// Spin (rad/s).
    pub spin: DVec3,
}

/// The two grips: the lower holds the end at least z, the upper the end at greatest z and is driven.
#[derive(Debug, Clone, PartialEq)]
pub struct GripSpec {
    /// How wires are held.
    pub kind: GripKind,
    /// Length of each grip along z (m). Gauge length = body length − 2 × this.
    pub length: f64,
    /// Motion of the upper grip along z.
    pub drive: DriveSpec,
    /// Faster between the start and the first rupture; `None`: as `drive` says throughout.
    pub adaptive: Option<AdaptiveSpec>,
    /// Rotation rate of the upper grip about z (rad/s).
    pub rotation_rate: f64,
    /// The upper grip turns freely about z (its torque is zero) instead of being held or driven.
    pub free_rotation: bool,
}

/// How a grip holds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum GripKind {
    /// Every wire, rotation held.
    All,
    /// The outermost layer only, pressed inwards.
    Jaw {
        /// Radial clamp pressure on the strand's surface (Pa).
        pressure: f64,
    },
}

/// A pull that is faster than [`DriveSpec::Speed`] between its start and the first rupture.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptiveSpec {
    /// Strain up to which the speed stays [`DriveSpec::Speed`] (-).
    pub from: f64,
    /// Greatest speed (m/s).
    pub fastest: f64,
    /// Greatest kinetic energy of the pull over the work that it has done (-).
    pub kinetic: f64,
    /// Least time to the next rupture at the speed of any moment, in passages of an elastic wave from grip to grip (-).
    pub passages: f64,
}

impl AdaptiveSpec {
    /// From strain `from` (-) up to `fastest` (m/s), with the usual limits: kinetic energy below that at which a run warns.
    pub fn new(from: f64, fastest: f64) -> Self {
        Self { from, fastest, kinetic: 0.04, passages: 20.0 }
    }
}

/// Motion of the upper grip along z.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum DriveSpec {
    /// Constant speed (m/s), positive pulls; starts from the affine velocity field.
    Speed(f64),
    /// Displacement amplitude × sin(2π f t).
    Cyclic {
        /// Amplitude (m).
        amplitude: f64,
        /// Frequency f (Hz).
        frequency: f64,
    },
}

/// A hold or load on one end of, or on all of, one body.
#[derive(Debug, Clone, PartialEq)]
pub struct HoldSpec {
    /// Body number from 0: strand wires first (inside out), then `wires`, then `spheres`; `rigids` are not among them.
    pub body: usize,
    /// Which part.
    pub part: BodyPart,
    /// Prescribed components: x, y, z, then rotation about x, y, z.
    pub fixed: [bool; 6],
    /// Velocity of the prescribed translational components (m/s).
    pub velocity: DVec3,
    /// Spin of the prescribed rotational components (rad/s).
    pub spin: DVec3,
    /// Total force on the part, shared equally by its particles (N).
    pub force: DVec3,
    /// Total moment on the part, shared equally by its particles (N m).
    pub moment: DVec3,
    /// Time over which force and moment rise smoothly from zero (s).
    pub ramp: f64,
}

/// Part of a body.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum BodyPart {
    /// First particle.
    Start,
    /// Last particle.
    End,
    /// All particles.
    All,
}

/// Time stepping.
#[derive(Debug, Clone, PartialEq)]
pub struct TimeSpec {
    /// Fraction of the bound on the stable step (-).
    pub safety: f64,
    /// How finely a contact is stepped at least: Δt √(k/m*) (-), before `safety`.
    pub contact_resolution: f64,
    /// Fixed step (s); `None`: from the bound, recomputed as stiffness changes.
    pub step: Option<f64>,
    /// Factor on particle mass (-); reported when not 1.
    pub mass_scale: f64,
    /// Factor on rotational inertia (-); reported when not 1.
    pub inertia_scale: f64,
    /// Kinetic over internal energy above which the run says that it is not quasi-static (-).
    pub kinetic_limit: f64,
    /// Relative difference of the grip forces above which the run says so (-).
    pub mismatch_limit: f64,
}

/// When to stop; the first that holds ends the run.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct StopSpec {
    /// Strain of the body, grip displacement over free length (-).
    pub strain: Option<f64>,
    /// Nominal stress has fallen to this fraction of its peak, after a rupture (-).
    pub stress_fraction: Option<f64>,
    /// Strain beyond the drop, at which nominal stress had fallen to 80 % of its peak after a rupture (-).
    pub strain_after_drop: Option<f64>,
    /// Simulated time (s).
    pub time: Option<f64>,
    /// Steps.
    pub steps: Option<u64>,
}

/// What to write and how often, and how frames look.
#[derive(Debug, Clone, PartialEq)]
pub struct OutputSpec {
    /// Number of curve samples over the planned run.
    pub samples: usize,
    /// Number of snapshots (recording and frames) over the planned run, evenly spaced; ruptures bring more.
    pub snapshots: usize,
    /// How many times denser than that snapshots are right after a rupture (-).
    pub rupture_density: f64,
    /// How often a run keeps its state.
    pub checkpoint: CheckpointSpec,
    /// Frame size in pixels.
    pub frame_size: [u32; 2],
    /// Quantity that colours wires in frames and recording.
    pub colour: ColourBy,
    /// Panels of a frame; empty means those that suit the scene.
    pub views: Vec<View>,
    /// Ground of the frames.
    pub theme: Theme,
    /// Viewpoint of the frames.
    pub camera: CameraSpec,
    /// Files for other programs that are made of a run when it has come to its end.
    pub also: Vec<Format>,
    /// Tables that are written at every snapshot.
    pub tables: Vec<Table>,
    /// How many times finer than its pixels a picture is drawn, in either direction.
    pub supersampling: u32,
    /// Pictures that are drawn of a run when it has come to its end.
    pub pictures: Vec<PictureSpec>,
}

impl Default for OutputSpec {
    fn default() -> Self {
        Self {
            samples: 2000,
            snapshots: 160,
            rupture_density: 40.0,
            checkpoint: CheckpointSpec::Auto,
            frame_size: [1280, 720],
            colour: ColourBy::Stress,
            views: Vec::new(),
            theme: Theme::default(),
            camera: CameraSpec::default(),
            also: Vec::new(),
            tables: Vec::new(),
            supersampling: 1,
            pictures: Vec::new(),
        }
    }
}

/// How often a run keeps its state, to be resumed from.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub enum CheckpointSpec {
    /// As often as costs little.
    #[default]
    Auto,
    /// After this much wall time (s).
    WallTime(f64),
    /// After so many steps.
    Steps(u64),
    /// Never.
    None,
}

/// Viewpoint of the three-dimensional panels. The strand's axis z points right, y points up, the eye looks along +x.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CameraSpec {
    /// Turn of the eye about the vertical (rad).
    pub azimuth: f64,
    /// Turn of the eye about the horizontal (rad).
    pub elevation: f64,
    /// Magnification over what fits a panel (-).
    pub zoom: f64,
    /// Section that the close-up follows, as z before loading (m). `None`: mid-length, then the first break,
    /// then the main fracture.
    pub focus_z: Option<f64>,
}

impl Default for CameraSpec {
    fn default() -> Self {
        Self { azimuth: 0.0, elevation: 0.0, zoom: 1.0, focus_z: None }
    }
}
