//! What every study of many runs shares: the record that is kept of a run ([`record`]), what is kept of it
//! ([`measured`]), the workshop that makes the runs ([`workshop`]), and means over seeds ([`stat`]).

pub mod measured;
pub mod record;
pub mod stat;
pub mod workshop;
