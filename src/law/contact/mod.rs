//! Normal contact laws.
//!
//! | name | equation | source |
//! | --- | --- | --- |
