//! Where the time of frames goes.

use serde::{Deserialize, Serialize};
use std::fmt;
use std::time::Duration;

/// Accumulated wall time by stage. As JSON: means per frame in milliseconds, and totals in seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(into = "Report", from = "Report")]
pub struct Timings {
    /// Frames drawn.
    pub frames: u32,
    /// Frames that were left out because the run was stopped.
    pub not_drawn: u32,
    /// An animation that was asked for is not made, because the run was stopped.
    pub not_animated: bool,
    /// Preparing instances and drawing on the adapter.
    pub draw: Duration,
    /// Copying the picture back.
    pub read_back: Duration,
    /// Charts and text, on a thread of its own where frames are written.
    pub overlay: Duration,
    /// PNG encoding and writing, on a thread of its own.
    pub encode: Duration,
    /// How long the simulation waited because too many snapshots were not yet drawn.
    pub waited: Duration,
    /// Drawing what was still waiting when the simulation had ended.
    pub drained: Duration,
    /// Making the animation.
    pub animation: Duration,
    /// Size of the animation (bytes).
    pub animation_bytes: u64,
}

impl Timings {
    /// Adds what another thread counted.
    pub fn merge(&mut self, other: &Timings) {
        self.frames += other.frames;
        self.not_drawn += other.not_drawn;
        self.not_animated |= other.not_animated;
        self.draw += other.draw;
        self.read_back += other.read_back;
        self.overlay += other.overlay;
        self.encode += other.encode;
        self.waited += other.waited;
        self.drained += other.drained;
        self.animation += other.animation;
        self.animation_bytes += other.animation_bytes;
    }

    /// Whether something that was asked for is not there, because the run was stopped.
    pub fn unfinished(&self) -> bool {
        self.not_drawn > 0 || self.not_animated
    }

    /// The same means for so many frames: what an earlier process drew and could not tell took as long as the others.
    pub fn for_frames(self, frames: u32) -> Self {
        let factor = f64::from(frames) / f64::from(self.frames.max(1));
        let [draw, read_back, overlay, encode] =
            [self.draw, self.read_back, self.overlay, self.encode].map(|time| time.mul_f64(factor));
        Self { frames, draw, read_back, overlay, encode, ..self }
    }

    /// Mean per frame (ms): draw, read-back, overlay, encode.
    fn per_frame_ms(&self) -> [f64; 4] {
        let n = f64::from(self.frames.max(1));
        [self.draw, self.read_back, self.overlay, self.encode].map(|d| d.as_secs_f64() * 1e3 / n)
    }
}

impl fmt::Display for Timings {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [draw, back, overlay, encode] = self.per_frame_ms();
        let drawing = draw + back;
        write!(
            f,
            "{}, {drawing:.1} ms each (draw {draw:.1}, read-back {back:.1}), beside it charts and text {overlay:.1} ms, \
             PNG {encode:.1} ms",
            self.frames
        )
    }
}

/// [`Timings`] for people and programs that read `summary.json`.
#[derive(Serialize, Deserialize)]
struct Report {
    count: u32,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    not_drawn: Option<u32>,
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    not_animated: bool,
    draw_ms: f64,
    read_back_ms: f64,
    charts_and_text_ms: f64,
    png_ms: f64,
    simulation_waited_s: f64,
    drawn_after_the_simulation_s: f64,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    animation_s: Option<f64>,
    #[serde(default, skip_serializing_if = "Option::is_none")]
    animation_bytes: Option<u64>,
}

impl From<Timings> for Report {
    fn from(timings: Timings) -> Self {
        let [draw_ms, read_back_ms, charts_and_text_ms, png_ms] = timings.per_frame_ms();
        let animated = timings.animation_bytes > 0;
        Self {
            count: timings.frames,
            not_animated: timings.not_animated,
            not_drawn: (timings.not_drawn > 0).then_some(timings.not_drawn),
            draw_ms,
            read_back_ms,
            charts_and_text_ms,
            png_ms,
            simulation_waited_s: timings.waited.as_secs_f64(),
            drawn_after_the_simulation_s: timings.drained.as_secs_f64(),
            animation_s: animated.then_some(timings.animation.as_secs_f64()),
            animation_bytes: animated.then_some(timings.animation_bytes),
        }
    }
}

impl From<Report> for Timings {
    fn from(report: Report) -> Self {
        let total = |ms: f64| Duration::from_secs_f64(ms * 1e-3 * f64::from(report.count));
        Self {
            frames: report.count,
            not_drawn: report.not_drawn.unwrap_or(0),
            not_animated: report.not_animated,
            draw: total(report.draw_ms),
            read_back: total(report.read_back_ms),
            overlay: total(report.charts_and_text_ms),
            encode: total(report.png_ms),
            waited: Duration::from_secs_f64(report.simulation_waited_s),
            drained: Duration::from_secs_f64(report.drawn_after_the_simulation_s),
            animation: Duration::from_secs_f64(report.animation_s.unwrap_or(0.0)),
            animation_bytes: report.animation_bytes.unwrap_or(0),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn json_has_milliseconds_per_frame() {
        let ms = Duration::from_millis;
        let timings = Timings { frames: 4, draw: ms(100), read_back: ms(8), encode: ms(40), ..Default::default() };
        let json = serde_json::to_value(timings).unwrap();
        assert_eq!((&json["count"], &json["draw_ms"], &json["png_ms"]), (&4.into(), &25.0.into(), &10.0.into()));
        assert_eq!((&json["read_back_ms"], json.get("animation_s")), (&2.0.into(), None));
        assert_eq!(serde_json::from_value::<Timings>(json).unwrap(), timings);
        assert_eq!(timings.for_frames(8).draw, ms(200));
        assert!(timings.to_string().starts_with("4, 27.0 ms each (draw 25.0,"), "{timings}");
    }
}
