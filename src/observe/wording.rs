//! How a run is put into words for people: one place, so that log, tables and pictures agree.

use crate::engine::view::{RunInfo, Rupture};
use crate::scene::spec::Spec;
use serde::{Deserialize, Serialize};

/// Number of wire `wire` as people see it (-): counted from 1.
pub fn wire_number(wire: usize) -> usize {
    wire + 1
}

/// What the first break of a run is called: another strand has another.
pub const FIRST_BREAK: &str = "first break in this strand";

/// The line that tells of a rupture, such as
/// `wire 24, outer layer, snapped at z = 65.7 mm, strain 23.4 %, 294 MPa`: place of the bond when it broke,
/// strain of the body, true axial stress of the bond just before.
pub fn rupture_line(info: &RunInfo, rupture: &Rupture) -> String {
    format!(
        "wire {}, {} layer, snapped at z = {:.1} mm, strain {:.1} %, {:.0} MPa",
        wire_number(rupture.wire),
        info.layers[rupture.layer],
        rupture.position[2] * 1e3,
        rupture.strain * 1e2,
        rupture.stress * 1e-6,
    )
}

/// A run whose bonds scatter is one draw: another seed is another strand, with other weak places.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct OneDraw {
    /// Seed of the scatter.
    pub seed: u64,
    /// Weibull modulus of the rupture value from bond to bond (-).
    pub weibull_modulus: f64,
}

impl OneDraw {
    /// Of a scene; `None` where every bond is as strong as the other, or nothing can break.
    pub fn of(spec: &Spec) -> Option<Self> {
        let weibull_modulus = spec.bond.rupture.as_ref()?.weibull_modulus;
        weibull_modulus.is_finite().then_some(Self { seed: spec.seed, weibull_modulus })
    }

    /// What may be said of such a run, in a sentence.
    pub fn sentence(&self) -> String {
        format!(
            "One draw of the scatter (seed {}, Weibull modulus {}): which wire breaks first, in which layer and where, and the \
             last per cents of strength and elongation, are those of this strand; ensembles over seeds say what holds for \
             others.",
            self.seed, self.weibull_modulus
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::RuptureCause;

    #[test]
    fn a_scene_with_scatter_is_one_draw_and_one_without_is_not() {
        let of = |option: &str| OneDraw::of(&crate::scene::load("ka4", &[option.to_string()]).unwrap().spec);
        let draw = of("seed=7").unwrap();
        assert_eq!(draw, OneDraw { seed: 7, weibull_modulus: 30.0 });
        assert!(draw.sentence().contains("One draw of the scatter (seed 7, Weibull modulus 30)"));
        assert_eq!(of("bond.rupture.weibull_modulus=inf"), None);
        assert_eq!(OneDraw::of(&crate::scene::load("cantilever", &[]).unwrap().spec), None);
    }

    #[test]
    fn a_rupture_reads_well() {
        let info = RunInfo {
            name: String::new(),
            about: String::new(),
            layers: vec!["inner".into(), "outer".into()],
            wires: Vec::new(),
            wire_particles: 0,
            particles: 0,
            radius: Vec::new(),
            rest_position: Vec::new(),
            gauge: None,
            stress_range: [0.0, 1.0],
            plastic_strain_range: [0.0, 1.0],
            speed_range: [0.0, 1.0],
            contact_pressure_range: [0.0, 1.0],
            strain_end: None,
            negligible_energy: 1e-12,
            wave_passage: 3e-5,
        };
        let rupture = Rupture {
            order: 1,
            step: 10,
            time: 1e-3,
            strain: 0.2341,
            wire: 23,
            layer: 1,
            bond: 100,
            bond_in_wire: 10,
            position: [0.0, 1e-3, 0.06572],
            rest_z: 0.053,
            cause: RuptureCause::PlasticStrain,
            stress: 294.3e6,
            body_stress: 270.0e6,
            first_of_wire: true,
        };
        assert_eq!(
            rupture_line(&info, &rupture),
            "wire 24, outer layer, snapped at z = 65.7 mm, strain 23.4 %, 294 MPa"
        );
    }
}
