//! Circles through points, least squares.

use glam::{DMat2, DVec2, DVec3};

/// A circle through points in space.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ring {
    /// Its centre (in the unit of the points).
    pub centre: DVec3,
    /// Its radius (likewise).
    pub radius: f64,
    /// Greatest distance of a point from it (likewise).
    pub deviation: f64,
}

/// Centre of the circle through points of a plane that misses least: of |q|² − 2 q·c = R² − |c|², linear in c (Kåsa, *IEEE
/// Trans. Instrum. Meas.* 25, 1976). Each group has a radius of its own and the centre in common. `None` where they are
/// on one line.
pub fn common_centre<'a>(groups: impl Iterator<Item = &'a [DVec2]>) -> Option<DVec2> {
    let (mut matrix, mut right, mut scale) = (DMat2::ZERO, DVec2::ZERO, 0.0);
    for group in groups {
        let count = group.len() as f64;
        let mean = group.iter().sum::<DVec2>() / count;
        let squares = group.iter().map(|q| (*q - mean).length_squared()).sum::<f64>() / count;
        for point in group {
            let q = *point - mean;
            matrix += DMat2::from_cols(q * q.x, q * q.y);
            // About the mean, so that far points lose no digits.
            right += q * (0.5 * (q.length_squared() - squares) + q.dot(mean));
            scale += q.length_squared();
        }
    }
    let unknown = scale > 0.0 && matrix.determinant() > 1e-12 * scale * scale;
    unknown.then(|| matrix.inverse() * right)
}

/// The circle through points in space, in their order around it. `None` where they are on one line.
pub fn ring(points: &[DVec3]) -> Option<Ring> {
    let mean = points.iter().sum::<DVec3>() / points.len() as f64;
    let normal: DVec3 = points.windows(2).map(|two| (two[0] - mean).cross(two[1] - mean)).sum();
    let normal = normal.try_normalize()?;
    let [x, y] = {
        let (x, y) = normal.any_orthonormal_pair();
        [x, y]
    };
    let flat: Vec<DVec2> = points.iter().map(|p| DVec2::new((*p - mean).dot(x), (*p - mean).dot(y))).collect();
    let middle = common_centre(std::iter::once(&flat[..]))?;
    let radius = flat.iter().map(|q| q.distance(middle)).sum::<f64>() / flat.len() as f64;
    let centre = mean + x * middle.x + y * middle.y;
    let off = |p: &DVec3| {
        let (height, around) = ((*p - centre).dot(normal), (*p - centre).reject_from(normal).length());
        height.hypot(around - radius)
    };
    Some(Ring { centre, radius, deviation: points.iter().map(off).fold(0.0, f64::max) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_of_a_circle_gives_the_whole() {
        let (centre, x, y) = (DVec3::new(7.0, -2.0, 30.0), DVec3::new(0.6, 0.8, 0.0), DVec3::Z);
        for turn in [0.5, 2.0, 5.9] {
            let at = |i: usize| {
                let (s, c) = (turn * i as f64 / 10.0).sin_cos();
                centre + 0.2 * (c * x + s * y)
            };
            let found = ring(&(0..=10).map(at).collect::<Vec<_>>()).unwrap();
            assert!(found.centre.distance(centre) < 1e-9 && (found.radius - 0.2).abs() < 1e-9, "{turn}: {found:?}");
            assert!(found.deviation < 1e-9);
        }
        assert_eq!(ring(&[DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), None);
    }

    #[test]
    fn groups_share_a_centre() {
        let centre = DVec2::new(3.0, 4.0);
        let arc = |radius: f64, from: f64| -> Vec<DVec2> {
            (0..5).map(|i| centre + radius * DVec2::from_angle(from + 0.3 * i as f64)).collect()
        };
        let groups = [arc(1.0, 0.2), arc(2.0, 4.0)];
        let found = common_centre(groups.iter().map(|group| &group[..])).unwrap();
        assert!(found.distance(centre) < 1e-12, "{found}");
    }
}
