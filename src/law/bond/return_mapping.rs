//! The way back to the yield surface (N/N_p)² + |M|/M_p + (T/T_p)² + (V/V_p)² = 1 of a round section: associative,
//! implicit, with isotropic hardening within the step.

use crate::base::lanes::{Mask, Real, Refinement};

/// Where a return ends: factors on the trial values, and the plastic multiplier.
#[derive(Clone, Copy)]
pub(super) struct Return<R> {
    /// σ/σ* (-).
    pub axial: R,
    /// M/M*, T/T*, V/V* (-).
    pub bend: R,
    pub twist: R,
    pub shear: R,
    /// Increment of p (-).
    pub equivalent: R,
}

/// Half of how fast the square of a mode falls with z.
#[inline(always)]
fn fall_of<R: Real>(value: R, rate: R, soft: R, h: R) -> R {
    value * value * (h + rate * soft)
}

/// A stress point on the way back, relative to the yield values there.
struct Point<R> {
    /// σ_y₀/σ_y (-).
    shrink: R,
    /// What plastic flow leaves of σ*, T*, V* (-).
    soft: [R; 3],
    axial: R,
    bend: R,
    twist: R,
    shear: R,
}

/// Trial point and compliances of the return, all relative to the yield values at the start of the step.
pub(super) struct Trial<R> {
    /// σ*/σ_y, |M*|/M_p, T*/T_p, |V*|/V_p (-).
    pub axial: R,
    pub bend: R,
    pub twist: R,
    pub shear: R,
    /// What one unit of x takes off each of them (1/Pa).
    pub axial_rate: R,
    pub bend_rate: R,
    pub twist_rate: R,
    pub shear_rate: R,
    /// Growth of σ_y/σ_y₀ with x at unit plastic work (1/Pa).
    pub hardening_rate: R,
    /// 1/σ_y at the start (1/Pa).
    pub inverse_yield: R,
}

/// Newton's rule for z on the yield surface that hardens at the rate `h`.
struct Newton<'a, R> {
    trial: &'a Trial<R>,
    h: R,
}

impl<R: Real> Refinement<R> for Newton<'_, R> {
    /// The stress point, and by how much it lies outside the surface.
    type Point = (Point<R>, R);

    #[inline(always)]
    fn at(&self, z: R) -> (Point<R>, R) {
        let point = self.trial.at(self.h, z);
        let f = point.axial * point.axial + point.bend + point.twist * point.twist + point.shear * point.shear - 1.0;
        (point, f)
    }

    #[inline(always)]
    fn unsettled(&self, (_, f): &(Point<R>, R)) -> R::Mask {
        !f.splat(1.0).simd_gt(f.abs() * 1e10)
    }

    #[inline(always)]
    fn next(&self, z: R, (point, f): &(Point<R>, R)) -> R {
        let (trial, h, zero) = (self.trial, self.h, z.splat(0.0));
        let slope = fall_of(point.axial, trial.axial_rate, point.soft[0], h)
            + fall_of(point.twist, trial.twist_rate, point.soft[1], h)
            + fall_of(point.shear, trial.shear_rate, point.soft[2], h);
        let bent = point.bend.simd_gt(zero);
        let falls = slope * 2.0 + R::select(bent, trial.bend * h + trial.bend_rate, zero);
        trial.within_range(h, z, (z + *f * falls.inverse()).simd_max(zero))
    }
}

impl<R: Real> Trial<R> {
    /// Where the trial lies beyond the yield surface.
    #[inline(always)]
    pub fn outside(&self) -> R::Mask {
        let reached = self.axial * self.axial + self.bend + self.twist * self.twist + self.shear * self.shear;
        reached.simd_gt(reached.splat(1.0))
    }

    /// Newton on z = x (σ_y₀/σ_y)², in which the return has no division by the growth of σ_y: 1/growth is 1 − hz.
    ///
    /// The start is the root for tension alone, good to the square of the step; one round always follows, so that the
    /// answer depends smoothly on the trial, and more where that was not enough. A bond that has its answer keeps it
    /// while others go on. Only the answers within `wanted` mean something.
    ///
    /// The root lies below z = 1/h, where σ_y would be infinite: a step of Newton's that would pass it goes half way.
    /// A law as steep as Ludwik's at first yield needs that.
    #[inline(always)]
    pub fn solve(&self, wanted: R::Mask) -> Return<R> {
        let one = self.axial.splat(1.0);
        let zero = self.axial.splat(0.0);
        // Plastic work per x is 2 − m on the surface. Hardening within the step takes m from the trial: what that
        // leaves out is of second order in the step, and the next step starts from σ_y(p) again.
        let h = self.hardening_rate * (-self.bend.simd_min(one) + 2.0);
        let (n2, t2, v2) = (self.axial * self.axial, self.twist * self.twist, self.shear * self.shear);
        let fall = n2 * (h + self.axial_rate) + t2 * (h + self.twist_rate) + v2 * (h + self.shear_rate);
        let size2 = n2 + t2 + v2;
        let size = size2 * size2.inverse_sqrt();
        let start = ((size - 1.0) * size2 * fall.inverse()).simd_max(zero);
        let newton = Newton { trial: self, h };
        let (z, (point, _)) = self.within_range(h, zero, start).refine(&newton, wanted, 61);
        self.end(z, &point)
    }

    /// `next`, or half way from `last` to the end of the range of z where it lies beyond that.
    #[inline(always)]
    fn within_range(&self, h: R, last: R, next: R) -> R {
        let far = (next * h).simd_gt((last * h + 1.0) * 0.5);
        if far.any() { R::select(far, (last + h.inverse()) * 0.5, next) } else { next }
    }

    /// The stress point at `z`, relative to the yield values that belong to it.
    #[inline(always)]
    fn at(&self, h: R, z: R) -> Point<R> {
        let shrink = z.splat(1.0) - h * z;
        // The axial mode apart, so that it has the same bits without the others; two inverses from one division.
        let axial = (z * self.axial_rate + 1.0).inverse();
        let (twist, shear) = (z * self.twist_rate + 1.0, z * self.shear_rate + 1.0);
        let both = (twist * shear).inverse();
        let soft = [axial, both * shear, both * twist];
        Point {
            shrink,
            soft,
            axial: self.axial * shrink * soft[0],
            twist: self.twist * shrink * soft[1],
            shear: self.shear * shrink * soft[2],
            bend: (self.bend * shrink - z * self.bend_rate).simd_max(z.splat(0.0)),
        }
    }

    /// What becomes of the trial values at the answer.
    #[inline(always)]
    fn end(&self, z: R, point: &Point<R>) -> Return<R> {
        let zero = z.splat(0.0);
        let bent = point.bend.simd_gt(zero);
        let bend = R::select(bent, self.bend, z.splat(1.0));
        let inverse = (point.shrink * bend).inverse();
        let growth = inverse * bend;
        Return {
            axial: point.soft[0],
            twist: point.soft[1],
            shear: point.soft[2],
            bend: R::select(bent, point.bend * inverse, zero),
            equivalent: z * (-point.bend + 2.0) * self.inverse_yield * growth,
        }
    }
}
