//! How much of its surroundings each particle cannot see, from its neighbours in other wires.

use crate::engine::view::RunInfo;
use glam::Vec3;
#[cfg(feature = "explore")]
use rayon::prelude::*;
use std::cell::RefCell;

/// Reach over the particle's own diameter (-).
const REACH: f32 = 2.2;
/// Most cells.
const CELLS: i64 = 1 << 21;

/// Per particle: the sum of w·d (xyz, world axes) and of w over neighbours of other wires, where d is the direction
/// to the neighbour and w the share of the hemisphere that it hides.
///
/// A surface with normal n under a cosine-weighted sky then loses about ¼ Σw + ½ n·Σ(w d) of its light: to first
/// order, a small source of occlusion in direction d hides w max(0, n·d), and max(0, c) ≈ ¼ + ½ c.
///
/// Found when a particle is asked for: a close-up shows few of them.
pub struct Occlusion {
    /// Not a number where it was not asked for so far.
    known: RefCell<Vec<[f32; 4]>>,
    around: Option<Around>,
}

impl Occlusion {
    /// That of particles at `position` (m) with `radius` (m). Those that are `removed` hide nothing; the list is empty when
    /// none is.
    pub fn new(info: &RunInfo, position: &[[f32; 3]], radius: &[f32], removed: &[bool]) -> Self {
        let all: Vec<Body> = bodies(info, position, radius);
        let known = RefCell::new(vec![[f32::NAN; 4]; position.len()]);
        Self { known, around: Some(Around { cells: Cells::new(&all, removed), all }) }
    }

    /// One that was found before.
    #[cfg(feature = "explore")]
    pub fn known(known: Vec<[f32; 4]>) -> Self {
        Self { known: RefCell::new(known), around: None }
    }

    /// That of every particle.
    #[cfg(feature = "explore")]
    pub fn all(&self) -> Vec<[f32; 4]> {
        match &self.around {
            Some(around) => (0..around.all.len()).into_par_iter().map(|i| around.occlusion(i)).collect(),
            None => self.known.borrow().clone(),
        }
    }

    /// That of particle `i`.
    pub fn at(&self, i: usize) -> [f32; 4] {
        let known = self.known.borrow()[i];
        match &self.around {
            Some(around) if known[3].is_nan() => {
                let found = around.occlusion(i);
                self.known.borrow_mut()[i] = found;
                found
            }
            _ => known,
        }
    }
}

/// A particle: centre (m), radius (m), and its wire.
#[derive(Debug, Clone, Copy)]
struct Body {
    centre: Vec3,
    radius: f32,
    wire: u32,
}

/// Every particle; free spheres get a wire of their own.
fn bodies(info: &RunInfo, position: &[[f32; 3]], radius: &[f32]) -> Vec<Body> {
    let body = |(i, (p, r)): (usize, (&[f32; 3], &f32))| Body {
        centre: Vec3::from(*p),
        radius: *r,
        wire: u32::MAX - i as u32,
    };
    let mut all: Vec<Body> = position.iter().zip(radius).enumerate().map(body).collect();
    for (w, wire) in info.wires.iter().enumerate() {
        all[wire.particles()].iter_mut().for_each(|body| body.wire = w as u32);
    }
    all
}

struct Around {
    all: Vec<Body>,
    cells: Cells,
}

impl Around {
    fn occlusion(&self, i: usize) -> [f32; 4] {
        let own = self.all[i];
        let reach = REACH * 2.0 * own.radius;
        let (mut sum, mut total) = (Vec3::ZERO, 0.0);
        for other in self.cells.around(own.centre).filter(|other| other.wire != own.wire) {
            let d = other.centre - own.centre;
            let square = d.length_squared();
            if square > reach * reach || square < 1e-18 {
                continue;
            }
            // Fades to nothing at the end of the reach, so that nothing pops when a neighbour leaves it.
            let fade = 1.0 - square / (reach * reach);
            let w = other.radius * other.radius / square * fade;
            sum += d * (w / square.sqrt());
            total += w;
        }
        [sum.x, sum.y, sum.z, total]
    }
}

/// Particles sorted into cells at least as wide as the longest reach. Their faces lie at multiples of their side, so that what
/// is found of a particle does not depend on others far away.
struct Cells {
    side: f32,
    /// The first cell, in x, y and z.
    first: [i64; 3],
    count: [i64; 3],
    starts: Vec<u32>,
    sorted: Vec<Body>,
}

impl Cells {
    fn new(all: &[Body], removed: &[bool]) -> Self {
        let shown =
            || all.iter().enumerate().filter(|(i, _)| !removed.get(*i).is_some_and(|r| *r)).map(|(_, body)| body);
        let (mut low, mut high, mut widest) = (Vec3::MAX, Vec3::MIN, 0f32);
        for body in shown() {
            (low, high, widest) = (low.min(body.centre), high.max(body.centre), widest.max(body.radius));
        }
        let mut side = (REACH * 2.0 * widest).max(1e-9);
        let (first, count) = loop {
            let [first, last] = [low.min(high), high].map(|place| cell(place, side));
            let count = [0, 1, 2].map(|k| (last[k] - first[k]).saturating_add(1));
            if count.iter().try_fold(1i64, |product, n| product.checked_mul(*n)).is_some_and(|all| all <= CELLS) {
                break (first, count);
            }
            // Fewer and larger ones where something has flown far away.
            side *= 2.0;
        };
        let starts = vec![0; count.iter().product::<i64>() as usize + 1];
        let mut cells = Self { side, first, count, starts, sorted: Vec::new() };
        for body in shown() {
            let cell = cells.number(cells.of(body.centre));
            cells.starts[cell + 1] += 1;
        }
        for k in 1..cells.starts.len() {
            cells.starts[k] += cells.starts[k - 1];
        }
        let mut next = cells.starts.clone();
        cells.sorted = vec![Body { centre: Vec3::ZERO, radius: 0.0, wire: 0 }; next[next.len() - 1] as usize];
        for body in shown() {
            let cell = cells.number(cells.of(body.centre));
            cells.sorted[next[cell] as usize] = *body;
            next[cell] += 1;
        }
        cells
    }

    /// The cell of a place, in x, y and z, counted from the first; of one outside, the nearest.
    fn of(&self, place: Vec3) -> [i64; 3] {
        let at = cell(place, self.side);
        [0, 1, 2].map(|k| at[k].saturating_sub(self.first[k]).clamp(0, self.count[k] - 1))
    }

    /// Cells next to one another in x stand next to one another.
    fn number(&self, [x, y, z]: [i64; 3]) -> usize {
        ((z * self.count[1] + y) * self.count[0] + x) as usize
    }

    /// Particles within a cell's side of a place, and some more.
    fn around(&self, place: Vec3) -> impl Iterator<Item = &Body> {
        let at = self.of(place);
        let [x, y, z] = [0, 1, 2].map(|k| [(at[k] - 1).max(0), (at[k] + 1).min(self.count[k] - 1)]);
        let rows = (z[0]..=z[1]).flat_map(move |z| (y[0]..=y[1]).map(move |y| [y, z]));
        rows.flat_map(move |[y, z]| {
            let [from, to] = [self.number([x[0], y, z]), self.number([x[1], y, z]) + 1];
            &self.sorted[self.starts[from] as usize..self.starts[to] as usize]
        })
    }
}

fn cell(place: Vec3, side: f32) -> [i64; 3] {
    (place / side).floor().to_array().map(|number| number as i64)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The same by its definition, from every particle.
    fn plain(all: &[Body], removed: &[bool], i: usize) -> [f64; 4] {
        let mut sum = [0.0; 4];
        for (j, other) in all.iter().enumerate().filter(|(j, other)| other.wire != all[i].wire && !removed[*j]) {
            let d = (other.centre - all[i].centre).as_dvec3();
            let (distance, reach) = (d.length(), f64::from(REACH * 2.0 * all[i].radius));
            if distance < reach && j != i {
                let w = (f64::from(other.radius) / distance).powi(2) * (1.0 - (distance / reach).powi(2));
                let part = d / distance * w;
                sum = [sum[0] + part.x, sum[1] + part.y, sum[2] + part.z, sum[3] + w];
            }
        }
        sum
    }

    fn agrees(all: Vec<Body>, removed: Vec<bool>) {
        let around = Around { cells: Cells::new(&all, &removed), all };
        let mut seen = 0;
        for i in 0..around.all.len() {
            let (found, right) = (around.occlusion(i), plain(&around.all, &removed, i));
            for k in 0..4 {
                assert!((f64::from(found[k]) - right[k]).abs() < 1e-4 * right[3].max(1.0), "{i}: {found:?}, {right:?}");
            }
            seen += usize::from(right[3] > 0.1);
        }
        assert!(seen > around.all.len() / 4, "too few have neighbours: {seen}");
    }

    /// Places that fill a box, by a low-discrepancy sequence.
    fn scattered(count: usize, size: Vec3) -> Vec<Body> {
        let body = |i: usize| {
            let share = |step: f64| (i as f64 * step).fract() as f32;
            let centre = size * Vec3::new(share(0.754_877_67), share(0.569_840_29), share(0.430_159_71));
            Body { centre, radius: 1e-4 * (1.0 + 0.2 * share(0.618)), wire: (i % 7) as u32 }
        };
        (0..count).map(body).collect()
    }

    #[test]
    fn it_is_that_of_all_neighbours_within_reach() {
        let all = scattered(400, Vec3::new(1e-3, 1.5e-3, 4e-3));
        let removed = (0..all.len()).map(|i| i % 11 == 3).collect();
        agrees(all, removed);
    }

    #[test]
    fn a_particle_that_flew_far_away_makes_cells_larger_and_changes_nothing_else() {
        let mut all = scattered(300, Vec3::new(1e-3, 1e-3, 3e-3));
        all[17].centre = Vec3::new(-3.0, 40.0, 1e5);
        let removed = vec![false; all.len()];
        agrees(all, removed);
    }
}
