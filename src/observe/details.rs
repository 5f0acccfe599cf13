//! The tables of a run's snapshots that its scene asks for (`output.tables`): a row for each particle, hold, contact, or state.

use super::Observer;
use super::column::Value;
use super::files::LiveTable;
use crate::base::error::Result;
use crate::base::units::{mm, mpa, newton_mm, percent};
use crate::engine::view::{Detail, Load, RunInfo, Snapshot};
use crate::observe::tables::layer_name;
use crate::observe::wording::wire_number;
use crate::scene::look::Table;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The files of all tables.
pub const FILES: [&str; Table::ALL.len()] =
    ["positions.csv", "velocities.csv", "spins.csv", "holds.csv", "contacts.csv", "grips.csv"];

/// Writes the tables that are asked for into a folder. Rows appear as they come, in files that are called `….partial` until the run
/// ends.
pub struct Details {
    folder: PathBuf,
    wanted: Vec<Table>,
    info: Arc<RunInfo>,
    open: Vec<(Table, LiveTable)>,
}

/// The file of a table.
pub fn file(table: Table) -> &'static str {
    let number = Table::ALL.iter().position(|known| *known == table);
    FILES[number.expect("every table is one of all")]
}

impl Details {
    /// Tables in `folder`, which must exist.
    pub fn new(folder: &Path, wanted: &[Table]) -> Self {
        Self { folder: folder.into(), wanted: wanted.to_vec(), info: Arc::default(), open: Vec::new() }
    }
}

impl Observer for Details {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.info = info.clone();
        for table in &self.wanted {
            let created = LiveTable::create(self.folder.join(file(*table)), &header(*table, info))?;
            self.open.push((*table, created));
        }
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(detail) = &snapshot.detail else { return Ok(()) };
        let sample = &snapshot.sample;
        let moment = [Value::from(sample.step), sample.time.into(), percent(sample.strain).into()];
        for (table, out) in &mut self.open {
            for row in rows(*table, &self.info, detail) {
                let cells = moment.iter().cloned().chain(row).map(Value::in_csv);
                out.row(&cells.collect::<Vec<_>>())?;
            }
        }
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        self.open.drain(..).try_for_each(|(_, table)| table.finish())
    }
}

fn header(table: Table, info: &RunInfo) -> Vec<String> {
    let particle = ["wire", "number"];
    let names: Vec<String> = match table {
        Table::Positions => [&particle[..], &["x_mm", "y_mm", "z_mm"]].concat().into_iter().map(Into::into).collect(),
        Table::Velocities => {
            [&particle[..], &["vx_m_s", "vy_m_s", "vz_m_s"]].concat().into_iter().map(Into::into).collect()
        }
        Table::Spins => {
            [&particle[..], &["wx_rad_s", "wy_rad_s", "wz_rad_s"]].concat().into_iter().map(Into::into).collect()
        }
        Table::Holds => {
            ["hold", "force_x_n", "force_y_n", "force_z_n", "moment_x_n_mm", "moment_y_n_mm", "moment_z_n_mm"]
                .map(Into::into)
                .to_vec()
        }
        Table::Contacts => [
            "wire_a",
            "number_a",
            "wire_b",
            "number_b",
            "x_mm",
            "y_mm",
            "z_mm",
            "force_n",
            "overlap_um",
            "pressure_mpa",
        ]
        .map(Into::into)
        .to_vec(),
        Table::Grips => {
            let of_layer = |layer| {
                let name = layer_name(info, layer).to_owned();
                [format!("lay_length_{name}_mm"), format!("lay_radius_{name}_mm")]
            };
            let own = ["displacement_mm".to_owned(), "angle_deg".to_owned()];
            own.into_iter().chain((0..info.layers.len()).flat_map(of_layer)).collect()
        }
    };
    ["step", "time_s", "strain_percent"].into_iter().map(Into::into).chain(names).collect()
}

/// A particle's wire and its number in it, both from 1; a free sphere has no wire, and its own number.
fn particle(info: &RunInfo, i: usize) -> [Value; 2] {
    match info.wires.iter().position(|wire| wire.particles().contains(&i)) {
        Some(wire) => [wire_number(wire).into(), (i - info.wires[wire].first + 1).into()],
        None => [Value::from(""), (i - info.wire_particles + 1).into()],
    }
}

fn rows(table: Table, info: &RunInfo, detail: &Detail) -> Vec<Vec<Value>> {
    let vectors = |list: &[[f64; 3]], unit: fn(f64) -> f64| {
        let row = |(i, v): (usize, &[f64; 3])| {
            particle(info, i).into_iter().chain(v.iter().map(|part| unit(*part).into())).collect()
        };
        list.iter().enumerate().map(row).collect()
    };
    match table {
        Table::Positions => vectors(&detail.position, mm),
        Table::Velocities => vectors(&detail.velocity, |v| v),
        Table::Spins => vectors(&detail.spin, |w| w),
        Table::Holds => {
            let row = |(number, Load { force, moment }): (usize, &Load)| {
                let loads = force.iter().copied().chain(moment.iter().map(|part| newton_mm(*part)));
                std::iter::once(number.into()).chain(loads.map(Value::from)).collect()
            };
            detail.holds.iter().enumerate().map(row).collect()
        }
        Table::Contacts => {
            let row = |touch: &crate::engine::view::Touch| {
                let pair = touch.pair.into_iter().flat_map(|p| particle(info, p as usize));
                let place = touch.position.iter().map(|x| mm(*x).into());
                let rest = [touch.force, 1e6 * touch.overlap, mpa(touch.pressure)].map(Value::from);
                pair.chain(place).chain(rest).collect()
            };
            detail.contacts.iter().map(row).collect()
        }
        Table::Grips => {
            let row = |grips: &crate::engine::view::GripState| {
                let lay = grips.lay.iter().flat_map(|lay| lay.map_or([f64::NAN; 2], |lay| lay.map(mm)));
                [mm(grips.displacement), grips.angle.to_degrees()].into_iter().chain(lay).map(Value::from).collect()
            };
            detail.grips.iter().map(row).collect()
        }
    }
}
