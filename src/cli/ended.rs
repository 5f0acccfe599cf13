//! How a command ended.

/// How a command ended when nothing went wrong.
pub enum Ended {
    Well,
    /// A study or a check ran, and a case of it misses what it must give.
    Missed,
}
