//! What bonds do in a step: their motion, their law, their dashpots; for bonds one at a time or several at once.

use super::layout::MODES;
use crate::base::lanes::Real;
use crate::base::triple::Triple;
use crate::law::bond::{BondForce, BondIncrement, BondLaw, BondShape};

/// Particles as their bonds see them.
#[derive(Clone, Copy)]
pub(super) struct Node<R> {
    pub(super) x: Triple<R>,
    pub(super) v: Triple<R>,
    pub(super) w: Triple<R>,
}

/// What bonds do: pull on the first particle (N) (the second feels minus this), moments on the first and on the second
/// (N m).
pub(super) struct Acts<R> {
    pub(super) pull: Triple<R>,
    pub(super) near: Triple<R>,
    pub(super) far: Triple<R>,
}

/// A step of some bonds: what they share, and the energies that they give off (J).
pub(super) struct Step<'a, L: BondLaw, R: Real> {
    pub(super) law: &'a L,
    /// Step (s), and its inverse (1/s).
    pub(super) dt: R,
    pub(super) per: R,
    pub(super) live: R::Mask,
    pub(super) plastic: R,
    pub(super) damping: R,
}

/// Length of a bond (m) and its direction.
#[inline(always)]
fn axis<R: Real>(d: Triple<R>) -> (R, Triple<R>) {
    let square = d.length_squared();
    let inverse = square.inverse_sqrt();
    (square * inverse, d * inverse)
}

/// ln(l/l₀), from the square of the length, which is there before its root (-).
#[inline(always)]
fn log_strain<R: Real>(d: Triple<R>, shape: &BondShape<R>) -> R {
    (d.length_squared() * (shape.inverse_length * shape.inverse_length)).ln() * 0.5
}

/// Where what limits a bond has reached its limit, or is no number.
#[inline(always)]
pub(super) fn reached<R: Real>(value: R, limit: R) -> R::Mask {
    !limit.simd_gt(value)
}

impl<L: BondLaw, R: Real> Step<'_, L, R> {
    /// Bonds that only stretch.
    #[inline(always)]
    pub(super) fn stretching(
        &mut self,
        [a, b]: &[Node<R>; 2],
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut L::State<R>,
        dashpot: &mut R,
        viscosity: Option<[R; MODES]>,
    ) -> Acts<R> {
        let d = b.x - a.x;
        let (length, n) = axis(d);
        let zero = length.splat(0.0);
        let log_strain = log_strain(d, shape);
        let step = BondIncrement { log_strain, length, shear: [zero; 2], bend: [zero; 2], twist: zero };
        self.plastic = self.law.axial_response(shape, force, state, &step, self.live);
        let mut axial = force.axial;
        if let Some(c) = viscosity {
            axial += self.axial_dashpot(c[0], (b.v - a.v).dot(n), dashpot);
        }
        let none = Triple { x: zero, y: zero, z: zero };
        Acts { pull: n * axial, near: none, far: none }
    }

    /// Force of the axial dashpot at an elongation rate (m/s); one formula for both kinds of bond, so that they agree
    /// to the bit. The first evaluation, before any step (`dt` = 0), has none: its work would go unbooked.
    ///
    /// Work is the mean of `last` and present force over the step between them. The present force alone books too much
    /// where the rate falls from step to step, as in the ringing after a rupture.
    #[inline(always)]
    fn axial_dashpot(&mut self, coefficient: R, rate: R, last: &mut R) -> R {
        let force = coefficient * rate;
        self.damping += (*last + force) * 0.5 * rate * self.dt;
        *last = force;
        force
    }

    /// Adds the force of a dashpot across to `f`.
    #[inline(always)]
    fn dashpot(&mut self, f: &mut R, coefficient: R, increment: R) {
        let push = coefficient * increment * self.per;
        *f += push;
        self.damping += push * increment;
    }

    /// Bonds in all modes.
    #[inline(always)]
    #[allow(clippy::too_many_arguments)]
    pub(super) fn turning(
        &mut self,
        [a, b]: &[Node<R>; 2],
        shape: &BondShape<R>,
        e1: &mut Triple<R>,
        force: &mut BondForce<R>,
        state: &mut L::State<R>,
        dashpot: &mut R,
        viscosity: Option<[R; MODES]>,
    ) -> Acts<R> {
        let dt = self.dt;
        let (d, dv) = (b.x - a.x, b.v - a.v);
        let (length, n) = axis(d);

        // Mid-step geometry.
        let middle = d - dv * (dt * 0.5);
        let inv_middle = middle.length_squared().inverse_sqrt();
        let n_mid = middle * inv_middle;
        let spin = (a.w + b.w).map(|w| w * 0.5);
        // The frame turns with the bond's direction and with the mean spin about it.
        let turn = n_mid.cross(dv) * (inv_middle * dt) + n_mid * (spin.dot(n_mid) * dt);
        let e1_old = *e1;
        let carried = e1_old + turn.cross(e1_old);
        let flat = carried - n * carried.dot(n);
        // Its length differs from 1 by the square of a step's rotation; one Newton step of 1/√q mends that.
        *e1 = flat * (flat.length_squared() * -0.5 + 1.5);
        let e1_mid = (e1_old + *e1).map(|e| e * 0.5);
        let e2_mid = n_mid.cross(e1_mid);

        let slide = (dv - spin.cross(middle)).map(|s| s * dt);
        let rotation = (b.w - a.w).map(|w| w * dt);
        let step = BondIncrement {
            log_strain: log_strain(d, shape),
            length,
            shear: [slide.dot(e1_mid), slide.dot(e2_mid)],
            bend: [rotation.dot(e1_mid), rotation.dot(e2_mid)],
            twist: rotation.dot(n_mid),
        };
        self.plastic = self.law.response(shape, force, state, &step, self.live);
        let mut f = *force;
        if let Some(c) = viscosity {
            f.axial += self.axial_dashpot(c[0], dv.dot(n), dashpot);
            self.dashpot(&mut f.twist, c[3], step.twist);
            for axis in 0..2 {
                self.dashpot(&mut f.shear[axis], c[1], step.shear[axis]);
                self.dashpot(&mut f.bend[axis], c[2], step.bend[axis]);
            }
        }
        let e2 = n.cross(*e1);
        let pull = n * f.axial + (*e1 * f.shear[0] + e2 * f.shear[1]);
        let moment = n * f.twist + (*e1 * f.bend[0] + e2 * f.bend[1]);
        let arm = n.cross(pull) * (length * 0.5);
        Acts { pull, near: arm + moment, far: arm - moment }
    }
}
