//! What recording and frames cost, per snapshot and as a share of a run.

use crate::Args;
use crate::measure::Row;
use strandsnap::base::error::Result;

/// Measures and prints; `rows` tell what the engine itself needs.
#[cfg(all(feature = "record", feature = "render"))]
pub fn print(args: &Args, rows: &[Row]) -> Result<()> {
    use crate::measure::load;
    use strandsnap::run::{assemble, estimate::estimate};
    use strandsnap::scene;

    let own = scene::load(&args.scene, &args.set)?;
    let steps = estimate(&own.spec, &own.plan, assemble(&own)?)?.steps;
    let cost = cost(&load(args, 1.0)?)?;
    let snapshots = own.spec.output.snapshots as f64;
    // A run of the scene as it is, on the most threads that were measured, in full contact all the way.
    let engine = rows.iter().filter(|r| r.length_factor == 1.0).max_by_key(|r| r.threads);
    let share = |ms: f64| match (steps, engine) {
        (Some(steps), Some(row)) => format!(
            "{:.2} % of a run's {steps:.0} steps at the scene's {snapshots} snapshots, {:.2} % if ruptures bring all \
             that they may",
            1e2 * ms * snapshots / (steps * row.ms_per_step),
            1e2 * ms * 5.0 * snapshots / (steps * row.ms_per_step)
        ),
        _ => "the scene tells no end, so there is no run to compare it with".into(),
    };
    println!("\nOutput, per snapshot; at most 10 % of a run is wanted");
    println!("recording  {:>7.2} ms, finishing the file included: {}", cost.record, share(cost.record));
    if let Some([draw, encode]) = cost.frame {
        println!("frame      {draw:>7.2} ms to draw and read back at 1280×720: {}", share(draw));
        println!("           {encode:>7.2} ms to encode, on a thread of its own: {}", share(encode));
    }
    Ok(())
}

/// Milliseconds per snapshot.
#[cfg(all(feature = "record", feature = "render"))]
struct Cost {
    record: f64,
    /// Drawing and encoding; none where no adapter is.
    frame: Option<[f64; 2]>,
}

#[cfg(all(feature = "record", feature = "render"))]
fn cost(scene: &strandsnap::scene::Scene) -> Result<Cost> {
    use std::sync::Arc;
    use std::time::Instant;
    use strandsnap::base::error::Error;
    use strandsnap::engine::Engine;
    use strandsnap::observe::Observer;
    use strandsnap::observe::recording::{Recording, RecordingOptions};
    use strandsnap::render::{History, Renderer, check, png};
    use strandsnap::run::assemble;
    use strandsnap::scene::spec::OutputSpec;

    const SHOWN: usize = 12;
    let mut engine = Engine::new(&scene.spec, &scene.plan, assemble(scene)?)?;
    let folder = tempfile::tempdir().map_err(|e| Error::io("cannot make", "a folder", e))?;
    let info = Arc::new(engine.info());
    let file = folder.path().join("bench.rrd");
    let options = RecordingOptions { live: None, scene: scene.spec.clone() };
    let mut recording = Recording::new(&file, options)?;
    let mut renderer = match check() {
        Ok(()) => Some(Renderer::new(&info, &OutputSpec::default())?),
        Err(error) => {
            println!("frames were not measured: {error}");
            None
        }
    };
    recording.start(&info)?;
    let mut history = History::default();
    let (mut record, mut draw, mut encode) = (0.0, 0.0, 0.0);
    for shown in 0..=SHOWN {
        (0..50).try_for_each(|_| engine.step())?;
        let clock = Instant::now();
        // Taking the snapshot is part of its price.
        let snapshot = Arc::new(engine.snapshot());
        recording.sample(&snapshot.sample)?;
        recording.snapshot(&snapshot)?;
        // The first frame sets pipelines up.
        let first = shown == 0;
        if !first {
            record += clock.elapsed().as_secs_f64();
        }
        if let Some(renderer) = &mut renderer {
            let clock = Instant::now();
            renderer.follow(&mut history, &snapshot);
            let image = renderer.draw(&snapshot, &history)?;
            let drawn = clock.elapsed().as_secs_f64();
            png::write(&folder.path().join("frame.png"), &image)?;
            if !first {
                draw += drawn;
                encode += clock.elapsed().as_secs_f64() - drawn;
            }
        }
    }
    let clock = Instant::now();
    recording.finish()?;
    record += clock.elapsed().as_secs_f64();
    let per = |seconds: f64| seconds * 1e3 / SHOWN as f64;
    Ok(Cost { record: per(record), frame: renderer.is_some().then(|| [per(draw), per(encode)]) })
}

/// Says that there is nothing to measure.
#[cfg(not(all(feature = "record", feature = "render")))]
pub fn print(_: &Args, _: &[Row]) -> Result<()> {
    println!("\nrecording and frames were not built in");
    Ok(())
}
