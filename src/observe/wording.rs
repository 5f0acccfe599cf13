//! How a run is put into words for people: one place, so that log, tables and pictures agree.

use crate::engine::view::{RunInfo, Rupture};

/// Number of wire `wire` as people see it [-]: counted from 1.
pub fn wire_number(wire: usize) -> usize {
    wire + 1
}

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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::RuptureCause;

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
