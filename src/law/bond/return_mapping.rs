//! The way back to the yield surface (N/N_p)² + |M|/M_p + (T/T_p)² + (V/V_p)² = 1 of a round section: associative,
//! implicit, with isotropic hardening within the step.

use crate::base::lanes::{Mask, Real};

/// Where a return ends: factors on the trial values, and the plastic multiplier.
#[derive(Clone, Copy)]
pub(super) struct Return<R> {
    /// σ/σ* [-].
    pub axial: R,
    /// M/M*, T/T*, V/V* [-].
    pub bend: R,
    pub twist: R,
    pub shear: R,
    /// Increment of p [-].
    pub equivalent: R,
}

impl<R: Real> Return<R> {
    #[inline(always)]
    fn choose(mask: R::Mask, yes: &Self, no: &Self) -> Self {
        let pick = |a, b| R::choose(mask, a, b);
        Self {
            axial: pick(yes.axial, no.axial),
            bend: pick(yes.bend, no.bend),
            twist: pick(yes.twist, no.twist),
            shear: pick(yes.shear, no.shear),
            equivalent: pick(yes.equivalent, no.equivalent),
        }
    }
}

/// Trial point and compliances of the return, all relative to the yield values at the start of the step.
pub(super) struct Trial<R> {
    /// σ*/σ_y, |M*|/M_p, T*/T_p, |V*|/V_p [-].
    pub axial: R,
    pub bend: R,
    pub twist: R,
    pub shear: R,
    /// What one unit of x takes off each of them [1/Pa].
    pub axial_rate: R,
    pub bend_rate: R,
    pub twist_rate: R,
    pub shear_rate: R,
    /// Growth of σ_y/σ_y₀ with x at unit plastic work [1/Pa].
    pub hardening_rate: R,
    /// 1/σ_y at the start [1/Pa].
    pub inverse_yield: R,
}

impl<R: Real> Trial<R> {
    /// Where the trial lies beyond the yield surface.
    #[inline(always)]
    pub fn outside(&self) -> R::Mask {
        let reached = self.axial * self.axial + self.bend + self.twist * self.twist + self.shear * self.shear;
        reached.above(reached.like(1.0))
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
        let one = self.axial.like(1.0);
        let zero = self.axial.like(0.0);
        // Plastic work per x is 2 − m on the surface. Hardening within the step takes m from the trial: what that
        // leaves out is of second order in the step, and the next step starts from σ_y(p) again.
        let h = self.hardening_rate * (-self.bend.lesser(one) + 2.0);
        let square = |value: R, rate: R| [value * value, value * value * (h + rate)];
        let (n, t, v) = (
            square(self.axial, self.axial_rate),
            square(self.twist, self.twist_rate),
            square(self.shear, self.shear_rate),
        );
        let size2 = n[0] + t[0] + v[0];
        let end_of_range = R::choose(h.above(zero), h.inverse(), zero.like(f64::INFINITY));
        let start = ((size2.sqrt() - 1.0) * size2 / (n[1] + t[1] + v[1])).greater(zero);
        let mut z = start.lesser(end_of_range * 0.5);
        let mut end = Return { axial: one, bend: one, twist: one, shear: one, equivalent: zero };
        let mut open = wanted;
        for round in 0..=60 {
            let shrink = one - h * z;
            // Each mode apart, so that the axial one has the same bits without the others.
            let soft = |rate: R| (z * rate + 1.0).inverse();
            let (axial, twist, shear) = (soft(self.axial_rate), soft(self.twist_rate), soft(self.shear_rate));
            let (n, t, v) = (self.axial * shrink * axial, self.twist * shrink * twist, self.shear * shrink * shear);
            let bend = (self.bend * shrink - z * self.bend_rate).greater(zero);
            let bent = bend.above(zero);
            let f = n * n + bend + t * t + v * v - 1.0;
            if round > 0 {
                let growth = shrink.inverse();
                let kept = R::choose(bent, bend * growth / self.bend, zero);
                let equivalent = z * (-bend + 2.0) * self.inverse_yield * growth;
                end = Return::choose(open, &Return { axial, bend: kept, twist, shear, equivalent }, &end);
                open = open & !one.above(f.abs() * 1e10);
                if !open.any() {
                    break;
                }
            }
            let fall = |value: R, rate: R, soft: R| value * value * (h + rate * soft);
            let slope =
                fall(n, self.axial_rate, axial) + fall(t, self.twist_rate, twist) + fall(v, self.shear_rate, shear);
            let slope = slope * -2.0 - R::choose(bent, self.bend * h + self.bend_rate, zero);
            z = (z - f / slope).greater(zero).lesser((z + end_of_range) * 0.5);
        }
        end
    }
}
