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

/// The front as a staircase: below and left of it nothing was found. It begins at the greatest error and ends at the
/// greatest cost among the points.
pub fn staircase(points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let corners: Vec<[f64; 2]> = front(points).into_iter().map(|i| points[i]).collect();
    let greatest = |k: usize| points.iter().map(|p| p[k]).filter(|v| v.is_finite()).fold(0.0, f64::max);
    let (Some(first), Some(last)) = (corners.first(), corners.last()) else { return Vec::new() };
    let mut stairs = vec![[first[0], greatest(1)]];
    for pair in corners.windows(2) {
        stairs.extend([pair[0], [pair[1][0], pair[0][1]]]);
    }
    stairs.extend([*last, [greatest(0), last[1]]]);
    stairs
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stairs_run_from_the_greatest_error_to_the_greatest_cost() {
        let points = [[1.0, 4.0], [2.0, 2.0], [3.0, 5.0], [5.0, 3.0]];
        assert_eq!(staircase(&points), [[1.0, 5.0], [1.0, 4.0], [2.0, 4.0], [2.0, 2.0], [5.0, 2.0]]);
        assert!(staircase(&[]).is_empty());
    }

    #[test]
    fn the_front_is_what_nothing_beats() {
        let points = [[4.0, 1.0], [1.0, 9.0], [2.0, 5.0], [3.0, 6.0], [5.0, 1.0], [2.0, 5.0], [0.5, f64::NAN]];
        assert_eq!(front(&points), [1, 2, 0]);
        assert_eq!(front(&[]), Vec::<usize>::new());
    }
}
