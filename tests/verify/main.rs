//! The engine against closed forms (physics page, section 8): every case is a scene in `assets/scenes/verify` and a
//! formula of `strandsnap::reference`.

mod beams;
mod conservation;
mod contacts;
mod plasticity;
mod stability;
mod strands;
mod support;
mod vibration;
