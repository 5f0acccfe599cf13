//! A strand pulled elastically, against strand theory.

use crate::support::{Case, case, set};
use strandsnap::engine::Engine;
use strandsnap::reference::strand::{Layer, stiffness_factor, stiffness_factor_contracting, wire_strain};

fn layers(case: &Case, pitch: f64) -> Vec<Layer> {
    let a = case.engine.assembly();
    (0..a.layers.len())
        .map(|k| Layer {
            wires: a.wires.iter().filter(|w| w.layer == k).count(),
            diameter: 0.39e-3,
            radius: a.layers[k].lay_radius,
            pitch,
        })
        .collect()
}

/// Strand strain and relative lay radius of each layer over the middle third.
fn middle(engine: &Engine) -> Vec<[f64; 2]> {
    let (a, s) = (engine.assembly(), engine.state());
    (0..a.layers.len())
        .map(|k| {
            let (mut before, mut after, mut radius, mut count) = (0.0, 0.0, 0.0, 0);
            for w in a.wires.iter().filter(|w| w.layer == k) {
                let (low, high) = (w.first + w.len / 3, w.first + 2 * w.len / 3);
                before += a.position.z[high] - a.position.z[low];
                after += s.x.z[high] - s.x.z[low];
                for p in low..=high {
                    radius += s.x.x[p].hypot(s.x.y[p]) / a.position.x[p].hypot(a.position.y[p]);
                    count += 1;
                }
            }
            [after / before - 1.0, radius / f64::from(count)]
        })
        .collect()
}

#[test]
fn elastic_strand_at_four_pitches() {
    for pitch in [39.0, 44.0, 49.0, 54.0] {
        let mut case = case("strand-elastic", &[set("strand.pitch", format!("{pitch} mm"))]);
        let layers = layers(&case, pitch * 1e-3);
        let young = case.spec.material.young;
        let upper = stiffness_factor(&layers);
        let lower = stiffness_factor_contracting(&layers, case.spec.material.poisson);
        let began = std::time::Instant::now();
        case.run(|_| {});
        let now = middle(&case.engine);
        let (mut sum, mut wires) = (0.0, 0);
        for (layer, [strain, radius]) in layers.iter().zip(&now) {
            let x = wire_strain(*strain, layer.lay_angle(), *radius);
            sum += layer.wires as f64 * x.ln_1p() * (1.0 + strain) * layer.lay_angle().cos() / (1.0 + x);
            wires += layer.wires;
        }
        let predicted = sum / f64::from(wires as u32);
        let s = case.engine.sample();
        println!(
            "pitch {pitch}: E/E = {:.4}, bounds {lower:.4} to {upper:.4}; stress/E {:.6e}, from the geometry {predicted:.6e} ({:+.2e}); middle {now:?}; {} steps, {:?}; {} contacts; kinetic {:.1e}",
            s.stress / young / s.strain,
            s.stress / young,
            s.stress / young / predicted - 1.0,
            case.engine.steps(),
            began.elapsed(),
            s.contacts,
            s.energy.kinetic / s.energy.internal(),
        );
        case.check_ledger();
    }
    for spacing in [2.0, 1.0, 0.5] {
        for safety in [0.8] {
            let mut case = case(
                "strand-elastic",
                &[set("strand.length", "15 mm"), set("spacing", spacing), set("time.safety", safety)],
            );
            let began = std::time::Instant::now();
            case.run(|_| {});
            let s = case.engine.sample();
            println!(
                "spacing {spacing}: E/E {:.4}, middle {:?} {:?}",
                s.stress / case.spec.material.young / s.strain,
                middle(&case.engine),
                began.elapsed()
            );
        }
    }
}
