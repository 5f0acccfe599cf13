//! Floor 1: closed forms to verify against, and published results. Nothing here simulates.
//!
//! | module | what it answers |
//! | --- | --- |
//! | [`beam`] | cantilever, torsion bar, free vibration, Euler buckling, wave speed |
//! | [`elastica`] | large deflection of a cantilever |
//! | [`mod@column`] | a column beyond its buckling load |
//! | [`spring`] | stiffness of an open-coiled helical spring |
//! | [`capstan`] | a wire that slides round another |
//! | [`helix`] | lay angle, arc length, curvature and torsion of a helical wire |
//! | [`hertz`] | duration and depth of an elastic collision of two spheres |
//! | [`thornton`] | yield velocity and restitution of an elastoplastic collision |
//! | [`mindlin`] | tangential force at constant normal force |
//! | [`oblique`] | rebound of elastic spheres that meet obliquely, with friction |
//! | [`sliding`] | a sphere that slides until it rolls |
//! | [`strand`] | stiffness and strength of a strand from its geometry |
//! | [`plasticity`] | section limits of a round wire, its engineering curve, Considère's strain |
//! | [`stability`] | exact critical step of uniform chains |
//! | [`elliptic`] | elliptic integrals for the others |
//! | [`published`] | published tests and simulations of strands |

pub mod beam;
pub mod capstan;
pub mod column;
pub mod elastica;
pub mod elliptic;
pub mod helix;
pub mod hertz;
pub mod mindlin;
pub mod oblique;
pub mod plasticity;
pub mod published;
pub mod sliding;
pub mod spring;
pub mod stability;
pub mod strand;
pub mod thornton;
