//! Tables as Apache Parquet: those of the CSV files under the same names, and long-form series per wire and per bond.
//!
//! Each column carries its unit and meaning (keys `unit` and `about` of the field's metadata, which pyarrow shows). The file's
//! own metadata names the run (`strandsnap.run`, `strandsnap.run_id`) and has all units once more as one JSON object
//! (`strandsnap.units`), for programs that show no metadata of columns.

use super::body::Body;
use super::parquet_table::ParquetTable;
use super::target::Target;
use crate::base::error::Result;
use crate::base::units::{mm, mpa, percent};
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::column::Column;
use crate::observe::peaks::Peaks;
use crate::observe::tables::{self, Wires, layer_name};
use std::sync::Arc;

/// A row of the series of wires.
pub struct WireMoment<'a> {
    info: &'a RunInfo,
    sample: &'a Sample,
    /// Wire, from 0.
    wire: usize,
    /// Its bonds that are broken.
    broken: usize,
}

/// A row of the series of bonds.
pub struct BondMoment<'a> {
    info: &'a RunInfo,
    snapshot: &'a Snapshot,
    /// Wire, from 0.
    wire: usize,
    slot: usize,
}

impl BondMoment<'_> {
    /// A coordinate of the bond's centre (mm).
    fn centre(&self, axis: usize) -> f32 {
        let ends = [self.slot, self.slot + 1].map(|p| f64::from(self.snapshot.position[p][axis]));
        mm((ends[0] + ends[1]) / 2.0) as f32
    }

    fn rest_z(&self) -> f32 {
        let ends = [self.slot, self.slot + 1].map(|p| f64::from(self.info.rest_position[p][2]));
        mm((ends[0] + ends[1]) / 2.0) as f32
    }
}

/// The word for a bond's state.
fn state(state: BondState) -> &'static str {
    match state {
        BondState::Whole => "whole",
        BondState::Yielding => "yielding",
        BondState::Broken => "broken",
        BondState::Absent => "absent",
    }
}

/// Columns of the series of wires: a row for each wire at each row of the curve.
pub fn wire_series<'a>() -> Vec<Column<'static, WireMoment<'a>>> {
    type W<'a> = WireMoment<'a>;
    vec![
        Column::described("step", "", "step of the engine", |w: &W| w.sample.step),
        Column::described("time_s", "s", "simulated time", |w: &W| w.sample.time),
        Column::described("strain_percent", "%", "strain of the body", |w: &W| percent(w.sample.strain)),
        Column::described("wire", "", "number of the wire, from 1", |w: &W| w.wire + 1),
        Column::described("layer", "", "its layer", |w: &W| layer_name(w.info, w.info.wires[w.wire].layer).to_owned()),
        Column::described("stress_mpa", "MPa", "its nominal stress at mid-gauge", |w: &W| {
            w.sample.wire_stress.get(w.wire).map(|stress| mpa(*stress))
        }),
        Column::described("bonds_broken", "", "its bonds broken so far", |w: &W| w.broken),
    ]
}

/// Columns of the series of bonds: a row for each bond at each snapshot.
pub fn bond_series<'a>() -> Vec<Column<'static, BondMoment<'a>>> {
    type B<'a> = BondMoment<'a>;
    let single = |unit: fn(f64) -> f64, of: fn(&B) -> f32| move |b: &B| unit(f64::from(of(b))) as f32;
    vec![
        Column::described("step", "", "step of the engine", |b: &B| b.snapshot.sample.step),
        Column::described("time_s", "s", "simulated time", |b: &B| b.snapshot.sample.time),
        Column::described("strain_percent", "%", "strain of the body", |b: &B| percent(b.snapshot.sample.strain)),
        Column::described("wire", "", "number of the wire, from 1", |b: &B| b.wire + 1),
        Column::described("layer", "", "layer of the wire", |b: &B| {
            layer_name(b.info, b.info.wires[b.wire].layer).to_owned()
        }),
        Column::described("bond", "", "number of the bond along its wire, from 1", |b: &B| {
            b.slot - b.info.wires[b.wire].first + 1
        }),
        Column::described("x_mm", "mm", "x of the bond's centre", |b: &B| b.centre(0)),
        Column::described("y_mm", "mm", "y of the bond's centre", |b: &B| b.centre(1)),
        Column::described("z_mm", "mm", "z of the bond's centre", |b: &B| b.centre(2)),
        Column::described("rest_z_mm", "mm", "z of the bond's centre before loading", BondMoment::rest_z),
        Column::described("stress_mpa", "MPa", "true axial stress", single(mpa, |b| b.snapshot.bond_stress[b.slot])),
        Column::described(
            "plastic_strain_percent",
            "%",
            "equivalent plastic strain",
            single(percent, |b| b.snapshot.plastic_strain[b.slot]),
        ),
        Column::described(
            "utilisation_percent",
            "%",
            "share of its rupture limit that the bond has reached",
            single(percent, |b| b.snapshot.utilisation[b.slot]),
        ),
        Column::described("state", "", "whole, yielding or broken", |b: &B| state(b.snapshot.bond_state[b.slot])),
    ]
}

pub struct Writer {
    target: Target,
    open: Option<Open>,
}

/// What is small is kept and written at the end; bonds are written as they come.
struct Open {
    body: Body,
    samples: Vec<Sample>,
    ruptures: Vec<Rupture>,
    wires: Wires,
    bonds: ParquetTable,
}

impl Writer {
    pub fn new(target: Target) -> Self {
        Self { target, open: None }
    }

    fn create<R>(&self, info: &RunInfo, name: &str, columns: &[Column<R>]) -> Result<ParquetTable> {
        let about = [("run", info.name.clone()), ("run_id", self.target.run.to_string())];
        ParquetTable::create(&self.target.folder.join(name), &about, columns)
    }

    fn write_small_tables(&self, open: &Open) -> Result<()> {
        let info = &*open.body.info;
        let curve = tables::curve(info);
        self.create(info, "curve.parquet", &curve)?.filled(&curve, &open.samples)?;
        let ruptures = tables::ruptures(info);
        self.create(info, "ruptures.parquet", &ruptures)?.filled(&ruptures, &open.ruptures)?;
        let wires = tables::wires(info);
        let rows: Vec<_> = open.wires.rows().collect();
        self.create(info, "wires.parquet", &wires)?.filled(&wires, &rows)?;
        let series = wire_series();
        let mut table = self.create(info, "wire_series.parquet", &series)?;
        let mut broken = vec![0; info.wires.len()];
        let mut ruptures = open.ruptures.iter().peekable();
        for sample in &open.samples {
            while let Some(rupture) = ruptures.next_if(|rupture| rupture.step <= sample.step) {
                broken[rupture.wire] += 1;
            }
            let [from, to] = self.target.strain;
            if (from..=to).contains(&sample.strain) {
                let row = |(wire, broken): (usize, &usize)| WireMoment { info, sample, wire, broken: *broken };
                table.write(&series, &broken.iter().enumerate().map(row).collect::<Vec<_>>())?;
            }
        }
        table.finish()
    }
}

impl Observer for Writer {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.open = Some(Open {
            body: Body::new(info),
            samples: Vec::new(),
            ruptures: Vec::new(),
            wires: Wires::new(info),
            bonds: self.create(info, "bond_series.parquet", &bond_series())?,
        });
        Ok(())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.open.iter_mut().for_each(|open| open.samples.push(sample.clone()));
        Ok(())
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        if let Some(open) = &mut self.open {
            open.wires.rupture(rupture);
            open.ruptures.push(rupture.clone());
        }
        Ok(())
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.open.iter_mut().for_each(|open| open.wires.peaks(peaks));
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(Open { body, bonds, .. }) = &mut self.open else { return Ok(()) };
        let row = |(wire, slot)| BondMoment { info: &body.info, snapshot, wire, slot };
        let rows: Vec<BondMoment> = body.bonds().map(row).collect();
        bonds.write(&bond_series(), &rows)
    }

    fn finish(&mut self) -> Result<()> {
        let Some(open) = self.open.take() else { return Ok(()) };
        self.write_small_tables(&open)?;
        open.bonds.finish()
    }
}
