//! The recording, read back.
#![cfg(feature = "record")]

#[path = "common/disk.rs"]
mod disk;
mod synthetic;

use disk::Disk;
use std::path::Path;
use std::time::Instant;
use strandsnap::base::error::Error;
use strandsnap::base::finding::{Finding, Instant as Moment, Notice};
use strandsnap::engine::view::Snapshot;
use strandsnap::observe::Observer;
use strandsnap::observe::recording::read::{RecordingContents, contents};
use strandsnap::observe::recording::{
    CONTACT_PRESSURE, PLASTIC_STRAIN, Recording, RecordingOptions, STATE, STRAIN, STRESS, TIME, UTILISATION,
};
use strandsnap::observe::tables::Tables;
use synthetic::Run;

fn options() -> RecordingOptions {
    RecordingOptions { live: None, scene: strandsnap::scene::load("ka4", &[]).unwrap().spec }
}

fn recorded(run: &Run, file: &Path) -> RecordingContents {
    run.show(&mut Recording::new(file, options()).unwrap()).unwrap();
    contents(file).unwrap()
}

fn folder() -> tempfile::TempDir {
    tempfile::tempdir().unwrap()
}

/// Wires that are looked at one by one: of each layer, first and last.
const WIRES: [&str; 4] =
    ["/strand/inner/wire_01", "/strand/middle/wire_06", "/strand/outer/wire_17", "/strand/outer/wire_34"];

#[test]
fn every_wire_has_its_particles_in_every_snapshot() {
    let (run, folder) = (Run::new(30), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    for wire in WIRES {
        let entity = &read.entities[wire];
        assert_eq!(entity.rows, 30, "{wire}");
        let points = ["Points3D:positions", "Points3D:colors"];
        for component in points.iter().chain(&[STRESS, PLASTIC_STRAIN, UTILISATION, CONTACT_PRESSURE]) {
            assert_eq!(entity.components[*component].rows, 30, "{component} of {wire}");
        }
        // The strand thins and turns evenly, and its wires yield before the first snapshot.
        for (component, rows) in
            [("Points3D:radii", 2..12), ("Tube:turn", 2..30), ("Tube:length", 2..30), (STATE, 1..2)]
        {
            let found = entity.components[component].rows;
            assert!(rows.contains(&found), "{found} rows of {component} of {wire}");
        }
        let timelines: Vec<_> = entity.timelines.iter().map(String::as_str).collect();
        assert_eq!(timelines, [STRAIN, "sim_time", "step"], "{wire}");
    }
    let wires = read.entities.keys().filter(|path| path.starts_with("/strand/") && path.matches('/').count() == 3);
    assert_eq!(wires.count(), 34);
    assert!(read.layout);
}

/// Places, colours and each field stand once for each particle and state, whatever draws them.
#[test]
fn nothing_is_recorded_twice() {
    let (run, folder) = (Run::new(40), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let states = run.snapshots().len();
    let each = run.info.particles * states;
    let components = || read.entities.values().flat_map(|entity| &entity.components);
    let sum = |of: &dyn Fn(&str, &str) -> bool| -> [usize; 2] {
        let these = components().filter(|(name, c)| of(name, c.kind.as_deref().unwrap_or_default()));
        these.fold([0; 2], |[values, bytes], (_, c)| [values + c.values, bytes + c.bytes])
    };
    for field in [STRESS, PLASTIC_STRAIN, UTILISATION, CONTACT_PRESSURE] {
        assert_eq!(sum(&|name, _| name == field), [each, 4 * each], "{field}");
    }
    // Besides particles: what the eye follows, marks, styles and bars, none of which grows with the number of particles.
    let few = |found: usize| found >= each && found <= each + 10 * states + 500;
    assert!(few(sum(&|_, kind| kind == "rerun.components.Position3D")[0]));
    assert!(few(sum(&|_, kind| kind == "rerun.components.Color")[0]));
    assert!(sum(&|_, kind| kind == "rerun.components.Position2D")[0] < run.info.particles + 500, "the map never moves");
    // Centres of the two grips alone.
    assert_eq!(sum(&|_, kind| kind == "rerun.components.Translation3D")[0], 2 * states);
    let turns = sum(&|name, _| name.starts_with("Tube:"))[1];
    assert!(turns < each * 12 / 2, "turns and lengths take {turns} bytes, as many as if they were always recorded");
    let all = sum(&|_, _| true)[1];
    assert!(all < each * (12 + 4 + 4 * 4 + 8), "{:.1} bytes a particle and state", all as f64 / each as f64);
}

#[test]
fn every_component_has_a_type() {
    let (run, folder) = (Run::new(5), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    for (path, entity) in &read.entities {
        for (name, component) in &entity.components {
            assert!(component.kind.as_ref().is_some_and(|kind| kind.contains(".components.")), "{name} of {path}");
        }
    }
    for wire in WIRES {
        let kind = |name: &str| read.entities[wire].components[name].kind.clone().unwrap();
        assert_eq!(kind(STRESS), "strandsnap.components.TrueAxialStress");
        assert_eq!(kind(PLASTIC_STRAIN), "strandsnap.components.EquivalentPlasticStrain");
        assert_eq!(kind(UTILISATION), "strandsnap.components.Utilisation");
        assert_eq!(kind(CONTACT_PRESSURE), "strandsnap.components.ContactPressure");
        assert_eq!(kind(STATE), "rerun.components.ClassId");
        assert_eq!(kind("Tube:turn"), "strandsnap.components.Turn");
        assert_eq!(kind("Map:place"), "rerun.components.Position2D");
    }
}

/// The layout names components by their names, which nothing else would check.
#[test]
fn views_draw_from_components_that_are_there() {
    let (run, folder) = (Run::new(5), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let sources = &read.last_layout.sources;
    for wire in WIRES {
        for source in
            ["Points3D:positions", "Points3D:colors", "Points3D:radii", "Tube:turn", "Tube:length", "Map:place"]
        {
            assert!(sources.contains(&(wire.to_owned(), source.to_owned())), "{source} of {wire} is not drawn");
        }
    }
    assert_eq!(sources.len(), 34 * 7, "{sources:?}");
    for (entity, component) in sources {
        assert!(read.entities[entity].components.contains_key(component), "{entity} has no {component}");
    }
}

/// Column `strain_percent` of the table, and the entity of strain.
#[test]
fn strain_is_that_of_the_table() {
    let (run, folder) = (Run::new(20), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    run.show(&mut Tables::new(folder.path())).unwrap();
    let table = std::fs::read_to_string(folder.path().join("curve.csv")).unwrap();
    let mut lines = table.lines().map(|line| line.split(',').collect::<Vec<_>>());
    let head = lines.next().unwrap();
    let column = head.iter().position(|name| *name == "strain_percent").unwrap();
    let told = &read.series["/strain"];
    assert_eq!(told.len(), 200);
    for (line, (step, values)) in lines.zip(told) {
        let strain: f64 = line[column].parse().unwrap();
        // The table has nine digits.
        assert!(
            line[0] == step.to_string() && (values[0] - strain).abs() <= 1e-8 * strain.max(1e-6),
            "{line:?}, {values:?}"
        );
    }
}

#[test]
fn last_fields_are_those_of_the_last_snapshot() {
    let (run, folder) = (Run::new(20), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let last = *run.snapshots().last().unwrap();
    for (number, wire) in run.info.wires.iter().enumerate() {
        let path = format!("/strand/{}/wire_{:02}", run.info.layers[wire.layer], number + 1);
        // The last particle has no bond after it and shows the one before.
        let of_bonds =
            |all: &[f32]| -> Vec<f32> { (0..wire.len).map(|k| all[wire.first + k.min(wire.len - 2)]).collect() };
        let fields = &read.last_fields[&path];
        let mpa = |all: &[f32]| -> Vec<f32> { all.iter().map(|s| (f64::from(*s) * 1e-6) as f32).collect() };
        assert_eq!(fields[STRESS], mpa(&of_bonds(&last.bond_stress)), "{path}");
        assert_eq!(fields[PLASTIC_STRAIN], of_bonds(&last.plastic_strain), "{path}");
        assert_eq!(fields[UTILISATION], of_bonds(&last.utilisation), "{path}");
        assert_eq!(fields[CONTACT_PRESSURE], mpa(&last.contact_pressure[wire.particles()]), "{path}");
    }
}

/// The middle of what the eye follows lies on the axis, where that section is now: of the five wires that broke between
/// 58.8 and 63.6 mm, and not of the first break. That one keeps its mark.
#[test]
fn the_eye_follows_the_main_fracture() {
    let (run, folder) = (Run::new(20), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let first = run.ruptures()[0].clone();
    let last: &Snapshot = run.snapshots().last().unwrap();
    let now = |rest_z: f64| (rest_z * (1.0 + last.sample.strain)) as f32;
    let rests = run.ruptures().iter().map(|r| r.rest_z * 1e3).filter(|z| *z < 65.0).collect::<Vec<_>>();
    let [low, high] =
        [f64::min as fn(f64, f64) -> f64, f64::max].map(|most| rests.iter().copied().reduce(most).unwrap());
    let fracture = 0.5 * (low + high);
    let specks = &read.last_positions["/focus"];
    let middle: Vec<f32> = (0..3).map(|axis| 0.5 * (specks[0][axis] + specks[1][axis])).collect();
    let off = middle[2] - now(fracture);
    assert!(middle[0].abs() < 0.1 && middle[1].abs() < 0.1 && off.abs() < 0.5, "{middle:?} for {}", now(fracture));
    assert_eq!(read.layouts, 2);
    let name = format!("Main fracture, z = {fracture:.0} mm");
    assert!(read.last_layout.views.contains(&name), "{name} is none of {:?}", read.last_layout.views);
    let mark = read.last_positions["/first_break"][0];
    assert!((mark[2] - now(first.rest_z * 1e3)).abs() < 1.0, "{mark:?} for {}", now(first.rest_z * 1e3));
}

#[test]
fn the_headline_says_what_broke_first_and_at_what_stress() {
    let (run, folder) = (Run::new(30), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let first = run.ruptures()[0];
    let words =
        ["# 1st break in this strand: wire 24, outer layer".to_owned(), format!("z = {:.1} mm", first.rest_z * 1e3)];
    let more = [format!("{:.2} %", first.strain * 1e2), format!("{:.1} MPa", first.body_stress * 1e-6)];
    for words in words.iter().chain(&more) {
        assert!(read.headline.contains(words), "{words} in {}", read.headline);
    }
    assert!(read.headline.contains("inner 1 of 5, middle 1 of 11, outer 4 of 18"), "{}", read.headline);
    assert!(read.headline.contains("One draw of the scatter (seed 1"), "{}", read.headline);
    assert!(read.headline.contains("24, 31, 19, 27, 13, 3 (6 of 34)"), "{}", read.headline);
}

#[test]
fn notices_are_warnings_in_the_log_and_in_the_headline() {
    let (run, folder) = (Run::new(5), folder());
    let file = folder.path().join("recording.rrd");
    let mut recording = Recording::new(&file, options()).unwrap();
    run.show_unfinished(&mut recording).unwrap();
    let at = Moment { step: 7, time: 1e-3, strain: Some(0.1) };
    let notice = Notice { at, finding: Finding::KineticEnergy { over_internal: 0.1, limit: 0.05 } };
    recording.notice(&notice).unwrap();
    let text = notice.to_string();
    recording.finish().unwrap();
    let read = contents(&file).unwrap();
    let at = read.log.iter().position(|line| *line == (100_000, text.clone())).unwrap();
    assert_eq!(read.levels[at], "WARN");
    assert!(read.levels.iter().enumerate().all(|(i, level)| i == at || level == "INFO"));
    assert!(read.headline.contains(&format!("**WARNING** {text}")), "{}", read.headline);
}

#[test]
fn last_positions_are_those_of_the_last_snapshot() {
    let (run, folder) = (Run::new(20), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let last = *run.snapshots().last().unwrap();
    for (number, wire) in run.info.wires.iter().enumerate() {
        let path = format!("/strand/{}/wire_{:02}", run.info.layers[wire.layer], number + 1);
        let mm: Vec<_> =
            last.position[wire.particles()].iter().map(|p| p.map(|x| (f64::from(x) * 1e3) as f32)).collect();
        assert_eq!(read.last_positions[&path], mm, "{path}");
    }
}

#[test]
fn every_rupture_is_marked_and_logged() {
    let (run, folder) = (Run::new(30), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let ruptures = run.ruptures();
    assert_eq!(ruptures.len(), 6);
    assert_eq!(read.log.len(), 6);
    assert_eq!(
        read.log[0],
        (
            234_000,
            "1. wire 24, outer layer, snapped at z = 76.9 mm, strain 23.4 %, 379 MPa; nominal 307 MPa".to_owned()
        )
    );
    for rupture in ruptures {
        let path = format!("/strand/{}/wire_{:02}/ruptures", run.info.layers[rupture.layer], rupture.wire + 1);
        let place = rupture.position.map(|x| (x * 1e3) as f32);
        assert_eq!(read.last_positions[&path], [place], "{path}");
        let lane = &read.entities[&format!("/states/{}/wire_{:02}", run.info.layers[rupture.layer], rupture.wire + 1)];
        assert_eq!(lane.rows, 2, "yielding from the first snapshot on, then broken");
    }
}

#[test]
fn the_curve_has_every_sample() {
    let (run, folder) = (Run::new(20), folder());
    let read = recorded(&run, &folder.path().join("recording.rrd"));
    let expected: Vec<_> = run.samples().iter().map(|s| ((s.strain * 1e6).round() as i64, s.stress * 1e-6)).collect();
    assert_eq!(read.nominal_stress, expected);
    for entity in
        ["/strain", "/stress/layers", "/stress/wires/outer", "/broken", "/energy", "/chart/body", "/chart/layers/outer"]
    {
        assert_eq!(read.entities[entity].rows, 200, "{entity}");
    }
}

#[test]
fn the_same_run_gives_the_same_contents() {
    let (run, folder) = (Run::new(20), folder());
    let first = recorded(&run, &folder.path().join("a.rrd"));
    assert_eq!(first, recorded(&run, &folder.path().join("b.rrd")));
    let mut other = options();
    other.scene.seed += 1;
    run.show(&mut Recording::new(&folder.path().join("c.rrd"), other).unwrap()).unwrap();
    assert_ne!(first.id, contents(&folder.path().join("c.rrd")).unwrap().id);
}

#[test]
fn a_file_that_is_not_finished_does_not_look_whole() {
    let (run, folder) = (Run::new(3), folder());
    let file = folder.path().join("recording.rrd");
    let mut recording = Recording::new(&file, options()).unwrap();
    run.show_unfinished(&mut recording).unwrap();
    assert!(!file.exists());
    assert!(folder.path().join("recording.rrd.partial").exists());
    recording.finish().unwrap();
    assert!(file.exists());
    assert!(!folder.path().join("recording.rrd.partial").exists());
    assert_eq!(contents(&file).unwrap().entities["/strand/inner/wire_01"].rows, 3, "a part of a batch is kept too");
}

#[test]
fn a_cut_file_is_refused() {
    let (run, folder) = (Run::new(3), folder());
    let file = folder.path().join("recording.rrd");
    recorded(&run, &file);
    let bytes = std::fs::read(&file).unwrap();
    std::fs::write(&file, &bytes[..bytes.len() / 2]).unwrap();
    assert!(matches!(contents(&file), Err(Error::Io { .. })), "a cut file was read");
}

#[test]
fn an_unwritable_place_is_an_error() {
    let error = Recording::new(Path::new("/nowhere/recording.rrd"), options()).err().unwrap();
    assert_eq!(error.exit_code(), 1);
    assert!(error.to_string().contains("/nowhere/recording.rrd.partial"), "{error}");
}

/// A disk too small for a recording.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_is_an_error() {
    let (run, folder) = (Run::new(20), folder());
    let Some(_disk) = Disk::mount(folder.path(), 16 * 1024, "a_full_disk_is_an_error") else { return };
    let file = folder.path().join("recording.rrd");
    let result = Recording::new(&file, options()).and_then(|mut recording| run.show(&mut recording));
    let Err(Error::Io { cause: source, .. }) = result else { panic!("{result:?}") };
    assert_eq!(source.kind(), std::io::ErrorKind::StorageFull);
    assert!(!file.exists());
}

#[test]
fn a_viewer_that_does_not_listen_is_said_before_the_run() {
    // Bound, then closed again: nobody listens there.
    let port = std::net::TcpListener::bind("127.0.0.1:0").unwrap().local_addr().unwrap().port();
    let folder = folder();
    let open = |live: String| {
        Recording::new(&folder.path().join("r.rrd"), RecordingOptions { live: Some(live), ..options() }).err().unwrap()
    };
    assert_eq!(open(format!("rerun+http://127.0.0.1:{port}/proxy")).exit_code(), 3);
    assert_eq!(open("localhost".into()).exit_code(), 2);
}

#[test]
fn a_run_plays_in_twenty_seconds() {
    let (run, folder) = (Run::new(30), folder());
    let layout = recorded(&run, &folder.path().join("recording.rrd")).last_layout;
    let most = run.samples().iter().map(|s| s.strain * 1e6).fold(0.0, f64::max);
    assert_eq!((layout.timeline.as_str(), layout.speed), (STRAIN, None));
    assert!((most / layout.per_second.unwrap() - 20.0).abs() < 1e-3, "{layout:?} up to {most}");
    let [from, to] = layout.selection.unwrap();
    for rupture in run.ruptures() {
        let at = rupture.strain * 1e6;
        assert!(from as f64 <= at && at <= to as f64, "{at} is not in {from} to {to}");
    }
    assert!(from > 0 && to as f64 <= most + 1.0, "{from} to {to}, and the run ends at {most}");
}

#[test]
fn a_run_without_strain_plays_over_time() {
    let (mut run, folder) = (Run::new(5), folder());
    std::sync::Arc::make_mut(&mut run.info).gauge = None;
    let layout = recorded(&run, &folder.path().join("recording.rrd")).last_layout;
    let end = run.samples().last().unwrap().time;
    assert_eq!((layout.timeline.as_str(), layout.per_second, layout.selection), (TIME, None, None));
    assert!((end / layout.speed.unwrap() - 20.0).abs() < 1e-6, "{layout:?} up to {end} s");
}

#[test]
fn views_have_names_of_their_own() {
    let (mut run, folder) = (Run::new(30), folder());
    // What broke first is below the outermost layer.
    run.events.retain(|event| !matches!(event, synthetic::Event::Rupture(rupture) if rupture.layer == 2));
    let views = recorded(&run, &folder.path().join("recording.rrd")).last_layout.views;
    let apart: std::collections::BTreeSet<_> = views.iter().collect();
    assert!(views.len() > 10 && apart.len() == views.len(), "{views:?}");
    assert!(views.iter().any(|name| name == "Particles without the outer layer"), "{views:?}");
}

/// Set STRANDSNAP_KEEP to a path to keep the file for the viewer.
#[test]
fn size_stays_within_bounds() {
    let (run, folder) = (Run::new(160), folder());
    let file = std::env::var_os("STRANDSNAP_KEEP").map_or(folder.path().join("recording.rrd"), Into::into);
    let start = Instant::now();
    let mut recording = Recording::new(&file, options()).unwrap();
    run.show_unfinished(&mut recording).unwrap();
    let in_run = start.elapsed();
    recording.finish().unwrap();
    let snapshots = run.snapshots().len();
    // Position, colour and four fields of a particle.
    let raw = run.info.particles * snapshots * (12 + 4 + 16);
    let size = std::fs::metadata(&file).unwrap().len() as usize;
    println!(
        "{} particles, {snapshots} snapshots: {size} bytes for {raw} raw ({:.2}), {:.2} ms a snapshot in the run, {:.2} with the end",
        run.info.particles,
        size as f64 / raw as f64,
        in_run.as_secs_f64() * 1e3 / snapshots as f64,
        start.elapsed().as_secs_f64() * 1e3 / snapshots as f64,
    );
    // With turns, lengths, radii and the heads of chunks, and compressed.
    assert!(size < raw + raw / 10);
}
