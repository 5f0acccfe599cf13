//! What a scene asks for beside the rest of a snapshot.

use super::step_view::StepView;
use super::view::{Detail, GripState, Load, Touch};
use crate::base::vectors::Vectors;
use crate::scene::look::Table;
use crate::strand::assembly::Wire;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// The tables of a snapshot (`output.tables`); `None` where the scene asks for none.
pub(super) fn detail(view: &StepView) -> Option<Box<Detail>> {
    let tables = &view.spec.output.tables;
    let of = |table: Table, list: &Vectors| -> Vec<[f64; 3]> {
        if tables.contains(&table) { list.iter().map(|v| v.to_array()).collect() } else { Vec::new() }
    };
    (!tables.is_empty()).then(|| {
        Box::new(Detail {
            position: of(Table::Positions, &view.state.x),
            velocity: of(Table::Velocities, &view.state.v),
            spin: of(Table::Spins, &view.state.w),
            holds: if tables.contains(&Table::Holds) { view.holds.reactions() } else { Vec::new() },
            contacts: if tables.contains(&Table::Contacts) { touches(view) } else { Vec::new() },
            grips: tables.contains(&Table::Grips).then(|| grips(view)).flatten(),
        })
    })
}

impl From<[DVec3; 2]> for Load {
    fn from([force, moment]: [DVec3; 2]) -> Self {
        Self { force: force.to_array(), moment: moment.to_array() }
    }
}

fn touches(view: &StepView) -> Vec<Touch> {
    let mut all = Vec::new();
    if let Some(contacts) = view.contacts {
        contacts.each_touch(view.state, &mut |touch| all.push(touch));
    }
    all
}

/// How far the upper grip has gone, and the lay of each layer between the grips.
fn grips(view: &StepView) -> Option<GripState> {
    let stretch = &view.holds.stretch;
    let [low, high] = stretch.gauge;
    let lay = |layer: usize| {
        let wires = view.assembly.wires.iter().filter(|wire| wire.layer == layer);
        let lays: Vec<[f64; 2]> = wires.filter_map(|wire| lay(view, wire)).collect();
        let mean = |k: usize| lays.iter().map(|lay| lay[k]).sum::<f64>() / lays.len() as f64;
        (!lays.is_empty()).then(|| [mean(0), mean(1)])
    };
    (high > low).then(|| GripState {
        displacement: stretch.displacement,
        angle: view.holds.angle,
        lay: (0..view.assembly.layers.len()).map(lay).collect(),
    })
}

/// Lay length and lay radius of a wire between the grips (m): 2π Δz/Δφ over its particles there, φ being the angle about the axis of
/// the grips, and the mean distance from that axis. `None` where it is broken there, or lies on the axis.
fn lay(view: &StepView, wire: &Wire) -> Option<[f64; 2]> {
    let [low, high] = view.holds.stretch.gauge;
    let axis = view.holds.axis();
    let between = |i: &usize| (low..=high).contains(&view.assembly.position.get(*i).z);
    let inside: Vec<usize> = (wire.first..wire.first + wire.len).filter(between).collect();
    let (first, last) = (*inside.first()?, *inside.last()?);
    if last == first || !view.state.whole[first..last].iter().all(|whole| *whole) {
        return None;
    }
    let arm = |i: usize| view.state.x.get(i).truncate() - DVec2::from(axis);
    let radius = inside.iter().map(|i| arm(*i).length()).sum::<f64>() / inside.len() as f64;
    // What trembles about the axis has no lay.
    if radius < 0.1 * wire.diameter {
        return None;
    }
    let turned: f64 = inside.windows(2).map(|pair| arm(pair[0]).angle_to(arm(pair[1]))).sum();
    let way = view.state.x.get(last).z - view.state.x.get(first).z;
    Some([if turned == 0.0 { f64::INFINITY } else { (TAU * way / turned).abs() }, radius])
}
