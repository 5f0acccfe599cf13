//! How a command ended.

/// How a command ended when nothing went wrong.
pub enum Ended {
    Well,
    /// Stopped by the user with results kept: the exit code is that of a program ended by Ctrl-C.
    Interrupted,
    /// A study or a check ran, and a case of it misses what it must give.
    Missed,
}
