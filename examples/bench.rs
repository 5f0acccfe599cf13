use std::time::Instant;
use strandsnap::{engine::Engine, scene, strand};

fn main() {
    let args: Vec<String> = std::env::args().skip(1).collect();
    let scene = scene::load(&args[0], &args[2..]).unwrap();
    let steps: u64 = args[1].parse().unwrap();
    let assembly = strand::build(&scene.spec).unwrap();
    println!("{} particles {} bonds", assembly.len(), assembly.bond_count());
    for l in &assembly.layers {
        println!("{l:?}");
    }
    let mut e = Engine::new(&scene.spec, assembly).unwrap();
    println!("{}", e.plan());
    println!("dt {:.3e} {}", e.time_step(), e.time_step_limit());
    let t = Instant::now();
    let mut last = (Instant::now(), 0);
    while e.steps() < steps {
        if let Err(x) = e.step() {
            println!("{x:?}");
            break;
        }
        for r in e.take_ruptures() {
            if r.first_of_wire {
                println!(
                    "  wire {} layer {} z {:.1} strain {:.2} stress {:.1} body {:.1}",
                    r.wire + 1,
                    r.layer,
                    r.position[2] * 1e3,
                    r.strain * 100.,
                    r.stress * 1e-6,
                    r.body_stress * 1e-6
                );
            }
        }
        if e.steps() % (steps / 40).max(1) == 0 {
            let s = e.sample();
            let en = s.energy;
            println!(
                "{:7} t {:.2e} e {:.3}% σ {:.2} F {:.1}/{:.1} layers {:?} cont {} dt {:.2e} KE/int {:.1e} res/W {:.2e} fr {:.1e} thin {:.1e} pc {:.1e} damp {:.1e} {:.3} ms/step {:?}",
                s.step,
                s.time,
                s.strain * 100.,
                s.stress * 1e-6,
                s.grip_force[0],
                s.grip_force[1],
                s.layer_stress.iter().map(|x| (x * 1e-6).round()).collect::<Vec<_>>(),
                s.contacts,
                s.time_step,
                en.kinetic / en.internal(),
                en.residual() / en.work,
                en.friction,
                en.plastic_thinning,
                en.plastic_contacts,
                en.damping,
                last.0.elapsed().as_secs_f64() * 1e3 / (e.steps() - last.1) as f64,
                e.contact_counts()
            );
            last = (Instant::now(), e.steps());
            if e.strain() > 0.2 && s.stress < 50e6 {
                break;
            }
        }
    }
    let ms = t.elapsed().as_secs_f64() * 1e3 / e.steps() as f64;
    println!("{ms:.4} ms/step {:?}", e.timings());
}
