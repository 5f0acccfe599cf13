//! What lies under a pixel: rays against pieces of wire, in closed form, in the coordinates of the view.

use glam::{Vec2, Vec3};

/// A piece of wire between two spheres, as cone with round ends.
pub struct Cone<T> {
    /// Centres in view coordinates (mm): x right, y up, z towards the eye; and radii (mm).
    pub ends: [(Vec3, f32); 2],
    /// What each end stands for.
    pub what: [T; 2],
}

/// A particle under a pixel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Picked {
    /// The particle, from 0.
    pub particle: usize,
    /// Its wire, from 0; `None` for a free sphere.
    pub wire: Option<usize>,
}

/// The end nearest to what is seen at `at` (mm): of the piece whose surface lies nearest to the eye there.
pub fn nearest<T: Copy>(cones: &[Cone<T>], at: Vec2) -> Option<T> {
    let hits = cones.iter().filter_map(|cone| {
        let (z, s) = hit(&cone.ends, at)?;
        Some((z, cone.what[usize::from(s > 0.5)]))
    });
    hits.max_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, what)| what)
}

/// Height of the surface over `at` (mm) and the place along the axis (0 to 1).
fn hit([(a, ra), (b, rb)]: &[(Vec3, f32); 2], at: Vec2) -> Option<(f32, f32)> {
    let widest = ra.max(*rb);
    let low = a.truncate().min(b.truncate()) - widest;
    let high = a.truncate().max(b.truncate()) + widest;
    if at.cmplt(low).any() || at.cmpgt(high).any() {
        return None;
    }
    let sphere = |centre: Vec3, radius: f32, s: f32| {
        let depth = radius * radius - (at - centre.truncate()).length_squared();
        (depth >= 0.0).then(|| (centre.z + depth.sqrt(), s))
    };
    [sphere(*a, *ra, 0.0), sphere(*b, *rb, 1.0), flank(*a, *b, *ra, *rb, at)]
        .into_iter()
        .flatten()
        .max_by(|a, b| a.0.total_cmp(&b.0))
}

/// The cone between the spheres: |w|² − (w·d)² = (r_a + k w·d)² with w = (at, a.z + t) − a, solved for the greater t.
fn flank(a: Vec3, b: Vec3, ra: f32, rb: f32, at: Vec2) -> Option<(f32, f32)> {
    let length = (b - a).length();
    if length < 1e-9 {
        return None;
    }
    let d = (b - a) / length;
    let k = (rb - ra) / length;
    let w = at - a.truncate();
    let m = w.dot(d.truncate());
    let r = ra + k * m;
    let qa = 1.0 - d.z * d.z * (1.0 + k * k);
    let qb = -d.z * (m + k * r);
    let qc = w.length_squared() - m * m - r * r;
    let discriminant = qb * qb - qa * qc;
    if discriminant <= 0.0 || qa <= 1e-6 {
        return None;
    }
    let t = (-qb + discriminant.sqrt()) / qa;
    let s = (m + t * d.z) / length;
    (0.0..=1.0).contains(&s).then_some((a.z + t, s))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cone(a: Vec3, b: Vec3, what: [usize; 2]) -> Cone<usize> {
        Cone { ends: [(a, 1.0), (b, 1.0)], what }
    }

    #[test]
    fn the_piece_in_front_is_picked_at_its_nearer_end() {
        let along = cone(Vec3::new(-5.0, 0.0, 0.0), Vec3::new(5.0, 0.0, 0.0), [1, 2]);
        let across = cone(Vec3::new(0.0, -5.0, 1.9), Vec3::new(0.0, 5.0, 1.9), [3, 4]);
        let cones = [along, across];
        assert_eq!(nearest(&cones, Vec2::new(-3.0, 0.5)), Some(1));
        assert_eq!(nearest(&cones, Vec2::new(3.0, -0.9)), Some(2));
        assert_eq!(nearest(&cones, Vec2::new(0.2, 0.1)), Some(4), "the one across lies in front");
        assert_eq!(nearest(&cones, Vec2::new(3.0, 1.1)), None);
        assert_eq!(nearest(&cones, Vec2::new(5.9, 0.0)), Some(2), "ends are round");
        assert_eq!(nearest(&cones, Vec2::new(6.1, 0.0)), None);
    }

    #[test]
    fn a_cylinder_seen_from_the_side_has_the_height_of_its_circle() {
        let ends = [(Vec3::new(-2.0, 0.0, 3.0), 0.5), (Vec3::new(2.0, 0.0, 3.0), 0.5)];
        let (z, s) = hit(&ends, Vec2::new(1.0, 0.3)).unwrap();
        assert!((z - 3.4).abs() < 1e-6 && (s - 0.75).abs() < 1e-6);
    }

    #[test]
    fn a_slanted_cone_agrees_with_marching_along_the_ray() {
        let (a, ra, b, rb) = (Vec3::new(-1.0, 0.2, -0.5), 0.6, Vec3::new(1.5, -0.3, 1.2), 0.4);
        let at = Vec2::new(0.4, 0.1);
        let (z, _) = hit(&[(a, ra), (b, rb)], at).unwrap();
        let inside = |z: f32| {
            let p = at.extend(z);
            let s = (p - a).dot(b - a) / (b - a).length_squared();
            (p - a.lerp(b, s)).length() < ra + (rb - ra) * s
        };
        assert!(inside(z - 1e-3) && !inside(z + 1e-3));
    }
}
