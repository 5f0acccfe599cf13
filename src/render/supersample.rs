//! Several pixels of a finer picture to one of a coarser.

use super::colour::{encoded, linear};

/// sRGB steps within which light is as good as linear: the mean of bytes is off by less than a tenth of a step.
const ALIKE: u8 = 4;

/// The mean of squares of `times` × `times` pixels: `rows` are `times` rows of RGBA bytes (sRGB), the result is row `y` of the
/// picture. Light is averaged, not bytes, so that thin bright things keep their light.
pub(super) fn average(rows: &[&[u8]], times: usize, y: u32, mean: &mut [u8]) {
    let count = (times * times) as f32;
    for (x, to) in mean.chunks_exact_mut(4).enumerate() {
        let from = x * times * 4..(x + 1) * times * 4;
        let threshold = threshold(x as u32, y);
        for channel in 0..3 {
            let samples = || rows.iter().flat_map(|row| row[from.clone()][channel..].iter().step_by(4).copied());
            let (low, high) = samples().fold((u8::MAX, 0), |(low, high), byte| (low.min(byte), high.max(byte)));
            to[channel] = if low == high {
                low
            } else if high - low <= ALIKE {
                (samples().map(f32::from).sum::<f32>() / count + threshold) as u8
            } else {
                let light = samples().map(linear).sum::<f32>() / count;
                (255.0 * encoded(light) + threshold) as u8
            };
        }
        to[3] = u8::MAX;
    }
}

/// What is added before a value is cut to a byte (0 to 1): a fixed pattern of pixels that hides the bands of slow gradients, which
/// the averaging would bring back. The pattern is interleaved gradient noise (J. Jimenez, SIGGRAPH 2014), as in the shader.
fn threshold(x: u32, y: u32) -> f32 {
    (52.982_918 * (0.067_110_56 * x as f32 + 0.005_837_15 * y as f32).fract()).fract()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The mean of one square whose pixels are grey.
    fn mean(pixels: &[u8], times: usize, y: u32) -> u8 {
        let rows: Vec<Vec<u8>> =
            pixels.chunks(times).map(|row| row.iter().flat_map(|v| [*v, *v, *v, 255]).collect()).collect();
        let rows: Vec<&[u8]> = rows.iter().map(Vec::as_slice).collect();
        let mut out = [0; 4];
        average(&rows, times, y, &mut out);
        assert!(out[0] == out[1] && out[1] == out[2] && out[3] == 255, "{out:?}");
        out[0]
    }

    #[test]
    fn light_is_averaged_not_bytes() {
        // Half of the light of white is sRGB 187.5 (IEC 61966-2-1: 1.055 · 0.5^(1/2.4) − 0.055).
        for y in 0..50 {
            let half = mean(&[0, 255, 255, 0], 2, y);
            assert!(half == 187 || half == 188, "{half}");
        }
    }

    #[test]
    fn what_is_alike_stays_as_it_is() {
        for byte in 0..=255 {
            assert_eq!(mean(&[byte; 9], 3, 7), byte);
        }
    }

    #[test]
    fn means_between_two_bytes_are_kept_on_average() {
        let mean = (0..1000).map(|y| f64::from(mean(&[100, 101, 101, 101], 2, y))).sum::<f64>() / 1000.0;
        assert!((mean - 100.75).abs() < 0.02, "{mean}");
    }
}
