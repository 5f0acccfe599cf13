//! From SI to the units of tables and reports: MPa, mm, N mm, %.

/// Pa → MPa.
pub fn mpa(pascal: f64) -> f64 {
    pascal * 1e-6
}

/// m → mm.
pub fn mm(metre: f64) -> f64 {
    metre * 1e3
}

/// N m → N mm.
pub fn newton_mm(newton_metre: f64) -> f64 {
    newton_metre * 1e3
}

/// Fraction → %.
pub fn percent(fraction: f64) -> f64 {
    fraction * 100.0
}
