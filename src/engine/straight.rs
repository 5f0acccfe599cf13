//! A grip that moves straight along z without turning: what most grips do, to a sixth of all particles, at every step.

use super::motion::Kicked;
use super::state::State;
use crate::base::lanes::{BLOCK, Lanes, Real};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Particles of a hold as runs of neighbours in memory.
pub fn runs(particles: &[u32]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for p in particles.iter().map(|p| *p as usize) {
        match runs.last_mut() {
            Some(last) if last.end == p => last.end += 1,
            _ => runs.push(p..p + 1),
        }
    }
    runs
}

/// Gives the particles of a grip its velocity, after a kick.
pub struct StraightGrip<'a> {
    pub runs: &'a [Range<usize>],
    pub state: &'a mut State,
    /// Velocity along z (m/s).
    pub speed: f64,
    /// Time that the kick spanned (s).
    pub kicked: f64,
    /// Where the grip's axis crosses the plane of x and y (m).
    pub axis: [f64; 2],
}

/// What that took.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Effort {
    /// Force along z (N).
    pub force: f64,
    /// Torque about the axis (N m).
    pub torque: f64,
    /// Mass of the particles (kg).
    pub mass: f64,
    /// Work (J).
    pub work: f64,
}

/// Sums per lane of a block: added up in the same order whatever the registers' width.
#[derive(Default)]
struct Sums {
    force: [f64; BLOCK],
    torque: [f64; BLOCK],
    mass: [f64; BLOCK],
    work: [f64; BLOCK],
}

impl WithSimd for StraightGrip<'_> {
    type Output = Effort;

    #[inline(always)]
    fn with_simd<S: Simd>(mut self, simd: S) -> Effort {
        let mut sums = Sums::default();
        for run in self.runs {
            for at in (run.start..run.end).step_by(BLOCK) {
                for lane in (0..BLOCK).step_by(Lanes::<S>::LEN) {
                    if at + lane < run.end {
                        self.hold(simd, at + lane..run.end, lane, &mut sums);
                    }
                }
            }
        }
        let sum = |lanes: [f64; BLOCK]| lanes.iter().sum();
        Effort { force: sum(sums.force), torque: sum(sums.torque), mass: sum(sums.mass), work: sum(sums.work) }
    }
}

impl StraightGrip<'_> {
    /// As many particles from the first of `run` on as a register holds. Past its end masses are 0, and so is the rest.
    #[inline(always)]
    fn hold<S: Simd>(&mut self, simd: S, run: Range<usize>, lane: usize, sums: &mut Sums) {
        let s = &mut *self.state;
        let mass = load(simd, &s.mass, &run);
        let (zero, [x, y]) = (mass.splat(0.0), self.axis);
        let kicked = Kicked {
            arm: [load(simd, &s.x.x, &run) - x, load(simd, &s.x.y, &run) - y],
            v: vector(simd, &s.v, &run),
            w: vector(simd, &s.w, &run),
            force: vector(simd, &s.force, &run),
            torque: vector(simd, &s.torque, &run),
            mass,
            inertia: load(simd, &s.inertia, &run),
            inverse_mass: load(simd, &s.inverse_mass, &run),
            inverse_inertia: load(simd, &s.inverse_inertia, &run),
            time: zero.splat(self.kicked),
        };
        let held = kicked.straight(zero.splat(self.speed), zero.splat(1.0 / self.kicked));
        book(simd, &mut sums.force, lane, held.force);
        book(simd, &mut sums.torque, lane, held.torque[0]);
        book(simd, &mut sums.mass, lane, mass);
        book(simd, &mut sums.work, lane, held.work[0]);
        let State { v, w, .. } = s;
        held.v.z.store_up_to_end(&mut v.z[run.clone()], 0);
        for row in [&mut v.x, &mut v.y, &mut w.x, &mut w.y, &mut w.z] {
            zero.store_up_to_end(&mut row[run.clone()], 0);
        }
    }
}

#[inline(always)]
fn load<S: Simd>(simd: S, numbers: &[f64], run: &Range<usize>) -> Lanes<S> {
    Lanes::load_up_to_end(simd, &numbers[run.clone()], 0)
}

#[inline(always)]
fn vector<S: Simd>(simd: S, v: &Vectors, run: &Range<usize>) -> Triple<Lanes<S>> {
    Triple { x: load(simd, &v.x, run), y: load(simd, &v.y, run), z: load(simd, &v.z, run) }
}

#[inline(always)]
fn book<S: Simd>(simd: S, sum: &mut [f64; BLOCK], lane: usize, part: Lanes<S>) {
    (Lanes::load(simd, sum, lane) + part).store(sum, lane);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn runs_are_neighbours_in_memory() {
        assert_eq!(runs(&[3, 4, 5, 9, 11, 12]), [3..6, 9..10, 11..13]);
        assert!(runs(&[]).is_empty());
    }
}
