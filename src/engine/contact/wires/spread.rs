//! From what contacts do to stretches and bonds to forces on particles.
//!
//! A contact acts at points of two centrelines: at the place u on the stretch around a particle, at t on a bond. So it is
//! enough to add up, per particle and per bond, the force times each function of u and of t that these curves are made of; what that does to particles then follows once for all contacts, with the same coefficients that
//! give the points. Neither momentum nor energy is lost.

use super::chains::Chains;
use super::curve::{Around, spread_arc};
use crate::engine::bytes::behind;
use crate::engine::state::{CHUNK, RowChunks, State};
use crate::engine::team::Team;
use glam::DVec3;

/// Bonds along which a stretch, and particles along which a bond hands its forces on.
const NEAR: usize = 4;
const FAR: usize = 2;

/// What contacts do to the stretch of one particle.
#[derive(Debug, Clone, Copy, Default)]
pub struct NearSum {
    /// Force times each power of u (N).
    pub force: [DVec3; 5],
    /// Moment on the particle (N m).
    pub moment: DVec3,
    /// Whether there is any.
    pub acts: bool,
}

/// What one contact, or all, do to a bond of the other wire, or to its first particle where there is no bond.
#[derive(Debug, Clone, Copy, Default)]
pub struct FarSum {
    /// Force times 1, t, t² and h(t) (N); see [`blend`](super::curve::blend).
    pub force: [DVec3; 4],
    /// Moments on the bond's two particles (N m).
    pub moment: [DVec3; 2],
    /// The bond.
    pub bond: u32,
    /// Whether there is any.
    pub acts: bool,
}

/// The sums of all particles, and which contacts act on which bonds.
#[derive(Default)]
pub struct Spread {
    pub near: Vec<NearSum>,
    /// What acts, chunk after chunk of the bonds; where each chunk's begin, and the end.
    order: Vec<Acts>,
    starts: Vec<usize>,
}

/// One that acts: by list and place in it, on a bond.
#[derive(Debug, Clone, Copy, Default)]
struct Acts {
    list: u32,
    place: u32,
    bond: u32,
}

impl Spread {
    /// Makes room for `particles`.
    pub fn resize(&mut self, particles: usize) {
        self.near.resize(particles, NearSum::default());
    }

    /// Memory that it keeps (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.near) + behind(&self.order) + behind(&self.starts)
    }

    /// Sorts what acts by chunk; the order within a chunk is kept.
    fn sort(&mut self, acting: &[&[FarSum]]) {
        let chunk_of = |bond: u32| bond as usize / CHUNK;
        self.starts.clear();
        self.starts.resize(self.near.len().div_ceil(CHUNK) + 1, 0);
        for act in acting.iter().copied().flatten() {
            self.starts[chunk_of(act.bond) + 1] += 1;
        }
        for chunk in 1..self.starts.len() {
            self.starts[chunk] += self.starts[chunk - 1];
        }
        let count = self.starts.last().copied().unwrap_or(0);
        if self.order.capacity() < count {
            self.order = Vec::with_capacity(count + count / 8);
        }
        self.order.resize(count, Acts::default());
        for (list, acts) in acting.iter().enumerate() {
            for (k, act) in acts.iter().enumerate() {
                let at = &mut self.starts[chunk_of(act.bond)];
                self.order[*at] = Acts { list: list as u32, place: k as u32, bond: act.bond };
                *at += 1;
            }
        }
        // Each start has gone on to the next one.
        self.starts.rotate_right(1);
        self.starts[0] = 0;
    }

    /// What contacts (`acting`, a list per chunk) do to the bonds `from..to`, in the order of contacts. These lie in the
    /// bonds of `chunk` or of those beside it.
    fn far(&self, acting: &[&[FarSum]], chunk: usize, from: usize, to: usize) -> Vec<FarSum> {
        let mut far = vec![FarSum::default(); to - from];
        let chunks = chunk.saturating_sub(1)..(chunk + 2).min(self.starts.len() - 1);
        for acts in &self.order[self.starts[chunks.start]..self.starts[chunks.end]] {
            let bond = acts.bond as usize;
            if (from..to).contains(&bond) {
                let act = &acting[acts.list as usize][acts.place as usize];
                let sum = &mut far[bond - from];
                sum.acts = true;
                sum.force.iter_mut().zip(act.force).for_each(|(sum, f)| *sum += f);
                sum.moment.iter_mut().zip(act.moment).for_each(|(sum, m)| *sum += m);
            }
        }
        far
    }

    /// Adds up what contacts do to bonds (`acting`, a list per chunk), and writes the forces and, with `turn`, the moments of
    /// all particles. Bonds at the edge of a chunk are added up for both of the chunks that they concern: so no thread waits
    /// for another, and there is no list of all bonds.
    pub fn finish(&mut self, acting: &[&[FarSum]], chains: &Chains, state: &mut State, turn: bool, team: &Team) {
        self.sort(acting);
        let (near, spread) = (&self.near[..], &*self);
        let (mut force, mut torque) =
            (std::mem::take(&mut state.contact_force), std::mem::take(&mut state.contact_torque));
        let seen = &*state;
        let rows = RowChunks::of(force.rows_mut()).zip(RowChunks::of(torque.rows_mut()));
        team.for_each(rows, |chunk, ([x, y, z], [tx, ty, tz])| {
            let first = chunk * CHUNK;
            let end = first + x.len();
            [&mut *x, &mut *y, &mut *z].into_iter().for_each(|row| row.fill(0.0));
            let mut add = |node: usize, f: DVec3| {
                if (first..end).contains(&node) {
                    x[node - first] += f.x;
                    y[node - first] += f.y;
                    z[node - first] += f.z;
                }
            };
            let from = first.saturating_sub(NEAR);
            for (i, sum) in (from..).zip(&near[from..(end + NEAR).min(near.len())]).filter(|(_, sum)| sum.acts) {
                Around::new(&seen.x, seen, chains, i).spread(i, &sum.force, &mut add);
            }
            let from = first.saturating_sub(FAR);
            let far = spread.far(acting, chunk, from, (end + FAR).min(near.len()));
            for (bond, sum) in (from..).zip(&far).filter(|(_, sum)| sum.acts) {
                spread_arc(seen, bond, &sum.force, &mut add);
            }
            if turn {
                for p in first..end {
                    let before = if p > 0 { far[p - 1 - from].moment[1] } else { DVec3::ZERO };
                    let sum = near[p].moment + far[p - from].moment[0] + before;
                    (tx[p - first], ty[p - first], tz[p - first]) = (sum.x, sum.y, sum.z);
                }
            }
        });
        (state.contact_force, state.contact_torque) = (force, torque);
    }
}
