//! Leapfrog: forces gathered per particle in a fixed order, velocities kicked, positions drifted.

use super::neighbours::Reference;
use super::state::{BondAction, CHUNK, State};
use crate::base::vectors::Vectors;
use glam::DVec3;
use rayon::prelude::*;

/// Adds up what bonds and contacts do to each particle: F_n and torques. Also lets wires thin: the radius of a particle
/// is the mean over its bonds.
pub fn gather(state: &mut State, turn: bool, contacts: bool) {
    let (bond, thinning, radius0, whole) = (&state.bond, &state.thinning, &state.radius0, &state.whole);
    let (cf, ct) = (&state.contact_force, &state.contact_torque);
    let (f, t) = (&mut state.force, &mut state.torque);
    (
        f.x.par_chunks_mut(CHUNK),
        f.y.par_chunks_mut(CHUNK),
        f.z.par_chunks_mut(CHUNK),
        t.x.par_chunks_mut(CHUNK),
        t.y.par_chunks_mut(CHUNK),
        t.z.par_chunks_mut(CHUNK),
        state.radius.par_chunks_mut(CHUNK),
    )
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .for_each(|(chunk, (fx, fy, fz, tx, ty, tz, radius))| {
            let first = chunk * CHUNK;
            let mut last = if first > 0 { bond[first - 1] } else { BondAction::default() };
            let slots = bond[first..first + fx.len()].iter().zip(radius.iter_mut());
            for (k, (next, radius)) in slots.enumerate() {
                let p = first + k;
                let mut force = next.pull - last.pull;
                if contacts {
                    force += cf.get(p);
                }
                (fx[k], fy[k], fz[k]) = force.into();
                if turn {
                    let mut torque = next.moment - last.moment + (next.arm + last.arm);
                    if contacts {
                        torque += ct.get(p);
                    }
                    (tx[k], ty[k], tz[k]) = torque.into();
                }
                if let Some(factor) = mean_thinning(whole, thinning, p) {
                    *radius = radius0[p] * factor;
                }
                last = *next;
            }
        });
}

/// Mean factor on the radius over the whole bonds of a particle; `None` keeps what it has.
#[inline(always)]
fn mean_thinning(whole: &[bool], thinning: &[f64], p: usize) -> Option<f64> {
    match (p > 0 && whole[p - 1], whole[p]) {
        (true, true) => Some(0.5 * (thinning[p - 1] + thinning[p])),
        (true, false) => Some(thinning[p - 1]),
        (false, true) => Some(thinning[p]),
        (false, false) => None,
    }
}

/// Velocities and spins over `dt` [s].
pub fn kick(state: &mut State, dt: f64, turn: bool) {
    accelerate(&mut state.v, &state.force, &state.inverse_mass, dt);
    if turn {
        accelerate(&mut state.w, &state.torque, &state.inverse_inertia, dt);
    }
}

/// v += F/m dt, one stream per axis.
fn accelerate(v: &mut Vectors, f: &Vectors, inverse_mass: &[f64], dt: f64) {
    (v.x.par_chunks_mut(CHUNK), v.y.par_chunks_mut(CHUNK), v.z.par_chunks_mut(CHUNK))
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .for_each(|(chunk, (vx, vy, vz))| {
            let here = chunk * CHUNK..chunk * CHUNK + vx.len();
            let per_mass = &inverse_mass[here.clone()];
            for (v, f) in [(vx, &f.x), (vy, &f.y), (vz, &f.z)] {
                for ((v, f), per_mass) in v.iter_mut().zip(&f[here.clone()]).zip(per_mass) {
                    *v += f * (dt * per_mass);
                }
            }
        });
}

/// What a drift saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drifted {
    /// Greatest squared displacement of the step [m²]; NaN when a position is not a number.
    pub largest2: f64,
    /// Greatest squared distance from the affine stretch since the last neighbour search [m²].
    pub residual2: f64,
}

impl Drifted {
    const NOTHING: Self = Self { largest2: 0.0, residual2: 0.0 };

    fn with(self, other: Self) -> Self {
        Self { largest2: larger(self.largest2, other.largest2), residual2: larger(self.residual2, other.residual2) }
    }
}

/// Positions over `state.dt`.
pub fn drift(state: &mut State, neighbours: Option<&Reference>) -> Drifted {
    let dt = state.dt;
    let (v, x) = (&state.v, &mut state.x);
    (x.x.par_chunks_mut(CHUNK), x.y.par_chunks_mut(CHUNK), x.z.par_chunks_mut(CHUNK))
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .map(|(chunk, (px, py, pz))| {
            let here = chunk * CHUNK..chunk * CHUNK + px.len();
            let (vx, vy, vz) = (&v.x[here.clone()], &v.y[here.clone()], &v.z[here.clone()]);
            let mut largest2 = 0.0;
            for k in 0..px.len() {
                let step = DVec3::new(vx[k], vy[k], vz[k]) * dt;
                px[k] += step.x;
                py[k] += step.y;
                pz[k] += step.z;
                largest2 = larger(largest2, step.length_squared());
            }
            let residual2 = neighbours.map_or(0.0, |r| r.residual2(here.start, px, py, pz));
            Drifted { largest2, residual2 }
        })
        .reduce(|| Drifted::NOTHING, Drifted::with)
}

/// The larger of two numbers; NaN wins, so that it is seen.
#[inline(always)]
pub(super) fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
