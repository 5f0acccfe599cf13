//! Rigid bodies in tables: `bodies.csv`, and what the summary says of them.

use super::column::Column;
use crate::base::units::{mm, newton_mm, percent};
use crate::engine::view::{BodyInfo, BodyState, RunInfo, Sample};
use serde::{Deserialize, Serialize};

/// The table of rigid bodies, which a run writes that has any.
pub const BODIES: &str = "bodies.csv";

/// A row of it: a body at a row of the curve.
pub struct BodyRow {
    step: u64,
    time: f64,
    strain: f64,
    name: String,
    state: BodyState,
}

/// Its rows at a row of the curve, a body each.
pub fn rows<'a>(info: &'a RunInfo, sample: &'a Sample) -> impl Iterator<Item = BodyRow> + 'a {
    let Sample { step, time, strain, .. } = *sample;
    let row = move |(body, state): (&'a BodyInfo, &BodyState)| BodyRow {
        step,
        time,
        strain,
        name: body.name.clone(),
        state: *state,
    };
    info.bodies.iter().zip(&sample.bodies).map(row)
}

/// Its columns. Force, moment, place and angle are means over the same time as stress and strain.
pub fn columns() -> Vec<Column<'static, BodyRow>> {
    type B = BodyRow;
    let mut columns = vec![
        Column::described("step", "", "step of the engine", |b: &B| b.step),
        Column::described("time_s", "s", "simulated time", |b: &B| b.time),
        Column::described("strain_percent", "%", "grip displacement over free length", |b: &B| percent(b.strain)),
        Column::described("body", "", "name of the rigid body", |b: &B| b.name.clone()),
    ];
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let about = format!("force along {name} of all that touches it on the body");
        columns.push(Column::described(format!("force_{name}_n"), "N", about, move |b: &B| b.state.force[axis]));
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let about = format!("moment about {name} of these forces about its place");
        let of = move |b: &B| newton_mm(b.state.moment[axis]);
        columns.push(Column::described(format!("moment_{name}_n_mm"), "N mm", about, of));
    }
    for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
        let about = format!("{name} of its place");
        columns.push(Column::described(format!("{name}_mm"), "mm", about, move |b: &B| mm(b.state.position[axis])));
    }
    let turned = |b: &B| b.state.angle.to_degrees();
    columns.push(Column::described("angle_deg", "deg", "by how much it has turned about its axis", turned));
    columns
}

/// What a summary says of a rigid body.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BodyLoads {
    /// Its name.
    pub name: String,
    /// Greatest force on it in a row (N).
    pub greatest_force_n: f64,
    /// When that was (s).
    pub greatest_force_at_s: f64,
    /// Force on it at the end (N).
    pub force_n: [f64; 3],
    /// Moment on it about its place at the end (N mm).
    pub moment_n_mm: [f64; 3],
    /// Its place at the end (mm).
    pub position_mm: [f64; 3],
    /// By how much it has turned by then (deg).
    pub angle_deg: f64,
}

/// Gathers what a summary says.
#[derive(Default)]
pub struct Gathered {
    /// Of each body: greatest force (N), and when (s).
    greatest: Vec<[f64; 2]>,
}

impl Gathered {
    /// Takes in a row.
    pub fn see(&mut self, sample: &Sample) {
        self.greatest.resize(sample.bodies.len(), [0.0; 2]);
        for (greatest, body) in self.greatest.iter_mut().zip(&sample.bodies) {
            let force = glam::DVec3::from(body.force).length();
            if force > greatest[0] {
                *greatest = [force, sample.time];
            }
        }
    }

    /// What is to be said after the `last` row.
    pub fn loads(&self, info: &RunInfo, last: &Sample) -> Vec<BodyLoads> {
        let all = info.bodies.iter().zip(&self.greatest).zip(&last.bodies);
        let one = |((body, [force, time]), state): ((&BodyInfo, &[f64; 2]), &BodyState)| BodyLoads {
            name: body.name.clone(),
            greatest_force_n: *force,
            greatest_force_at_s: *time,
            force_n: state.force,
            moment_n_mm: state.moment.map(newton_mm),
            position_mm: state.position.map(mm),
            angle_deg: state.angle.to_degrees(),
        };
        all.map(one).collect()
    }
}
