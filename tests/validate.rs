//! The shipped KA4 scene against the reference paper: the same strand, and a material that carries its test.

use strandsnap::reference::published::{CALIBRATED_ON, Published, find};
use strandsnap::reference::strand::{Layer, strength_factor};
use strandsnap::scene::spec::{BondLawSpec, GripKind, Spec};
use strandsnap::{scene, strand};

fn paper() -> &'static Published {
    find(CALIBRATED_ON).expect("it comes with the program")
}

fn ka4() -> Spec {
    scene::load("ka4", &[]).expect("the built-in scene loads").spec
}

#[test]
fn the_scene_is_the_papers_specimen() {
    let (spec, specimen) = (ka4(), &paper().specimen);
    let strand = spec.strand.as_ref().expect("a strand");
    let near = |a: f64, b: f64| assert!((a / b - 1.0).abs() < 1e-9, "{a} {b}");
    assert_eq!(strand.layers.iter().map(|l| l.wires).collect::<Vec<_>>(), specimen.wires_per_layer);
    for layer in &strand.layers {
        near(layer.wire_diameter * 1e3, specimen.wire_diameter_mm);
        near(layer.pitch * 1e3, specimen.pitch_mm);
    }
    near(strand.layers[2].lay_radius.expect("given") * 1e3, specimen.outer_lay_radius_mm);
    near(strand.length * 1e3, specimen.length_mm);
    let grip = spec.grip.as_ref().expect("grips");
    assert_eq!(grip.kind, GripKind::All);
    near((strand.length - 2.0 * grip.length) * 1e3, specimen.gauge_length_mm);
    near(spec.contact.as_ref().expect("contacts").friction, specimen.friction);
    // The paper rounds 4.0616 mm² to 4.
    let area = strand::build(&spec).expect("it can be built").area * 1e6;
    assert!((area - 4.0616).abs() < 1e-4 && (area - specimen.nominal_area_mm2).abs() < 0.1, "{area}");
}

/// What strand theory says of the calibrated material: wires strained uniformly to the experiment's elongation carry its
/// strength. The engine's own figure, from a run of minutes, stands in README.
#[test]
fn the_calibrated_material_carries_the_experiment() {
    let (spec, experiment) = (ka4(), &paper().experiment);
    let BondLawSpec::ElastoPlastic(law) = &spec.bond.law else { panic!("ka4 is elastoplastic") };
    let log_strain = (experiment.fracture_elongation_percent / 100.0).ln_1p();
    assert_eq!(law.considere(1.2 * log_strain), None, "uniform straining must stay stable up to rupture");
    let strand = spec.strand.as_ref().expect("a strand");
    let built = strand::build(&spec).expect("it can be built");
    let layers: Vec<Layer> = strand
        .layers
        .iter()
        .zip(&built.layers)
        .map(|(l, b)| Layer {
            wires: l.wires,
            diameter: l.wire_diameter,
            radius: b.lay_radius,
            pitch: l.pitch,
            lay: 1.0,
        })
        .collect();
    let strength = strength_factor(&layers) * law.stress(log_strain) * (-log_strain).exp() * 1e-6;
    let error = strength / experiment.tensile_strength_mpa - 1.0;
    assert!(error.abs() < 0.03, "{strength} MPa");
}
