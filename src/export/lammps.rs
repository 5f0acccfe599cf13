//! What LAMMPS writes of a bonded granular body: a data file of the body before loading, a dump of atoms and a dump local of
//! bonds, in its unit style `si`. Atoms are particles, molecules wires, types layers; all are numbered from 1.
//!
//! Formats: LAMMPS manual, `read_data`, `dump` (styles custom and local, with `units yes` and `time yes`).

use super::body::{Body, bounds};
use super::target::{Growing, Target};
use crate::base::error::Result;
use crate::engine::view::{RunInfo, Sample, Snapshot};
use crate::observe::Observer;
use crate::run::exported::{ATOMS, BONDS, DATA};
use std::io::Write;
use std::sync::Arc;

pub struct Writer {
    target: Target,
    open: Option<Open>,
}

struct Open {
    body: Body,
    /// Types of the particles: their layer, or one more for free spheres.
    types: Vec<usize>,
    atoms: Growing,
    bonds: Growing,
    first: bool,
}

impl Writer {
    pub fn new(target: Target) -> Self {
        Self { target, open: None }
    }
}

impl Observer for Writer {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let body = Body::new(info);
        let spheres = info.layers.len() + 1;
        let types: Vec<usize> =
            body.layer.iter().map(|layer| if *layer > 0 { *layer as usize } else { spheres }).collect();
        let mut data = Growing::create(&self.target, DATA)?;
        let title = self.target.title(info);
        data.write(|file| write_data(file, &title, &body, &types))?;
        data.finish()?;
        let [atoms, bonds] = [ATOMS, BONDS].map(|name| Growing::create(&self.target, name));
        self.open = Some(Open { body, types, atoms: atoms?, bonds: bonds?, first: true });
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(open) = &mut self.open else { return Ok(()) };
        let first = std::mem::replace(&mut open.first, false);
        let Open { body, types, atoms, bonds, .. } = open;
        atoms.write(|file| {
            head(file, &snapshot.sample, first, "ATOMS", snapshot.position.len())?;
            box_bounds(file, snapshot)?;
            writeln!(file, "ITEM: ATOMS id mol type x y z radius speed contact_pressure")?;
            for (p, [x, y, z]) in snapshot.position.iter().enumerate() {
                let (radius, speed, pressure) = (snapshot.radius[p], snapshot.speed[p], snapshot.contact_pressure[p]);
                let (id, molecule, kind) = (p + 1, body.wire[p], types[p]);
                writeln!(file, "{id} {molecule} {kind} {x:e} {y:e} {z:e} {radius:e} {speed:e} {pressure:e}")?;
            }
            Ok(())
        })?;
        bonds.write(|file| {
            head(file, &snapshot.sample, first, "ENTRIES", body.bonds().count())?;
            box_bounds(file, snapshot)?;
            writeln!(file, "ITEM: ENTRIES index batom1 batom2 btype stress plastic_strain utilisation state")?;
            for (index, (_, slot)) in body.bonds().enumerate() {
                let (stress, plastic) = (snapshot.bond_stress[slot], snapshot.plastic_strain[slot]);
                let (utilisation, state) = (snapshot.utilisation[slot], snapshot.bond_state[slot] as u8);
                let (number, kind, from, to) = (index + 1, types[slot], slot + 1, slot + 2);
                writeln!(file, "{number} {from} {to} {kind} {stress:e} {plastic:e} {utilisation:e} {state}")?;
            }
            Ok(())
        })
    }

    fn finish(&mut self) -> Result<()> {
        let Some(mut open) = self.open.take() else { return Ok(()) };
        open.atoms.finish()?;
        open.bonds.finish()
    }
}

fn write_data(file: &mut impl Write, title: &str, body: &Body, types: &[usize]) -> std::io::Result<()> {
    let info = &body.info;
    // The first line is a comment; programs read on from the third.
    let layers: Vec<String> = info.layers.iter().enumerate().map(|(k, name)| format!("{} {name}", k + 1)).collect();
    writeln!(file, "LAMMPS data file, units si, atom_style bond: {title}; types: {}\n", layers.join(", "))?;
    let kinds = types.iter().max().unwrap_or(&1);
    writeln!(file, "{} atoms\n{} bonds\n{kinds} atom types", types.len(), body.bonds().count())?;
    writeln!(file, "{} bond types\n", info.layers.len())?;
    for (axis, [low, high]) in ["x", "y", "z"].iter().zip(bounds(&info.rest_position, &info.radius)) {
        writeln!(file, "{low:e} {high:e} {axis}lo {axis}hi")?;
    }
    writeln!(file, "\nAtoms # bond\n")?;
    for (p, [x, y, z]) in info.rest_position.iter().enumerate() {
        writeln!(file, "{} {} {} {x:e} {y:e} {z:e}", p + 1, body.wire[p], types[p])?;
    }
    if !info.wires.is_empty() {
        writeln!(file, "\nBonds\n")?;
        for (index, (_, slot)) in body.bonds().enumerate() {
            writeln!(file, "{} {} {} {}", index + 1, types[slot], slot + 1, slot + 2)?;
        }
    }
    Ok(())
}

fn head(file: &mut impl Write, sample: &Sample, first: bool, what: &str, count: usize) -> std::io::Result<()> {
    if first {
        writeln!(file, "ITEM: UNITS\nsi")?;
    }
    writeln!(file, "ITEM: TIME\n{:e}\nITEM: TIMESTEP\n{}", sample.time, sample.step)?;
    writeln!(file, "ITEM: NUMBER OF {what}\n{count}")
}

/// The box is shrink-wrapped: as large as what is in it.
fn box_bounds(file: &mut impl Write, snapshot: &Snapshot) -> std::io::Result<()> {
    writeln!(file, "ITEM: BOX BOUNDS ss ss ss")?;
    bounds(&snapshot.position, &snapshot.radius).iter().try_for_each(|[low, high]| writeln!(file, "{low:e} {high:e}"))
}
