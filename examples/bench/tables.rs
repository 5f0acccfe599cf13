//! The rows as tables for people.

use crate::measure::Row;

/// Everything about the rows.
pub fn print(rows: &[Row]) {
    times(rows);
    roofline(rows);
    neighbours(rows);
    memory(rows);
}

fn times(rows: &[Row]) {
    println!(
        "Time per step [ms], best of the repeats; time per particle-step over that of the first length. Processor: of"
    );
    println!("all threads, and per particle-step over that of the first; it says more where others use the machine");
    print!("length threads particles contacts  ms/step  M p-steps/s  relative  processor  relative");
    rows.first().into_iter().flat_map(|r| r.stages.named()).for_each(|(name, _)| print!("  {name:>10}"));
    println!();
    for r in rows {
        print!(
            "{:>5}× {:>7} {:>9} {:>8.0} {:>8.3}  {:>11.1}  {:>7.2}×  {:>9.3}  {:>7.2}×",
            r.length_factor,
            r.threads,
            r.particles,
            r.contacts,
            r.ms_per_step,
            r.particle_steps_per_s * 1e-6,
            relative(rows, r, |r| r.ms_per_step),
            r.cpu_ms_per_step.unwrap_or(f64::NAN),
            relative(rows, r, |r| r.cpu_ms_per_step.unwrap_or(f64::NAN)),
        );
        r.stages.named().iter().for_each(|(_, ms)| print!("  {ms:>10.4}"));
        println!();
    }
    for r in rows {
        println!(
            "{:>5}× {:>7} a step's parallel loops take {:.1} µs to start and to end",
            r.length_factor,
            r.threads,
            r.empty_loops_ms * 1e3
        );
    }
}

/// A time per particle-step over that of the first length on as many threads (-).
fn relative(rows: &[Row], row: &Row, ms: impl Fn(&Row) -> f64) -> f64 {
    let first = rows.iter().find(|r| r.threads == row.threads).unwrap_or(row);
    let each = |r: &Row| ms(r) / r.particles as f64;
    each(row) / each(first)
}

fn roofline(rows: &[Row]) {
    println!("\nDistance to what the machine can do, per step: bytes over its bandwidth on as much memory, operations");
    println!(
        "(laws of bonds and contacts counted by running them, the rest by hand; a fused one counts once) over its"
    );
    println!("throughput in the widest registers; ms without the time that other programs took");
    println!(
        "length threads stage            MB  M flop   M div  M sqrt       ms  limits: bandwidth  arithmetic   reached"
    );
    for r in rows {
        let limits = r.limits.named();
        for ((name, ms), (_, l)) in r.stages.named().into_iter().zip(limits).filter(|(_, (_, l))| l.bytes > 0) {
            let ms = ms * r.got();
            println!(
                "{:>5}× {:>7} {name:<10} {:>8.2} {:>7.2} {:>7.3} {:>7.3} {ms:>8.4} {:>18.4} {:>11.4} {:>7.0} %",
                r.length_factor,
                r.threads,
                l.bytes as f64 * 1e-6,
                l.simple * 1e-6,
                l.divisions * 1e-6,
                l.roots * 1e-6,
                l.bandwidth,
                l.arithmetic,
                1e2 * l.reached(ms),
            );
        }
    }
    for r in rows {
        println!("{:>5}× {:>7} {}", r.length_factor, r.threads, r.machine);
    }
}

fn neighbours(rows: &[Row]) {
    println!("\nNeighbour search: at most 3 % of the time and 1.6 candidates per closed contact are wanted");
    println!("length threads  per 1000 steps  % of time  candidates/contact");
    for r in rows {
        println!(
            "{:>5}× {:>7}  {:>14.1}  {:>9.2}  {:>18.2}",
            r.length_factor,
            r.threads,
            r.searches_per_1000_steps,
            1e2 * r.stages.neighbours / r.ms_per_step,
            r.candidates / r.contacts,
        );
    }
    println!("on the way there:   steps  searches  per % of strain  % of time  candidates/contact");
    for (r, p) in rows.iter().filter_map(|r| Some((r, r.pull?))) {
        println!(
            "{:>5}× {:>18}  {:>8}  {:>15.2}  {:>9.2}  {:>18.2}",
            r.length_factor,
            p.steps,
            p.searches,
            p.searches as f64 / (1e2 * p.strain),
            1e2 * p.search_share,
            p.candidates_per_contact,
        );
    }
}

fn memory(rows: &[Row]) {
    println!("\nMemory per particle [bytes]; a peak of at most 1000 is wanted (of a short strand the program is most)");
    let mut seen = Vec::new();
    for r in rows {
        if seen.contains(&r.particles) {
            continue;
        }
        seen.push(r.particles);
        let kept: usize = r.bytes_per_particle.iter().map(|(_, bytes)| bytes).sum();
        let by_stage: Vec<String> =
            r.bytes_per_particle.iter().map(|(name, bytes)| format!("{name} {bytes}")).collect();
        println!(
            "{:>5}× {:>9} particles: peak {:.0}, kept by the engine {kept}: {}",
            r.length_factor,
            r.particles,
            r.peak_bytes_per_particle.unwrap_or(f64::NAN),
            by_stage.join(", ")
        );
    }
}
