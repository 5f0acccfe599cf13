//! Where the time of a frame goes.

use std::fmt;
use std::time::Duration;

/// Accumulated wall time by stage.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Timings {
    /// Frames drawn.
    pub frames: u32,
    /// Preparing instances and drawing on the adapter.
    pub draw: Duration,
    /// Copying the picture back.
    pub read_back: Duration,
    /// Charts and text.
    pub overlay: Duration,
    /// PNG encoding and writing.
    pub encode: Duration,
}

impl Timings {
    /// Adds what another thread counted.
    pub fn merge(&mut self, other: &Timings) {
        self.frames += other.frames;
        self.draw += other.draw;
        self.read_back += other.read_back;
        self.overlay += other.overlay;
        self.encode += other.encode;
    }

    /// Mean per frame [ms]: draw, read-back, overlay, encode.
    pub fn per_frame_ms(&self) -> [f64; 4] {
        let n = f64::from(self.frames.max(1));
        [self.draw, self.read_back, self.overlay, self.encode].map(|d| d.as_secs_f64() * 1e3 / n)
    }
}

impl fmt::Display for Timings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [draw, back, overlay, encode] = self.per_frame_ms();
        let total = draw + back + overlay + encode;
        write!(
            f,
            "{} frames, {total:.0} ms each (draw {draw:.1}, read-back {back:.1}, charts and text {overlay:.1}, PNG {encode:.1})",
            self.frames
        )
    }
}
