//! No tangential force: contacts slide freely.

use super::{TangentialInput, TangentialLaw, TangentialResponse};

/// Frictionless contact.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Frictionless;

impl TangentialLaw for Frictionless {
    type State = ();

    const ACTIVE: bool = false;

    #[inline(always)]
    fn response(&self, _: &mut (), _: &TangentialInput) -> TangentialResponse {
        TangentialResponse::default()
    }

    #[inline(always)]
    fn elastic_energy(&self, _: &()) -> f64 {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn slip_meets_no_force_and_leaves_no_energy() {
        let input = TangentialInput { normal: DVec3::Z, slip: DVec3::X, normal_force: 5.0, radius: 1e-3 };
        assert_eq!(Frictionless.response(&mut (), &input), TangentialResponse::default());
        assert_eq!(Frictionless.elastic_energy(&()), 0.0);
    }
}
