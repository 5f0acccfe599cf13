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
