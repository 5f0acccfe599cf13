//! What a step does to particles as formulas that can be recorded: their motion under grips and holds, and what their bonds
//! add up to. Those of bonds stand in [`bonds::formula`](super::bonds::formula).
//!
//! Names of numbers: of a particle by their own (`x_x`, `mass`); those of the bond that begins at it and of the one before
//! with `here_` and `before_`; `held_0` is 1 where hold 0 acts, `free` where none prescribes anything. Others are of the step, the same for all particles.

use super::motion::{
    Kicked, Rigid, affine_share, drifted, force_of_bonds, kicked, ran_away, residual, sped_up, thinned_radius,
    torque_of_bonds,
};
use crate::base::lanes::Real;
use crate::base::recorder::{Formula, put_vector, take_vector};
use crate::base::triple::Triple;

/// What a group of held particles must do.
#[derive(Debug, Clone)]
pub enum HoldFormula {
    /// [`Kicked::straight`].
    Straight,
    /// [`Kicked::rigid`], with or without a clamp force.
    Rigid {
        /// Whether there is one.
        clamped: bool,
    },
    /// [`Kicked::components`].
    Components {
        /// Prescribed components: x, y, z, then rotation about x, y, z.
        fixed: [bool; 6],
        /// Their velocity (m/s) and spin (rad/s).
        motion: [Triple; 2],
    },
}

/// Kick, grips and holds, drift.
#[derive(Debug, Clone)]
pub struct Motion {
    /// Whether particles turn.
    pub turn: bool,
    /// Where the axis of the grips crosses the plane of x and y (m).
    pub axis: [f64; 2],
    /// Groups of held particles, in the order in which they act.
    pub holds: Vec<HoldFormula>,
    /// Whether the affine field of the pull is sped up and slowed down.
    pub adaptive: bool,
    /// Squared displacement in a step beyond which a particle has run away (m²).
    pub limit: f64,
    /// Whether particles see that neighbours have to be searched anew.
    pub search: bool,
}

impl Formula for Motion {
    /// Puts position, velocity and spin; the work that the holds have done so far (J); force (N) and torque (N m) of the grips
    /// at this step; and whether the particle ran away (1 or 0).
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let (x, v, force) = (take_vector(take, "x"), take_vector(take, "v"), take_vector(take, "force"));
        let none = Triple::zero(x.x);
        let (zero, one) = (none.x, none.x.splat(1.0));
        let turning =
            |take: &mut dyn FnMut(&str) -> R, name: &str| if self.turn { take_vector(take, name) } else { none };
        let (w, torque) = (turning(take, "w"), turning(take, "torque"));
        let [mass, inertia, inverse_mass, inverse_inertia] =
            ["mass", "inertia", "inverse_mass", "inverse_inertia"].map(&mut *take);
        let [dt, time, per_time] = ["dt", "kicked", "inverse_kicked"].map(&mut *take);
        let arm = [x.x - self.axis[0], x.y - self.axis[1]];
        let mut v = kicked(v, force, inverse_mass, time);
        let mut w = if self.turn { kicked(w, torque, inverse_inertia, time) } else { none };
        let (mut work, mut grip_force, mut grip_torque) = (zero, zero, zero);
        for (hold, formula) in self.holds.iter().enumerate() {
            let mut number = |name: &str| take(&format!("{name}_{hold}"));
            let here = number("held").simd_gt(zero);
            let before = Kicked { arm, v, w, force, torque, mass, inertia, inverse_mass, inverse_inertia, time };
            let held = match formula {
                HoldFormula::Straight => before.straight(number("speed"), per_time),
                HoldFormula::Rigid { clamped } => before.rigid(&Rigid {
                    chord: [number("cos"), number("sin")],
                    speed: number("speed"),
                    spin: number("spin"),
                    clamp: clamped.then(|| number("clamp")),
                    acceleration: number("acceleration"),
                }),
                HoldFormula::Components { fixed, motion } => {
                    let push = take_vector(take, &format!("push_{hold}"));
                    let load = [push, turning(take, &format!("moment_{hold}"))];
                    before.components(fixed, *motion, load)
                }
            };
            let part = |number: R| R::select(here, number, zero);
            v = Triple::select(here, held.v, v);
            w = Triple::select(here, held.w, w);
            work += part(held.work[0] + held.work[1]);
            grip_force += part(held.force);
            grip_torque += part(held.torque[0] + held.torque[1]);
        }
        if self.adaptive {
            let share = affine_share(x.z, ["low", "high"].map(&mut *take));
            let [speed, done] = sped_up(v.z, share * take("speed_change"), force.z, mass, time);
            let free = take("free").simd_gt(zero);
            v.z = R::select(free, speed, v.z);
            work += R::select(free, done, zero);
        }
        let (x, square) = drifted(x, v, dt);
        put_vector(put, "x", x);
        put_vector(put, "v", v);
        if self.turn {
            put_vector(put, "w", w);
        }
        if !self.holds.is_empty() {
            put("work", take("work") + work);
            put("grip_force", grip_force);
            put("grip_torque", grip_torque);
        }
        put("ran_away", R::select(ran_away(square, zero.splat(self.limit)), one, zero));
        if self.search {
            let reference = take_vector(take, "reference");
            let [moved, low, per_length, most] =
                ["search_moved", "search_low", "search_per_length", "search_most"].map(&mut *take);
            let fits = most.simd_gt(residual(x, reference, moved, [low, per_length]));
            put("search", R::select(fits, zero, one));
        }
    }
}

/// What the bonds and contacts of a particle add up to; of its contacts `contacts_` are the sums over their pairs.
#[derive(Debug, Clone)]
pub struct Gathering {
    /// Whether particles turn.
    pub turn: bool,
    /// Whether wires thin as they stretch.
    pub thin: bool,
    /// Whether there are bonds.
    pub bonds: bool,
    /// Whether there are contacts.
    pub contacts: bool,
}

impl Formula for Gathering {
    /// Puts force (N) and torque (N m), radius (m), and by how much it has shrunk.
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        for axis in ["x", "y", "z"] {
            let mut parts = Vec::new();
            if self.bonds {
                let [here, before] = ["here", "before"].map(|side| take(&format!("{side}_pull_{axis}")));
                parts.push(force_of_bonds(here, before));
            }
            if self.contacts {
                parts.push(take(&format!("contacts_force_{axis}")));
            }
            put(&format!("force_{axis}"), sum(&parts));
            if self.turn {
                parts.clear();
                if self.bonds {
                    let (near, far) = (format!("here_moment_near_{axis}"), format!("before_moment_far_{axis}"));
                    parts.push(torque_of_bonds(take(&near), take(&far)));
                }
                if self.contacts {
                    parts.push(take(&format!("contacts_torque_{axis}")));
                }
                put(&format!("torque_{axis}"), sum(&parts));
            }
        }
        if self.thin {
            let [undeformed, kept, here, before] =
                ["radius0", "radius", "here_thinning", "before_thinning"].map(&mut *take);
            let now = thinned_radius(undeformed, kept, here, before);
            put("radius", now);
            put("thinned", kept - now);
        }
    }
}

/// The sum of some parts, of which there is one.
fn sum<R: Real>(parts: &[R]) -> R {
    let mut sum = parts[0];
    parts[1..].iter().for_each(|part| sum += *part);
    sum
}
