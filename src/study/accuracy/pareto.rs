//! The front of what cannot be had both faster and more exact.

/// Indices of the (cost, error) points that no other point beats, by rising cost. Of equal points the first counts;
/// points that are not finite never do.
pub fn front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..points.len()).filter(|i| points[*i].iter().all(|v| v.is_finite())).collect();
    order.sort_by(|a, b| points[*a][0].total_cmp(&points[*b][0]).then(points[*a][1].total_cmp(&points[*b][1])));
    let mut best = f64::INFINITY;
    order.retain(|i| {
        let better = points[*i][1] < best;
        best = best.min(points[*i][1]);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::front;

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [[4.0, 1.0], [1.0, 9.0], [2.0, 5.0], [3.0, 6.0], [5.0, 1.0], [2.0, 5.0], [0.5, f64::NAN]];
        assert_eq!(front(&points), [1, 2, 0]);
        assert_eq!(front(&[]), Vec::<usize>::new());
    }
}
