//! Capsules: wires are smooth.

use crate::drive::*;
use glam::DVec3;
use strandsnap::engine::Engine;

/// Two parallel wires, pressed together by their overlap of 2 µm; all of both is held, the upper one slides along.
const RAILS: &str = r#"
about = "One straight wire is dragged along another."
[bond]
law = "elastic"
[contact]
normal = "hertz"
tangential = "none"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "8 mm"]
[[wire]]
diameter = "0.4 mm"
from = ["0.398 mm", "0 mm", "2 mm"]
to = ["0.398 mm", "0 mm", "6 mm"]
[[hold]]
body = 0
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 1
fix = ["x", "y", "z", "rx", "ry", "rz"]
velocity = ["0 m/s", "0 m/s", "2 m/s"]
[stop]
time = "1 ms"
[time]
step = "1e-7 s"
"#;

/// Contact force on a wire (N) away from its ends: those are round, and what slides over them is pushed along.
fn force_on(engine: &Engine, wire: usize) -> DVec3 {
    let particles = engine.assembly().wires[wire].particles();
    (particles.start + 2..particles.end - 2).map(|p| engine.state().force_from_contacts(p)).sum()
}

/// Forces on the sliding wire over two particle spacings.
fn slide(shape: &str) -> Vec<DVec3> {
    let mut engine = engine(RAILS, &[&format!("contact.shape={shape}")]);
    (0..400)
        .map(|_| {
            run_steps(&mut engine, 10);
            force_on(&engine, 1)
        })
        .collect()
}

#[test]
fn a_smooth_wire_slides_freely_and_a_chain_of_spheres_does_not() {
    let smooth = slide("wire");
    let press = smooth[0].x;
    assert!(press > 0.0);
    for f in &smooth {
        // Straight and parallel: no axial force, and the same pressure wherever the particles are.
        assert!(f.z.abs() < 1e-9 * press, "{f}");
        assert!((f.x / press - 1.0).abs() < 1e-6, "{f} {press}");
    }
    let rough = slide("sphere");
    let axial = rough.iter().map(|f| f.z.abs()).fold(0.0, f64::max);
    let (most, least) = rough.iter().fold((0.0f64, f64::MAX), |(a, b), f| (a.max(f.x), b.min(f.x)));
    println!("smooth wires press {press}; spheres: axial {axial}, press {least} to {most}");
    assert!(axial > 0.02 * most, "spheres interlock: {axial} of {most}");
    assert!(least == 0.0, "over the saddles spheres do not touch at 2 µm");
}

/// A sphere is led over a bent wire, over the borders of its segments. The overlap, and so the size of the force, goes
/// on smoothly; on the outside of the bend its direction does too, on the inside that turns by the angle between two
/// segments where the nearer one changes.
#[test]
fn the_force_is_continuous_over_the_borders_of_segments() {
    const BENT: &str = r#"
about = "A sphere is led along a wire."
[bond]
law = "elastic"
[contact]
normal = "hertz"
tangential = "none"
shape = "wire"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "4 mm"]
[[sphere]]
diameter = "1 mm"
position = ["0.69 mm", "0 mm", "0.5 mm"]
velocity = ["0 m/s", "0 m/s", "1 m/s"]
[[hold]]
body = 0
fix = ["x", "y", "z", "rx", "ry", "rz"]
[[hold]]
body = 1
fix = ["x", "y", "z", "rx", "ry", "rz"]
velocity = ["0 m/s", "0 m/s", "1 m/s"]
[stop]
time = "4 ms"
[time]
step = "2e-7 s"
"#;
    // x = ∓50 z², so that segments of 0.4 mm turn by 0.04 rad.
    let kink = 100.0 * 0.4e-3;
    for outside in [true, false] {
        let mut engine = edited(BENT, &[], |a| {
            for p in 0..a.wire_particles {
                let z = a.position.get(p).z - 2e-3;
                a.position.x[p] -= if outside { 50.0 } else { -50.0 } * z * z;
            }
        });
        let sphere = engine.assembly().len() - 1;
        let (mut size, mut turn, mut most) = (0.0f64, 0.0f64, 0.0f64);
        let mut last = engine.state().force_from_contacts(sphere);
        for _ in 0..14_000 {
            engine.step().unwrap();
            let f = engine.state().force_from_contacts(sphere);
            size = size.max((f.length() - last.length()).abs());
            if f.length() > 0.0 && last.length() > 0.0 {
                turn = turn.max(f.angle_between(last));
            }
            most = most.max(f.length());
            last = f;
        }
        println!("outside {outside}: size jumps by {:e}, direction by {turn:e}", size / most);
        assert!(most > 1.0);
        // The sphere moves by 1/2000 of a segment a step.
        assert!(size < 5e-3 * most, "{size} of {most}");
        assert!(if outside { turn < 1e-3 } else { turn < 1.1 * kink }, "{turn}");
    }
}

/// A free sphere on a straight wire is Hertz with R* = √(R_a R_b), the geometric mean of the two principal relative
/// radii: R_a = R along the wire, R_b = (1/R + 1/r)⁻¹ across.
#[test]
fn a_sphere_on_a_wire_is_hertz_with_the_mean_radius() {
    const LYING: &str = r#"
about = "A sphere is pressed into a wire."
[bond]
law = "elastic"
[contact]
normal = "hertz"
tangential = "none"
shape = "wire"
[[wire]]
diameter = "0.4 mm"
from = ["0 mm", "0 mm", "0 mm"]
to = ["0 mm", "0 mm", "4 mm"]
[[sphere]]
diameter = "1 mm"
position = ["0.698 mm", "0 mm", "2.1 mm"]
[stop]
time = "1 ms"
"#;
    let engine = engine(LYING, &[]);
    let material = spec(LYING, &[]).material;
    let modulus = material.young / (2.0 * (1.0 - material.poisson * material.poisson));
    let (large, small) = (0.5e-3, 0.2e-3);
    let across: f64 = large * small / (large + small);
    let expected = 4.0 / 3.0 * modulus * (large * across).sqrt().sqrt() * 2e-6f64.powf(1.5);
    let sphere = engine.assembly().len() - 1;
    let force = engine.state().force_from_contacts(sphere);
    assert!((force.x / expected - 1.0).abs() < 1e-9, "{force} {expected}");
    assert_eq!((force.y, force.z), (0.0, 0.0));
    // A quarter of the way from the particle at 2.0 mm to that at 2.4 mm: the weights of the parabolas through
    // the particles, passing over with 3t² − 2t³.
    let shares: Vec<f64> = (0..sphere).map(|p| -engine.state().force_from_contacts(p).x / expected).collect();
    for (share, weight) in
        shares[4..8].iter().zip([-0.079_101_562_5, 0.893_554_687_5, 0.200_195_312_5, -0.014_648_437_5])
    {
        assert!((share - weight).abs() < 1e-9, "{shares:?}");
    }
}

/// Three layers like KA4's, with smooth wires, past the first ruptures.
#[test]
fn a_strand_of_three_layers_keeps_its_ledger() {
    let set = [
        "contact.shape=wire",
        "strand.layer.0.wires=5",
        "strand.layer.0.pitch=39 mm",
        "strand.layer.1.name=middle",
        "strand.layer.1.wires=11",
        "strand.layer.1.pitch=39 mm",
        "bond.rupture.strain=4 %",
    ];
    let text = format!("{STRAND}\n[[strand.layer]]\nname = \"outer\"\nwires = 18\npitch = \"39 mm\"\n");
    let mut engine = engine(&text, &set);
    assert_eq!(engine.assembly().wires.len(), 34);
    let mut worst = 0.0f64;
    for _ in 0..30 {
        run_steps(&mut engine, 100);
        let e = engine.energy();
        worst = worst.max(e.residual().abs() / e.work);
    }
    let sample = engine.sample();
    println!("{worst:e}, {} bonds broken, {} contacts", sample.bonds_broken, sample.contacts);
    assert!(sample.wires_broken > 10 && sample.energy.friction > 0.0);
    assert!(worst < 0.01, "{worst}");
}
