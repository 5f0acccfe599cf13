//! The program: everything is in [`strandsnap::cli`].

fn main() -> std::process::ExitCode {
    strandsnap::cli::main()
}
