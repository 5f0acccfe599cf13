//! `curve.csv`, `wires.csv` and `ruptures.csv`.
//!
//! Wires and bonds are numbered from 1, layers by name; units stand in the column names.

use super::Observer;
use super::files::LiveTable;
use super::peaks::{Peak, Peaks};
use crate::base::error::Result;
use crate::base::units::{mm, mpa, newton_mm, percent};
use crate::engine::view::{Energy, RunInfo, Rupture, RuptureCause, Sample};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The three files that this observer writes.
pub const FILES: [&str; 3] = ["curve.csv", "wires.csv", "ruptures.csv"];

/// Writes the three tables into a folder. Rows of the curve and ruptures appear as they come, in files that
/// are called `….partial` until the run ends.
pub struct Tables {
    folder: PathBuf,
    open: Option<Open>,
}

struct Open {
    info: Arc<RunInfo>,
    curve: LiveTable,
    ruptures: LiveTable,
    wires: Vec<WireRecord>,
    /// Greatest stress of each wire over all steps.
    peaks: Vec<Peak>,
}

/// What `wires.csv` says of a wire.
#[derive(Default, Clone)]
struct WireRecord {
    first_rupture: Option<Rupture>,
}

impl Tables {
    /// Tables in `folder`, which must exist.
    pub fn new(folder: &Path) -> Self {
        Self { folder: folder.into(), open: None }
    }
}

impl Observer for Tables {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let create = |name: &str, header: Vec<String>| LiveTable::create(self.folder.join(name), &header);
        self.open = Some(Open {
            info: info.clone(),
            curve: create(FILES[0], curve_header(info))?,
            ruptures: create(FILES[2], rupture_header())?,
            wires: vec![WireRecord::default(); info.wires.len()],
            peaks: Vec::new(),
        });
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        open.curve.row(&curve_row(sample, open.info.layers.len()))
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        let Some(open) = &mut self.open else {
            return Ok(());
        };
        if let Some(record) = open.wires.get_mut(rupture.wire) {
            record.first_rupture.get_or_insert_with(|| rupture.clone());
        }
        open.ruptures.row(&rupture_row(rupture, &open.info))
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        if let Some(open) = &mut self.open {
            open.peaks = peaks.wires.clone();
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        let Some(open) = self.open.take() else {
            return Ok(());
        };
        let mut wires = LiveTable::create(self.folder.join(FILES[1]), &wire_header())?;
        for (w, record) in open.wires.iter().enumerate() {
            wires.row(&wire_row(w, record, open.peaks.get(w), &open.info))?;
        }
        open.curve.finish()?;
        wires.finish()?;
        open.ruptures.finish()
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

fn owned<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(String::from).to_vec()
}

fn energies(e: &Energy) -> [(&'static str, f64); 11] {
    [
        ("work_j", e.work),
        ("kinetic_j", e.kinetic),
        ("elastic_bonds_j", e.elastic_bonds),
        ("elastic_contacts_j", e.elastic_contacts),
        ("plastic_bonds_j", e.plastic_bonds),
        ("plastic_contacts_j", e.plastic_contacts),
        ("plastic_thinning_j", e.plastic_thinning),
        ("friction_j", e.friction),
        ("damping_j", e.damping),
        ("released_j", e.released),
        ("residual_j", e.residual()),
    ]
}

fn curve_header(info: &RunInfo) -> Vec<String> {
    let mut header = owned([
        "step",
        "time_s",
        "strain_percent",
        "stress_mpa",
        "grip_force_lower_n",
        "grip_force_upper_n",
        "torque_n_mm",
    ]);
    header.extend(info.layers.iter().map(|name| format!("stress_{}_mpa", name.replace(' ', "_"))));
    header.extend(owned(["wires_broken", "bonds_broken", "contacts", "time_step_s"]));
    header.extend(energies(&Energy::default()).map(|(name, _)| name.to_string()));
    header
}

fn curve_row(sample: &Sample, layers: usize) -> Vec<String> {
    let mut row = vec![
        sample.step.to_string(),
        number(sample.time),
        number(percent(sample.strain)),
        number(mpa(sample.stress)),
        number(sample.grip_force[0]),
        number(sample.grip_force[1]),
        number(newton_mm(sample.torque)),
    ];
    // Free bodies have layers but no gauge to measure a stress in: the cell stays empty.
    row.extend((0..layers).map(|k| match sample.layer_stress.get(k) {
        Some(&stress) => number(mpa(stress)),
        None => String::new(),
    }));
    row.extend([
        sample.wires_broken.to_string(),
        sample.bonds_broken.to_string(),
        sample.contacts.to_string(),
        number(sample.time_step),
    ]);
    row.extend(energies(&sample.energy).map(|(_, value)| number(value)));
    row
}

fn rupture_header() -> Vec<String> {
    owned([
        "order",
        "step",
        "time_s",
        "strain_percent",
        "wire",
        "layer",
        "bond",
        "z_mm",
        "rest_z_mm",
        "cause",
        "stress_mpa",
        "body_stress_mpa",
    ])
}

fn rupture_row(rupture: &Rupture, info: &RunInfo) -> Vec<String> {
    vec![
        rupture.order.to_string(),
        rupture.step.to_string(),
        number(rupture.time),
        number(percent(rupture.strain)),
        (rupture.wire + 1).to_string(),
        layer_name(info, rupture.layer).to_string(),
        (rupture.bond_in_wire + 1).to_string(),
        number(mm(rupture.position[2])),
        number(mm(rupture.rest_z)),
        cause(rupture.cause).to_string(),
        number(mpa(rupture.stress)),
        number(mpa(rupture.body_stress)),
    ]
}

fn wire_header() -> Vec<String> {
    owned([
        "wire",
        "layer",
        "diameter_mm",
        "greatest_stress_mpa",
        "strain_at_greatest_stress_percent",
        "broken",
        "first_rupture_z_mm",
        "first_rupture_strain_percent",
        "first_rupture_order",
        "first_rupture_cause",
    ])
}

/// The greatest stress is that of the wire at mid-gauge: a wire that broke elsewhere, or not at all, may carry more.
fn wire_row(w: usize, record: &WireRecord, peak: Option<&Peak>, info: &RunInfo) -> Vec<String> {
    let wire = &info.wires[w];
    let (greatest, strain) = match peak {
        Some(peak) => (number(mpa(peak.stress)), number(percent(peak.strain))),
        None => (String::new(), String::new()),
    };
    let broken = if record.first_rupture.is_some() { "yes" } else { "no" };
    let mut row = vec![
        (w + 1).to_string(),
        layer_name(info, wire.layer).to_string(),
        (mm(wire.diameter) as f32).to_string(),
        greatest,
        strain,
        broken.to_string(),
    ];
    match &record.first_rupture {
        Some(r) => row.extend([
            number(mm(r.position[2])),
            number(percent(r.strain)),
            r.order.to_string(),
            cause(r.cause).to_string(),
        ]),
        None => row.extend(owned([""; 4])),
    }
    row
}
