//! Bodies that have passed through each other. The axes of two wires are polylines, and these never cross in nature; nor
//! does the centre of a free sphere come to lie inside another body.
//!
//! Between two neighbour searches particles move by less than the skin, so a pair of segments that changes sides does so
//! in full view: the volume 6V = (a₁ − a₀)·((b₁ − b₀) × (b₀ − a₀)) that the two span changes its sign, and at the instant
//! when it is zero the segments have a point in common. Overlap alone shows no crossing: wires of touching spheres that
//! are stretched by a quarter have gaps through which another wire just fits. A free sphere that goes through another
//! body is seen inside it, which takes longer than from one search to the next.

use crate::base::vectors::Vectors;
use crate::engine::neighbours::Neighbours;
use crate::engine::state::State;
use crate::engine::team::Team;
use crate::scene::spec::Shape;
use glam::DVec3;

/// Candidates that a thread looks at, one after the other.
const GRAIN: usize = 2048;
/// Halvings in the search for the instant at which two segments lie in one plane.
const HALVINGS: usize = 40;
/// Two segments have a point in common when they are nearer than this share of the smaller radius (-).
const COMMON: f64 = 0.05;

/// Two bonds of different wires, or of one, that have changed sides; or a free sphere with its centre in another body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Crossing {
    /// First particles of the two bonds; the free sphere, the smaller of two, comes first.
    pub between: [usize; 2],
    /// Where they crossed (m).
    pub position: DVec3,
}

/// The first pair, in the order of the list, that crossed since the last neighbour search, or of which one is in the other.
pub fn crossing(neighbours: &Neighbours, state: &State, wire_of: &[u32], team: &Team) -> Option<Crossing> {
    let (list, before) = neighbours.last();
    // Segments that cross have two ends within √½ of a length; before and after they may be a skin further apart.
    let near = std::f64::consts::FRAC_1_SQRT_2 * neighbours.longest() + neighbours.skin();
    let near2 = near * near;
    let look = Look { before, state, wire_of, shape: neighbours.shape() };
    let crossed = |(i, j): &(u32, u32)| {
        let (i, j) = (*i as usize, *j as usize);
        if look.is_sphere(i) || look.is_sphere(j) {
            return look.inside(i, j);
        }
        if (state.x.get(j) - state.x.get(i)).length_squared() > near2 {
            return None;
        }
        let [first, second] = [i, j].map(|p| [p.checked_sub(1), Some(p)]);
        let pairs = first.into_iter().flatten().flat_map(|a| second.into_iter().flatten().map(move |b| [a, b]));
        pairs.filter_map(|bonds| look.at(bonds)).next()
    };
    team.map(list.pairs.chunks(GRAIN), |_, pairs| pairs.iter().find_map(crossed)).into_iter().flatten().next()
}

struct Look<'a> {
    before: &'a Vectors,
    state: &'a State,
    wire_of: &'a [u32],
    shape: Shape,
}

impl Look<'_> {
    fn is_sphere(&self, particle: usize) -> bool {
        self.wire_of[particle] == u32::MAX
    }

    /// A pair with a free sphere, if its centre is inside the other body.
    fn inside(&self, i: usize, j: usize) -> Option<Crossing> {
        let State { x, radius, whole, .. } = self.state;
        let [smaller, larger] = if radius[j] < radius[i] { [j, i] } else { [i, j] };
        let [sphere, other] = match (self.is_sphere(i), self.is_sphere(j)) {
            (true, true) => [smaller, larger],
            (true, false) => [i, j],
            (false, _) => [j, i],
        };
        let centre = x.get(sphere);
        if x.get(other).distance(centre) < radius[larger] {
            return Some(Crossing { between: [sphere, other], position: centre });
        }
        // Small spheres may rest in the saddles of a chain, but no sphere on its axis.
        let near = match self.shape {
            Shape::Wire => radius[larger],
            Shape::Sphere => radius[smaller],
        };
        let bonds = [other.checked_sub(1), Some(other)].into_iter().flatten().filter(|bond| whole[*bond]);
        let mut distances = bonds.map(|bond| {
            let [_, on_axis] = nearest_points(&[centre, centre, x.get(bond), x.get(bond + 1)]);
            (bond, on_axis.distance(centre))
        });
        let through = distances.find(|(_, distance)| *distance < near);
        through.map(|(bond, _)| Crossing { between: [sphere, bond], position: centre })
    }

    fn at(&self, bonds @ [a, b]: [usize; 2]) -> Option<Crossing> {
        let whole = &self.state.whole;
        // Two bonds that share a particle, or lie beside a broken one that did, cannot cross.
        let beside = a.abs_diff(b) <= 2 && self.wire_of[a] == self.wire_of[b];
        if !whole[a] || !whole[b] || beside {
            return None;
        }
        let ends = [a, a + 1, b, b + 1];
        let (from, to) = (ends.map(|p| self.before.get(p)), ends.map(|p| self.state.x.get(p)));
        let side = volume(&from);
        if side * volume(&to) >= 0.0 {
            return None;
        }
        let between = |t: f64| std::array::from_fn(|k| from[k].lerp(to[k], t));
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..HALVINGS {
            let middle = 0.5 * (low + high);
            if volume(&between(middle)) * side > 0.0 { low = middle } else { high = middle }
        }
        let radius = ends.map(|p| self.state.radius[p]).into_iter().fold(f64::MAX, f64::min);
        let [p, q] = nearest_points(&between(high));
        (p.distance(q) < COMMON * radius).then_some(Crossing { between: bonds, position: 0.5 * (p + q) })
    }
}

/// Six times the signed volume that two segments span (m³).
fn volume([a0, a1, b0, b1]: &[DVec3; 4]) -> f64 {
    (a1 - a0).dot((b1 - b0).cross(b0 - a0))
}

/// The nearest points of two segments (Ericson 2005, Real-Time Collision Detection, 5.1.9).
fn nearest_points([a0, a1, b0, b1]: &[DVec3; 4]) -> [DVec3; 2] {
    let (u, v, w) = (a1 - a0, b1 - b0, a0 - b0);
    let (uu, uv, vv, uw, vw) = (u.dot(u), u.dot(v), v.dot(v), u.dot(w), v.dot(w));
    let denominator = uu * vv - uv * uv;
    // Parallel segments, and a point: any point of the first will do to begin with.
    let s = if denominator > 1e-12 * uu * vv { ((uv * vw - uw * vv) / denominator).clamp(0.0, 1.0) } else { 0.0 };
    let t = ((uv * s + vw) / vv).clamp(0.0, 1.0);
    let s = if uu > 0.0 { ((uv * t - uw) / uu).clamp(0.0, 1.0) } else { 0.0 };
    [a0 + u * s, b0 + v * t]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearest_points_are_those_of_a_fine_search() {
        let p = |x: f64, y: f64, z: f64| DVec3::new(x, y, z);
        let cases = [
            [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.5, -1.0, 0.3), p(0.6, 1.0, 0.1)],
            [p(0.0, 0.0, 0.0), p(1.0, 0.2, 0.0), p(2.0, 0.0, 0.3), p(1.5, 1.0, 0.1)],
            [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(0.4, 0.5, 0.0), p(1.4, 0.5, 0.0)],
        ];
        for case in cases {
            let [a, b] = nearest_points(&case);
            let [a0, a1, b0, b1] = case;
            let fine = (0..=400)
                .flat_map(|s| (0..=400).map(move |t| (f64::from(s) / 400.0, f64::from(t) / 400.0)))
                .map(|(s, t)| a0.lerp(a1, s).distance(b0.lerp(b1, t)))
                .fold(f64::MAX, f64::min);
            assert!((a.distance(b) - fine).abs() < 5e-3, "{} {fine}", a.distance(b));
        }
    }
}
