//! A strand pulled elastically, against strand theory.

use crate::support::{case, set};
use strandsnap::reference::strand::{Layer, stiffness_factor, stiffness_factor_contracting};

#[test]
fn elastic_strand_at_four_pitches() {
    for pitch in [39.0, 44.0, 49.0, 54.0] {
        let mut case = case("strand-elastic", &[set("strand.pitch", format!("{pitch} mm"))]);
        let a = case.engine.assembly();
        let layers: Vec<Layer> = (0..a.layers.len())
            .map(|k| Layer {
                wires: a.wires.iter().filter(|w| w.layer == k).count(),
                diameter: 0.39e-3,
                radius: a.layers[k].lay_radius,
                pitch: pitch * 1e-3,
            })
            .collect();
        let upper = stiffness_factor(&layers);
        let lower = stiffness_factor_contracting(&layers, case.spec.material.poisson);
        let began = std::time::Instant::now();
        let mut points = Vec::new();
        case.run(|engine| {
            if engine.steps().is_multiple_of(50) {
                points.push([engine.strain(), engine.stress()]);
            }
        });
        let at = |strain: f64| points.iter().find(|p| p[0] >= strain).unwrap();
        for pair in [[0.001, 0.003], [0.003, 0.006], [0.006, 0.0098]] {
            let (a, b) = (at(pair[0]), at(pair[1]));
            let slope = (b[1] - a[1]) / (b[0] - a[0]) / case.spec.material.young;
            println!("pitch {pitch}: {pair:?} E_strand/E = {slope:.4}");
        }
        let s = case.engine.sample();
        println!(
            "pitch {pitch}: bounds {lower:.4} to {upper:.4}; {} steps, {:?}; radii {:?}; {} contacts; kinetic {:.1e}; forces {:?}",
            case.engine.steps(),
            began.elapsed(),
            layers.iter().map(|l| l.radius * 1e3).collect::<Vec<_>>(),
            s.contacts,
            s.energy.kinetic / s.energy.internal(),
            s.grip_force,
        );
        case.check_ledger();
    }
}
