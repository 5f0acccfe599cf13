//! The program: everything is in [`strandsnap::cli`].

fn main() -> std::process::ExitCode {
    quiet_mesa();
    strandsnap::cli::main()
}

/// Mesa's Vulkan driver complains on stderr when there is no session folder, which no off-screen picture needs.
fn quiet_mesa() {
    if cfg!(all(unix, feature = "render")) && std::env::var_os("XDG_RUNTIME_DIR").is_none() {
        // SAFETY: nothing else runs yet that could read the environment.
        unsafe { std::env::set_var("XDG_RUNTIME_DIR", std::env::temp_dir()) };
    }
}
