//! What a file of any format gives.

use super::fault::Unread;
use super::shape::Piece;

/// What a file of any format gives.
#[derive(Debug, Clone, Default)]
pub struct Contents {
    /// What kind of file it is, for people: "STEP (AUTOMOTIVE_DESIGN)".
    pub format: String,
    /// Lines, in metres.
    pub pieces: Vec<Piece>,
    /// What is not used.
    pub unread: Vec<Unread>,
    /// Lengths that the file counts in (m), each once.
    pub units: Vec<f64>,
}
