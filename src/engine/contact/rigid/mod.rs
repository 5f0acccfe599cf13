//! Rigid bodies: planes, cylinders and spheres in contact with wires and spheres, by the laws by which these touch each
//! other.
//!
//! A particle that is a ball (a free sphere, one of a chain of spheres, what two breaks have left alone) meets the surface at
//! one point, with the reduced radius of [`reduced_radius`](crate::strand::surface::Surface::reduced_radius). Of a smooth wire each particle's stretch meets it with
//! its cells, each a spring at a fixed place of the wire ([`respond_cells`](crate::law::contact::line::respond_cells)): about
//! the middle of a block of cells the gap is expanded to the second order, d(u) = d₀ + n·p' u + ½ (n·p'' + p'·H p') u² with
//! the gradient n and the second derivative H of the distance. Blocks are so short that a patch 1 % of the wire's radius deep
//! has ten cells, so that forces do not depend on the spacing. Friction and damping act at the centre of the push.
//!
//! Bodies go as they are told: where one is follows from the time in closed form. What they do to particles is the work of a
//! drive: mean of the force before and after a step times the way in it, which is what leapfrog's ledger needs. Forces are
//! added when all others are gathered, in the order of particles, so that bits do not depend on the number of threads, and a
//! run without rigid bodies is what it was.

mod bodies;
mod body;
mod build;
mod stage;
mod touch;

pub use build::build;
pub use stage::{Outcome, RigidBodies};
