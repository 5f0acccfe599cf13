//! A resolved scene as TOML that reads back to an equal [`Spec`].

use super::picture::When;
use super::spec::*;
use crate::base::units::{self, Dimension};
use glam::DVec3;
use std::fmt::Write;

/// Writes a resolved scene. [`super::parse`] of the text gives an equal [`Spec`], bit for bit.
pub fn to_toml(spec: &Spec) -> String {
    let mut out = Lines::default();
    out.comment("Resolved scene, written by strandsnap: every default filled in.");
    out.entry("name", text(&spec.name));
    out.entry("about", text(&spec.about));
    out.entry("seed", spec.seed.to_string());
    out.entry("spacing", number(spec.spacing));
    out.entry("plan", text(plan_name(spec.plan)));
    materials(&mut out, spec);
    materials_of_rigids(&mut out, spec);
    contact(&mut out, spec);
    strand(&mut out, spec);
    spec.wires.iter().for_each(|wire| self::wire(&mut out, spec, wire));
    spec.spheres.iter().for_each(|sphere| self::sphere(&mut out, spec, sphere));
    spec.rigids.iter().for_each(|rigid| self::rigid(&mut out, rigid));
    grip(&mut out, spec.grip.as_ref());
    spec.holds.iter().for_each(|hold| self::hold(&mut out, hold));
    time(&mut out, &spec.time);
    stop(&mut out, &spec.stop);
    output(&mut out, &spec.output);
    out.text
}

#[derive(Default)]
struct Lines {
    text: String,
}

impl Lines {
    fn comment(&mut self, words: &str) {
        let _ = writeln!(self.text, "# {words}");
    }

    fn table(&mut self, header: &str) {
        let _ = writeln!(self.text, "\n{header}");
    }

    fn entry(&mut self, key: &str, value: String) {
        let _ = writeln!(self.text, "{key} = {value}");
    }

    fn quantity(&mut self, key: &str, value: f64, dimension: Dimension) {
        self.entry(key, quantity(value, dimension));
    }

    /// An array of one line, left out when it is empty.
    fn list(&mut self, key: &str, values: impl Iterator<Item = String>) {
        let values: Vec<String> = values.collect();
        if !values.is_empty() {
            self.entry(key, format!("[{}]", values.join(", ")));
        }
    }

    /// A vector, left out when zero, which is its default.
    fn vector(&mut self, key: &str, value: DVec3, dimension: Dimension) {
        if value != DVec3::ZERO {
            self.entry(key, vector(value, dimension));
        }
    }
}

/// A TOML string.
fn text(words: &str) -> String {
    toml_edit::Value::from(words).to_string()
}

/// A TOML float with all its digits.
fn number(value: f64) -> String {
    format!("{value:?}")
}

fn quantity(value: f64, dimension: Dimension) -> String {
    match value.is_infinite() {
        true => text("inf"),
        false => text(&units::format(value, dimension)),
    }
}

fn vector(value: DVec3, dimension: Dimension) -> String {
    let [x, y, z] = value.to_array().map(|value| quantity(value, dimension));
    format!("[{x}, {y}, {z}]")
}

fn plan_name(plan: PlanMode) -> &'static str {
    match plan {
        PlanMode::Auto => "auto",
        PlanMode::General => "general",
    }
}

/// The materials of which there are bodies, in the order in which a scene is read.
fn materials(out: &mut Lines, spec: &Spec) {
    for one in spec.materials() {
        match one.name {
            None => {
                out.table("[material]");
                material(out, one.material);
                out.table("[bond]");
                bond(out, one.bond);
            }
            Some(name) => {
                out.table(&format!("[materials.{}]", key(name)));
                material(out, one.material);
                bond(out, one.bond);
                if spec.has_several_materials() {
                    hardness(out, spec, name);
                }
            }
        }
    }
}

/// The materials of which there are rigid bodies alone.
fn materials_of_rigids(out: &mut Lines, spec: &Spec) {
    let mut written: Vec<Option<&str>> = spec.materials().map(|one| one.name).collect();
    for rigid in &spec.rigids {
        let name = rigid.material_name.as_deref();
        if written.contains(&name) {
            continue;
        }
        written.push(name);
        out.table(&name.map_or("[material]".into(), |name| format!("[materials.{}]", key(name))));
        material(out, &rigid.material);
    }
}

/// A name as a key of TOML.
fn key(name: &str) -> String {
    toml_edit::Key::new(name).to_string()
}

/// The limiting pressure of a named material beside others; that of a single one stands in `[contact]`.
fn hardness(out: &mut Lines, spec: &Spec, name: &str) {
    let first = spec.contact.as_ref().and_then(|contact| contact.hardness);
    let rules = std::iter::once(first).chain(spec.further.iter().map(|further| further.hardness));
    let found = spec.materials().zip(rules).find(|(one, _)| one.name == Some(name));
    let Some((OneMaterial { limiting_pressure: Some(pressure), .. }, rule)) = found else { return };
    limit(out, pressure, rule);
}

/// A limiting pressure (Pa), or the rule that gives it.
fn limit(out: &mut Lines, pressure: f64, rule: Option<Hardness>) {
    match rule {
        Some(Hardness { factor, strain }) => {
            out.entry("hardness_factor", number(factor));
            out.entry("hardness_strain", number(strain));
        }
        None => out.quantity("limiting_pressure", pressure, Dimension::Pressure),
    }
}

/// Names the material of a body, if it has one.
fn named(out: &mut Lines, spec: &Spec, number: usize) {
    if let Some(name) = spec.material_at(number).name {
        out.entry("material", text(name));
    }
}

fn material(out: &mut Lines, material: &Material) {
    out.quantity("density", material.density, Dimension::Density);
    out.quantity("young", material.young, Dimension::Pressure);
    out.entry("poisson", number(material.poisson));
}

fn bond(out: &mut Lines, bond: &BondSpec) {
    match &bond.law {
        BondLawSpec::Elastic => out.entry("law", text("elastic")),
        BondLawSpec::ElastoPlastic(law) => {
            out.entry("law", text("elasto-plastic"));
            out.entry("hardening", hardening(law));
        }
    }
    let [axial, shear, bending, torsion] = bond.damping.map(number);
    out.entry("damping", format!("{{ axial = {axial}, shear = {shear}, bending = {bending}, torsion = {torsion} }}"));
    if let Some(rupture) = &bond.rupture {
        out.entry("rupture", self::rupture(rupture));
    }
}

fn hardening(law: &HardeningSpec) -> String {
    let stress = |value| quantity(value, Dimension::Pressure);
    match law {
        HardeningSpec::Voce { yield_stress, saturation, rate, linear } => format!(
            "{{ form = \"voce\", yield_stress = {}, saturation = {}, rate = {}, linear = {} }}",
            stress(*yield_stress),
            stress(*saturation),
            number(*rate),
            stress(*linear)
        ),
        HardeningSpec::Swift { strength, prestrain, exponent } => format!(
            "{{ form = \"swift\", strength = {}, prestrain = {}, exponent = {} }}",
            stress(*strength),
            number(*prestrain),
            number(*exponent)
        ),
        HardeningSpec::Ludwik { yield_stress, strength, exponent } => format!(
            "{{ form = \"ludwik\", yield_stress = {}, strength = {}, exponent = {} }}",
            stress(*yield_stress),
            stress(*strength),
            number(*exponent)
        ),
        HardeningSpec::Table(points) => {
            let points: Vec<String> =
                points.iter().map(|[strain, value]| format!("[{}, {}]", number(*strain), stress(*value))).collect();
            format!("{{ form = \"table\", points = [{}] }}", points.join(", "))
        }
    }
}

fn rupture(rupture: &RuptureSpec) -> String {
    let criterion = match rupture.criterion {
        RuptureCriterion::PlasticStrain { strain } => {
            format!("criterion = \"plastic-strain\", strain = {}", number(strain))
        }
        RuptureCriterion::FibreStrain { strain } => {
            format!("criterion = \"fibre-strain\", strain = {}", number(strain))
        }
        RuptureCriterion::BeamStress { tensile, shear, moment_share } => format!(
            "criterion = \"beam-stress\", tensile = {}, shear = {}, moment_share = {}",
            quantity(tensile, Dimension::Pressure),
            quantity(shear, Dimension::Pressure),
            number(moment_share)
        ),
    };
    format!("{{ {criterion}, weibull_modulus = {} }}", number(rupture.weibull_modulus))
}

fn contact(out: &mut Lines, spec: &Spec) {
    let Some(contact) = &spec.contact else { return };
    out.table("[contact]");
    match contact.normal {
        NormalSpec::Hertz => out.entry("normal", text("hertz")),
        NormalSpec::Thornton { limiting_pressure } => {
            out.entry("normal", text("thornton"));
            let unnamed = spec.further.iter().find(|further| further.name.is_none());
            match (spec.has_several_materials() && spec.material_name.is_some(), unnamed) {
                (false, _) => limit(out, limiting_pressure, contact.hardness),
                (true, Some(one)) => limit(out, one.limiting_pressure.unwrap_or(f64::INFINITY), one.hardness),
                // Named materials have their own.
                (true, None) => {}
            }
        }
    }
    let tangential = match contact.tangential {
        Some(TangentialSpec::Mindlin) => "mindlin",
        Some(TangentialSpec::MindlinDeresiewicz) => "mindlin-deresiewicz",
        None => "none",
    };
    out.entry("tangential", text(tangential));
    out.entry("friction", number(contact.friction));
    let shape = match contact.shape {
        Shape::Sphere => "sphere",
        Shape::Wire => "wire",
    };
    out.entry("shape", text(shape));
    match contact.restitution {
        Some(coefficient) => out.entry("restitution", number(coefficient)),
        None => out.entry("damping", number(contact.damping)),
    }
    out.entry("skin", number(contact.skin));
    for pair in &contact.pairs {
        let names = pair.materials.map(|number| text(spec.material_at(number).label()));
        out.table("[[contact.pair]]");
        out.entry("materials", format!("[{}, {}]", names[0], names[1]));
        out.entry("friction", number(pair.friction));
    }
}

fn strand(out: &mut Lines, spec: &Spec) {
    let Some(strand) = &spec.strand else { return };
    out.table("[strand]");
    out.quantity("length", strand.length, Dimension::Length);
    for layer in &strand.layers {
        out.table("[[strand.layer]]");
        out.entry("name", text(&layer.name));
        out.entry("wires", layer.wires.to_string());
        out.quantity("wire_diameter", layer.wire_diameter, Dimension::Length);
        match layer.lay_radius {
            Some(radius) => out.quantity("lay_radius", radius, Dimension::Length),
            None => out.entry("lay_radius", text("auto")),
        }
        out.quantity("pitch", layer.pitch, Dimension::Length);
        out.entry("lay", text(if layer.lay > 0.0 { "right" } else { "left" }));
        out.quantity("phase", layer.phase, Dimension::Angle);
        named(out, spec, layer.material);
    }
}

fn wire(out: &mut Lines, spec: &Spec, wire: &WireSpec) {
    out.table("[[wire]]");
    out.entry("layer", text(&wire.layer));
    named(out, spec, wire.material);
    out.quantity("diameter", wire.diameter, Dimension::Length);
    match &wire.path {
        PathSpec::Straight { from, to } => {
            out.entry("from", vector(*from, Dimension::Length));
            out.entry("to", vector(*to, Dimension::Length));
        }
        PathSpec::File { file, index, .. } => {
            out.entry("file", text(&file.to_string_lossy()));
            out.entry("index", index.to_string());
        }
    }
    out.vector("velocity", wire.velocity, Dimension::Velocity);
    out.vector("spin", wire.spin, Dimension::AngularVelocity);
}

fn sphere(out: &mut Lines, spec: &Spec, sphere: &SphereSpec) {
    out.table("[[sphere]]");
    named(out, spec, sphere.material);
    out.quantity("diameter", sphere.diameter, Dimension::Length);
    out.entry("position", vector(sphere.position, Dimension::Length));
    out.vector("velocity", sphere.velocity, Dimension::Velocity);
    out.vector("spin", sphere.spin, Dimension::AngularVelocity);
}

fn rigid(out: &mut Lines, rigid: &RigidSpec) {
    out.table("[[body]]");
    out.entry("name", text(&rigid.name));
    out.entry("shape", text(rigid.shape.word()));
    if let Some(name) = &rigid.material_name {
        out.entry("material", text(name));
    }
    out.entry("position", vector(rigid.position, Dimension::Length));
    let direction = |v: DVec3| format!("[{}]", v.to_array().map(number).join(", "));
    match rigid.shape {
        RigidShape::Plane { normal } => out.entry("normal", direction(normal)),
        RigidShape::Cylinder { axis, diameter, length } => {
            out.entry("axis", direction(axis));
            out.quantity("diameter", diameter, Dimension::Length);
            if let Some(length) = length {
                out.quantity("length", length, Dimension::Length);
            }
        }
        RigidShape::Sphere { axis, diameter } => {
            out.quantity("diameter", diameter, Dimension::Length);
            if rigid.motion.spin != 0.0 {
                out.entry("axis", direction(axis));
            }
        }
    }
    let RigidMotion { velocity, spin, ramp, duration } = rigid.motion;
    out.vector("velocity", velocity, Dimension::Velocity);
    if spin != 0.0 {
        out.quantity("spin", spin, Dimension::AngularVelocity);
    }
    if rigid.motion.moves() {
        out.quantity("ramp", ramp, Dimension::Time);
    }
    if let Some(duration) = duration {
        out.quantity("duration", duration, Dimension::Time);
    }
    out.entry("friction", number(rigid.friction));
}

fn grip(out: &mut Lines, grip: Option<&GripSpec>) {
    let Some(grip) = grip else { return };
    out.table("[grip]");
    match grip.kind {
        GripKind::All => out.entry("kind", text("all")),
        GripKind::Jaw { pressure } => {
            out.entry("kind", text("jaw"));
            out.quantity("clamp_pressure", pressure, Dimension::Pressure);
        }
    }
    out.quantity("length", grip.length, Dimension::Length);
    match grip.drive {
        DriveSpec::Speed(speed) => out.quantity("speed", speed, Dimension::Velocity),
        DriveSpec::Cyclic { amplitude, frequency } => {
            out.quantity("displacement_amplitude", amplitude, Dimension::Length);
            out.quantity("frequency", frequency, Dimension::Frequency);
        }
    }
    if let Some(adaptive) = &grip.adaptive {
        let fastest = quantity(adaptive.fastest, Dimension::Velocity);
        let [from, kinetic, passages] = [adaptive.from, adaptive.kinetic, adaptive.passages].map(number);
        let keys = format!("from = {from}, fastest = {fastest}, kinetic = {kinetic}, passages = {passages}");
        out.entry("adaptive", format!("{{ {keys} }}"));
    }
    out.quantity("rotation_rate", grip.rotation_rate, Dimension::AngularVelocity);
    out.entry("free_rotation", grip.free_rotation.to_string());
}

fn hold(out: &mut Lines, hold: &HoldSpec) {
    out.table("[[hold]]");
    out.entry("body", hold.body.to_string());
    let part = match hold.part {
        BodyPart::Start => "start",
        BodyPart::End => "end",
        BodyPart::All => "all",
    };
    out.entry("part", text(part));
    let names = ["x", "y", "z", "rx", "ry", "rz"];
    let fixed: Vec<String> =
        names.iter().zip(hold.fixed).filter(|(_, fixed)| *fixed).map(|(name, _)| text(name)).collect();
    out.entry("fix", format!("[{}]", fixed.join(", ")));
    out.vector("velocity", hold.velocity, Dimension::Velocity);
    out.vector("spin", hold.spin, Dimension::AngularVelocity);
    out.vector("force", hold.force, Dimension::Force);
    out.vector("moment", hold.moment, Dimension::Moment);
    out.quantity("ramp", hold.ramp, Dimension::Time);
}

fn time(out: &mut Lines, time: &TimeSpec) {
    out.table("[time]");
    out.entry("safety", number(time.safety));
    out.entry("contact_resolution", number(time.contact_resolution));
    if let Some(step) = time.step {
        out.quantity("step", step, Dimension::Time);
    }
    out.entry("mass_scale", number(time.mass_scale));
    out.entry("inertia_scale", number(time.inertia_scale));
    out.entry("kinetic_limit", number(time.kinetic_limit));
    out.entry("mismatch_limit", number(time.mismatch_limit));
}

fn stop(out: &mut Lines, stop: &StopSpec) {
    out.table("[stop]");
    if let Some(strain) = stop.strain {
        out.entry("strain", number(strain));
    }
    if let Some(fraction) = stop.stress_fraction {
        out.entry("stress_fraction", number(fraction));
    }
    if let Some(strain) = stop.strain_after_drop {
        out.entry("strain_after_drop", number(strain));
    }
    if let Some(time) = stop.time {
        out.quantity("time", time, Dimension::Time);
    }
    if let Some(steps) = stop.steps {
        out.entry("steps", steps.to_string());
    }
}

fn output(out: &mut Lines, output: &OutputSpec) {
    out.table("[output]");
    out.entry("samples", output.samples.to_string());
    out.entry("snapshots", output.snapshots.to_string());
    out.entry("rupture_density", number(output.rupture_density));
    match output.checkpoint {
        CheckpointSpec::Auto => {}
        CheckpointSpec::WallTime(seconds) => out.quantity("checkpoint", seconds, Dimension::Time),
        CheckpointSpec::Steps(steps) => out.entry("checkpoint", steps.to_string()),
        CheckpointSpec::None => out.entry("checkpoint", text("none")),
    }
    let [width, height] = output.frame_size;
    out.entry("frame_size", format!("[{width}, {height}]"));
    out.entry("colour", text(output.colour.word()));
    out.list("views", output.views.iter().map(|view| text(view.word())));
    out.entry("theme", text(output.theme.word()));
    out.list("tables", output.tables.iter().map(|table| text(table.word())));
    out.list("also", output.also.iter().map(|format| text(format.word())));
    if output.supersampling != OutputSpec::default().supersampling {
        out.entry("supersampling", output.supersampling.to_string());
    }
    out.table("[output.camera]");
    out.quantity("azimuth", output.camera.azimuth, Dimension::Angle);
    out.quantity("elevation", output.camera.elevation, Dimension::Angle);
    out.entry("zoom", number(output.camera.zoom));
    if let Some(z) = output.camera.focus_z {
        out.quantity("focus_z", z, Dimension::Length);
    }
    output.pictures.iter().for_each(|picture| self::picture(out, picture));
}

/// One picture as an entry of a scene.
pub fn picture_to_toml(picture: &PictureSpec) -> String {
    let mut out = Lines::default();
    self::picture(&mut out, picture);
    out.text.trim_start().into()
}

fn picture(out: &mut Lines, picture: &PictureSpec) {
    out.table("[[output.picture]]");
    out.entry("name", text(&picture.name));
    match picture.when {
        When::At(moment) => out.entry("at", text(moment.word())),
        When::Strain(strain) => out.entry("strain", number(strain)),
        When::Time(time) => out.quantity("time", time, Dimension::Time),
    }
    let [width, height] = picture.size;
    out.entry("size", format!("[{width}, {height}]"));
    out.quantity("azimuth", picture.azimuth, Dimension::Angle);
    out.quantity("elevation", picture.elevation, Dimension::Angle);
    if let Some(centre) = picture.centre {
        out.entry("centre", vector(centre, Dimension::Length));
    }
    if let Some(height) = picture.height {
        out.quantity("height", height, Dimension::Length);
    }
    if picture.perspective != 0.0 {
        out.quantity("perspective", picture.perspective, Dimension::Angle);
    }
    if let Some(z) = picture.follow {
        out.quantity("follow", z, Dimension::Length);
    }
    out.entry("colour", text(picture.colour.word()));
    if let Some([low, high]) = picture.range {
        out.entry("range", format!("[{}, {}]", number(low), number(high)));
    }
    out.list("hidden_layers", picture.hidden_layers.iter().map(|name| text(name)));
    out.list("ghost_layers", picture.ghost_layers.iter().map(|name| text(name)));
    out.list("hidden_wires", picture.hidden_wires.iter().map(|wire| (wire + 1).to_string()));
    if let Some(wire) = picture.selected {
        out.entry("selected", (wire + 1).to_string());
    }
    if picture.explode != 0.0 {
        out.entry("explode", number(picture.explode));
    }
    if let Some(z) = picture.cut {
        out.quantity("cut", z, Dimension::Length);
    }
    out.entry("theme", text(picture.theme.word()));
    out.entry("supersampling", picture.supersampling.to_string());
}
