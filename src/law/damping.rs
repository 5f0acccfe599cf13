//! Viscous damping as a fraction of critical.

/// c = 2 ξ √(m k) [N s/m] (or [N m s] for rotation) from the fraction of critical ξ [-], mass [kg] (or inertia) and
/// stiffness [N/m] (or [N m/rad]).
#[inline(always)]
pub fn viscous_coefficient(fraction: f64, mass: f64, stiffness: f64) -> f64 {
    2.0 * fraction * (mass * stiffness).sqrt()
}
