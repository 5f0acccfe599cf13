//! The common axis of a strand's wires.
//!
//! Of points at equal distances along a helix, p(i−k) − 2 p(i) + p(i+k) is radial, so that the cross product of two of them
//! has the direction of the axis; circles about one centre in the plane across give its place. Then both are refined: the
//! axis is that about which the wires' distances vary least (least squares, Gauss–Newton).

use super::circle::common_centre;
use glam::{DAffine3, DQuat, DVec2, DVec3};

/// Points at equal distances that are looked at for each wire.
pub const STATIONS: usize = 120;
/// Extent of each wire along the axis, over its length, below which there is none (-): a lay angle of 78°.
const LEAST_EXTENT: f64 = 0.2;
/// Rounds of the refinement.
const ROUNDS: usize = 8;

/// An axis.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Axis {
    /// A point of it (m).
    pub origin: DVec3,
    /// Unit vector along it.
    pub direction: DVec3,
}

/// What is known of a wire: points of it (m), at equal distances where it is curved.
#[derive(Debug, Clone)]
pub struct Course {
    /// [`STATIONS`] + 1 points at equal distances.
    pub even: Vec<DVec3>,
    /// Points to fit to: the same, or corners of a polygon, which alone lie on its curve.
    pub points: Vec<DVec3>,
    /// Whether it is straight to within what its file can tell.
    pub is_straight: bool,
}

impl Course {
    /// Of a wire by its points; `off` (m) is the distance from a straight line that means nothing.
    pub fn new(even: Vec<DVec3>, points: Vec<DVec3>, off: f64) -> Self {
        let (from, to) = (points[0], points[points.len() - 1]);
        let along = (to - from).normalize_or_zero();
        let is_straight =
            along != DVec3::ZERO && points.iter().all(|p| (*p - from).reject_from_normalized(along).length() <= off);
        Self { even, points, is_straight }
    }

    fn span(&self) -> DVec3 {
        self.points[self.points.len() - 1] - self.points[0]
    }
}

impl Axis {
    /// The common axis; `None` where there is none.
    pub fn common(wires: &[Course]) -> Option<Self> {
        let curved: Vec<&Course> = wires.iter().filter(|wire| !wire.is_straight).collect();
        let direction = match curved.is_empty() {
            true => mean_span(wires),
            false => across_curvature(&curved),
        };
        let direction = upward(direction?);
        let centroid = {
            let points = wires.iter().flat_map(|wire| &wire.points);
            points.clone().sum::<DVec3>() / points.count() as f64
        };
        let start = Self { origin: centroid, direction };
        let axis = if curved.is_empty() { start } else { start.centred(&curved).refined(&curved) };
        let follows = |wire: &Course| {
            let length: f64 = wire.even.windows(2).map(|two| two[0].distance(two[1])).sum();
            wire.span().dot(axis.direction).abs() >= LEAST_EXTENT * length
        };
        (axis.origin.is_finite() && wires.iter().all(follows)).then_some(axis)
    }

    /// To coordinates whose z runs along the axis.
    pub fn upright(&self) -> DAffine3 {
        // The least turn that brings the axis upright, which leaves an upright one as it is.
        let turn = DQuat::from_rotation_arc(self.direction, DVec3::Z);
        DAffine3::from_quat(turn) * DAffine3::from_translation(-self.origin)
    }

    fn centred(self, curved: &[&Course]) -> Self {
        let upright = self.upright();
        let flat = |wire: &&Course| -> Vec<DVec2> {
            wire.points.iter().map(|point| upright.transform_point3(*point).truncate()).collect()
        };
        let groups: Vec<Vec<DVec2>> = curved.iter().map(flat).collect();
        match common_centre(groups.iter().map(|group| &group[..])) {
            Some(centre) => Self { origin: upright.inverse().transform_point3(centre.extend(0.0)), ..self },
            None => self,
        }
    }

    /// The axis about which distances vary least.
    fn refined(self, curved: &[&Course]) -> Self {
        let mut axis = self;
        let mut best = axis.variance(curved, None);
        for _ in 0..ROUNDS {
            let mut normal = Normal::default();
            axis.variance(curved, Some(&mut normal));
            let Some([cx, cy, a, b]) = normal.solve() else { break };
            let back = axis.upright().inverse();
            let moved = Self {
                origin: back.transform_point3(DVec3::new(cx, cy, 0.0)),
                direction: upward(back.transform_vector3(DVec3::new(a, b, 1.0)).normalize()),
            };
            let now = moved.variance(curved, None);
            if now >= best || now.is_nan() {
                break;
            }
            (axis, best) = (moved, now);
        }
        axis
    }

    /// Sum of squares of how distances from the axis vary within each wire (m²), and the equations of what lowers it.
    fn variance(&self, curved: &[&Course], mut normal: Option<&mut Normal>) -> f64 {
        let upright = self.upright();
        let mut sum = 0.0;
        for wire in curved {
            let rows: Vec<(f64, [f64; 4])> = wire
                .points
                .iter()
                .map(|point| {
                    let local = upright.transform_point3(*point);
                    let radial = local.truncate();
                    let (r, out) = (radial.length(), radial.normalize_or_zero());
                    (r, [-out.x, -out.y, -out.x * local.z, -out.y * local.z])
                })
                .collect();
            let count = rows.len() as f64;
            let mean = rows.iter().map(|(r, _)| r).sum::<f64>() / count;
            let slopes: [f64; 4] = std::array::from_fn(|k| rows.iter().map(|(_, row)| row[k]).sum::<f64>() / count);
            for (r, row) in &rows {
                let residual = r - mean;
                sum += residual * residual;
                if let Some(normal) = normal.as_deref_mut() {
                    normal.add(std::array::from_fn(|k| row[k] - slopes[k]), -residual);
                }
            }
        }
        sum
    }
}

/// Along its greatest component, upwards.
fn upward(direction: DVec3) -> DVec3 {
    let greatest = direction.abs().max_position();
    if direction[greatest] < 0.0 { -direction } else { direction }
}

fn mean_span(wires: &[Course]) -> Option<DVec3> {
    let mut sum = DVec3::ZERO;
    for wire in wires {
        let span = wire.span();
        sum += if span.dot(sum) < 0.0 { -span } else { span };
    }
    sum.try_normalize()
}

fn across_curvature(curved: &[&Course]) -> Option<DVec3> {
    let mut sum = DVec3::ZERO;
    for wire in curved {
        for step in [5, 10, 20, 40] {
            let radial: Vec<DVec3> = (step..=STATIONS - step)
                .map(|i| wire.even[i - step] - 2.0 * wire.even[i] + wire.even[i + step])
                .collect();
            for apart in [5, 15, 30] {
                for i in apart..radial.len() {
                    let along = radial[i - apart].cross(radial[i]);
                    sum += if along.dot(sum) < 0.0 { -along } else { along };
                }
            }
        }
    }
    sum.try_normalize()
}

/// Normal equations of four unknowns.
#[derive(Default)]
struct Normal {
    matrix: [[f64; 4]; 4],
    right: [f64; 4],
}

impl Normal {
    fn add(&mut self, row: [f64; 4], value: f64) {
        for (i, factor) in row.iter().enumerate() {
            for (j, other) in row.iter().enumerate() {
                self.matrix[i][j] += factor * other;
            }
            self.right[i] += factor * value;
        }
    }

    /// Gaussian elimination; `None` where the equations leave something open.
    fn solve(mut self) -> Option<[f64; 4]> {
        let diagonal: [f64; 4] = std::array::from_fn(|k| self.matrix[k][k]);
        for (k, scale) in diagonal.into_iter().enumerate() {
            let pivot = (k..4).max_by(|a, b| self.matrix[*a][k].abs().total_cmp(&self.matrix[*b][k].abs()))?;
            self.matrix.swap(k, pivot);
            self.right.swap(k, pivot);
            if self.matrix[k][k].abs() <= 1e-12 * scale {
                return None;
            }
            for i in k + 1..4 {
                let factor = self.matrix[i][k] / self.matrix[k][k];
                for j in k..4 {
                    self.matrix[i][j] -= factor * self.matrix[k][j];
                }
                self.right[i] -= factor * self.right[k];
            }
        }
        let mut found = [0.0; 4];
        for k in (0..4).rev() {
            let known: f64 = (k + 1..4).map(|j| self.matrix[k][j] * found[j]).sum();
            found[k] = (self.right[k] - known) / self.matrix[k][k];
        }
        Some(found)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::strand::helix::Helix;

    fn courses(turn: DAffine3, noise: f64) -> Vec<Course> {
        let helix = |lay: f64, radius: f64, k: usize| Helix { radius, pitch: 0.012, lay, phase: k as f64 };
        let wires = [helix(1.0, 0.4e-3, 0), helix(1.0, 0.4e-3, 2), helix(-1.0, 0.8e-3, 1), helix(1.0, 0.0, 0)];
        let wires = wires.iter().map(|helix| {
            // Noise that is the same at each run.
            let shift =
                |i: usize| noise * DVec3::new((i * 7) as f64, (i * 13) as f64, (i * 29) as f64).map(|x| x.sin());
            let points: Vec<DVec3> = (0..=STATIONS)
                .map(|i| turn.transform_point3(helix.point(9e-3 * i as f64 / STATIONS as f64) + shift(i)))
                .collect();
            Course::new(points.clone(), points, 1e-9 + 2.0 * noise)
        });
        wires.collect()
    }

    #[test]
    fn an_axis_of_any_direction_is_found() {
        for direction in [DVec3::Z, DVec3::X, DVec3::new(0.3, -0.9, 0.1).normalize()] {
            let origin = DVec3::new(0.1, -0.2, 0.3);
            let turn =
                DAffine3::from_translation(origin) * DAffine3::from_quat(DQuat::from_rotation_arc(DVec3::Z, direction));
            for (noise, within) in [(0.0, 1e-10), (1e-6, 2e-6)] {
                let axis = Axis::common(&courses(turn, noise)).unwrap();
                assert!(axis.direction.cross(direction).length() < 1e3 * within, "{direction} {noise}: {axis:?}");
                let off = (axis.origin - origin).reject_from_normalized(direction).length();
                assert!(off < within, "{direction} {noise}: {off}");
            }
        }
    }

    #[test]
    fn an_upright_axis_stays_as_it_is() {
        let axis = Axis { origin: DVec3::ZERO, direction: DVec3::Z };
        assert_eq!(axis.upright(), DAffine3::IDENTITY);
    }

    #[test]
    fn a_bent_wire_has_no_axis() {
        let bend: Vec<DVec3> = (0..=STATIONS)
            .map(|i| {
                let (sin, cos) = (2.0 * i as f64 / STATIONS as f64).sin_cos();
                DVec3::new(cos, 0.0, sin)
            })
            .collect();
        assert_eq!(Axis::common(&[Course::new(bend.clone(), bend, 1e-9)]), None);
    }
}
