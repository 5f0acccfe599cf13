//! Points in the units of the search.

use nalgebra::DVector;

/// Points moved and scaled to u and v of −1 to 1, which keeps the search well-conditioned.
pub(super) struct Scaled {
    /// Middle and half-width of x.
    pub x: [f64; 2],
    /// Middle and half-width of y; a half-width of 1 when all are equal.
    pub y: [f64; 2],
    /// u.
    pub u: Vec<f64>,
    /// v.
    pub v: Vec<f64>,
    /// Whether all y are equal.
    pub flat: bool,
}

impl Scaled {
    pub fn new(points: &[[f64; 2]]) -> Self {
        let span = |k: usize| {
            let ends = points
                .iter()
                .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], point| [low.min(point[k]), high.max(point[k])]);
            [0.5 * (ends[0] + ends[1]), 0.5 * (ends[1] - ends[0])]
        };
        let (x, y) = (span(0), span(1));
        let flat = y[1] <= f64::EPSILON * y[0].abs();
        let unit = |[middle, half]: [f64; 2]| [middle, if half > 0.0 { half } else { 1.0 }];
        let (x, y) = (unit(x), if flat { [y[0], 1.0] } else { y });
        let scale =
            |k: usize, [middle, half]: [f64; 2]| points.iter().map(|point| (point[k] - middle) / half).collect();
        Self { x, y, u: scale(0, x), v: scale(1, y), flat }
    }

    pub fn v(&self) -> DVector<f64> {
        DVector::from_column_slice(&self.v)
    }
}
