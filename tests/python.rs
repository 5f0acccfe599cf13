//! The Python package, where one is: `STRANDSNAP_PYTHON` names an interpreter that has it, with numpy and distributed;
//! without it these tests say that they were skipped. What is tested stands in the scripts of `tests/python/`.

#[path = "common/drive.rs"]
#[allow(unused_imports, reason = "only the scene of the strand is needed")]
mod drive;

use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// An interpreter that has the package; `None`, said aloud, when there is none.
fn interpreter(test: &str) -> Option<PathBuf> {
    let python = std::env::var_os("STRANDSNAP_PYTHON").filter(|python| !python.is_empty());
    if python.is_none() {
        let why = "STRANDSNAP_PYTHON does not name a Python with the package strandsnap, numpy and distributed";
        let _ = writeln!(std::io::stderr(), "SKIPPED ({why}): {test}");
    }
    python.map(PathBuf::from)
}

/// Runs a script in a folder of its own that holds `strand.toml`; it is told where the program and the repository are. It ends
/// with 3 where all is well but nothing can be drawn.
fn script(test: &str, name: &str) {
    let Some(python) = interpreter(test) else { return };
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("strand.toml"), drive::STRAND).unwrap();
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut command = Command::new(python);
    command.arg(root.join("tests/python").join(name)).arg(env!("CARGO_BIN_EXE_strandsnap")).arg(root);
    let output = command.current_dir(folder.path()).output().expect("Python starts");
    let [said, told] = [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    if output.status.code() == Some(3) {
        let _ = writeln!(std::io::stderr(), "SKIPPED ({}): {test}, all but the picture", said.trim());
        return;
    }
    assert!(output.status.success(), "{said}{told}");
    println!("{said}");
}

#[test]
fn results_are_those_of_the_command_line() {
    script("results_are_those_of_the_command_line", "results.py");
}

#[test]
fn errors_have_the_text_of_the_command_line() {
    script("errors_have_the_text_of_the_command_line", "errors.py");
}

#[test]
fn what_is_stopped_is_kept_and_goes_on_to_the_same_bits() {
    script("what_is_stopped_is_kept_and_goes_on_to_the_same_bits", "stopped.py");
}

#[test]
fn studies_give_the_tables_of_the_command_line() {
    script("studies_give_the_tables_of_the_command_line", "study.py");
}

#[test]
fn a_study_goes_on_when_a_worker_of_dask_is_killed() {
    script("a_study_goes_on_when_a_worker_of_dask_is_killed", "workers.py");
}

#[test]
fn the_package_brings_the_program_and_its_types() {
    script("the_package_brings_the_program_and_its_types", "package.py");
}

#[test]
fn the_notebook_runs() {
    script("the_notebook_runs", "notebook.py");
}

#[test]
fn pictures_are_arrays_that_show_themselves() {
    script("pictures_are_arrays_that_show_themselves", "frames.py");
}
