//! Printing that survives a reader who has gone, as in `strandsnap scene list | head -1`.

use std::fmt::Arguments;
use std::io::Write;

/// Prints to standard output. `println!` would panic when nobody reads any more; results are in files by then, so
/// there is nothing to save.
pub fn print(text: Arguments) {
    let _ = std::io::stdout().write_fmt(text);
}

/// Like `println!`, but see [`print`].
macro_rules! say {
    ($($part:tt)*) => { $crate::cli::say::print(format_args!("{}\n", format_args!($($part)*))) };
}
pub(super) use say;
