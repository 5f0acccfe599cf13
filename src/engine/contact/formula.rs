//! What a touching pair does in a step, as a formula that can be recorded.

use super::pair::{ContactKinematics, Dissipated, History, Laws, contact_response};
use crate::base::lanes::Real;
use crate::base::recorder::{Formula, put_vector, take_vector};
use crate::law::contact::NormalLaw;
use crate::law::tangential::TangentialLaw;

/// A step of one contact: normal law, friction, damping, thinning.
#[derive(Debug, Clone, Copy)]
pub struct ContactStep<N, T>(pub Laws<N, T>);

impl<N: NormalLaw, T: TangentialLaw> Formula for ContactStep<N, T> {
    /// Takes the reduced radius (m), what the contact remembers ([`History`]), normal, overlap and thinning (m), velocity
    /// (m/s), viscosity (√kg) and step (s). Puts what it then remembers, the force on the first body and the friction in it
    /// (N), and the energies that it gives off (J).
    fn compute<R: Real>(&self, take: &mut dyn FnMut(&str) -> R, put: &mut dyn FnMut(&str, R)) {
        let reduced_radius = take("reduced_radius");
        let numbers: Vec<R> = (0..History::<N, T>::NUMBERS).map(|k| take(&format!("history_{k}"))).collect();
        let mut history = History::<N, T, R>::of(reduced_radius, |k| numbers[k]);
        let meeting = ContactKinematics {
            normal: take_vector(take, "normal"),
            overlap: take("overlap"),
            thinner: take("thinner"),
            velocity: take_vector(take, "velocity"),
            viscosity: take("viscosity"),
            dt: take("dt"),
        };
        let (force, given) = contact_response(&self.0, &mut history, &meeting);
        history.each_number(|k, number| put(&format!("history_{k}"), number));
        put_vector(put, "force", force.force);
        put_vector(put, "friction", force.friction);
        let Dissipated { plastic, thinning, friction, damping } = given;
        let works = [("plastic", plastic), ("thinning", thinning), ("friction", friction), ("damping", damping)];
        works.into_iter().for_each(|(name, work)| put(&format!("{name}_work"), work));
    }
}
