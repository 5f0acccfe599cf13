//! No tangential force: contacts slide freely.

use super::{TangentialInput, TangentialLaw, TangentialResponse};
use crate::base::lanes::Real;
use crate::base::triple::Triple;

/// Frictionless contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Frictionless;

impl TangentialLaw for Frictionless {
    type State<R: Real> = ();

    const HISTORY: usize = 0;

    const ACTIVE: bool = false;

    #[inline(always)]
    fn history<R: Real>(_: impl Fn(usize) -> R) {}

    #[inline(always)]
    fn each_number<R: Real>((): &(), _: impl FnMut(usize, R)) {}

    #[inline(always)]
    fn response<R: Real>(&self, (): &mut (), input: &TangentialInput<R>) -> TangentialResponse<R> {
        let zero = input.radius.splat(0.0);
        TangentialResponse { pull: Triple::zero(zero), stiffness: zero, friction_work: zero }
    }

    #[inline(always)]
    fn elastic_energy(&self, (): &()) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn slip_meets_no_force_and_leaves_no_energy() {
        let input = TangentialInput { slip: DVec3::X.into(), ..TangentialInput::at_rest(5.0, 1e-3) };
        assert_eq!(Frictionless.response(&mut (), &input), TangentialResponse::default());
        assert_eq!(Frictionless.elastic_energy(&()), 0.0);
    }
}
