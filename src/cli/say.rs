//! Printing that survives a reader who has gone, as in `strandsnap scene list | head -1`.

use crate::base::error::Error;
use std::fmt::Arguments;
use std::io::{ErrorKind, Write};

/// Prints to standard output. `println!` would panic when nobody reads any more; results are in files by then, so
/// there is nothing to save. Anything else that is refused, such as a full disk behind a redirection, ends the program:
/// half of a scene or of a table must not look whole.
pub fn print(text: Arguments) {
    let mut out = std::io::stdout();
    match out.write_fmt(text).and_then(|()| out.flush()) {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            let error = Error::io("cannot write", "standard output", cause);
            tell(format_args!("{error}"));
            std::process::exit(i32::from(error.exit_code()));
        }
        _ => {}
    }
}

/// Prints a line to standard error; one that is lost ends the program, as [`print`] does, where `eprintln!` would panic.
pub fn tell(text: Arguments) {
    match writeln!(std::io::stderr(), "{text}") {
        Err(cause) if cause.kind() != ErrorKind::BrokenPipe => {
            std::process::exit(i32::from(Error::io("cannot write", "standard error", cause).exit_code()));
        }
        _ => {}
    }
}

/// Like `println!`, but see [`print`].
macro_rules! say {
    ($($part:tt)*) => { $crate::cli::say::print(format_args!("{}\n", format_args!($($part)*))) };
}
pub(super) use say;
