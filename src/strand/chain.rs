//! The wires of a scene as chains of points, layer by layer, before they become particles.

use crate::scene::spec::{PathSpec, Spec, StrandSpec, WireSpec};
use crate::strand::assembly::Layer;
use crate::strand::error::{BuildError, BuildErrorKind, mm};
use crate::strand::helix::Helix;
use crate::strand::lay_radius;
use crate::strand::resample::{self, Chain, PathError};
use glam::DVec3;
use std::f64::consts::TAU;

/// A wire before it is put into the assembly.
pub(super) struct WireChain {
    /// Index into the assembly's layers.
    pub layer: usize,
    /// Number of its material.
    pub material: usize,
    /// Diameter (m).
    pub diameter: f64,
    /// Particle centres and the arcs between them.
    pub chain: Chain,
    /// Velocity of the centre of mass (m/s).
    pub velocity: DVec3,
    /// Spin of the whole wire (rad/s).
    pub spin: DVec3,
    /// The scene's key that describes it.
    pub key: String,
    /// The strand's layer it belongs to.
    pub strand_layer: Option<usize>,
}

/// The strand's layers and wires, inside out.
pub(super) fn lay_up(
    spec: &Spec,
    strand: &StrandSpec,
    layers: &mut Vec<Layer>,
    chains: &mut Vec<WireChain>,
) -> Result<(), BuildError> {
    let radii = lay_radius::resolve(&strand.layers).map_err(|error| {
        let names: Vec<&str> = strand.layers.iter().map(|l| l.name.as_str()).collect();
        BuildError::lay_radius(error, &names)
    })?;
    for (k, (layer, radius)) in strand.layers.iter().zip(radii).enumerate() {
        let straight = layer.pitch.is_infinite();
        layers.push(Layer {
            name: layer.name.clone(),
            lay_radius: radius,
            pitch: layer.pitch,
            lay: if straight { 0.0 } else { layer.lay },
        });
        for i in 0..layer.wires {
            let helix = Helix {
                radius,
                pitch: layer.pitch,
                lay: layer.lay,
                phase: TAU * i as f64 / layer.wires as f64 + layer.phase,
            };
            let chain = chain_of_helix(&helix, strand.length, spec.spacing * layer.wire_diameter).map_err(|error| {
                let who = format!("wire {} (layer \"{}\")", chains.len() + 1, layer.name);
                let spacing = spec.spacing * layer.wire_diameter;
                path_error(error, &who, "strand.length".into(), Some(k), spacing)
            })?;
            chains.push(WireChain {
                layer: k,
                material: layer.material,
                diameter: layer.wire_diameter,
                chain,
                velocity: DVec3::ZERO,
                spin: DVec3::ZERO,
                key: format!("strand.layer.{k}.lay_radius"),
                strand_layer: Some(k),
            });
        }
    }
    Ok(())
}

/// Particles of a helical wire from z = 0 to `length` (m): equal steps of z are equal steps of arc.
fn chain_of_helix(helix: &Helix, length: f64, spacing: f64) -> Result<Chain, PathError> {
    let arc = helix.arc_length(length);
    let n = resample::pieces(arc, spacing).ok_or(PathError::TooShort(arc))?;
    Ok(Chain {
        points: (0..=n).map(|i| helix.point(length * (i as f64 / n as f64))).collect(),
        arcs: vec![arc / n as f64; n],
        deviation: 0.0,
        merged: 0,
    })
}

/// Wire `index` of the scene's own, in the layer of its name, which is added if there is none yet.
pub(super) fn chain_of_wire(
    spec: &Spec,
    wire: &WireSpec,
    index: usize,
    layers: &mut Vec<Layer>,
) -> Result<WireChain, BuildError> {
    let spacing = spec.spacing * wire.diameter;
    let (chain, who) = match &wire.path {
        PathSpec::Straight { from, to } => (resample::straight(*from, *to, spacing), format!("[[wire]] {}", index + 1)),
        PathSpec::File { file, index: in_file, points } => {
            (resample::resample(points, spacing), format!("wire {} of {}", in_file + 1, file.display()))
        }
    };
    let key = format!("wire.{index}");
    let chain = chain.map_err(|error| path_error(error, &who, key.clone(), None, spacing))?;
    let layer = layers.iter().position(|l| l.name == wire.layer).unwrap_or_else(|| {
        layers.push(Layer { name: wire.layer.clone(), lay_radius: 0.0, pitch: f64::INFINITY, lay: 0.0 });
        layers.len() - 1
    });
    Ok(WireChain {
        layer,
        material: wire.material,
        diameter: wire.diameter,
        chain,
        velocity: wire.velocity,
        spin: wire.spin,
        key,
        strand_layer: None,
    })
}

fn path_error(error: PathError, who: &str, key: String, layer: Option<usize>, spacing: f64) -> BuildError {
    let (kind, message, help) = match error {
        PathError::TooShort(length) => (
            BuildErrorKind::TooShort,
            format!("{who} is {} mm long, shorter than the spacing of its particles, {} mm", mm(length), mm(spacing)),
            "make it at least one spacing (spacing × diameter) long".to_owned(),
        ),
        PathError::TooFewPoints => (
            BuildErrorKind::BadPath,
            format!("{who} has fewer than two points"),
            "a centre line needs at least its two ends".to_owned(),
        ),
        PathError::NotFinite(i) => (
            BuildErrorKind::BadPath,
            format!("{who}: point {} is not finite", i + 1),
            "coordinates must be finite numbers".to_owned(),
        ),
    };
    BuildError { kind, layer, message, help, key }
}
