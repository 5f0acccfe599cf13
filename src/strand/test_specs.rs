//! Specs built by hand, for tests of this floor and of those below it.

use crate::scene::spec::*;
use glam::DVec3;

/// A layer laid to the right, starting on the x axis.
pub(crate) fn layer(wires: usize, wire_diameter: f64, lay_radius: Option<f64>, pitch: f64) -> LayerSpec {
    LayerSpec {
        name: format!("{wires} wires"),
        wires,
        wire_diameter,
        lay_radius,
        pitch,
        lay: 1.0,
        phase: 0.0,
        material: 0,
    }
}

/// Nothing but annealed copper, elastic unbreakable bonds and touching spheres.
pub(crate) fn empty() -> Spec {
    Spec {
        name: "test".into(),
        about: "A scene built by a test.".into(),
        seed: 1,
        material_name: None,
        material: Material { density: 8940.0, young: 115e9, poisson: 0.34 },
        bond: BondSpec { law: BondLawSpec::Elastic, rupture: None, damping: [0.0; 4] },
        further: Vec::new(),
        contact: None,
        strand: None,
        wires: Vec::new(),
        spheres: Vec::new(),
        rigids: Vec::new(),
        spacing: 1.0,
        grip: None,
        holds: Vec::new(),
        time: TimeSpec {
            safety: 0.8,
            step: None,
            mass_scale: 1.0,
            inertia_scale: 1.0,
            contact_resolution: 0.4,
            kinetic_limit: 0.05,
            mismatch_limit: 0.05,
        },
        stop: StopSpec { time: Some(1e-6), ..StopSpec::default() },
        output: OutputSpec { samples: 10, snapshots: 2, rupture_density: 1.0, ..OutputSpec::default() },
        plan: PlanMode::Auto,
    }
}

/// The KA4 strand: 5 + 11 + 18 wires of 0.39 mm, pitch 39 mm, outer lay radius 1.165 mm, the inner ones `auto`.
pub(crate) fn ka4() -> Spec {
    let named = |name: &str, wires, radius| LayerSpec { name: name.into(), ..layer(wires, 0.39e-3, radius, 39e-3) };
    Spec {
        strand: Some(StrandSpec {
            length: 0.12,
            layers: vec![named("inner", 5, None), named("middle", 11, None), named("outer", 18, Some(1.165e-3))],
        }),
        ..empty()
    }
}

/// A wire along `path`, at rest, counted in the layer `wire`.
pub(crate) fn wire(diameter: f64, path: PathSpec) -> WireSpec {
    WireSpec { layer: "wire".into(), material: 0, diameter, path, velocity: DVec3::ZERO, spin: DVec3::ZERO }
}

/// A straight wire at rest.
pub(crate) fn straight(diameter: f64, from: DVec3, to: DVec3) -> WireSpec {
    wire(diameter, PathSpec::Straight { from, to })
}

/// A sphere at rest.
pub(crate) fn sphere(diameter: f64, position: DVec3) -> SphereSpec {
    SphereSpec { material: 0, diameter, position, velocity: DVec3::ZERO, spin: DVec3::ZERO }
}
