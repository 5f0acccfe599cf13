//! Properties that hold whatever the numbers: conservation, invariance, one result however it is computed.

#[path = "property/bits.rs"]
mod bits;
#[path = "property/broken_ends.rs"]
mod broken_ends;
#[path = "property/conservation.rs"]
mod conservation;
#[path = "common/drive.rs"]
mod drive;
#[path = "property/ledger.rs"]
mod ledger;
#[path = "property/loading_rate.rs"]
mod loading_rate;
#[path = "property/memory.rs"]
mod memory;
#[path = "property/random.rs"]
mod random;
#[path = "property/time.rs"]
mod time;
#[path = "property/wires.rs"]
mod wires;
