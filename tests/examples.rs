//! The examples run and say what they should: each fails by itself where the engine does not do what it shows.

#[path = "../examples/custom_law.rs"]
mod custom_law;
#[path = "../examples/observe.rs"]
mod observe;
#[path = "../examples/run_scene.rs"]
mod run_scene;

#[test]
fn a_scene_is_run() {
    run_scene::main().unwrap();
}

#[test]
fn a_law_of_ones_own_is_followed() {
    custom_law::main().unwrap();
}

#[test]
fn a_run_is_observed() {
    observe::main().unwrap();
}
