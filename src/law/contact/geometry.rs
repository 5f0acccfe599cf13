//! Pure geometry of contacts: where a point and a segment are nearest.

use glam::DVec3;

/// The point of a segment nearest to another point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClosestOnSegment {
    /// Parameter of the foot of the perpendicular on the endless line, before clamping (-): below 0 or above 1 where
    /// the foot lies beyond an end.
    pub raw: f64,
    /// `raw` clamped to [0, 1] (-).
    pub t: f64,
    /// The nearest point a + t (b − a) (m).
    pub point: DVec3,
}

/// Nearest point of the segment from `a` to `b` to the point `p` (Ericson, Real-Time Collision Detection, 5.1.2).
///
/// A segment without length answers its end `a` with both parameters 0.
#[inline(always)]
pub fn closest_on_segment(p: DVec3, a: DVec3, b: DVec3) -> ClosestOnSegment {
    let along = b - a;
    let length_squared = along.length_squared();
    let raw = if length_squared > 0.0 { (p - a).dot(along) / length_squared } else { 0.0 };
    let t = raw.clamp(0.0, 1.0);
    ClosestOnSegment { raw, t, point: a + along * t }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const A: DVec3 = DVec3::new(1.0, 0.0, 0.0);
    const B: DVec3 = DVec3::new(1.0, 0.0, 4.0);

    #[test]
    fn beside_the_segment_the_foot_is_inside() {
        let foot = closest_on_segment(DVec3::new(3.0, -2.0, 1.0), A, B);
        assert_eq!(foot, ClosestOnSegment { raw: 0.25, t: 0.25, point: DVec3::new(1.0, 0.0, 1.0) });
    }

    #[test]
    fn beyond_the_ends_the_end_answers_and_raw_says_how_far() {
        let before = closest_on_segment(DVec3::new(0.0, 0.0, -2.0), A, B);
        assert_eq!((before.raw, before.t, before.point), (-0.5, 0.0, A));
        let after = closest_on_segment(DVec3::new(0.0, 5.0, 6.0), A, B);
        assert_eq!((after.raw, after.t, after.point), (1.5, 1.0, B));
    }

    #[test]
    fn a_segment_without_length_is_a_point() {
        let foot = closest_on_segment(B, A, A);
        assert_eq!((foot.raw, foot.t, foot.point), (0.0, 0.0, A));
    }

    fn vector() -> impl Strategy<Value = DVec3> {
        [-1.0..1.0f64, -1.0..1.0, -1.0..1.0].prop_map(DVec3::from_array)
    }

    proptest! {
        #[test]
        fn no_other_point_of_the_segment_is_nearer(p in vector(), a in vector(), b in vector(), t in 0.0..1.0f64) {
            let foot = closest_on_segment(p, a, b);
            let other = a + (b - a) * t;
            prop_assert!(foot.point.distance(p) <= other.distance(p) + 1e-12);
        }

        #[test]
        fn turning_the_segment_round_mirrors_the_parameter(p in vector(), a in vector(), b in vector()) {
            prop_assume!(a.distance(b) > 1e-3);
            let (forth, back) = (closest_on_segment(p, a, b), closest_on_segment(p, b, a));
            prop_assert!((forth.raw + back.raw - 1.0).abs() < 1e-9);
            prop_assert!(forth.point.distance(back.point) < 1e-12);
        }
    }
}
