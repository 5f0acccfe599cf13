//! What a step does to particles besides their bonds and contacts, written once for numbers of every kind: one particle,
//! a register of them, or a recorded one.

use crate::base::lanes::Real;
use crate::base::triple::Triple;

/// Velocities after a kick over `time` (s).
#[inline(always)]
pub fn kicked<R: Real>(v: Triple<R>, force: Triple<R>, inverse_mass: R, time: R) -> Triple<R> {
    v + force * (inverse_mass * time)
}

/// Positions after a step of `dt` (s), and the squared displacement (m²).
#[inline(always)]
pub fn drifted<R: Real>(x: Triple<R>, v: Triple<R>, dt: R) -> (Triple<R>, R) {
    let step = v * dt;
    (x + step, step.plain_dot(step))
}

/// Where a squared displacement is beyond its limit (m²), or no number.
#[inline(always)]
pub fn ran_away<R: Real>(square: R, limit: R) -> R::Mask {
    square.simd_gt(limit) | !square.simd_gt(square.splat(f64::NEG_INFINITY))
}

/// Squared distance (m²) of a place from where the affine stretch since a reference would have it: `moved` (m) is how far the
/// upper face has moved since, over a length whose lower end and inverse are `low` (m) and `per_length` (1/m).
#[inline(always)]
pub fn residual<R: Real>(x: Triple<R>, reference: Triple<R>, moved: R, [low, per_length]: [R; 2]) -> R {
    let share = ((reference.z - low) * per_length).simd_max(low.splat(0.0)).simd_min(low.splat(1.0));
    let mut off = x - reference;
    off.z -= moved * share;
    off.plain_dot(off)
}

/// Force of the two bonds of a particle (N) from their pulls: of the bond that begins at it and of the one before.
#[inline(always)]
pub fn force_of_bonds<R: Real>(here: R, before: R) -> R {
    here - before
}

/// Torque of the two bonds of a particle (N m): `near` moment of the bond that begins at it, `far` one of the bond before.
#[inline(always)]
pub fn torque_of_bonds<R: Real>(near: R, far: R) -> R {
    near + far
}

/// Radius of a particle (m) as the mean over its bonds, from their factors on the undeformed radius, which are 0 where none has
/// been. Those that have broken count with the factor that they had: plastic strain stays. A particle without any keeps its own.
#[inline(always)]
pub fn thinned_radius<R: Real>(undeformed: R, kept: R, here: R, before: R) -> R {
    let (zero, half, one) = (kept.splat(0.0), kept.splat(0.5), kept.splat(1.0));
    let (some, both) = (here.simd_gt(zero) | before.simd_gt(zero), here.simd_gt(zero) & before.simd_gt(zero));
    let mean = undeformed * ((here + before) * R::select(both, half, one));
    R::select(some, mean, kept)
}

/// Share of the upper grip's speed that a place has in the affine field of a pull between two faces (-).
#[inline(always)]
pub fn affine_share<R: Real>(z: R, [low, high]: [R; 2]) -> R {
    ((z - low) / (high - low)).simd_max(z.splat(0.0)).simd_min(z.splat(1.0))
}

/// Speed along z (m/s) with a push (m/s) on top of a kick by `force` over `time` (s), and the work of that push (J).
#[inline(always)]
pub fn sped_up<R: Real>(speed: R, push: R, force: R, mass: R, time: R) -> [R; 2] {
    let kick = force * time / mass;
    // Mean of the speeds before the kick, forces and this push, and after it.
    let mean = speed + (push - kick) * 0.5;
    [speed + push, mass * push * mean]
}

/// A particle that a grip or a hold acts on, after a kick.
pub struct Kicked<R> {
    /// Its place in the plane of x and y, from the axis of the grips (m).
    pub arm: [R; 2],
    /// Velocity (m/s) and spin (rad/s).
    pub v: Triple<R>,
    /// See `v`.
    pub w: Triple<R>,
    /// Force (N) and torque (N m) that kicked it.
    pub force: Triple<R>,
    /// See `force`.
    pub torque: Triple<R>,
    /// Mass (kg), rotational inertia (kg m²), and their inverses.
    pub mass: R,
    /// See `mass`.
    pub inertia: R,
    /// See `mass`.
    pub inverse_mass: R,
    /// See `mass`.
    pub inverse_inertia: R,
    /// Time that the kick spanned (s).
    pub time: R,
}

/// What a grip or a hold makes of a particle, and what that takes.
pub struct Held<R> {
    /// Velocity (m/s) and spin (rad/s).
    pub v: Triple<R>,
    /// See `v`.
    pub w: Triple<R>,
    /// Force along z (N), without what speeds up the particle together with the whole body, and torque about the axis of the
    /// grips (N m): of forces, and of moments.
    pub force: R,
    /// See `force`.
    pub torque: [R; 2],
    /// Work of forces and of moments (J).
    pub work: [R; 2],
}

impl<R: Real> Kicked<R> {
    /// Under a grip that moves straight along z at `speed` (m/s); `per_time` is the inverse of the time (1/s). Torque and work
    /// of moments are among those of forces.
    #[inline(always)]
    pub fn straight(&self, speed: R, per_time: R) -> Held<R> {
        let zero = speed.splat(0.0);
        // The speeds before the kick, the push to where the grip goes, and the work of it.
        let after = Triple { x: zero, y: zero, z: speed };
        let push = (after - self.v) * (self.mass * per_time);
        let before = self.v - self.force * (self.inverse_mass * self.time);
        let twist = self.w * (-self.inertia * per_time);
        let spin = self.w - self.torque * (self.inverse_inertia * self.time);
        let work = (push.dot(before + after) + twist.dot(spin)) * (self.time * 0.5);
        let [x, y] = self.arm;
        let torque = x * push.y - y * push.x + twist.z;
        let none = Triple { x: zero, y: zero, z: zero };
        Held { v: after, w: none, force: push.z, torque: [torque, zero], work: [work, zero] }
    }

    /// Under a grip that moves along and about z.
    #[inline(always)]
    pub fn rigid(&self, grip: &Rigid<R>) -> Held<R> {
        let [x, y] = self.arm;
        let zero = x.splat(0.0);
        let kick = self.time / self.mass;
        let before = self.v - self.force * kick;
        let [cos, sin] = grip.chord;
        let mut after = Triple { x: cos * x + (-sin) * y, y: sin * x + cos * y, z: grip.speed };
        let mut load = Triple { x: zero, y: zero, z: zero };
        if let Some(clamp) = grip.clamp {
            let outward = outward(self.arm);
            load = outward * -clamp;
            after = after + outward * (self.v + load * kick).plain_dot(outward);
        }
        let push = (after - self.v) * (self.mass / self.time);
        let half = self.time * 0.5;
        let work = push.plain_dot(before + after) * half;
        let constraint = push - load;
        let turn = Triple { x: zero * grip.spin, y: zero * grip.spin, z: grip.spin };
        let twist = (turn - self.w) * (self.inertia / self.time);
        let spin_before = self.w - self.torque * (self.time / self.inertia);
        Held {
            v: after,
            w: turn,
            force: constraint.z - grip.acceleration * self.mass,
            torque: [x * constraint.y - y * constraint.x, twist.z],
            work: [work, twist.plain_dot(spin_before + turn) * half],
        }
    }

    /// Under a hold of single components and a load: force (N) and moment (N m). It has no part in the grips' reactions.
    #[inline(always)]
    pub fn components(&self, fixed: &[bool; 6], [velocity, spin]: [Triple; 2], load: [Triple<R>; 2]) -> Held<R> {
        let (kick, spin_kick) = (self.time / self.mass, self.time / self.inertia);
        let half = self.time * 0.5;
        let before = self.v - self.force * kick;
        let v = prescribed(&fixed[..3], velocity, self.v + load[0] * kick);
        let work = (v - self.v).map(|change| change / kick).plain_dot(before + v) * half;
        let before = self.w - self.torque * spin_kick;
        let w = prescribed(&fixed[3..], spin, self.w + load[1] * spin_kick);
        let work_of_moments = (w - self.w).map(|change| change / spin_kick).plain_dot(before + w) * half;
        let zero = kick.splat(0.0);
        Held { v, w, force: zero, torque: [zero; 2], work: [work, work_of_moments] }
    }
}

/// Motion of a grip in a step.
pub struct Rigid<R> {
    /// (cos − 1)/Δt and sin/Δt of the angle that it turns by (1/s): the chord of the exact rotation, so that particles stay
    /// on their circle.
    pub chord: [R; 2],
    /// Velocity along z (m/s).
    pub speed: R,
    /// Spin about z (rad/s).
    pub spin: R,
    /// Clamp force per particle (N), under which it is free along the radius.
    pub clamp: Option<R>,
    /// What it takes to speed up the held particles themselves loads the drive, not the body: acceleration along z (m/s²).
    pub acceleration: R,
}

/// Direction of a place from the axis; none on it.
#[inline(always)]
fn outward<R: Real>([x, y]: [R; 2]) -> Triple<R> {
    let (zero, one) = (x.splat(0.0), x.splat(1.0));
    let inverse = one / (x * x + y * y).sqrt();
    let some = inverse.simd_gt(zero) & x.splat(f64::INFINITY).simd_gt(inverse);
    Triple::select(some, Triple { x: x * inverse, y: y * inverse, z: zero }, Triple { x: zero, y: zero, z: zero })
}

/// `free` with the fixed components replaced.
#[inline(always)]
pub fn prescribed<R: Real>(fixed: &[bool], value: Triple, free: Triple<R>) -> Triple<R> {
    Triple {
        x: if fixed[0] { free.x.splat(value.x) } else { free.x },
        y: if fixed[1] { free.y.splat(value.y) } else { free.y },
        z: if fixed[2] { free.z.splat(value.z) } else { free.z },
    }
}
