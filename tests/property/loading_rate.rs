//! An adaptive pull finds what a slow one finds, in fewer steps.

use crate::drive::*;
use strandsnap::engine::Engine;

/// A pull through the plastic stage until wires break.
const PULL: [&str; 4] =
    ["strand.length=24 mm", "grip.speed=2 m/s", "bond.rupture.strain=12 %", "stop.stress_fraction=50 %"];
const ADAPTIVE: &str = "grip.adaptive={ fastest = '20 m/s' }";
/// Gauge length of the strand (m).
const GAUGE: f64 = 20e-3;

/// What a pull found.
struct Found {
    /// Greatest nominal stress up to the second rupture (Pa).
    strength: f64,
    /// Strain at the first rupture (-).
    first: f64,
    steps: u64,
    /// Greatest residual of the ledger over the work (-).
    residual: f64,
    /// Slowest and fastest (m/s).
    speeds: [f64; 2],
}

fn pull(set: &[&str], mut look: impl FnMut(&Engine)) -> Found {
    let mut engine = engine(STRAND, &[&PULL, set].concat());
    let mut found =
        Found { strength: 0.0, first: 0.0, steps: 0, residual: 0.0, speeds: [f64::INFINITY, f64::NEG_INFINITY] };
    while engine.sample().bonds_broken < 2 {
        run_steps(&mut engine, 8);
        look(&engine);
        let (energy, speed) = (engine.energy(), engine.grip_speed());
        found.strength = found.strength.max(engine.stress());
        found.residual = found.residual.max(energy.residual().abs() / energy.work);
        found.speeds = [found.speeds[0].min(speed), found.speeds[1].max(speed)];
        if let Some(first) = engine.take_ruptures().first().filter(|_| found.first == 0.0) {
            found.first = first.strain;
        }
    }
    found.steps = engine.steps();
    found
}

#[test]
fn an_adaptive_pull_finds_what_a_slow_one_finds_in_fewer_steps() {
    let slow = pull(&[], |_| {});
    let adaptive = pull(&[ADAPTIVE], |_| {});
    println!(
        "{} MPa at {}, {} steps; adaptive {} at {}, {}, {:?} m/s",
        slow.strength * 1e-6,
        slow.first,
        slow.steps,
        adaptive.strength * 1e-6,
        adaptive.first,
        adaptive.steps,
        adaptive.speeds
    );
    assert_eq!(slow.speeds, [2.0, 2.0]);
    assert!(adaptive.speeds[0] >= 2.0 && adaptive.speeds[1] > 10.0 && adaptive.speeds[1] <= 20.0);
    assert!((adaptive.strength / slow.strength - 1.0).abs() < 0.003, "{} {}", adaptive.strength, slow.strength);
    assert!((adaptive.first / slow.first - 1.0).abs() < 0.01, "{} {}", adaptive.first, slow.first);
    assert!(2 * adaptive.steps < slow.steps, "{} against {} steps", adaptive.steps, slow.steps);
}

/// The whole field is sped up, and what that takes is work of the grips: the ledger stays as closed as at constant speed.
/// No step changes the speed by more than its share of the least rise time, ten passages of a wave.
#[test]
fn the_ledger_stays_closed_and_the_acceleration_bounded() {
    let passage = GAUGE / (115e9f64 / 8960.0).sqrt();
    let most = 20.0 / (10.0 * passage) * (1.0 + 1e-6);
    let mut before = (0.0, 2.0);
    let mut changes = 0;
    let found = pull(&[ADAPTIVE], |engine| {
        let now = (engine.time(), engine.grip_speed());
        // A kick spans half of the step before as well.
        let span = now.0 - before.0 + engine.time_step();
        assert!((now.1 - before.1).abs() <= most * span, "{before:?} {now:?}");
        changes += usize::from(now.1 != before.1);
        before = now;
    });
    println!("residual {:e} of the work, {changes} changes of speed", found.residual);
    assert!(changes > 100, "{changes}");
    assert!(found.residual < 1e-3, "{}", found.residual);
}

/// From the first rupture on the pull slows down to its slow speed, and stays there.
#[test]
fn after_a_rupture_it_is_slow() {
    // Far from any rupture by its mean rate: the bond that breaks has been cut short by hand.
    let set = [&PULL[..], &[ADAPTIVE]].concat();
    let mut engine = edited(STRAND, &set, |a| {
        let slot = a.wires[3].first + 30;
        a.rest_length[slot] *= 0.93;
    });
    run_while(&mut engine, |e| e.sample().bonds_broken == 0);
    let then = engine.strain();
    run_while(&mut engine, |e| e.strain() < then + 0.02);
    assert_eq!(engine.grip_speed(), 2.0);
}

#[test]
fn threads_do_not_change_a_bit_of_an_adaptive_pull() {
    let run = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let set =
                [&PULL[..], &["strand.length=60 mm", "grip.adaptive={ fastest = '40 m/s', passages = 5 }"]].concat();
            let mut engine = engine(STRAND, &set);
            run_steps(&mut engine, 6000);
            assert!(engine.grip_speed() > 3.0, "{} m/s is hardly adaptive", engine.grip_speed());
            Outcome::of(&mut engine)
        })
    };
    let one = run(1);
    assert!(one.position.len() > 1024, "{} particles are too few chunks", one.position.len());
    run(3).assert_same(&one, "3 threads");
}

/// What `plan` foretells: the time of the pull, from the law of the bonds alone.
#[test]
fn the_time_of_an_adaptive_pull_is_foretold() {
    let mut engine = engine(STRAND, &[&PULL[..], &[ADAPTIVE]].concat());
    let foretold = engine.adaptive_time(0.1).expect("it is adaptive");
    run_while(&mut engine, |e| e.strain() < 0.1);
    println!("foretold {foretold:e} s, taken {:e} s", engine.time());
    assert!((engine.time() / foretold - 1.0).abs() < 0.1, "{} {foretold}", engine.time());
    assert_eq!(self::engine(STRAND, &PULL).adaptive_time(0.1), None);
}

/// The step of a contact follows its resolution, and with damped contacts the ledger stays closed at twice the usual one.
#[test]
fn a_contact_is_stepped_as_finely_as_asked() {
    let run = |resolution: &str| {
        let resolution = format!("time.contact_resolution={resolution}");
        let mut engine = engine(STRAND, &[&resolution]);
        let (mut worst, mut least) = (0.0f64, f64::INFINITY);
        while engine.time() < 2e-4 {
            run_steps(&mut engine, 50);
            let energy = engine.energy();
            worst = worst.max(energy.residual().abs() / energy.work);
            least = least.min(engine.time_step());
        }
        println!("{resolution}: residual {worst:e}, least step {least:e} s, {} steps", engine.steps());
        (worst, least)
    };
    let (fine, usual, coarse) = (run("0.1"), run("0.4"), run("0.8"));
    assert!(fine.1 < 0.6 * usual.1 && coarse.1 >= usual.1);
    assert!(fine.0 < 0.01 && usual.0 < 0.01 && coarse.0 < 0.01);
}
