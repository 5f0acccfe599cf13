//! What this machine can compute and draw with, and what is used for what.

use crate::base::lanes::register_width;
use serde::Serialize;
use std::num::NonZero;

/// The processor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Processor {
    /// Its model, where the system tells.
    pub model: Option<String>,
    /// Its architecture.
    pub architecture: &'static str,
    /// Threads that it runs at once.
    pub threads: usize,
    /// Width of the registers that are used (bits).
    pub register_bits: usize,
}

/// What is used for what.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Use {
    /// Steps of a run.
    pub simulation: &'static str,
    /// The adapter that draws frames; `None` where none can.
    pub frames: Option<String>,
}

/// What this machine can compute and draw with.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Devices {
    /// The processor.
    pub processor: Processor,
    /// Its graphics adapters.
    #[cfg(feature = "gpu")]
    pub adapters: Vec<crate::gpu::Adapter>,
    /// What is used for what.
    #[serde(rename = "used_for")]
    pub used: Use,
}

impl Devices {
    /// Looks at this machine.
    pub fn find() -> Self {
        Self {
            processor: Processor::find(),
            #[cfg(feature = "gpu")]
            adapters: crate::gpu::adapters(),
            used: Use {
                simulation: "processor",
                #[cfg(feature = "render")]
                frames: crate::render::adapter::name().ok(),
                #[cfg(not(feature = "render"))]
                frames: None,
            },
        }
    }
}

impl Processor {
    fn find() -> Self {
        // Only Linux tells without a library of its own.
        let about = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
        Self {
            model: model(&about),
            architecture: std::env::consts::ARCH,
            threads: std::thread::available_parallelism().map_or(1, NonZero::get),
            register_bits: register_width() * 8 * size_of::<f64>(),
        }
    }
}

fn model(about: &str) -> Option<String> {
    let mut pairs = about.lines().filter_map(|line| line.split_once(':'));
    pairs.find(|(name, _)| name.trim() == "model name").map(|(_, model)| model.trim().to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_model_is_read_where_the_system_tells() {
        let about = "processor\t: 0\nvendor_id\t: GenuineIntel\nmodel name\t: Intel(R) Xeon(R) CPU @ 2.20GHz\n";
        assert_eq!(model(about).as_deref(), Some("Intel(R) Xeon(R) CPU @ 2.20GHz"));
        assert_eq!(model("CPU part\t: 0xd0c\n"), None);
    }

    #[test]
    fn the_processor_has_threads_and_registers() {
        let own = Processor::find();
        assert!(own.threads > 0 && [64, 128, 256, 512].contains(&own.register_bits), "{own:?}");
    }
}
