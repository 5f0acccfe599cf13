//! Where and how two spheres meet, written once for numbers of every kind, and what they then do to each other as a formula
//! that can be recorded.

use crate::base::lanes::Real;
use crate::base::recorder::{Formula, put_vector, take_vector};
use crate::base::triple::Triple;
use crate::engine::contact::formula::ContactStep;
use crate::engine::contact::pair::{History, Laws};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;
use std::collections::BTreeMap;

/// Two spheres from centre to centre.
#[derive(Clone, Copy)]
pub struct Between<R> {
    /// From the first centre to the second (m).
    pub way: Triple<R>,
    /// Inverse of the distance (1/m).
    pub inverse: R,
    /// Overlap that counts (m); below 0 where they are apart.
    pub overlap: R,
}

impl<R: Real> Between<R> {
    /// Of `way` (m) between centres that touch at the sum of the radii `touching` (m); `offset` of the overlap does not count
    /// (m).
    #[inline(always)]
    pub fn of(way: Triple<R>, touching: R, offset: R) -> Self {
        let square = way.length_squared();
        let inverse = square.inverse_sqrt();
        let distance = square * inverse;
        let reach = touching - offset;
        Self { way, inverse, overlap: reach - distance }
    }

    /// Unit normal from the first to the second.
    #[inline(always)]
    pub fn normal(&self) -> Triple<R> {
        self.way * self.inverse
    }
}

/// From the centres to where the surfaces meet (m), at an `overlap` that counts and an `offset` that does not (m).
#[inline(always)]
pub fn arms<R: Real>(radii: [R; 2], overlap: R, offset: R) -> [R; 2] {
    let sunk = (overlap + offset) * 0.5;
    // A closure in `map` might be compiled without the wide registers of its caller.
    [radii[0] - sunk, radii[1] - sunk]
}

/// Velocity of the second surface relative to the first where they meet (m/s), from that of the centres (m/s) and the spins
/// (rad/s).
#[inline(always)]
pub fn surface_velocity<R: Real>(
    slide: Triple<R>,
    spins: [Triple<R>; 2],
    arms: [R; 2],
    normal: Triple<R>,
) -> Triple<R> {
    let roll = spins[0] * arms[0] + spins[1] * arms[1];
    slide - roll.cross(normal)
}

/// A pair of spheres in a step.
#[derive(Debug, Clone, Copy)]
pub struct SpherePair<N, T> {
    /// The laws.
    pub laws: Laws<N, T>,
    /// Whether particles turn.
    pub turn: bool,
}

impl<N: NormalLaw, T: TangentialLaw> Formula for SpherePair<N, T> {
    /// Takes what the two particles are (`first_`, `second_`), and of the pair its reduced radius (m), viscosity (√kg), what it
    /// remembers, the energies that it has given off so far (J), and how deep it was at its deepest. Puts what it then
    /// remembers, force (N) on the first particle and torques (N m) on both, the energies, and the deepest overlap.
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let mut both = |what: &str| [take(&format!("first_{what}")), take(&format!("second_{what}"))];
        let [radii, thinned] = ["radius", "thinned"].map(&mut both);
        let mut vectors =
            |what: &str| [take_vector(take, &format!("first_{what}")), take_vector(take, &format!("second_{what}"))];
        let (x, v) = (vectors("x"), vectors("v"));
        let turns = T::ACTIVE && self.turn;
        let zero = radii[0].splat(0.0);
        let spins = if turns { vectors("w") } else { [Triple::zero(zero); 2] };
        // Needed before the contact takes it.
        let offset = take(OFFSET);

        let between = Between::of(x[1] - x[0], radii[0] + radii[1], offset);
        let touches = between.overlap.simd_gt(zero);
        let overlap = R::select(touches, between.overlap, zero);
        let normal = between.normal();
        let arms = arms(radii, overlap, offset);
        let slide = v[1] - v[0];
        let velocity = if T::ACTIVE { surface_velocity(slide, spins, arms, normal) } else { slide };
        let (mut given, mut done) = (BTreeMap::new(), BTreeMap::new());
        let mut give = |name: &str, number| {
            given.insert(name.to_owned(), number);
        };
        put_vector(&mut give, "normal", normal);
        put_vector(&mut give, "velocity", velocity);
        give("overlap", overlap);
        give("thinner", thinned[0] + thinned[1]);
        give(OFFSET, offset);
        ContactStep(self.laws).compute(
            &mut |name| given.get(name).copied().unwrap_or_else(|| take(name)),
            &mut |name, number| {
                done.insert(name.to_owned(), number);
            },
        );

        let mut result = |name: &str| done[name];
        let [push, friction] = ["force", "friction"].map(|name| take_vector(&mut result, name));
        let nothing = Triple::zero(zero);
        put_vector(put, "push", Triple::select(touches, push, nothing));
        if turns {
            let twist = Triple::select(touches, normal.cross(friction), nothing);
            put_vector(put, "twist_first", twist * arms[0]);
            put_vector(put, "twist_second", twist * arms[1]);
        }
        ENERGIES.into_iter().for_each(|name| put(name, take(name) + done[name]));
        for k in 0..History::<N, T>::NUMBERS {
            let name = format!("history_{k}");
            put(&name, done[&name]);
        }
        let least = radii[0].simd_min(radii[1]);
        let before = take("deepest");
        let deeper = touches & overlap.simd_gt(least * before);
        put("deepest", R::select(deeper, overlap / least, before));
        let force = done[&format!("history_{}", History::<N, T>::FORCE)];
        for (name, number) in [("deepest_overlap", overlap), ("deepest_force", force)] {
            put(name, R::select(deeper, number, take(name)));
        }
    }
}

/// Names of the energies that a pair gives off: plastic work, work on thinning wires, friction, damping.
pub const ENERGIES: [&str; 4] = ["plastic_work", "thinning_work", "friction_work", "damping_work"];
/// Name of the overlap that does not count, [`History::OFFSET`].
const OFFSET: &str = "history_0";
