//! Rigid bodies: forces against closed forms, whatever the spacing and wherever a wire is touched; the energy ledger; bits.

#[path = "common/drive.rs"]
mod drive;

use drive::*;
use glam::DVec3;
use strandsnap::base::error::Error;
use strandsnap::engine::Engine;
use strandsnap::engine::view::BodyState;
use strandsnap::reference::hertz::{Pair, elliptical_factor};

/// Copper on copper: E* = E/(2(1 − ν²)) (Pa).
const MODULUS: f64 = 115e9 / (2.0 * (1.0 - 0.34 * 0.34));

const CONTACT: &str = r#"
about = "A test of rigid bodies."
[material]
density = "8960 kg/m^3"
young = "115 GPa"
poisson = 0.34
[contact]
normal = "hertz"
tangential = "none"
shape = "wire"
"#;

/// A held wire along z, of 0.4 mm, that a body comes 4 µm into in 500 steps.
fn held_wire(body: &str, spacing: f64) -> Engine {
    let text = format!(
        r#"{CONTACT}
        [[wire]]
        diameter = "0.4 mm"
        from = ["0 mm", "0 mm", "-4 mm"]
        to = ["0 mm", "0 mm", "4 mm"]
        [[hold]]
        body = 0
        fix = ["x", "y", "z", "rx", "ry", "rz"]
        [time]
        step = "10 ns"
        [stop]
        time = "6 us"
        [[body]]
        velocity = ["0 m/s", "1 m/s", "0 m/s"]
        travel = "5 um"
        {body}"#
    );
    let mut engine = engine(&text, &[&format!("spacing={spacing}")]);
    run_to(&mut engine, 5.5e-6);
    engine
}

fn body(engine: &Engine, number: usize) -> BodyState {
    engine.view().rigid.expect("there are bodies").bodies()[number]
}

fn near(value: f64, expected: f64, tolerance: f64) {
    assert!((value / expected - 1.0).abs() <= tolerance, "{value} is not {expected}, but {} of it", value / expected);
}

/// Hertz's force at overlap `overlap` (m) for principal relative radii (m), the greater first.
fn hertz(radii: [f64; 2], overlap: f64) -> f64 {
    let pair = Pair { modulus: MODULUS, radius: (radii[0] * radii[1]).sqrt(), mass: 1.0 };
    pair.force(overlap) * elliptical_factor(radii[0] / radii[1])
}

/// Force of a pin across a wire is Hertz's for the ellipse of a cylinder on a cylinder, for any spacing of particles and
/// any place between them.
#[test]
fn a_pin_across_a_wire_presses_as_hertz_says_whatever_the_spacing_and_the_place() {
    for pin in [1.0e-3, 0.2e-3] {
        let exact = hertz([pin, 0.2e-3], 4e-6);
        for spacing in [1.0, 0.5, 0.25] {
            for place in [0.0, 0.013, 0.1, 0.187] {
                let text = format!(
                    r#"shape = "cylinder"
                    axis = [1, 0, 0]
                    diameter = "{} mm"
                    position = ["0 mm", "{} mm", "{place} mm"]"#,
                    2e3 * pin,
                    -1e3 * (pin + 0.2e-3) - 1e-3
                );
                let found = body(&held_wire(&text, spacing), 0);
                near(-found.force[1], exact, 0.01);
                // Cells do not lie evenly to both sides of the narrowest place.
                assert!(found.force[0] == 0.0 && found.force[2].abs() < 1e-3 * exact, "{found:?}");
                near(found.position[1], -pin - 0.2e-3 + 4e-6, 1e-12);
            }
        }
    }
}

/// A sphere of R on a straight wire of r: relative radii R and Rr/(R + r).
#[test]
fn a_sphere_on_a_wire_presses_as_hertz_says() {
    for (sphere, tolerance) in [(1.0e-3, 0.015), (0.2e-3, 0.06)] {
        let exact = hertz([sphere, sphere * 0.2e-3 / (sphere + 0.2e-3)], 4e-6);
        let text = format!(
            r#"shape = "sphere"
            diameter = "{} mm"
            position = ["0 mm", "{} mm", "0.07 mm"]"#,
            2e3 * sphere,
            -1e3 * (sphere + 0.2e-3) - 1e-3
        );
        for spacing in [1.0, 0.3] {
            let found = body(&held_wire(&text, spacing), 0);
            near(-found.force[1], exact, tolerance);
        }
    }
}

/// Along its whole length: the line's k = 0.3 E* times overlap and length.
#[test]
fn a_wire_on_a_plane_is_pressed_along_its_whole_length() {
    let text = r#"shape = "plane"
        normal = [0, 2, 0]
        position = ["7 mm", "-0.201 mm", "-3 mm"]"#;
    let exact = 0.3 * MODULUS * 4e-6 * 8e-3;
    for spacing in [1.0, 0.5] {
        let found = body(&held_wire(text, spacing), 0);
        near(-found.force[1], exact, 1e-9);
        // About the place of the plane, 7 mm beside the wire and 3 mm from its middle: r × F with r = (−7, ., 3) mm.
        near(found.moment[2], 7e-3 * exact, 1e-9);
        near(found.moment[0], 3e-3 * exact, 1e-9);
    }
}

/// A ball pressed on a pin: the geometric mean of the relative radii, less than 0.1 % off where the pin is five times as thick.
#[test]
fn a_ball_on_a_pin_is_pressed_as_hertz_says() {
    let text = format!(
        r#"{CONTACT}
        [[sphere]]
        diameter = "1 mm"
        position = ["0 mm", "0 mm", "0 mm"]
        [[hold]]
        body = 0
        fix = ["x", "y", "z"]
        [time]
        step = "10 ns"
        [stop]
        time = "6 us"
        [[body]]
        shape = "cylinder"
        axis = [1, 0, 0]
        diameter = "5 mm"
        position = ["0 mm", "-3.001 mm", "0 mm"]
        velocity = ["0 m/s", "1 m/s", "0 m/s"]
        travel = "5 um""#
    );
    let mut engine = engine(&text, &[]);
    run_to(&mut engine, 5.5e-6);
    // Along the pin 1/R = 1/r, across it 1/r + 1/R.
    near(-body(&engine, 0).force[1], hertz([0.5e-3, 0.5e-3 * 2.5e-3 / 3e-3], 4e-6), 1e-3);
}

/// A wire on two pins, pressed by a roller that comes down, spins and goes sideways: plastic contacts, friction, damping.
fn rolled(more: &str, set: &[&str]) -> Engine {
    let text = format!(
        r#"
        about = "A wire on two pins under a roller."
        [bond]
        damping = 0.01
        [contact]
        normal = "thornton"
        tangential = "mindlin"
        limiting_pressure = "400 MPa"
        shape = "wire"
        damping = 0.05
        [[wire]]
        diameter = "0.4 mm"
        from = ["-6 mm", "0 mm", "0.013 mm"]
        to = ["6 mm", "0 mm", "0.013 mm"]
        [[body]]
        shape = "cylinder"
        axis = [0, 0, 1]
        diameter = "1 mm"
        position = ["-4 mm", "-0.7 mm", "0 mm"]
        [[body]]
        shape = "sphere"
        diameter = "1.2 mm"
        position = ["4 mm", "-0.8 mm", "0.1 mm"]
        [[body]]
        shape = "cylinder"
        axis = [0, 0, -1]
        diameter = "2 mm"
        length = "3 mm"
        position = ["0 mm", "1.201 mm", "0 mm"]
        velocity = ["1 m/s", "-3 m/s", "0.1 m/s"]
        spin = "1500 rad/s"
        ramp = "20 us"
        duration = "120 us"
        [stop]
        time = "200 us"
        {more}"#
    );
    engine(&text, set)
}

#[test]
fn the_ledger_closes_under_a_roller_that_presses_slides_and_spins() {
    for (shape, law) in [("wire", "mindlin"), ("sphere", "mindlin"), ("wire", "mindlin-deresiewicz"), ("wire", "none")]
    {
        let mut engine = rolled("", &[&format!("contact.shape={shape}"), &format!("contact.tangential={law}")]);
        let mut worst: f64 = 0.0;
        run_while(&mut engine, |engine| {
            let energy = engine.energy();
            worst = worst.max(energy.residual().abs());
            engine.time() < 200e-6
        });
        let energy = engine.energy();
        assert!(energy.work > 1e-4 && energy.elastic_bonds > 1e-6 && energy.plastic_contacts > 1e-7, "{energy:?}");
        assert_eq!(energy.friction > 1e-6, law != "none", "{energy:?}");
        assert!(worst < 1e-3 * energy.work, "{worst} {energy:?}");
    }
}

/// All forces on bodies are those on the wire: momentum is what they leave in it.
#[test]
fn the_momentum_of_a_free_wire_is_the_impulse_of_the_bodies() {
    let mut engine = rolled("", &[]);
    let total = |engine: &Engine| {
        let bodies = engine.view().rigid.unwrap().bodies();
        let force: DVec3 = bodies.iter().map(|b| DVec3::from(b.force)).sum();
        let about = |b: &BodyState| DVec3::from(b.moment) + DVec3::from(b.position).cross(b.force.into());
        (force, bodies.iter().map(about).sum::<DVec3>())
    };
    for _ in 0..4000 {
        // A kick takes the force before it over half of both steps.
        let (force, moment) = total(&engine);
        let before = momentum(engine.state());
        let spin = angular_momentum(engine.state());
        engine.step().unwrap();
        let kicked = momentum(engine.state()) - before;
        let turned = angular_momentum(engine.state()) - spin;
        if force.length() > 1e-3 {
            let time = -kicked.dot(force) / force.length_squared();
            assert!((kicked + force * time).length() < 1e-9 * kicked.length().max(1e-12), "{kicked} {force}");
            // Where forces act is where surfaces meet to the second order in the overlap.
            assert!(
                (turned + moment * time).length() < 0.02 * (moment.length() * time).max(1e-15),
                "{turned} {moment}"
            );
        }
    }
}

#[test]
fn the_same_bits_come_on_any_number_of_threads_and_after_a_restart() {
    // More than one chunk of particles.
    let wires: String = (0..4)
        .map(|k| {
            format!(
                "[[wire]]\ndiameter = \"0.4 mm\"\nfrom = [\"-30 mm\", \"0 mm\", \"{} mm\"]\nto = [\"30 mm\", \"0 mm\", \"{} mm\"]\n",
                1.0 + 0.5 * f64::from(k),
                1.0 + 0.5 * f64::from(k)
            )
        })
        .collect();
    let run = |threads: usize, restart: bool| {
        let mut one = rolled(&wires, &[]);
        one.set_threads(threads).unwrap();
        run_steps(&mut one, 900);
        if restart {
            let saved = one.save();
            one = rolled(&wires, &[]);
            one.restore(&saved).unwrap_or_else(|error| panic!("{error}"));
        }
        run_steps(&mut one, 900);
        (body(&one, 2), Outcome::of(&mut one))
    };
    let (load, outcome) = run(1, false);
    assert!(load.force[1] > 1.0, "{load:?}");
    for (threads, restart) in [(2, false), (3, false), (1, true), (2, true)] {
        let (other, again) = run(threads, restart);
        assert_eq!(load, other);
        outcome.assert_same(&again, &format!("{threads} threads, restart: {restart}"));
    }
}

#[test]
fn a_body_that_goes_through_a_wire_stops_the_run() {
    let text = format!(
        r#"{CONTACT}
        [[wire]]
        diameter = "0.4 mm"
        from = ["0 mm", "0 mm", "-2 mm"]
        to = ["0 mm", "0 mm", "2 mm"]
        [[hold]]
        body = 0
        fix = ["x", "y", "z", "rx", "ry", "rz"]
        [stop]
        time = "1 ms"
        [[body]]
        name = "knife"
        shape = "cylinder"
        axis = [1, 0, 0]
        diameter = "0.2 mm"
        position = ["0 mm", "-0.4 mm", "0 mm"]
        velocity = ["0 m/s", "1 m/s", "0 m/s"]"#
    );
    let mut engine = engine(&text, &[]);
    let error = loop {
        match engine.step() {
            Ok(()) => assert!(engine.time() < 1e-3, "it went through"),
            Err(error) => break error,
        }
    };
    assert!(matches!(error, Error::Simulation(_)));
    let words = error.to_string();
    assert!(words.contains("into rigid body \"knife\""), "{words}");
    assert!(engine.time() > 0.25e-3 && engine.time() < 0.31e-3, "{}", engine.time());
    assert!(engine.take_notices().iter().any(|notice| notice.to_string().contains("knife")));
}

/// An elastic sphere that a plane strikes at V leaves it at 2V, and has its energy from the plane.
#[test]
fn a_plane_that_strikes_a_sphere_gives_it_twice_its_speed() {
    let text = format!(
        r#"{CONTACT}
        [[sphere]]
        diameter = "2 mm"
        position = ["0 mm", "1 mm", "0 mm"]
        [time]
        step = "20 ns"
        [stop]
        time = "30 us"
        [[body]]
        shape = "plane"
        normal = [0, 5, 0]
        position = ["3 mm", "-0.002 mm", "1 mm"]
        velocity = ["0.4 m/s", "1 m/s", "0 m/s"]"#
    );
    let mut engine = engine(&text, &[]);
    run_to(&mut engine, 30e-6);
    let (mass, energy) = (engine.state().mass[0], engine.energy());
    near(engine.state().v.y[0], 2.0, 1e-6);
    assert_eq!(engine.state().v.x[0], 0.0, "nothing rubs");
    near(energy.work, 0.5 * mass * 4.0, 1e-5);
    near(energy.kinetic, energy.work, 1e-5);
}

/// What turns does work by friction: a sphere between two planes, of which one turns under it.
#[test]
fn a_table_that_turns_takes_a_sphere_along() {
    let text = format!(
        r#"{CONTACT}
        [[sphere]]
        diameter = "2 mm"
        position = ["10 mm", "0.9999 mm", "0 mm"]
        [[hold]]
        body = 0
        fix = ["y"]
        [stop]
        time = "2 ms"
        [[body]]
        shape = "plane"
        normal = [0, 1, 0]
        position = ["0 mm", "0 mm", "0 mm"]
        spin = "100 rad/s"
        ramp = "0.5 ms""#
    );
    let set = ["contact.tangential=mindlin", "contact.friction=0.3", "contact.damping=0.05"];
    let mut engine = engine(&text, &set);
    run_to(&mut engine, 2e-3);
    let (state, energy) = (engine.state(), engine.energy());
    // It rolls: its lowest point moves as the table, at ω × r = −z at x = 10 mm, and it has got 2/7 of that speed itself.
    let low = state.v.get(0) + state.w.get(0).cross(DVec3::NEG_Y * (1e-3 - 0.5e-7));
    near(-low.z, 1.0, 0.02);
    near(-state.v.z[0], 2.0 / 7.0, 0.02);
    assert!(energy.residual().abs() < 1e-3 * energy.work, "{energy:?}");
}

#[test]
fn a_body_that_reaches_into_a_wire_is_refused() {
    let text = format!(
        r#"{CONTACT}
        [[wire]]
        diameter = "0.4 mm"
        from = ["0 mm", "0 mm", "-2 mm"]
        to = ["0 mm", "0 mm", "2 mm"]
        [stop]
        time = "1 ms"
        [[body]]
        name = "far"
        shape = "plane"
        normal = [0, 1, 0]
        position = ["0 mm", "-0.2 mm", "0 mm"]
        [[body]]
        name = "knife"
        shape = "cylinder"
        axis = [1, 0, 0]
        diameter = "0.2 mm"
        position = ["0 mm", "0.25 mm", "0.31 mm"]"#
    );
    let error = strandsnap::strand::build(&spec(&text, &[])).expect_err("it overlaps");
    assert_eq!(error.key, "body.1");
    assert!(error.message.contains("\"knife\" reaches into wire 1 (layer \"wire\") by 0.05 mm, 12 %"), "{error}");
    strandsnap::strand::build(&spec(&text, &[r#"body.1.position=["0 mm", "0.27 mm", "0.31 mm"]"#])).unwrap();
}

/// Contacts may be switched off for one run: bodies then do nothing, which is told.
#[test]
fn without_contacts_there_are_no_bodies() {
    let scene = strandsnap::scene::load("bounce", &["contact.normal=none".into(), "contact.limiting_pressure=".into()]);
    let scene = scene.unwrap_or_else(|error| panic!("{error:?}"));
    assert!(scene.spec.rigids.is_empty() && !scene.plan.rigid);
    let resolved = strandsnap::scene::write::to_toml(&scene.spec);
    assert_eq!(spec(&resolved, &[]).spheres, scene.spec.spheres);
    let told = strandsnap::scene::load("bounce", &["contact.tangential=none".into(), "body.0.friction=0.2".into()]);
    assert!(told.unwrap_err().to_string().contains("leaves friction out"));
}
