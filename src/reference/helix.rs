//! The circular helix x = R cos θ, y = R sin θ, z = θ h/(2π): any textbook of differential geometry.

use std::f64::consts::TAU;

/// Lay angle β between wire and axis, tan β = 2π R/h (rad), for radius (m) and pitch (m) (infinite when straight).
pub fn lay_angle(radius: f64, pitch: f64) -> f64 {
    (TAU * radius / pitch).atan()
}

/// Arc length L/cos β of a wire that advances by `length` along the axis (m).
pub fn arc_length(radius: f64, pitch: f64, length: f64) -> f64 {
    length * 1.0_f64.hypot(TAU * radius / pitch)
}

/// Curvature sin²β/R (1/m); 0 on the axis.
pub fn curvature(radius: f64, pitch: f64) -> f64 {
    // R k²/(1 + R²k²) with k = 2π/h is sin²β/R without the division by a zero radius.
    let rate = TAU / pitch;
    radius * rate.powi(2) / (1.0 + (radius * rate).powi(2))
}

/// Torsion s sin β cos β/R (1/m) for lay direction `lay` s (+1 right, −1 left); s 2π/h on the axis.
pub fn torsion(radius: f64, pitch: f64, lay: f64) -> f64 {
    let rate = TAU / pitch;
    lay * rate / (1.0 + (radius * rate).powi(2))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Outer wire of KA4, worked by hand: tan β = 2π·1.165/39.
    #[test]
    fn outer_wire_of_ka4() {
        let (radius, pitch) = (1.165e-3, 39e-3);
        let beta = lay_angle(radius, pitch);
        assert!((beta.tan() - 0.187_690).abs() < 1e-6);
        assert!((beta.to_degrees() - 10.630).abs() < 1e-3);
        assert!((arc_length(radius, pitch, 0.12) - 0.12 / beta.cos()).abs() < 1e-15);
        assert!((curvature(radius, pitch) - beta.sin().powi(2) / radius).abs() < 1e-9);
        let torsion_right = torsion(radius, pitch, 1.0);
        assert!((torsion_right - beta.sin() * beta.cos() / radius).abs() < 1e-9);
        assert_eq!(torsion(radius, pitch, -1.0), -torsion_right);
    }

    #[test]
    fn straight_and_central_wires_are_straight() {
        assert_eq!(curvature(0.0, 39e-3), 0.0);
        assert_eq!(curvature(1e-3, f64::INFINITY), 0.0);
        assert_eq!(torsion(1e-3, f64::INFINITY, 1.0), 0.0);
        assert_eq!(arc_length(1e-3, f64::INFINITY, 0.1), 0.1);
        assert_eq!(lay_angle(1e-3, f64::INFINITY), 0.0);
    }
}
