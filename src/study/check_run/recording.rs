//! The recording of a run, if there is one, against its trajectory.

use super::finding::{InvariantOutcome, Search};
use super::folder::{Folder, energies};
use crate::engine::view::{BondState, Sample, WireInfo};
use crate::observe::recording::STRESS;
use crate::observe::recording::read::{RecordingContents, contents, paths};
use crate::run::folder::RECORDING;

/// See [`super::files::RECORDING`].
pub fn check(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    match contents(&run.path.join(RECORDING)) {
        Ok(read) => {
            series(run, &read, &mut search);
            last_state(run, &read, &mut search);
        }
        Err(error) => search.add(f64::NAN, || error.to_string()),
    }
    search.end(1e-12, "-", "")
}

/// A row's values of one entity.
type Values = Box<dyn Fn(&Sample) -> Vec<f64>>;

fn series(run: &Folder, read: &RecordingContents, search: &mut Search) {
    let info = &run.trajectory.info;
    let mpa = |stress: f64| stress * 1e-6;
    let mut entities: Vec<(String, Values)> = vec![
        (paths::body_stress(), Box::new(move |s| vec![mpa(s.stress)])),
        (paths::layer_stress(), Box::new(move |s| s.layer_stress.iter().map(|v| mpa(*v)).collect())),
        (paths::broken(), Box::new(|s| vec![s.wires_broken as f64, s.bonds_broken as f64])),
        (paths::energy(), Box::new(energies)),
    ];
    if info.gauge.is_some() {
        entities.push((paths::body_strain(), Box::new(|s| vec![s.strain * 100.0])));
    }
    for layer in 0..info.layers.len() {
        let wires: Vec<usize> = (0..info.wires.len()).filter(|w| info.wires[*w].layer == layer).collect();
        entities.push((
            paths::wire_stress(info, layer),
            Box::new(move |s| wires.iter().filter_map(|w| s.wire_stress.get(*w)).map(|v| mpa(*v)).collect()),
        ));
    }
    if info.materials.len() > 1 {
        let pull = |of: Vec<usize>, count: usize| -> Values {
            Box::new(move |s| {
                let force = |k: usize| s.wire_pull.iter().zip(&of).filter(|(_, of)| **of == k).map(|(f, _)| f).sum();
                (0..count).map(force).collect()
            })
        };
        let layers = info.wires.iter().map(|wire| wire.layer).collect();
        let materials = info.wires.iter().map(|wire| wire.material).collect();
        entities.push((paths::layer_force(), pull(layers, info.layers.len())));
        entities.push((paths::material_force(), pull(materials, info.materials.len())));
    }
    for (path, values) in entities {
        let told = read.series.get(&path).map_or(&[][..], Vec::as_slice);
        search.same(told.len(), run.trajectory.samples.len(), || format!("rows of {path} in {RECORDING}"));
        for ((step, found), sample) in told.iter().zip(&run.trajectory.samples) {
            search.same(*step, sample.step as i64, || format!("step of {path}"));
            let right = values(sample);
            search.same(found.len(), right.len(), || format!("values of {path} at step {step}"));
            for (k, (found, right)) in found.iter().zip(&right).enumerate() {
                search.compare(*found, *right, right.abs(), || format!("{path}, {} at step {step}", k + 1));
            }
        }
    }
    let lines = run.trajectory.ruptures.len() + run.trajectory.notices.len();
    search.same(read.log.len(), lines, || format!("lines of the log in {RECORDING}"));
}

/// Stress of the bonds in the end, broken ones at nothing.
fn last_state(run: &Folder, read: &RecordingContents, search: &mut Search) {
    let info = &run.trajectory.info;
    let Some(last) = &run.trajectory.last else { return };
    for (w, wire) in info.wires.iter().enumerate() {
        let path = paths::wire(info, w);
        let Some(found) = read.last_fields.get(&path).and_then(|fields| fields.get(STRESS)) else {
            search.add(1.0, || format!("{RECORDING} has no stress of {path}"));
            continue;
        };
        search.same(found.len(), wire.len, || format!("particles of {path}"));
        for (k, stress) in found.iter().enumerate().take(wire.len) {
            let slot = shown(wire, k);
            let broken = last.bond_state[slot] == BondState::Broken;
            let right = if broken { 0.0 } else { (f64::from(last.bond_stress[slot]) * 1e-6) as f32 };
            search.same(*stress, right, || format!("{path}, bond {} in the end [MPa]", slot - wire.first + 1));
        }
    }
}

/// A particle shows the bond after it; the last one the bond before it.
fn shown(wire: &WireInfo, particle: usize) -> usize {
    wire.first + particle.min(wire.len.saturating_sub(2))
}
