//! `elastic`: linear in all modes, the classic parallel bond (Potyondy & Cundall 2004), on log strain.

use super::{BondForce, BondIncrement, BondLaw, BondShape, BondStiffness, Moduli, Section};
use super::{add_transverse, transverse_energy};
use crate::base::lanes::Real;

/// Elastic bond.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elastic {
    /// Elastic constants.
    pub moduli: Moduli,
}

impl BondLaw for Elastic {
    type State<R: Real> = ();

    const HISTORY: usize = 0;

    #[inline(always)]
    fn history<R: Real>(_: impl Fn(usize) -> R) {}

    #[inline(always)]
    fn each_number<R: Real>((): &(), _: impl FnMut(usize, R)) {}

    fn initial(&self) {}

    #[inline(always)]
    fn response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        state: &mut (),
        step: &BondIncrement<R>,
        live: R::Mask,
    ) -> R {
        let k = self.stiffness(shape, state);
        add_transverse(force, &k, step);
        self.axial_response(shape, force, state, step, live)
    }

    #[inline(always)]
    fn axial_response<R: Real>(
        &self,
        shape: &BondShape<R>,
        force: &mut BondForce<R>,
        _: &mut (),
        step: &BondIncrement<R>,
        _: R::Mask,
    ) -> R {
        force.axial = Section::round(shape.radius).area * self.moduli.young * step.log_strain;
        step.length.splat(0.0)
    }

    #[inline(always)]
    fn stiffness<R: Real>(&self, shape: &BondShape<R>, _: &()) -> BondStiffness<R> {
        Section::round(shape.radius).stiffness(&self.moduli, shape.inverse_length)
    }

    /// The axial part is the potential of N = EA ln(l/l₀): EA (l ln(l/l₀) − l + l₀).
    fn elastic_energy(&self, shape: &BondShape, force: &BondForce, state: &()) -> f64 {
        let stiffness = self.moduli.young * Section::round(shape.radius).area;
        let strain = force.axial / stiffness;
        let axial = stiffness * shape.rest_length * (strain * f64::exp(strain) - strain.exp_m1());
        axial + transverse_energy(force, &self.stiffness(shape, state))
    }

    #[inline(always)]
    fn section<R: Real>(&self, shape: &BondShape<R>, _: &()) -> Section<R> {
        Section::round(shape.radius)
    }

    #[inline(always)]
    fn plastic_strain<R: Real>(&self, shape: &BondShape<R>, _: &()) -> R {
        shape.radius.splat(0.0)
    }

    #[inline(always)]
    fn thinning<R: Real>(&self, shape: &BondShape<R>, _: &()) -> R {
        shape.radius.splat(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axial_force_is_the_slope_of_its_energy() {
        let law = Elastic { moduli: Moduli::new(115e9, 0.34) };
        let shape = BondShape::new(0.39e-3, 0.195e-3);
        let energy = |l: f64| {
            let mut force = BondForce::default();
            let step = BondIncrement { log_strain: f64::ln(l / shape.rest_length), length: l, ..Default::default() };
            law.axial_response(&shape, &mut force, &mut (), &step, true);
            (law.elastic_energy(&shape, &force, &()), force.axial)
        };
        let (l, h) = (0.40e-3, 1e-9);
        let slope = (energy(l + h).0 - energy(l - h).0) / (2.0 * h);
        assert!((slope / energy(l).1 - 1.0).abs() < 1e-6);
    }
}
