//! Floor 1: the physics as stateless formula kernels. Nothing here knows of particles, lists or files.

pub mod bond;
pub mod contact;
pub mod damping;
pub mod tangential;
