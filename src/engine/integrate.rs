//! Leapfrog: forces gathered per particle in a fixed order, velocities kicked, positions drifted.

use super::contact::spheres::second::SecondSides;
use super::motion::{drifted, force_of_bonds, kicked, thinned_radius, torque_of_bonds};
use super::state::{BondActions, CHUNK, RowChunks, State};
use super::team::Team;
use crate::base::lanes::{BLOCK, Lanes, Real};
use crate::base::triple::Triple;
use crate::base::vectors::Vectors;
use pulp::{Arch, Simd, WithSimd};

/// What there is to add up.
#[derive(Clone, Copy)]
pub struct Parts<'a> {
    /// Torques, because particles turn.
    pub turn: bool,
    /// Forces of contacts, with second sides or without.
    pub contacts: Option<Option<SecondSides<'a>>>,
    /// Radii, because plastic wires thin as they stretch.
    pub thin: bool,
}

/// Adds up what bonds and contacts do to each particle: F_n and torques. Also lets wires thin: the radius of a particle
/// is the mean over its bonds.
pub fn gather(state: &mut State, parts: Parts, arch: Arch, team: &Team) {
    let (bond, radius0) = (&state.bond, &state.radius0);
    let first_sides = parts.contacts.is_some().then_some([&state.contact_force, &state.contact_torque]);
    let (f, t) = (&mut state.force, &mut state.torque);
    let radii = RowChunks::of([&mut state.radius, &mut state.thinned]);
    let chunks = RowChunks::of(f.rows_mut()).zip(RowChunks::of(t.rows_mut())).zip(radii);
    team.for_each(chunks, |chunk, ((force, torque), [radius, thinned])| {
        let first = chunk * CHUNK;
        let rows = Rows { bond, first, actions: &bond.data[first * bond.fields()..(first + CHUNK) * bond.fields()] };
        arch.dispatch(Gather { rows, first_sides, parts, force, torque });
        if parts.thin {
            arch.dispatch(Thin { rows, radius, thinned, radius0: &radius0[first..] });
        }
    });
}

/// What the bonds of one chunk do.
#[derive(Clone, Copy)]
struct Rows<'a> {
    bond: &'a BondActions,
    /// The first particle.
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
}

/// Forces and torques of one chunk.
struct Gather<'a> {
    rows: Rows<'a>,
    /// Forces and torques from contacts on their first sides.
    first_sides: Option<[&'a Vectors; 2]>,
    parts: Parts<'a>,
    force: [&'a mut [f64]; 3],
    torque: [&'a mut [f64]; 3],
}

impl WithSimd for Gather<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Gather { rows, first_sides, parts, force, torque } = self;
        let zero = Lanes::splat(simd, 0.0);
        for k in (0..force[0].len()).step_by(Lanes::<S>::LEN) {
            // The bond behind a particle, the bond before it, and what contacts do.
            let mut sum = [zero; 6];
            for axis in 0..3 {
                let pull = BondActions::PULL + axis;
                sum[axis] = force_of_bonds(rows.here(simd, pull, k), rows.before(simd, pull, k));
                if parts.turn {
                    let (near, far) = (BondActions::NEAR + axis, BondActions::FAR + axis);
                    sum[3 + axis] = torque_of_bonds(rows.here(simd, near, k), rows.before(simd, far, k));
                }
            }
            if let Some([push, twist]) = first_sides {
                add(simd, &mut sum, 0, push, rows.first + k);
                if parts.turn {
                    add(simd, &mut sum, 3, twist, rows.first + k);
                }
            }
            if let Some(Some(second)) = &parts.contacts {
                second.add(simd, (rows.first + k) / BLOCK, k % BLOCK, &mut sum);
            }
            for axis in 0..3 {
                sum[axis].store_up_to_end(force[axis], k);
                if parts.turn {
                    sum[3 + axis].store_up_to_end(torque[axis], k);
                }
            }
        }
    }
}

/// Adds the vectors from `at` on to three of the sums.
#[inline(always)]
fn add<S: Simd>(simd: S, sum: &mut [Lanes<S>; 6], first: usize, v: &Vectors, at: usize) {
    sum[first] += Lanes::load_up_to_end(simd, &v.x, at);
    sum[first + 1] += Lanes::load_up_to_end(simd, &v.y, at);
    sum[first + 2] += Lanes::load_up_to_end(simd, &v.z, at);
}

/// Radii of one chunk.
struct Thin<'a> {
    rows: Rows<'a>,
    radius: &'a mut [f64],
    thinned: &'a mut [f64],
    radius0: &'a [f64],
}

impl WithSimd for Thin<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Thin { rows, radius, thinned, radius0 } = self;
        for k in (0..radius.len()).step_by(Lanes::<S>::LEN) {
            let here = rows.here(simd, BondActions::THINNING, k);
            let before = rows.before(simd, BondActions::THINNING, k);
            let kept = Lanes::load_up_to_end(simd, radius, k);
            let now = thinned_radius(Lanes::load_up_to_end(simd, radius0, k), kept, here, before);
            now.store_up_to_end(radius, k);
            (kept - now).store_up_to_end(thinned, k);
        }
    }
}

/// Velocities and spins over `dt` (s).
pub fn kick(state: &mut State, dt: f64, turn: bool, arch: Arch, team: &Team) {
    let State { v, w, force, torque, inverse_mass, inverse_inertia, .. } = state;
    let (v, w) = (&mut *v, &mut *w);
    team.for_each(RowChunks::of(v.rows_mut()).zip(RowChunks::of(w.rows_mut())), |chunk, (v, w)| {
        let first = chunk * CHUNK;
        arch.dispatch(Kick { v, force, inverse_mass, first, dt });
        if turn {
            arch.dispatch(Kick { v: w, force: torque, inverse_mass: inverse_inertia, first, dt });
        }
    });
}

/// Velocities of one chunk: v += F/m dt.
struct Kick<'a> {
    v: [&'a mut [f64]; 3],
    /// Of all particles.
    force: &'a Vectors,
    inverse_mass: &'a [f64],
    first: usize,
    dt: f64,
}

impl WithSimd for Kick<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Kick { mut v, force, inverse_mass, first, dt } = self;
        let (force, time) = (force.rows(), Lanes::splat(simd, dt));
        for k in (0..v[0].len()).step_by(Lanes::<S>::LEN) {
            let inverse_mass = Lanes::load_up_to_end(simd, inverse_mass, first + k);
            let before = load(simd, v.each_ref().map(|row| &**row), k);
            store(kicked(before, load(simd, force, first + k), inverse_mass, time), &mut v, k);
        }
    }
}

/// The vectors from `at` on.
#[inline(always)]
fn load<S: Simd>(simd: S, [x, y, z]: [&[f64]; 3], at: usize) -> Triple<Lanes<S>> {
    Triple {
        x: Lanes::load_up_to_end(simd, x, at),
        y: Lanes::load_up_to_end(simd, y, at),
        z: Lanes::load_up_to_end(simd, z, at),
    }
}

/// Writes the vectors from `at` on.
#[inline(always)]
fn store<S: Simd>(vectors: Triple<Lanes<S>>, [x, y, z]: &mut [&mut [f64]; 3], at: usize) {
    vectors.x.store_up_to_end(x, at);
    vectors.y.store_up_to_end(y, at);
    vectors.z.store_up_to_end(z, at);
}

/// Positions over `state.dt`; returns the greatest squared displacement of the step (m²), NaN when a position is not a
/// number.
pub fn drift(state: &mut State, arch: Arch, team: &Team) -> f64 {
    let dt = state.dt;
    let (v, x) = (&state.v, &mut state.x);
    let largest = team.map(RowChunks::of(x.rows_mut()), |chunk, x| {
        let here = chunk * CHUNK..chunk * CHUNK + x[0].len();
        let v = v.rows().map(|row| &row[here.clone()]);
        arch.dispatch(Drift { x, v, dt })
    });
    largest.into_iter().fold(0.0, larger)
}

/// Positions of one chunk.
struct Drift<'a> {
    x: [&'a mut [f64]; 3],
    v: [&'a [f64]; 3],
    dt: f64,
}

impl WithSimd for Drift<'_> {
    type Output = f64;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> f64 {
        let Drift { mut x, v, dt } = self;
        let (mut largest2, dt) = (Lanes::splat(simd, 0.0), Lanes::splat(simd, dt));
        for k in (0..x[0].len()).step_by(Lanes::<S>::LEN) {
            let before = load(simd, x.each_ref().map(|row| &**row), k);
            let (after, step2) = drifted(before, load(simd, v, k), dt);
            store(after, &mut x, k);
            largest2 = worse(largest2, step2);
        }
        largest(largest2)
    }
}

/// The larger of two numbers, lane by lane; one that is none wins, so that it is seen.
#[inline(always)]
fn worse<R: Real>(most: R, next: R) -> R {
    R::select(!most.simd_gt(next) & most.simd_gt(most.splat(f64::NEG_INFINITY)), next, most)
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
