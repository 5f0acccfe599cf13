//! A solid sphere thrown to slide on a fixed plane under constant normal force: friction slows it and spins it up
//! until it rolls. Source: Timoshenko & Young, *Advanced Dynamics*, 1948 (the billiard ball).

/// Time from which the sphere rolls, 2 v₀/(7 μ g′) (s), thrown at `speed` v₀ (m/s) without spin, with friction
/// coefficient `friction` μ (-) and normal acceleration `acceleration` g′ = F_n/m (m/s²).
pub fn rolling_start(speed: f64, friction: f64, acceleration: f64) -> f64 {
    2.0 * speed / (7.0 * friction * acceleration)
}

/// Speed from then on, (5/7) v₀ (m/s).
pub fn rolling_speed(speed: f64) -> f64 {
    5.0 / 7.0 * speed
}

#[cfg(test)]
mod tests {
    use super::*;

    /// When it starts to roll, the surface speed of the spin, r ω = (5/2) μ g′ t, is the speed v₀ − μ g′ t.
    #[test]
    fn surface_does_not_slip_when_rolling_starts() {
        let (speed, friction, acceleration) = (1.3, 0.2, 9.81);
        let lost = friction * acceleration * rolling_start(speed, friction, acceleration);
        assert!((2.5 * lost - rolling_speed(speed)).abs() < 1e-12);
        assert!((speed - lost - rolling_speed(speed)).abs() < 1e-12);
    }
}
