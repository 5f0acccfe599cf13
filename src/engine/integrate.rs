//! Leapfrog: forces gathered per particle in a fixed order, velocities kicked, positions drifted.

use super::neighbours::Reference;
use super::state::{BondActions, CHUNK, State};
use crate::base::lanes::{BLOCK, Lanes, Real};
use crate::base::vectors::Vectors;
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;

/// What there is to add up.
#[derive(Debug, Clone, Copy)]
pub struct Parts {
    /// Torques, because particles turn.
    pub turn: bool,
    /// Forces of contacts.
    pub contacts: bool,
    /// Radii, because plastic wires thin as they stretch.
    pub thin: bool,
}

/// Adds up what bonds and contacts do to each particle: F_n and torques. Also lets wires thin: the radius of a particle
/// is the mean over its bonds.
pub fn gather(state: &mut State, parts: Parts, arch: Arch) {
    let (bond, radius0) = (&state.bond, &state.radius0);
    let others = parts.contacts.then_some([&state.contact_force, &state.contact_torque]);
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
            let (force, torque) = ([fx, fy, fz], [tx, ty, tz]);
            arch.dispatch(Gather { bond, first, others, parts, force, torque, radius, radius0 });
        });
}

/// The particles of one chunk.
struct Gather<'a> {
    bond: &'a BondActions,
    /// The first of them.
    first: usize,
    /// Forces and torques from contacts.
    others: Option<[&'a Vectors; 2]>,
    parts: Parts,
    force: [&'a mut [f64]; 3],
    torque: [&'a mut [f64]; 3],
    radius: &'a mut [f64],
    radius0: &'a [f64],
}

impl WithSimd for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Gather { bond, first, others, parts, force, torque, radius, radius0 } = self;
        let rows = Rows { bond, first, actions: &bond.data[first * bond.fields()..(first + CHUNK) * bond.fields()] };
        let [push, twist] = others.map_or([None, None], |o| o.map(|v| Some([&v.x[..], &v.y[..], &v.z[..]])));
        for (axis, out) in force.into_iter().enumerate() {
            rows.add(simd, out, BondActions::PULL + axis, BondActions::PULL + axis, -1.0, push.map(|p| p[axis]));
        }
        if parts.turn {
            for (axis, out) in torque.into_iter().enumerate() {
                rows.add(simd, out, BondActions::NEAR + axis, BondActions::FAR + axis, 1.0, twist.map(|t| t[axis]));
            }
        }
        if parts.thin {
            rows.thin(simd, radius, &radius0[first..]);
        }
    }
}

/// What the bonds of one chunk do.
struct Rows<'a> {
    bond: &'a BondActions,
    first: usize,
    actions: &'a [f64],
}

impl Rows<'_> {
    #[inline(always)]
    fn row(&self, field: usize) -> &[f64] {
        &self.actions[field * CHUNK..(field + 1) * CHUNK]
    }

    #[inline(always)]
    fn here<S: Simd>(&self, simd: S, field: usize, k: usize) -> Lanes<S> {
        Lanes::load(simd, self.row(field), k)
    }

    /// What the bonds before do; the very first one belongs to the chunk before.
    #[inline(always)]
    fn before<S: Simd>(&self, simd: S, field: usize, k: usize) -> Lanes<S> {
        if k > 0 {
            return Lanes::load(simd, self.row(field), k - 1);
        }
        let mut numbers = [0.0; BLOCK];
        numbers[0] = if self.first > 0 { self.bond.get(self.first - 1, field) } else { 0.0 };
        numbers[1..].copy_from_slice(&self.row(field)[..BLOCK - 1]);
        Lanes::load(simd, &numbers, 0)
    }

    /// One axis: the bond behind a particle, the bond before it, and what contacts do.
    #[inline(always)]
    fn add<S: Simd>(&self, simd: S, out: &mut [f64], near: usize, far: usize, sign: f64, others: Option<&[f64]>) {
        for k in (0..out.len()).step_by(Lanes::<S>::LEN) {
            let mut sum = self.here(simd, near, k) + self.before(simd, far, k) * sign;
            if let Some(others) = others {
                sum += Lanes::load_up_to_end(simd, others, self.first + k);
            }
            sum.store_up_to_end(out, k);
        }
    }

    /// Radius as the mean over the bonds that hold; a particle without any keeps its own.
    #[inline(always)]
    fn thin<S: Simd>(&self, simd: S, radius: &mut [f64], radius0: &[f64]) {
        for k in (0..radius.len()).step_by(Lanes::<S>::LEN) {
            let live = self.here(simd, BondActions::LIVE, k) + self.before(simd, BondActions::LIVE, k);
            let thinning = self.here(simd, BondActions::THINNING, k) + self.before(simd, BondActions::THINNING, k);
            let undeformed = Lanes::load_up_to_end(simd, radius0, k);
            let kept = Lanes::load_up_to_end(simd, radius, k);
            let held = live.above(live.like(0.0));
            let share = Lanes::choose(live.above(live.like(1.0)), live.like(0.5), live.like(1.0));
            Lanes::choose(held, undeformed * (thinning * share), kept).store_up_to_end(radius, k);
        }
    }
}

/// Velocities and spins over `dt` [s].
pub fn kick(state: &mut State, dt: f64, turn: bool, arch: Arch) {
    accelerate(&mut state.v, &state.force, &state.inverse_mass, dt, arch);
    if turn {
        accelerate(&mut state.w, &state.torque, &state.inverse_inertia, dt, arch);
    }
}

/// v += F/m dt.
fn accelerate(v: &mut Vectors, f: &Vectors, inverse_mass: &[f64], dt: f64, arch: Arch) {
    (v.x.par_chunks_mut(CHUNK), v.y.par_chunks_mut(CHUNK), v.z.par_chunks_mut(CHUNK))
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .for_each(|(chunk, (x, y, z))| {
            let here = chunk * CHUNK..chunk * CHUNK + x.len();
            let force = f.rows().map(|row| &row[here.clone()]);
            arch.dispatch(Kick { v: [x, y, z], force, inverse_mass: &inverse_mass[here], dt });
        });
}

/// Velocities of one chunk.
struct Kick<'a> {
    v: [&'a mut [f64]; 3],
    force: [&'a [f64]; 3],
    inverse_mass: &'a [f64],
    dt: f64,
}

impl WithSimd for Kick<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Kick { v, force, inverse_mass, dt } = self;
        for k in (0..inverse_mass.len()).step_by(Lanes::<S>::LEN) {
            let per_force = Lanes::load_up_to_end(simd, inverse_mass, k) * dt;
            for axis in 0..3 {
                let change = Lanes::load_up_to_end(simd, force[axis], k) * per_force;
                (Lanes::load_up_to_end(simd, v[axis], k) + change).store_up_to_end(v[axis], k);
            }
        }
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

impl Drifted {
    const NOTHING: Self = Self { largest2: 0.0, residual2: 0.0 };

    fn with(self, other: Self) -> Self {
        Self { largest2: larger(self.largest2, other.largest2), residual2: larger(self.residual2, other.residual2) }
    }
}

/// Positions over `state.dt`.
pub fn drift(state: &mut State, neighbours: Option<&Reference>, arch: Arch) -> Drifted {
    let dt = state.dt;
    let (v, x) = (&state.v, &mut state.x);
    (x.x.par_chunks_mut(CHUNK), x.y.par_chunks_mut(CHUNK), x.z.par_chunks_mut(CHUNK))
        .into_par_iter()
        .with_max_len(1)
        .enumerate()
        .map(|(chunk, (x, y, z))| {
            let here = chunk * CHUNK..chunk * CHUNK + x.len();
            let v = v.rows().map(|row| &row[here.clone()]);
            arch.dispatch(Drift { first: here.start, x: [x, y, z], v, dt, neighbours })
        })
        .reduce(|| Drifted::NOTHING, Drifted::with)
}

/// Positions of one chunk.
struct Drift<'a> {
    first: usize,
    x: [&'a mut [f64]; 3],
    v: [&'a [f64]; 3],
    dt: f64,
    neighbours: Option<&'a Reference<'a>>,
}

impl WithSimd for Drift<'_> {
    type Output = Drifted;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> Drifted {
        let Drift { first, x, v, dt, neighbours } = self;
        let zero = Lanes::splat(simd, 0.0);
        let (mut largest2, mut residual2) = (zero, zero);
        for k in (0..x[0].len()).step_by(Lanes::<S>::LEN) {
            let (mut step2, mut here) = (zero, [zero; 3]);
            for axis in 0..3 {
                let step = Lanes::load_up_to_end(simd, v[axis], k) * dt;
                step2 += step * step;
                here[axis] = Lanes::load_up_to_end(simd, x[axis], k) + step;
                here[axis].store_up_to_end(x[axis], k);
            }
            largest2 = worse(largest2, step2);
            if let Some(reference) = neighbours {
                let mut residual = reference.residual2(simd, first + k, here);
                // Past the end there is no particle.
                (x[0].len().saturating_sub(k)..Lanes::<S>::LEN).for_each(|lane| residual.put(lane, 0.0));
                residual2 = worse(residual2, residual);
            }
        }
        Drifted { largest2: largest(largest2), residual2: largest(residual2) }
    }
}

/// The larger of two numbers, lane by lane; one that is none wins, so that it is seen.
#[inline(always)]
fn worse<R: Real>(most: R, next: R) -> R {
    R::choose(!most.above(next) & most.above(most.like(f64::NEG_INFINITY)), next, most)
}

/// The largest of some numbers.
#[inline(always)]
fn largest<R: Real>(numbers: R) -> f64 {
    (0..R::COUNT).map(|k| numbers.at(k)).fold(0.0, larger)
}

/// The larger of two numbers; NaN wins, so that it is seen.
#[inline(always)]
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}
