//! `strandsnap devices`.

use super::say::say;
use crate::base::wording::counted;
use crate::run::devices::Devices;

#[derive(Debug, clap::Args)]
pub struct Args {
    /// As JSON
    #[arg(long)]
    json: bool,
}

pub fn devices(args: &Args) {
    let found = Devices::find();
    if args.json {
        say!("{}", serde_json::to_string_pretty(&found).expect("devices hold nothing that JSON lacks"));
        return;
    }
    let own = &found.processor;
    let model = own.model.as_deref().unwrap_or("a processor of which the system does not tell the model");
    let numbers = counted(own.register_bits / 64, "number");
    say!(
        "processor: {model} ({}), {}, registers of {} bits: {numbers} at a time\n",
        own.architecture,
        counted(own.threads, "thread"),
        own.register_bits
    );
    adapters(&found);
    let frames = match &found.used.frames {
        Some(adapter) => format!("frames: {adapter}"),
        None if cfg!(feature = "render") => "frames: none can be drawn, for want of a graphics adapter".to_owned(),
        None => "frames: none can be drawn, this program was built without them (feature `render`)".to_owned(),
    };
    say!("used for the simulation: {}, unless --device says otherwise; for {frames}", found.used.simulation);
}

#[cfg(not(feature = "gpu"))]
fn adapters(_: &Devices) {
    say!("graphics adapters: not looked for, this program was built without that (feature `gpu`)\n");
}

#[cfg(feature = "gpu")]
fn adapters(found: &Devices) {
    use crate::gpu::Adapter;
    use crate::study::column::{self, Column};

    let columns = [
        Column::new("name", "graphics adapter", "", 0, |a: &Adapter| a.name.clone()),
        Column::new("kind", "kind", "", 0, |a: &Adapter| a.kind),
        Column::new("backend", "backend", "", 0, |a: &Adapter| a.backend.clone()),
        Column::new("driver", "driver", "", 0, |a: &Adapter| a.driver.clone()),
        Column::new("f64", "64-bit numbers", "", 0, |a: &Adapter| a.f64),
        Column::new("largest_buffer", "largest buffer", "MiB", 0, |a: &Adapter| a.largest_buffer >> 20),
        Column::new("largest_binding", "largest binding", "MiB", 0, |a: &Adapter| a.largest_binding >> 20),
        Column::new("bindings", "bindings", "", 0, |a: &Adapter| u64::from(a.bindings)),
    ];
    if found.adapters.is_empty() {
        say!("graphics adapters: none\n");
    } else {
        say!("{}", column::table("Graphics adapters".into(), &columns, &found.adapters, 4).to_text());
    }
}
