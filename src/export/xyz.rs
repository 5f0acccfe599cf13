//! Extended XYZ: every particle over time in one file, lengths in mm, stresses in MPa. No lattice: nothing repeats.
//!
//! Format: the extended XYZ specification (github.com/libAtoms/extxyz): the second line of a frame holds `key=value`
//! pairs, of which `Properties` names the columns.

use super::body::Body;
use super::target::{Growing, Target};
use crate::base::error::Result;
use crate::base::units::{mm, mpa, percent};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::Observer;
use crate::run::exported::XYZ;
use std::io::Write;
use std::sync::Arc;

/// Columns: name, type, numbers, as `Properties` lists them.
const COLUMNS: &str = "species:S:1:pos:R:3:id:I:1:molecule:I:1:radius:R:1:stress_mpa:R:1:plastic_strain_percent:R:1:\
utilisation_percent:R:1:broken:I:1:speed_m_s:R:1:contact_pressure_mpa:R:1";

pub struct Writer {
    target: Target,
    open: Option<Open>,
}

struct Open {
    title: String,
    body: Body,
    /// Names of the layers as one word each.
    layers: Vec<String>,
    file: Growing,
}

impl Writer {
    pub fn new(target: Target) -> Self {
        Self { target, open: None }
    }
}

impl Observer for Writer {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let word = |name: &String| name.split_whitespace().collect::<Vec<_>>().join("_");
        let layers = info.layers.iter().map(word).collect();
        // A quotation mark would end the value.
        let title = self.target.title(info).replace(['"', '\\', '\n'], " ");
        let file = Growing::create(&self.target, XYZ)?;
        self.open = Some(Open { title, body: Body::new(info), layers, file });
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(Open { title, body, layers, file }) = &mut self.open else { return Ok(()) };
        let [stress, plastic, utilisation] = [&snapshot.bond_stress, &snapshot.plastic_strain, &snapshot.utilisation]
            .map(|quantity| Body::at_particles(snapshot, quantity));
        let broken = Body::at_breaks(snapshot);
        file.write(|file| {
            let s = &snapshot.sample;
            writeln!(file, "{}", snapshot.position.len())?;
            write!(file, "Properties={COLUMNS} pbc=\"F F F\" step={} time_s={:e} ", s.step, s.time)?;
            write!(file, "strain_percent={:e} nominal_stress_mpa={:e} ", percent(s.strain), mpa(s.stress))?;
            writeln!(file, "units=\"lengths mm\" run=\"{title}\"")?;
            for (p, position) in snapshot.position.iter().enumerate() {
                let layer = usize::try_from(body.layer[p] - 1).ok().and_then(|layer| layers.get(layer));
                let species = layer.map_or("sphere", String::as_str);
                let [x, y, z] = position.map(to(mm));
                let (radius, pressure) = (to(mm)(snapshot.radius[p]), to(mpa)(snapshot.contact_pressure[p]));
                let (stress, plastic) = (to(mpa)(stress[p]), to(percent)(plastic[p]));
                let (utilisation, broken, speed) = (to(percent)(utilisation[p]), broken[p], snapshot.speed[p]);
                let (id, wire) = (p + 1, body.wire[p]);
                write!(file, "{species} {x} {y} {z} {id} {wire} {radius} {stress} {plastic} {utilisation} ")?;
                writeln!(file, "{broken} {speed} {pressure}")?;
            }
            Ok(())
        })
    }

    fn finish(&mut self) -> Result<()> {
        self.open.take().map_or(Ok(()), |mut open| open.file.finish())
    }
}

/// A conversion, in single precision.
fn to(unit: fn(f64) -> f64) -> impl Fn(f32) -> f32 {
    move |value| unit(f64::from(value)) as f32
}
