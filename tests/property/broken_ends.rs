//! The two ends of a broken wire.

use crate::drive::*;

/// A wire that is pulled until it snaps, and then pushed together again.
const SNAPPED: &str = r#"
about = "A wire is pulled apart and pushed together."
[bond]
law = "elastic"
damping = 0.2
rupture = { criterion = "beam-stress", tensile = "115 MPa", shear = "1 GPa", weibull_modulus = 8 }
[contact]
normal = "hertz"
tangential = "none"
damping = 0.2
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "8 mm"]
[grip]
length = "0.1 mm"
displacement_amplitude = "0.016 mm"
frequency = "5 kHz"
[stop]
time = "1 ms"
"#;

/// They meet again where they parted, whatever the shape in contact and the spacing: nothing pushes while the crack is
/// open, and once it is closed something does.
#[test]
fn broken_ends_meet_where_they_parted() {
    for shape in ["sphere", "wire"] {
        for spacing in ["2", "1", "0.5", "0.25"] {
            if shape == "sphere" && spacing == "2" {
                continue;
            }
            let mut engine = engine(SNAPPED, &[&format!("contact.shape={shape}"), &format!("spacing={spacing}")]);
            let area = engine.assembly().area;
            let (mut open, mut opened, mut closed) = (0.0f64, 0.0f64, 0.0f64);
            while engine.time() < 190e-6 {
                run_steps(&mut engine, 50);
                let sample = engine.sample();
                let force = sample.stress * area;
                // Both pieces ring on: their mean counts.
                if sample.bonds_broken > 0 && sample.strain > 1e-4 {
                    (open, opened) = (open + force, opened + 1.0);
                }
                if opened > 0.0 && sample.strain < -1e-3 {
                    closed = closed.min(force);
                }
            }
            let whole = 115e9 * area * 1e-3;
            let open = open / opened;
            println!("{shape} {spacing}: open {open:.3e} N, closed {closed:.3e} N, a whole wire {whole:.3e} N");
            assert!(opened > 20.0 && open.abs() < 0.05 * whole, "{shape} {spacing}: {open} N with the crack open");
            assert!(-closed > 0.3 * whole, "{shape} {spacing}: {closed} N with the crack closed");
        }
    }
}
