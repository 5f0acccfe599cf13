//! The manual: pages without code. [`physics`] states every equation and parameter of the model with its source,
//! [`import`] how wires come from CAD models, [`architecture`] how the crate is built and where a new thing goes, [`glossary`]
//! what the words mean, [`python`] the package for Python.

#[doc = include_str!("manual/physics.md")]
pub mod physics {}

#[doc = include_str!("manual/import.md")]
pub mod import {}

#[doc = include_str!("manual/architecture.md")]
pub mod architecture {}

#[doc = include_str!("manual/glossary.md")]
pub mod glossary {}

#[doc = include_str!("manual/python.md")]
pub mod python {}
