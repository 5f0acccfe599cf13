//! Leapfrog: forces gathered per particle in a fixed order, velocities kicked, positions drifted.

use super::neighbours::Neighbours;
use super::state::{CHUNK, State};
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
        .enumerate()
        .for_each(|(chunk, (fx, fy, fz, tx, ty, tz, radius))| {
            for k in 0..fx.len() {
                let p = chunk * CHUNK + k;
                let (next, last) = (bond[p], if p > 0 { bond[p - 1] } else { Default::default() });
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
                    radius[k] = radius0[p] * factor;
                }
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
    let (mass, inertia) = (&state.mass, &state.inertia);
    let (f, t) = (&state.force, &state.torque);
    let accelerate = |v: &mut crate::base::vectors::Vectors, f: &crate::base::vectors::Vectors, m: &[f64]| {
        (v.x.par_chunks_mut(CHUNK), v.y.par_chunks_mut(CHUNK), v.z.par_chunks_mut(CHUNK))
            .into_par_iter()
            .enumerate()
            .for_each(|(chunk, (vx, vy, vz))| {
                for k in 0..vx.len() {
                    let p = chunk * CHUNK + k;
                    let per_mass = dt / m[p];
                    vx[k] += f.x[p] * per_mass;
                    vy[k] += f.y[p] * per_mass;
                    vz[k] += f.z[p] * per_mass;
                }
            });
    };
    accelerate(&mut state.v, f, mass);
    if turn {
        accelerate(&mut state.w, t, inertia);
    }
}

/// What a drift saw.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drifted {
    /// Greatest squared displacement of the step [m²]; NaN when a position is not a number.
    pub largest2: f64,
    /// Greatest squared distance from the affine stretch since the last neighbour search [m²].
    pub residual2: f64,
}

/// Positions over `state.dt`.
pub fn drift(state: &mut State, neighbours: Option<(&Neighbours, f64)>) -> Drifted {
    let dt = state.dt;
    let (v, x) = (&state.v, &mut state.x);
    let none = Drifted { largest2: 0.0, residual2: 0.0 };
    (x.x.par_chunks_mut(CHUNK), x.y.par_chunks_mut(CHUNK), x.z.par_chunks_mut(CHUNK))
        .into_par_iter()
        .enumerate()
        .map(|(chunk, (px, py, pz))| {
            let mut seen = none;
            for k in 0..px.len() {
                let p = chunk * CHUNK + k;
                let step = v.get(p) * dt;
                px[k] += step.x;
                py[k] += step.y;
                pz[k] += step.z;
                seen.largest2 = larger(seen.largest2, step.length_squared());
                if let Some((list, moved)) = neighbours {
                    let residual = list.residual2(p, DVec3::new(px[k], py[k], pz[k]), moved);
                    seen.residual2 = larger(seen.residual2, residual);
                }
            }
            seen
        })
        .reduce(
            || none,
            |a, b| Drifted { largest2: larger(a.largest2, b.largest2), residual2: larger(a.residual2, b.residual2) },
        )
}

/// The larger of two numbers; NaN wins, so that it is seen.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
