//! `curve.csv`, `wires.csv` and `ruptures.csv`, and `bodies.csv` where there are rigid bodies.
//!
//! Wires and bonds are numbered from 1, layers by name; units stand in the column names. What the columns are is said once,
//! in [`curve`], [`wires`], [`ruptures`] and [`super::bodies::columns`], from which other formats take them too.

use super::Observer;
use super::bodies::{self, BODIES, BodyRow};
use super::column::{Column, Value};
use super::files::LiveTable;
use super::materials::Group;
use super::peaks::{Peak, Peaks};
use crate::base::error::Result;
use crate::base::units::{mm, mpa, newton_mm, percent};
use crate::engine::view::{Energy, RunInfo, Rupture, RuptureCause, Sample, WireInfo};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The three files that this observer writes of every run.
pub const FILES: [&str; 3] = ["curve.csv", "wires.csv", "ruptures.csv"];

/// Writes the three tables into a folder. Rows of the curve and ruptures appear as they come, in files that
/// are called `….partial` until the run ends.
pub struct Tables {
    folder: PathBuf,
    open: Option<Open>,
}

struct Open {
    curve: (LiveTable, Vec<Column<'static, Sample>>),
    ruptures: (LiveTable, Vec<Column<'static, Rupture>>),
    /// Where there are rigid bodies.
    bodies: Option<(LiveTable, Vec<Column<'static, BodyRow>>)>,
    wires: Wires,
}

/// What the rows of `wires.csv` are gathered from.
pub struct Wires {
    info: Arc<RunInfo>,
    first_rupture: Vec<Option<Rupture>>,
    /// Greatest stress of each wire over all steps.
    peaks: Vec<Peak>,
}

/// A row of `wires.csv`.
pub struct WireRow<'a> {
    /// Wire, from 0.
    pub number: usize,
    /// What it is.
    pub wire: &'a WireInfo,
    /// Name of its layer.
    pub layer: &'a str,
    /// Its greatest stress at mid-gauge; `None` where none was measured.
    pub peak: Option<&'a Peak>,
    /// Where it broke first.
    pub first_rupture: Option<&'a Rupture>,
}

impl Wires {
    /// Of a run that begins.
    pub fn new(info: &Arc<RunInfo>) -> Self {
        Self { info: info.clone(), first_rupture: vec![None; info.wires.len()], peaks: Vec::new() }
    }

    /// The run.
    pub fn info(&self) -> &RunInfo {
        &self.info
    }

    /// A bond broke.
    pub fn rupture(&mut self, rupture: &Rupture) {
        if let Some(first) = self.first_rupture.get_mut(rupture.wire) {
            first.get_or_insert_with(|| rupture.clone());
        }
    }

    /// The greatest stresses are known.
    pub fn peaks(&mut self, peaks: &Peaks) {
        self.peaks.clone_from(&peaks.wires);
    }

    /// A row per wire.
    pub fn rows(&self) -> impl Iterator<Item = WireRow<'_>> {
        self.info.wires.iter().enumerate().map(|(number, wire)| WireRow {
            number,
            wire,
            layer: layer_name(&self.info, wire.layer),
            peak: self.peaks.get(number),
            first_rupture: self.first_rupture[number].as_ref(),
        })
    }
}

impl Tables {
    /// Tables in `folder`, which must exist.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.into(), open: None }
    }
}

impl Observer for Tables {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let at = |name: &str| self.folder.join(name);
        self.open = Some(Open {
            curve: table(at(FILES[0]), curve(info))?,
            ruptures: table(at(FILES[2]), ruptures(info))?,
            bodies: match info.bodies.is_empty() {
                true => None,
                false => Some(table(at(BODIES), bodies::columns())?),
            },
            wires: Wires::new(info),
        });
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        row(&mut open.curve, sample)?;
        match &mut open.bodies {
            Some(table) => bodies::rows(open.wires.info(), sample).try_for_each(|body| row(table, &body)),
            None => Ok(()),
        }
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        open.wires.rupture(rupture);
        row(&mut open.ruptures, rupture)
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        if let Some(open) = &mut self.open {
            open.wires.peaks(peaks);
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        let mut wires = table(self.folder.join(FILES[1]), wires(&open.wires.info))?;
        open.wires.rows().try_for_each(|wire| row(&mut wires, &wire))?;
        open.bodies.map_or(Ok(()), |bodies| bodies.0.finish())?;
        open.curve.0.finish()?;
        wires.0.finish()?;
        open.ruptures.0.finish()
    }
}

/// A table with its columns, created with its header.
fn table<R>(path: PathBuf, columns: Vec<Column<'static, R>>) -> Result<(LiveTable, Vec<Column<'static, R>>)> {
    let header: Vec<String> = columns.iter().map(|column| column.name.to_string()).collect();
    Ok((LiveTable::create(path, &header)?, columns))
}

fn row<R>((table, columns): &mut (LiveTable, Vec<Column<R>>), of: &R) -> Result<()> {
    table.row(&columns.iter().map(|column| cell(column.value(of))).collect::<Vec<_>>())
}

fn cell(value: Value) -> String {
    match value {
        Value::Number(value) => number(value),
        other => other.in_csv(),
    }
}

/// The cause in words, as in the recording and the scenes.
pub fn cause(cause: RuptureCause) -> &'static str {
    match cause {
        RuptureCause::PlasticStrain => "plastic-strain",
        RuptureCause::Tension => "tension",
        RuptureCause::Shear => "shear",
        RuptureCause::FibreStrain => "fibre-strain",
    }
}

/// Name of layer `index`.
pub fn layer_name(info: &RunInfo, index: usize) -> &str {
    info.layers.get(index).map_or("", String::as_str)
}

fn number(value: f64) -> String {
    // Nine digits: enough to compare runs, short enough to read. A `Display` of the shortest exact form
    // would print seventeen.
    let text = format!("{value:.8e}");
    match text.parse::<f64>() {
        Ok(rounded) => rounded.to_string(),
        Err(_) => text,
    }
}

/// What becomes of energy: name, meaning, value.
type EnergyTerm = (&'static str, &'static str, fn(&Energy) -> f64);

const ENERGIES: [EnergyTerm; 11] = [
    ("work_j", "work done by grips, holds and applied loads, and the energy at the start", |e| e.work),
    ("kinetic_j", "kinetic energy", |e| e.kinetic),
    ("elastic_bonds_j", "elastic energy in bonds", |e| e.elastic_bonds),
    ("elastic_contacts_j", "elastic energy in contacts", |e| e.elastic_contacts),
    ("plastic_bonds_j", "plastic work in bonds", |e| e.plastic_bonds),
    ("plastic_contacts_j", "plastic work in contacts", |e| e.plastic_contacts),
    ("plastic_thinning_j", "work of contact pressure on wires that thin", |e| e.plastic_thinning),
    ("friction_j", "lost to friction", |e| e.friction),
    ("damping_j", "lost to viscous damping", |e| e.damping),
    ("released_j", "released by rupture", |e| e.released),
    ("residual_j", "what the ledger does not account for", Energy::residual),
];

/// The columns of `curve.csv`.
pub fn curve(info: &RunInfo) -> Vec<Column<'static, Sample>> {
    type S = Sample;
    let mut columns = vec![
        Column::described("step", "", "step of the engine", |s: &S| s.step),
        Column::described("time_s", "s", "simulated time", |s: &S| s.time),
        Column::described("strain_percent", "%", "grip displacement over free length", |s: &S| percent(s.strain)),
        Column::described("stress_mpa", "MPa", "nominal stress of the body", |s: &S| mpa(s.stress)),
        Column::described("grip_force_lower_n", "N", "force of the lower grip", |s: &S| s.grip_force[0]),
        Column::described("grip_force_upper_n", "N", "force of the upper grip", |s: &S| s.grip_force[1]),
        Column::described("torque_n_mm", "N mm", "torque about z on the upper grip", |s: &S| newton_mm(s.torque)),
    ];
    columns.extend(info.layers.iter().enumerate().map(|(layer, name)| {
        let column = format!("stress_{}_mpa", name.replace(' ', "_"));
        let about = format!("mean nominal stress at mid-gauge of the wires of layer {name}");
        // Free bodies have layers but no gauge to measure a stress in: the cell stays empty.
        Column::described(column, "MPa", about, move |s: &S| s.layer_stress.get(layer).map(|stress| mpa(*stress)))
    }));
    if info.has_several_materials() {
        columns.extend(carried(info));
    }
    columns.extend([
        Column::described("wires_broken", "", "wires broken so far", |s: &S| s.wires_broken),
        Column::described("bonds_broken", "", "bonds broken so far", |s: &S| s.bonds_broken),
        Column::described("contacts", "", "active contacts", |s: &S| s.contacts),
        Column::described("time_step_s", "s", "time step", |s: &S| s.time_step),
    ]);
    let energy = |(name, about, of): EnergyTerm| Column::described(name, "J", about, move |s: &S| of(&s.energy));
    columns.extend(ENERGIES.map(energy));
    columns
}

/// What layers and materials carry, where wires are of several materials.
fn carried(info: &RunInfo) -> Vec<Column<'static, Sample>> {
    type S = Sample;
    let info = Arc::new(info.clone());
    let force = |name: String, about: String, group: Group| {
        let info = info.clone();
        Column::described(name, "N", about, move |s: &S| group.force(&info, s))
    };
    let stress = |name: String, about: String, group: Group| {
        let info = info.clone();
        Column::described(name, "MPa", about, move |s: &S| group.stress(&info, s).map(mpa))
    };
    let mut columns = Vec::new();
    for (k, name) in info.layers.iter().enumerate() {
        let about = format!("force along z at mid-gauge of the wires of layer {name}");
        columns.push(force(format!("force_{}_n", name.replace(' ', "_")), about, Group::Layer(k)));
    }
    let wires_of = |k: usize| info.wires.iter().any(|wire| wire.material == k);
    for (k, name) in info.materials.iter().enumerate().filter(|(k, _)| wires_of(*k)) {
        let about = format!("mean nominal stress at mid-gauge, by section, of the wires of {name}");
        columns.push(stress(format!("material_{name}_mpa"), about, Group::Material(k)));
        let about = format!("force along z at mid-gauge of the wires of {name}");
        columns.push(force(format!("material_{name}_n"), about, Group::Material(k)));
    }
    columns
}

/// The columns of `ruptures.csv`.
pub fn ruptures(info: &RunInfo) -> Vec<Column<'static, Rupture>> {
    type R = Rupture;
    let layers = info.layers.clone();
    let layer = move |r: &R| layers.get(r.layer).cloned().unwrap_or_default();
    let mut columns = vec![
        Column::described("order", "", "order of the rupture in the run, from 1", |r: &R| r.order),
        Column::described("step", "", "step of the engine", |r: &R| r.step),
        Column::described("time_s", "s", "simulated time", |r: &R| r.time),
        Column::described("strain_percent", "%", "strain of the body", |r: &R| percent(r.strain)),
        Column::described("wire", "", "number of the wire, from 1", |r: &R| r.wire + 1),
        Column::described("layer", "", "layer of the wire", layer),
        Column::described("bond", "", "number of the bond along its wire, from 1", |r: &R| r.bond_in_wire + 1),
        Column::described("z_mm", "mm", "z of the bond's centre when it broke", |r: &R| mm(r.position[2])),
        Column::described("rest_z_mm", "mm", "z of the bond's centre before loading", |r: &R| mm(r.rest_z)),
        Column::described("cause", "", "why it broke", |r: &R| cause(r.cause)),
        Column::described("stress_mpa", "MPa", "true axial stress of the bond just before", |r: &R| mpa(r.stress)),
        Column::described("body_stress_mpa", "MPa", "nominal stress of the body just before", |r: &R| {
            mpa(r.body_stress)
        }),
    ];
    if info.has_several_materials() {
        let names: Vec<String> = material_of_wires(info);
        let material = move |r: &R| names.get(r.wire).cloned().unwrap_or_default();
        columns.insert(6, Column::described("material", "", "material of the wire", material));
    }
    columns
}

/// The columns of `wires.csv`. The greatest stress is that of the wire at mid-gauge: a wire that broke elsewhere, or not at
/// all, may carry more.
pub fn wires<'a>(info: &RunInfo) -> Vec<Column<'static, WireRow<'a>>> {
    fn peak(of: fn(&Peak) -> f64) -> impl Fn(&WireRow) -> Option<f64> {
        move |row| row.peak.map(of)
    }
    fn first<T>(of: fn(&Rupture) -> T) -> impl Fn(&WireRow) -> Option<T> {
        move |row| row.first_rupture.map(of)
    }
    let mut columns = vec![
        Column::described("wire", "", "number of the wire, from 1", |w: &WireRow| w.number + 1),
        Column::described("layer", "", "its layer", |w: &WireRow| w.layer.to_owned()),
        Column::described("diameter_mm", "mm", "its diameter before loading", |w: &WireRow| mm(w.wire.diameter)),
        Column::described(
            "greatest_stress_mpa",
            "MPa",
            "its greatest nominal stress at mid-gauge",
            peak(|p| mpa(p.stress)),
        ),
        Column::described(
            "strain_at_greatest_stress_percent",
            "%",
            "strain of the body then",
            peak(|p| percent(p.strain)),
        ),
        Column::described("broken", "", "whether it broke", |w: &WireRow| w.first_rupture.is_some()),
        Column::described("first_rupture_z_mm", "mm", "z of its first rupture", first(|r| mm(r.position[2]))),
        Column::described("first_rupture_strain_percent", "%", "strain of the body then", first(|r| percent(r.strain))),
        Column::described("first_rupture_order", "", "order of that rupture in the run", first(|r| r.order)),
        Column::described("first_rupture_cause", "", "why it broke", first(|r| cause(r.cause))),
    ];
    if info.has_several_materials() {
        let names = material_of_wires(info);
        let material = move |w: &WireRow| names[w.number].clone();
        columns.insert(2, Column::described("material", "", "its material", material));
        let force = peak(|p| p.stress);
        let force = move |w: &WireRow| force(w).map(|stress| stress * w.wire.area());
        columns.insert(5, Column::described("greatest_force_n", "N", "its force at that stress", force));
    }
    columns
}

/// Name of the material of each wire.
fn material_of_wires(info: &RunInfo) -> Vec<String> {
    let name = |wire: &WireInfo| info.materials.get(wire.material).cloned().unwrap_or_default();
    info.wires.iter().map(name).collect()
}
