//! How much of its surroundings each particle cannot see, from its neighbours in other wires.

use crate::engine::view::RunInfo;
use glam::Vec3;

/// Reach over the particle's own diameter (-).
const REACH: f32 = 2.2;

/// Per particle: the sum of w·d (xyz, world axes) and of w over neighbours of other wires, where d is the direction
/// to the neighbour and w the share of the hemisphere that it hides.
///
/// A surface with normal n under a cosine-weighted sky then loses about ¼ Σw + ½ n·Σ(w d) of its light: to first
/// order, a small source of occlusion in direction d hides w max(0, n·d), and max(0, c) ≈ ¼ + ½ c.
///
/// Particles that are `removed` hide nothing; the list is empty when none is.
pub fn occlusion(info: &RunInfo, position: &[[f32; 3]], radius: &[f32], removed: &[bool]) -> Vec<[f32; 4]> {
    let wire_of = wire_numbers(info, position.len());
    let cells = Cells::new(position, radius);
    let one = |i: usize| {
        let centre = Vec3::from(position[i]);
        let reach = REACH * 2.0 * radius[i];
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for &j in cells.around(centre.z) {
            let j = j as usize;
            if wire_of[j] == wire_of[i] || removed.get(j).is_some_and(|r| *r) {
                continue;
            }
            let d = Vec3::from(position[j]) - centre;
            let square = d.length_squared();
            if square > reach * reach || square < 1e-18 {
                continue;
            }
            let distance = square.sqrt();
            // Fades to nothing at the end of the reach, so that nothing pops when a neighbour leaves it.
            let fade = 1.0 - square / (reach * reach);
            let w = (radius[j] / distance).powi(2) * fade;
            sum += d * (w / distance);
            total += w;
        }
        [sum.x, sum.y, sum.z, total]
    };
    (0..position.len()).map(one).collect()
}

/// Wire of each particle; free spheres get a number of their own.
fn wire_numbers(info: &RunInfo, count: usize) -> Vec<u32> {
    let mut numbers: Vec<u32> = (0..count as u32).map(|i| u32::MAX - i).collect();
    for (w, wire) in info.wires.iter().enumerate() {
        numbers[wire.particles()].fill(w as u32);
    }
    numbers
}

/// Particles sorted into slabs along z, each slab as thick as the longest reach: a strand is long and thin.
struct Cells {
    low: f32,
    slab: f32,
    starts: Vec<usize>,
    order: Vec<u32>,
}

impl Cells {
    fn new(position: &[[f32; 3]], radius: &[f32]) -> Self {
        let widest = radius.iter().copied().fold(0.0, f32::max);
        let low = position.iter().map(|p| p[2]).fold(f32::MAX, f32::min);
        let high = position.iter().map(|p| p[2]).fold(f32::MIN, f32::max);
        // At most a million slabs, also when a sphere has flown away.
        let slab = (REACH * 2.0 * widest).max((high - low) * 1e-6).max(1e-9);
        let count = if position.is_empty() { 0 } else { ((high - low) / slab) as usize + 1 };
        let slab_of = |p: &[f32; 3]| (((p[2] - low) / slab) as usize).min(count.saturating_sub(1));
        let mut starts = vec![0; count + 1];
        for p in position {
            starts[slab_of(p) + 1] += 1;
        }
        for k in 0..count {
            starts[k + 1] += starts[k];
        }
        let mut next = starts.clone();
        let mut order = vec![0; position.len()];
        for (i, p) in position.iter().enumerate() {
            let k = slab_of(p);
            order[next[k]] = i as u32;
            next[k] += 1;
        }
        Self { low, slab, starts, order }
    }

    /// Particles within a slab's thickness of `z`, and some more.
    fn around(&self, z: f32) -> &[u32] {
        let count = self.starts.len() - 1;
        let k = (((z - self.low) / self.slab) as usize).min(count - 1);
        &self.order[self.starts[k.saturating_sub(1)]..self.starts[(k + 2).min(count)]]
    }
}
