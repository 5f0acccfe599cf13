//! Raw tables → [`Spec`]: units read, defaults filled in, values checked against each other. Every error points at the
//! key that is wrong.

use super::at::{At, Range, can_name_a_folder};
use super::look::{FRAME_SIDE, ZOOM};
use super::raw::*;
use super::resolve_materials::{self, GivenHardness, Materials};
use super::resolve_picture::supersampling;
use super::spec::*;
use super::{resolve_bodies, resolve_drive, resolve_picture, resolve_rigid};
use crate::base::error::{Error, Result};
use crate::base::units::{Dimension, shortest};
use crate::law::damping::{hertzian_fraction, ratio_of_restitution};
use std::path::Path;

/// Friction between bare copper wires where a scene gives none (-) (the reference paper's).
const FRICTION: f64 = 0.2;
/// Neighbour skin over the largest diameter (-).
const SKIN: f64 = 0.15;
/// Δt √(k/m*) of a contact (-): eight steps to a half period.
const RESOLVED: f64 = 0.4;
/// Spacing over diameter from which a wire fits between two neighbouring spheres of another (-).
const GAP: f64 = 2.0;
/// Evenly spread snapshots where bonds can break: what they leave of the usual number is for the ruptures.
const SNAPSHOTS_IF_IT_BREAKS: usize = 60;

/// Resolves a scene. `name` is that of its file, `folder` where its centreline files are looked for.
pub(super) fn resolve(at: &At, raw: &RawScene, name: &str, folder: &Path) -> Result<Spec> {
    let materials = Materials::new(at, raw)?;
    let strand =
        raw.strand.as_ref().map(|raw| resolve_bodies::strand(&at.key("strand"), raw, &materials)).transpose()?;
    let wires = resolve_bodies::wires(&at.key("wire"), &raw.wire, folder, &materials)?;
    let spheres = resolve_bodies::spheres(&at.key("sphere"), &raw.sphere, &materials)?;
    if strand.is_none() && wires.is_empty() && spheres.is_empty() {
        let what = if raw.body.is_empty() { "the scene has no body" } else { "the scene has rigid bodies alone" };
        return Err(at.error(what, "add a [strand], a [[wire]] or a [[sphere]]"));
    }
    let bodies = resolve_bodies::count(strand.as_ref(), &wires, &spheres);
    let extent = resolve_bodies::extent(strand.as_ref(), &wires);
    let spacing = at.ratio_or("spacing", &raw.spacing, 1.0, Range::Positive)?;
    let mut used = materials.of_bodies();
    let contact = contact(&at.key("contact"), raw.contact.as_ref(), &materials, &mut used)?;
    let rigids = rigids(at, raw, &materials, contact.as_ref())?;
    let (first, further) = resolve_materials::in_order(used);
    let breaks = first.bond.rupture.is_some() || further.iter().any(|further| further.bond.rupture.is_some());
    let wire_count = strand.as_ref().map_or(0, |s| s.layers.iter().map(|l| l.wires).sum()) + wires.len();
    if wire_count > 1 {
        refuse_gaps(at, spacing, contact.as_ref())?;
    }
    let mut output = output(&at.key("output"), &raw.output, breaks)?;
    let mut layers: Vec<&str> =
        strand.iter().flat_map(|strand| &strand.layers).map(|layer| layer.name.as_str()).collect();
    for wire in &wires {
        if !layers.contains(&wire.layer.as_str()) {
            layers.push(&wire.layer);
        }
    }
    let context = resolve_picture::Context { layers, wires: wire_count, pulled: raw.grip.is_some(), output: &output };
    output.pictures = resolve_picture::pictures(&at.key("output").key("picture"), &raw.output.picture, &context)?;
    let grip = raw.grip.as_ref().map(|raw| resolve_drive::grip(&at.key("grip"), raw, extent)).transpose()?;
    Ok(Spec {
        name: scene_name(at, raw, name)?,
        about: about(at, raw)?,
        seed: at.count_or("seed", raw.seed, 1, 0)?,
        contact,
        spacing,
        holds: resolve_drive::holds(&at.key("hold"), &raw.hold, bodies)?,
        time: time(&at.key("time"), &raw.time)?,
        stop: resolve_drive::stop(&at.key("stop"), &raw.stop, grip.as_ref(), breaks)?,
        output,
        plan: match raw.plan {
            None | Some(RawPlan::Auto) => PlanMode::Auto,
            Some(RawPlan::General) => PlanMode::General,
        },
        material_name: first.name,
        material: first.material,
        bond: first.bond,
        further,
        strand,
        wires,
        spheres,
        rigids,
        grip,
    })
}

/// Rigid bodies: none where `contact.normal = "none"` leaves contacts out.
fn rigids(at: &At, raw: &RawScene, materials: &Materials, contact: Option<&ContactSpec>) -> Result<Vec<RigidSpec>> {
    let here = at.key("body");
    if raw.contact.is_none() && !raw.body.is_empty() {
        let what = "a rigid body does nothing but touch, and the scene has no contacts";
        return Err(here.element(0).error(what, "add [contact] with a law, for example normal = \"hertz\""));
    }
    let friction = contact.map_or(FRICTION, |contact| contact.friction);
    let rigids = resolve_rigid::rigids(&here, &raw.body, materials, friction)?;
    Ok(if contact.is_some() { rigids } else { Vec::new() })
}

/// Refuses chains of spheres with gaps that another wire passes through unseen.
fn refuse_gaps(at: &At, spacing: f64, contact: Option<&ContactSpec>) -> Result<()> {
    if spacing < GAP || contact.is_none_or(|contact| contact.shape != Shape::Sphere) {
        return Ok(());
    }
    let what = format!("spheres {spacing} diameters apart leave gaps that another wire passes through");
    Err(at.key("spacing").error(what, format!("take a spacing below {GAP}, or smooth wires: contact.shape = \"wire\"")))
}

fn scene_name(at: &At, raw: &RawScene, file: &str) -> Result<String> {
    let Some(name) = &raw.name else {
        return Ok(file.to_owned());
    };
    if !can_name_a_folder(name) {
        let what = format!("`name` is {name:?}, which cannot name a folder");
        return Err(at.key("name").error(what, "use letters, digits, - and _"));
    }
    Ok(name.clone())
}

fn about(at: &At, raw: &RawScene) -> Result<String> {
    let about = raw.about.as_ref().ok_or_else(|| at.missing("about", "\"What this scene shows.\""))?;
    match about.trim() {
        "" => Err(at.key("about").error("`about` is empty", "say in a sentence what the scene shows")),
        text => Ok(text.to_owned()),
    }
}

/// Resolves `[contact]`, and the limiting pressures of the materials in `used`.
fn contact(
    at: &At,
    raw: Option<&RawContact>,
    materials: &Materials,
    used: &mut [MaterialSpec],
) -> Result<Option<ContactSpec>> {
    let Some(raw) = raw else { return Ok(None) };
    // Values are checked even where `normal = "none"` leaves them without effect: switching contacts off for one run
    // must not need the rest of the table to go.
    let friction = at.ratio_or("friction", &raw.friction, FRICTION, Range::NotNegative)?;
    let mut damping = at.ratio_or("damping", &raw.damping, 0.0, Range::NotNegative)?;
    let restitution = at.optional("restitution", &raw.restitution, Dimension::Ratio, Range::Fraction)?;
    if let Some(coefficient) = restitution {
        at.refuse("damping", &raw.damping, "and `restitution` both say how contacts are damped")?;
        damping = hertzian_fraction(ratio_of_restitution(coefficient));
    }
    let skin = at.ratio_or("skin", &raw.skin, SKIN, Range::Positive)?;
    let given = GivenHardness::of_contact(at, raw)?;
    let pairs = materials.pairs(&at.key("pair"), &raw.pair)?;
    let mut hardness = None;
    let normal = match raw.normal.ok_or_else(|| at.missing("normal", "\"thornton\""))? {
        RawNormal::None => return Ok(None),
        RawNormal::Hertz => {
            let why = "belongs to contact.normal = \"thornton\" only";
            at.refuse("hardness_factor", &raw.hardness_factor, why)?;
            at.refuse("hardness_strain", &raw.hardness_strain, why)?;
            at.refuse("limiting_pressure", &raw.limiting_pressure, why)?;
            materials.refuse_hardness(why)?;
            NormalSpec::Hertz
        }
        RawNormal::Thornton => {
            materials.limit_pressures(at, &given, used)?;
            hardness = used[0].hardness;
            NormalSpec::Thornton { limiting_pressure: used[0].limiting_pressure.unwrap_or(f64::INFINITY) }
        }
    };
    Ok(Some(ContactSpec {
        normal,
        hardness,
        tangential: match raw.tangential.unwrap_or(RawTangential::Mindlin) {
            RawTangential::Mindlin => Some(TangentialSpec::Mindlin),
            RawTangential::MindlinDeresiewicz => Some(TangentialSpec::MindlinDeresiewicz),
            RawTangential::None => None,
        },
        friction,
        pairs,
        shape: match raw.shape.unwrap_or(RawShape::Sphere) {
            RawShape::Sphere => Shape::Sphere,
            RawShape::Wire => Shape::Wire,
        },
        damping,
        restitution,
        skin,
    }))
}

fn time(at: &At, raw: &RawTime) -> Result<TimeSpec> {
    Ok(TimeSpec {
        safety: at.ratio_or("safety", &raw.safety, 0.8, Range::Fraction)?,
        contact_resolution: at.ratio_or("contact_resolution", &raw.contact_resolution, RESOLVED, Range::Positive)?,
        step: at.optional("step", &raw.step, Dimension::Time, Range::Positive)?,
        mass_scale: at.ratio_or("mass_scale", &raw.mass_scale, 1.0, Range::Positive)?,
        inertia_scale: at.ratio_or("inertia_scale", &raw.inertia_scale, 1.0, Range::Positive)?,
        kinetic_limit: at.ratio_or("kinetic_limit", &raw.kinetic_limit, 0.05, Range::Positive)?,
        mismatch_limit: at.ratio_or("mismatch_limit", &raw.mismatch_limit, 0.05, Range::Positive)?,
    })
}

fn output(at: &At, raw: &RawOutput, breaks: bool) -> Result<OutputSpec> {
    let usual = OutputSpec::default();
    let [width, height] = raw.frame_size.unwrap_or(usual.frame_size.map(i64::from));
    let side = |index: usize, pixels: i64| -> Result<u32> {
        let fits = u32::try_from(pixels).ok().filter(|pixels| FRAME_SIDE.contains(pixels));
        let Some(fits) = fits else {
            let what = format!(
                "`frame_size` holds {pixels}, but a side must have {} to {} pixels",
                FRAME_SIDE.start(),
                FRAME_SIDE.end()
            );
            return Err(at.key("frame_size").element(index).error(what, "for example [1280, 720]"));
        };
        Ok(fits)
    };
    let snapshots = if breaks { SNAPSHOTS_IF_IT_BREAKS } else { usual.snapshots };
    let density = at.ratio_or("rupture_density", &raw.rupture_density, usual.rupture_density, Range::AtLeastOne)?;
    Ok(OutputSpec {
        samples: at.count_or("samples", raw.samples, usual.samples as u64, 1)? as usize,
        snapshots: at.count_or("snapshots", raw.snapshots, snapshots as u64, 1)? as usize,
        rupture_density: density,
        checkpoint: checkpoint(&at.key("checkpoint"), &raw.checkpoint)?,
        frame_size: [side(0, width)?, side(1, height)?],
        colour: raw.colour.unwrap_or(usual.colour),
        views: raw.views.clone().unwrap_or(usual.views),
        theme: raw.theme.unwrap_or(usual.theme),
        camera: camera(&at.key("camera"), &raw.camera)?,
        also: once(&at.key("also"), &raw.also, Format::word)?,
        tables: once(&at.key("tables"), &raw.tables, Table::word)?,
        supersampling: supersampling(&at.key("supersampling"), raw.supersampling, usual.supersampling)?,
        pictures: Vec::new(),
    })
}

/// Words of a list, each once.
fn once<W: Copy + PartialEq>(at: &At, raw: &Option<Vec<W>>, word: fn(W) -> &'static str) -> Result<Vec<W>> {
    let raw = raw.as_deref().unwrap_or_default();
    match (1..raw.len()).find(|index| raw[..*index].contains(&raw[*index])) {
        None => Ok(raw.into()),
        Some(twice) => {
            let what = format!("`{}` names \"{}\" twice", at.name(), word(raw[twice]));
            Err(at.element(twice).error(what, "once is enough"))
        }
    }
}

fn checkpoint(at: &At, raw: &Option<Scalar>) -> Result<CheckpointSpec> {
    match raw {
        None => Ok(CheckpointSpec::Auto),
        Some(Scalar::Text(word)) if word == "none" => Ok(CheckpointSpec::None),
        Some(Scalar::Text(word)) if word == "auto" => Ok(CheckpointSpec::Auto),
        Some(Scalar::Number(steps)) if steps.fract() == 0.0 && (1.0..1e15).contains(steps) => {
            Ok(CheckpointSpec::Steps(*steps as u64))
        }
        Some(Scalar::Number(steps)) => Err(at.error(
            format!("`checkpoint` is {}, but a number without a unit is one of steps, 1 or more", shortest(*steps)),
            "for example 10000, \"30 s\" or \"none\"",
        )),
        Some(text) => Ok(CheckpointSpec::WallTime(at.quantity(text, Dimension::Time, Range::Positive)?)),
    }
}

fn camera(at: &At, raw: &RawCamera) -> Result<CameraSpec> {
    let angle = |name, raw| Ok::<f64, Error>(at.optional(name, raw, Dimension::Angle, Range::Any)?.unwrap_or(0.0));
    let zoom = at.ratio_or("zoom", &raw.zoom, CameraSpec::default().zoom, Range::Positive)?;
    if !ZOOM.contains(&zoom) {
        let what = format!("`zoom` is {}, but must be between {} and {}", shortest(zoom), ZOOM.start(), ZOOM.end());
        return Err(at.key("zoom").error(what, "for example zoom = 2"));
    }
    Ok(CameraSpec {
        azimuth: angle("azimuth", &raw.azimuth)?,
        elevation: angle("elevation", &raw.elevation)?,
        zoom,
        focus_z: at.optional("focus_z", &raw.focus_z, Dimension::Length, Range::Any)?,
    })
}
