//! Bodies of a scene: strand, wires, spheres.

use super::at::{At, Range};
use super::centreline_text::{self, CentrelineWire};
use super::construction;
use super::raw::{RawLay, RawLayer, RawSphere, RawStrand, RawWire, Scalar};
use super::resolve_materials::Materials;
use super::spec::{LayerSpec, PathSpec, SphereSpec, StrandSpec, WireSpec};
use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::base::units::{self, Dimension};
use crate::base::wording::{counted, ordinal};
use glam::DVec3;
use std::path::{Path, PathBuf};

/// Relative difference up to which two diameters are one, written with other units (-).
const SAME_DIAMETER: f64 = 1e-9;
/// Layer of a wire that names none.
const DEFAULT_LAYER: &str = "wire";

/// Resolves `[strand]`.
pub(super) fn strand(at: &At, raw: &RawStrand, materials: &Materials) -> Result<StrandSpec> {
    let length = at.required("length", &raw.length, Dimension::Length, Range::Positive)?;
    if let Some(given) = &raw.construction {
        return Ok(StrandSpec { length, layers: construction::layers(at, raw, given, materials)? });
    }
    at.refuse("area", &raw.area, "has no effect without construction = \"auto\"")?;
    if raw.layer.is_empty() {
        return Err(at.error("the strand has no layer", "add [[strand.layer]] with `wires`, or a `construction`"));
    }
    // Checked even where every layer has its own.
    at.optional("pitch", &raw.pitch, Dimension::Length, Range::PositiveOrInfinite)?;
    at.optional("wire_diameter", &raw.wire_diameter, Dimension::Length, Range::Positive)?;
    let mut layers: Vec<LayerSpec> = Vec::with_capacity(raw.layer.len());
    for (index, layer) in raw.layer.iter().enumerate() {
        let here = at.key("layer").element(index);
        let layer = self::layer(&here, at, layer, raw, index, materials)?;
        if layers.iter().any(|before| before.name == layer.name) {
            let what = format!("two layers are named {:?}", layer.name);
            return Err(here.key("name").error(what, "give each layer its own name"));
        }
        layers.push(layer);
    }
    Ok(StrandSpec { length, layers })
}

fn layer(
    at: &At,
    strand: &At,
    raw: &RawLayer,
    defaults: &RawStrand,
    index: usize,
    materials: &Materials,
) -> Result<LayerSpec> {
    let wires = raw.wires.ok_or_else(|| at.missing("wires", "6"))?;
    let wires = at.key("wires").count_within(wires, 1, construction::MOST_WIRES as u64)? as usize;
    let lay_radius = lay_radius(at, raw.lay_radius.as_ref(), wires, index)?;
    let on_axis = lay_radius == Some(0.0);
    let pitch = match layer_or_strand(at, strand, "pitch", &raw.pitch, &defaults.pitch, Range::PositiveOrInfinite)? {
        Some(pitch) => pitch,
        None if on_axis => f64::INFINITY,
        None => return Err(at.missing("pitch", "\"39 mm\"")),
    };
    let diameter =
        layer_or_strand(at, strand, "wire_diameter", &raw.wire_diameter, &defaults.wire_diameter, Range::Positive)?;
    let material = match &raw.material {
        Some(_) => materials.number(at, raw.material.as_ref())?,
        None => materials.number(strand, defaults.material.as_ref())?,
    };
    Ok(LayerSpec {
        material,
        name: raw.name.clone().unwrap_or_else(|| ordinal(index + 1)),
        wires,
        wire_diameter: diameter.ok_or_else(|| at.missing("wire_diameter", "\"0.39 mm\""))?,
        lay_radius,
        pitch,
        lay: RawLay::sign(raw.lay.or(defaults.lay)),
        phase: at.optional("phase", &raw.phase, Dimension::Angle, Range::Any)?.unwrap_or(0.0),
    })
}

/// A length that the layer gives, or the strand for all layers.
fn layer_or_strand(
    layer: &At,
    strand: &At,
    name: &str,
    own: &Option<Scalar>,
    common: &Option<Scalar>,
    range: Range,
) -> Result<Option<f64>> {
    match own {
        Some(_) => layer.optional(name, own, Dimension::Length, range),
        None => strand.optional(name, common, Dimension::Length, range),
    }
}

/// `None` for `auto`, except that a single wire in the first layer lies on the axis.
fn lay_radius(at: &At, raw: Option<&Scalar>, wires: usize, index: usize) -> Result<Option<f64>> {
    let auto = match raw {
        None => true,
        Some(Scalar::Text(text)) => text == "auto",
        Some(Scalar::Number(_)) => false,
    };
    if auto {
        return Ok((wires == 1 && index == 0).then_some(0.0));
    }
    let here = at.key("lay_radius");
    let radius = raw.map(|raw| here.quantity(raw, Dimension::Length, Range::NotNegative)).transpose()?;
    if radius == Some(0.0) && wires > 1 {
        return Err(
            here.error(format!("{wires} wires cannot all lie on the axis"), "give a radius, or lay_radius = \"auto\"")
        );
    }
    Ok(radius)
}

/// Resolves all `[[wire]]`; one that takes all wires of a file becomes as many.
pub(super) fn wires(at: &At, raw: &[RawWire], folder: &Path, materials: &Materials) -> Result<Vec<WireSpec>> {
    let mut wires = Vec::new();
    for (index, raw) in raw.iter().enumerate() {
        let here = at.element(index);
        let material = materials.number(&here, raw.material.as_ref())?;
        match &raw.file {
            Some(file) => wires.extend(wires_of_file(&here, raw, file, folder, material)?),
            None => wires.push(straight_wire(&here, raw, material)?),
        }
    }
    Ok(wires)
}

fn straight_wire(at: &At, raw: &RawWire, material: usize) -> Result<WireSpec> {
    let why = "has no effect without `file`";
    at.refuse("index", &raw.index, why)?;
    at.refuse("all", &raw.all, why)?;
    let (Some(from), Some(to)) = (&raw.from, &raw.to) else {
        let example = "[\"0 mm\", \"0 mm\", \"20 mm\"]";
        let missing = if raw.from.is_none() { "from" } else { "to" };
        return Err(at.missing(missing, example));
    };
    let from = at.key("from").vector(from, Dimension::Length)?;
    let to = at.key("to").vector(to, Dimension::Length)?;
    if from == to {
        return Err(at.key("to").error("the wire has no length: `to` is the same point as `from`", ""));
    }
    let diameter = at.required("diameter", &raw.diameter, Dimension::Length, Range::Positive)?;
    let path = PathSpec::Straight { from, to };
    wire(
        at,
        raw,
        WireSpec { layer: DEFAULT_LAYER.into(), material, diameter, path, velocity: DVec3::ZERO, spin: DVec3::ZERO },
    )
}

/// The wire `own` with what `raw` says of every wire.
fn wire(at: &At, raw: &RawWire, own: WireSpec) -> Result<WireSpec> {
    Ok(WireSpec {
        layer: raw.layer.clone().unwrap_or(own.layer),
        velocity: at.vector_or_zero("velocity", &raw.velocity, Dimension::Velocity)?,
        spin: at.vector_or_zero("spin", &raw.spin, Dimension::AngularVelocity)?,
        ..own
    })
}

fn wires_of_file(at: &At, raw: &RawWire, file: &str, folder: &Path, material: usize) -> Result<Vec<WireSpec>> {
    at.refuse("from", &raw.from, "has no effect beside `file`")?;
    at.refuse("to", &raw.to, "has no effect beside `file`")?;
    let (path, centrelines) = read_centrelines(at, file, folder)?;
    let numbers = chosen_wires(at, raw, centrelines.len())?;
    let given = at.optional("diameter", &raw.diameter, Dimension::Length, Range::Positive)?;
    numbers
        .map(|index| {
            let CentrelineWire { layer, diameter, points } = &centrelines[index];
            refuse_two_diameters(at, given, *diameter, index)?;
            let diameter = given.or(*diameter).ok_or_else(|| at.missing("diameter", "\"0.39 mm\""))?;
            let path = PathSpec::File { file: path.clone(), index, points: points.clone() };
            let (layer, velocity, spin) = (layer.clone(), DVec3::ZERO, DVec3::ZERO);
            wire(at, raw, WireSpec { layer, material, diameter, path, velocity, spin })
        })
        .collect()
}

/// Refuses a diameter that differs from the one in the file's header.
fn refuse_two_diameters(at: &At, scene: Option<f64>, header: Option<f64>, index: usize) -> Result<()> {
    match (scene, header) {
        (Some(scene), Some(header)) if (scene - header).abs() > SAME_DIAMETER * header => {
            let [scene, header] = [scene, header].map(|d| units::format(d, Dimension::Length));
            let what = format!("`diameter` is {scene}, but the header of wire {} of the file says {header}", index + 1);
            Err(at
                .key("diameter")
                .error(what, "remove one of the two: the layout of the wires belongs to one diameter"))
        }
        _ => Ok(()),
    }
}

/// The file's full path, so that the resolved scene may be kept in any folder, and its wires.
fn read_centrelines(at: &At, file: &str, folder: &Path) -> Result<(PathBuf, Vec<CentrelineWire>)> {
    let unreadable =
        |error: Error| at.key("file").error(error.to_string(), "the path is taken from the scene's folder");
    let given = folder.join(file);
    let path = std::path::absolute(&given).map_err(|cause| unreadable(Error::io("cannot read", &given, cause)))?;
    let bytes = regular::read(&path, regular::LONGEST_TABLE).map_err(unreadable)?;
    let text = centreline_text::decode(&bytes).ok_or_else(|| {
        let what = format!("{} is no text in UTF-8, nor in UTF-16 with its mark", path.display());
        at.key("file").error(what, "save it as plain text")
    })?;
    let wires = centreline_text::parse(&text, &path)?;
    Ok((path, wires))
}

/// Which wires of a file of `len` a scene takes.
fn chosen_wires(at: &At, raw: &RawWire, len: usize) -> Result<std::ops::Range<usize>> {
    match (raw.all.unwrap_or(false), raw.index) {
        (true, Some(_)) => Err(at.key("index").refused("has no effect beside `all = true`")),
        (true, None) => Ok(0..len),
        (false, None) if len == 1 => Ok(0..1),
        (false, None) => Err(at.key("file").error(
            format!("the file has {len} wires, and the scene does not say which"),
            "add `index`, from 0, or `all = true`",
        )),
        (false, Some(index)) => {
            let number = at.key("index").count(index, 0)? as usize;
            match number < len {
                true => Ok(number..number + 1),
                false => {
                    let what = format!("`index` is {number}, but the file has {}", counted(len, "wire"));
                    Err(at.key("index").error(what, "they are numbered from 0"))
                }
            }
        }
    }
}

/// Resolves all `[[sphere]]`.
pub(super) fn spheres(at: &At, raw: &[RawSphere], materials: &Materials) -> Result<Vec<SphereSpec>> {
    raw.iter().enumerate().map(|(index, raw)| sphere(&at.element(index), raw, materials)).collect()
}

fn sphere(at: &At, raw: &RawSphere, materials: &Materials) -> Result<SphereSpec> {
    let example = "[\"0 mm\", \"0 mm\", \"5 mm\"]";
    let position = raw.position.as_ref().ok_or_else(|| at.missing("position", example))?;
    Ok(SphereSpec {
        material: materials.number(at, raw.material.as_ref())?,
        diameter: at.required("diameter", &raw.diameter, Dimension::Length, Range::Positive)?,
        position: at.key("position").vector(position, Dimension::Length)?,
        velocity: at.vector_or_zero("velocity", &raw.velocity, Dimension::Velocity)?,
        spin: at.vector_or_zero("spin", &raw.spin, Dimension::AngularVelocity)?,
    })
}

/// Number of bodies: strand wires, wires, spheres.
pub(super) fn count(strand: Option<&StrandSpec>, wires: &[WireSpec], spheres: &[SphereSpec]) -> usize {
    let in_strand: usize = strand.map_or(0, |strand| strand.layers.iter().map(|layer| layer.wires).sum());
    in_strand + wires.len() + spheres.len()
}

/// Length along z of all that grips can hold (m); `None` without wires.
pub(super) fn extent(strand: Option<&StrandSpec>, wires: &[WireSpec]) -> Option<f64> {
    let ends = strand.map(|strand| [0.0, strand.length]).into_iter().flatten();
    let heights = wires.iter().flat_map(|wire| match &wire.path {
        PathSpec::Straight { from, to } => vec![from.z, to.z],
        PathSpec::File { points, .. } => points.iter().map(|point| point.z).collect(),
    });
    let (least, greatest) = ends
        .chain(heights)
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, greatest), z| (z.min(least), z.max(greatest)));
    (least <= greatest).then_some(greatest - least)
}
