//! The bound on the stable time step.
//!
//! ω_max² ≤ max over elements λ_e, where each bond or contact gets a share of the masses (and inertias) of its
//! particles in proportion to its stiffness; the shares of a particle add up to the particle, so the largest element
//! eigenvalue bounds the assembly's (Irons & Treharne 1971). With these shares it is a Gershgorin bound whose rows are
//! scaled by stiffness; for a uniform chain it is exact, 4k/m. Leapfrog with forces that lag by half a step in velocity
//! is stable to Δt = (2/ω)(√(1+ξ²) − ξ).
//!
//! The elements are gone through twice, for the sums of the particles and for the eigenvalues, and are made anew each time:
//! all of them at once would be as much memory as the contacts themselves.

use super::bytes::behind;
use super::state::State;
use super::team::Team;
use crate::base::finding::{self, StiffnessMode};
use crate::law::bond::BondStiffness;
use serde::{Deserialize, Serialize};

/// One bond or contact as the bound sees it.
#[derive(Debug, Clone, Copy)]
pub struct Element {
    nodes: [u32; 3],
    /// Share of the element's displacement that each node carries (-).
    weights: [f64; 3],
    /// Stiffness along the normal or axis, and across it (N/m).
    normal: f64,
    across: f64,
    /// Lever arms of the two sides for the stiffness across (m).
    arm: [f64; 2],
    /// Bending and torsional stiffness (N m/rad).
    bend: f64,
    twist: f64,
    /// Largest viscous coefficient of its translation (N s/m) and rotation (N m s).
    viscous: [f64; 2],
    bond: bool,
}

impl Element {
    /// Bond `slot` of length `length` (m) with its viscous coefficients.
    pub fn bond(slot: usize, k: &BondStiffness, length: f64, viscosity: [f64; 4], turn: bool) -> Self {
        let arm = if turn { 0.5 * length } else { 0.0 };
        let (shear, bend, twist) = if turn { (k.shear, k.bend, k.twist) } else { (0.0, 0.0, 0.0) };
        let [axial, across, bending, torsion] = viscosity;
        let turning = (across * arm * arm).max(bending).max(torsion);
        let viscous = if turn { [axial.max(across), turning] } else { [axial, 0.0] };
        Self {
            nodes: [slot as u32, slot as u32 + 1, 0],
            weights: [1.0, 1.0, 0.0],
            normal: k.axial,
            across: shear,
            arm: [arm; 2],
            bend,
            twist,
            viscous,
            bond: true,
        }
    }

    /// Contact of the first node with the second and third; `weights` are the shares of the point of contact that each
    /// carries (-), `stiffness` along the normal and across it (N/m), `arm` the lever arms of friction on the two sides (m)
    /// (0 when nothing turns), `viscosity` the viscous coefficient along the normal (N s/m).
    pub fn contact(nodes: [u32; 3], weights: [f64; 3], stiffness: [f64; 2], arm: [f64; 2], viscosity: f64) -> Self {
        let [normal, across] = stiffness;
        Self { nodes, weights, normal, across, arm, bend: 0.0, twist: 0.0, viscous: [viscosity, 0.0], bond: false }
    }

    /// Share of the element's displacement that a node carries (-).
    fn weight(&self, node: usize) -> f64 {
        self.weights[node]
    }

    /// Lever arm of a node (m).
    fn lever(&self, node: usize) -> f64 {
        self.arm[node.min(1)]
    }

    fn translation(&self) -> f64 {
        self.normal.max(self.across)
    }

    /// √(k/m*) of a contact on its own (1/s).
    fn pair_frequency(&self, state: &State, held: &impl Fn(usize) -> bool) -> f64 {
        let free = (0..3).filter(|k| self.weight(*k) > 0.0 && !held(self.nodes[*k] as usize));
        let inverse_mass: f64 =
            free.map(|k| self.weight(k) * self.weight(k) / state.mass[self.nodes[k] as usize]).sum();
        (self.normal * inverse_mass).sqrt()
    }

    fn rotation(&self) -> f64 {
        let arm = self.arm.iter().fold(0.0f64, |a, b| a.max(*b));
        (self.across * arm * arm).max(self.bend).max(self.twist)
    }
}

/// Parts whose elements are there at once while they are added up.
const WAVE: usize = 64;

/// What limits the time step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Bound {
    /// Bound on the stable step (s); infinite when nothing is stiff.
    pub step: f64,
    /// First particle of the limiting element.
    pub particle: usize,
    /// Whether a bond limits (else a contact).
    pub bond: bool,
    /// Which mode limits.
    pub mode: StiffnessMode,
}

impl Bound {
    /// What limits.
    pub fn element(&self) -> finding::Element {
        if self.bond { finding::Element::Bond } else { finding::Element::Contact }
    }
}

/// Sums over the elements of each particle. Kept between calls so that it does not allocate.
#[derive(Default)]
pub struct Stiffness {
    particles: Vec<Sums>,
}

/// Sums of one particle.
#[derive(Debug, Clone, Copy, Default)]
struct Sums {
    /// Σ stiffness × weight (N/m).
    translation: f64,
    /// The same for rotation (N m/rad).
    rotation: f64,
    /// Σ viscous coefficient × weight, translation (N s/m) and rotation (N m s).
    viscous: [f64; 2],
}

/// What limits the step.
#[derive(Default, Clone, Copy)]
struct Worst {
    /// Greatest eigenvalue of stiffness over mass (1/s²), with its mode and element.
    stiffest: Option<(f64, StiffnessMode, Element)>,
    /// Greatest eigenvalue of damping over mass (1/s), bounded element by element like the stiffness.
    damping: f64,
    /// Least step that resolves a contact (s).
    shortest: Option<(f64, Element)>,
}

impl Worst {
    /// The worse of two, where the first comes before the second in the order of elements.
    fn with(self, other: Self) -> Self {
        let stiffest = match (self.stiffest, other.stiffest) {
            (Some(a), Some(b)) => Some(if b.0 > a.0 { b } else { a }),
            (a, b) => a.or(b),
        };
        let shortest = match (self.shortest, other.shortest) {
            (Some(a), Some(b)) => Some(if b.0 < a.0 { b } else { a }),
            (a, b) => a.or(b),
        };
        Self { stiffest, damping: self.damping.max(other.damping), shortest }
    }
}

impl Stiffness {
    /// Memory that it keeps (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.particles)
    }

    /// The bound for the elements that `elements` gives for each of `parts` parts; a contact is stepped at least as finely as Δt √(k/m*) = `resolution`
    /// (-). Particles that are wholly held do not move and do not count.
    pub fn bound(
        &mut self,
        parts: usize,
        elements: impl Fn(usize, &mut dyn FnMut(Element)) + Sync,
        state: &State,
        resolution: f64,
        held: impl Fn(usize) -> bool + Sync,
        team: &Team,
    ) -> Bound {
        self.particles.clear();
        self.particles.resize(state.len(), Sums::default());
        let mut add = |e: Element| {
            let (translation, rotation) = (e.translation(), e.rotation());
            for k in 0..3 {
                let (sums, weight) = (&mut self.particles[e.nodes[k] as usize], e.weight(k));
                sums.translation += translation * weight;
                sums.rotation += rotation * weight;
                sums.viscous[0] += e.viscous[0] * weight;
                sums.viscous[1] += e.viscous[1] * weight;
            }
        };
        // Added up by one thread, in their order; what is to be added up, by all: a wave of parts at a time, so that there is
        // never much of it.
        for wave in (0..parts).step_by(WAVE) {
            let listed = team.map(wave..parts.min(wave + WAVE), |_, part| {
                let mut list = Vec::new();
                elements(part, &mut |e| list.push(e));
                list
            });
            listed.into_iter().flatten().for_each(&mut add);
        }
        let found = team.map(0..parts, |part, _| {
            let mut worst = Worst::default();
            elements(part, &mut |e| self.look_at(&e, state, resolution, &held, &mut worst));
            worst
        });
        let found = found.into_iter().fold(Worst::default(), Worst::with);
        let mut bound = Bound { step: f64::INFINITY, ..Default::default() };
        if let Some((eigenvalue, mode, e)) = found.stiffest {
            let omega = eigenvalue.sqrt();
            let xi = 0.5 * found.damping / omega;
            let step = 2.0 / omega * ((1.0 + xi * xi).sqrt() - xi);
            bound = Bound { step, particle: e.nodes[0] as usize, bond: e.bond, mode };
        }
        match found.shortest {
            Some((meeting, e)) if meeting < bound.step => {
                Bound { step: meeting, particle: e.nodes[0] as usize, bond: false, mode: StiffnessMode::Duration }
            }
            _ => bound,
        }
    }

    /// Takes in how one element limits the step; the first of equals stays.
    fn look_at(&self, e: &Element, state: &State, resolution: f64, held: &impl Fn(usize) -> bool, worst: &mut Worst) {
        let (eigenvalue, mode) = self.element(e, state, held);
        if eigenvalue > worst.stiffest.as_ref().map_or(0.0, |(most, ..)| *most) {
            worst.stiffest = Some((eigenvalue, mode, *e));
        }
        worst.damping = worst.damping.max(self.damping(e, state, held));
        // A pair of held particles never moves.
        let frequency = if e.bond { 0.0 } else { e.pair_frequency(state, held) };
        if frequency > 0.0 && worst.shortest.as_ref().is_none_or(|(least, _)| resolution / frequency < *least) {
            worst.shortest = Some((resolution / frequency, *e));
        }
    }

    /// Largest eigenvalue of damping over mass that one element can have (1/s), with shares as for stiffness.
    fn damping(&self, e: &Element, state: &State, held: &impl Fn(usize) -> bool) -> f64 {
        if e.viscous == [0.0; 2] {
            return 0.0;
        }
        (0..3)
            .filter(|k| e.weight(*k) > 0.0 && !held(e.nodes[*k] as usize))
            .map(|k| {
                let node = e.nodes[k] as usize;
                let [translation, rotation] = self.particles[node].viscous;
                e.weight(k) * (translation / state.mass[node] + rotation / state.inertia[node])
            })
            .sum()
    }

    /// Largest eigenvalue of one element with its shares (1/s²), and its mode.
    fn element(&self, e: &Element, state: &State, held: &impl Fn(usize) -> bool) -> (f64, StiffnessMode) {
        let (ke, qe) = (e.translation(), e.rotation());
        let (mut mass, mut levers, mut turn) = (0.0, 0.0, [0.0; 3]);
        for (k, turn) in turn.iter_mut().enumerate() {
            let node = e.nodes[k] as usize;
            if e.weight(k) == 0.0 || held(node) {
                continue;
            }
            mass += e.weight(k) * self.particles[node].translation / state.mass[node];
            if qe > 0.0 {
                *turn = e.weight(k) * self.particles[node].rotation / (state.inertia[node] * qe);
                levers += e.lever(k) * e.lever(k) * *turn;
            }
        }
        let normal = if ke > 0.0 { e.normal / ke * mass } else { 0.0 };
        let spin = turn[0] + turn[1] + turn[2];
        let shear = if ke > 0.0 { e.across / ke * mass + e.across * levers } else { 0.0 };
        let bend = e.bend * spin;
        // Shear and bending of one bond couple where the two inertias differ.
        let couple = (e.bend * e.across).sqrt() * e.arm[0] * (turn[0] - turn[1]).abs();
        let sideways = shear.max(bend) + couple;
        let twist = e.twist * spin;
        let axis = if e.bond { StiffnessMode::Axial } else { StiffnessMode::Normal };
        let across = match (e.bond, bend > shear) {
            (true, true) => StiffnessMode::Bending,
            (true, false) => StiffnessMode::Shear,
            (false, _) => StiffnessMode::Tangential,
        };
        [(normal, axis), (sideways, across), (twist, StiffnessMode::Torsion)]
            .into_iter()
            .max_by(|a, b| a.0.total_cmp(&b.0))
            .unwrap_or((0.0, StiffnessMode::None))
    }
}
