//! `strandsnap scene keys` and `scene new`.

use super::*;

#[test]
fn the_keys_of_a_scene_are_listed() {
    let folder = tempfile::tempdir().unwrap();
    let all = strandsnap(folder.path(), &["scene", "keys"]);
    assert_code(&all, 0);
    for word in
        ["strand.layer[].pitch: number or text with a unit, or inf; such as mm", "hertz: Elastic.", "default 2.8"]
    {
        assert!(stdout(&all).contains(word), "{word}\n{}", stdout(&all));
    }
    let some: serde_json::Value =
        serde_json::from_str(&stdout(&strandsnap(folder.path(), &["scene", "keys", "grip.ad", "--json"]))).unwrap();
    let keys: Vec<&str> = some.as_array().unwrap().iter().map(|key| key["key"].as_str().unwrap()).collect();
    let passages = "grip.adaptive.passages";
    assert_eq!(
        keys,
        ["grip.adaptive", "grip.adaptive.fastest", "grip.adaptive.from", "grip.adaptive.kinetic", passages]
    );
    // Elements as --set counts them, any case, and conditional requirements.
    let pitch = stdout(&strandsnap(folder.path(), &["scene", "keys", "Strand.Layer.0.pitch"]));
    for word in ["strand.layer[].pitch: number or text with a unit, or inf; such as mm", "--set strand.layer.0.pitch="]
    {
        assert!(pitch.contains(word), "{word}\n{pitch}");
    }
    let speed = stdout(&strandsnap(folder.path(), &["scene", "keys", "grip.speed"]));
    assert!(speed.contains("required when there are no displacement_amplitude and frequency"), "{speed}");
    let none = strandsnap(folder.path(), &["scene", "keys", "frction"]);
    assert_code(&none, 2);
    assert!(plain(&stderr(&none)).contains("did you mean `friction`?"), "{}", stderr(&none));
}

#[test]
fn a_scene_of_ones_own_begins_as_a_copy() {
    let folder = tempfile::tempdir().unwrap();
    let new = ["scene", "new", "mine", "--from", "strand-1x7"];
    assert_code(&strandsnap(folder.path(), &new), 0);
    let original = stdout(&strandsnap(folder.path(), &["scene", "show", "strand-1x7"]));
    assert_eq!(fs::read_to_string(folder.path().join("mine.toml")).unwrap(), original);
    assert_code(&strandsnap(folder.path(), &["scene", "check", "mine.toml"]), 0);
    fs::write(folder.path().join("mine.toml"), "mine").unwrap();
    assert_code(&strandsnap(folder.path(), &new), 2);
    assert_eq!(fs::read_to_string(folder.path().join("mine.toml")).unwrap(), "mine", "nothing is replaced");
    assert_code(&strandsnap(folder.path(), &["scene", "new", "no/such/folder/mine"]), 1);
    assert_code(&strandsnap(folder.path(), &["scene", "new", "other", "--from", "ka5"]), 2);
    assert!(!folder.path().join("other.toml").exists());
    for name in [" ", "a b", ".hidden", "my;strand", ".toml", "--x"] {
        let refused = strandsnap(folder.path(), &["scene", "new", "--from", "ka4", "--", name]);
        assert_code(&refused, 2);
        assert!(plain(&stderr(&refused)).contains("is no name for a scene"), "{name}: {}", stderr(&refused));
    }
    fs::create_dir(folder.path().join("my strands")).unwrap();
    let made = strandsnap(folder.path(), &["scene", "new", "my strands/one"]);
    assert!(stdout(&made).contains("check it: strandsnap scene check 'my strands/one.toml'"), "{}", stdout(&made));
    let from_file = strandsnap(folder.path(), &["scene", "new", "two", "--from", "mine.toml"]);
    assert_code(&from_file, 2);
    assert!(plain(&stderr(&from_file)).contains("mine.toml is a file"), "{}", stderr(&from_file));
    let without = strandsnap(folder.path(), &["scene", "check", "mine"]);
    assert_code(&without, 2);
    assert!(plain(&stderr(&without)).contains("did you mean the file mine.toml?"), "{}", stderr(&without));
}

#[cfg(unix)]
#[test]
fn a_name_that_is_no_text_is_refused_with_the_name() {
    use std::os::unix::ffi::OsStrExt as _;
    let folder = tempfile::tempdir().unwrap();
    let name = std::ffi::OsStr::from_bytes(b"strand-\xff.toml");
    std::fs::write(folder.path().join(name), "").unwrap();
    for command in [&["run"][..], &["scene", "check"], &["study"]] {
        let program = env!("CARGO_BIN_EXE_strandsnap");
        let mut asked = std::process::Command::new(program);
        let output = asked.args(command).arg(name).current_dir(folder.path()).output().expect("the program starts");
        assert_code(&output, 2);
        let said = plain(&stderr(&output));
        assert!(said.contains(r#""strand-\xFF.toml" is not UTF-8"#), "{said}");
    }
}
