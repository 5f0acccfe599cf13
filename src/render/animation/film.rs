//! A film: H.264 in MP4, which slides, phones and browsers play. Smaller than a GIF of the same pictures and with all
//! colours, but with those of four pixels in one, as such players want it (4:2:0).

use super::pictures::{Pictures, Refuse};
use crate::base::error;
use image::{RgbImage, imageops};
use openh264::OpenH264API;
use openh264::encoder::{
    BitRate, Complexity, Encoder, EncoderConfig, FrameType, Profile, QpRange, RateControlMode, UsageType, VuiConfig,
};
use openh264::formats::{RgbSliceU8, YUVBuffer};
use shiguredo_mp4::TrackKind;
use shiguredo_mp4::bitstream::h264::{
    H264SampleEntryConfig, LengthSize, annexb_to_length_prefixed, build_avc1_box_from_annexb,
};
use shiguredo_mp4::boxes::SampleEntry;
use shiguredo_mp4::mux::{Mp4FileMuxer, Mp4FileMuxerOptions, Sample, estimate_maximum_moov_box_size};
use std::fmt::Display;
use std::io::{Error as IoError, Result, Seek, SeekFrom, Write};
use std::num::NonZeroU32;

/// Quantiser of every picture (0 is best, 51 worst): lines and small print stay sharp, at a third of what 14 takes.
const QUANTISER: u8 = 20;
/// Units of time in a second.
const MILLISECONDS: NonZeroU32 = NonZeroU32::new(1000).unwrap();
/// Bits per second that are never reached, so that the quantiser alone decides.
const NO_BOUND: u32 = 50_000_000;
/// Longer and shorter side of a picture that the encoder takes at most (px); larger ones are made smaller.
const LARGEST: [f64; 2] = [3840.0, 2160.0];
/// Shortest side that it takes (px); smaller pictures are made larger.
const LEAST: f64 = 16.0;

/// A film that is being written.
pub struct Film<W: Write + Seek> {
    out: W,
    encoder: Encoder,
    film: Mp4FileMuxer,
    data_offset: u64,
    begun: bool,
}

impl<W: Write + Seek> Film<W> {
    /// Begins a film of so many pictures: what a player needs to know stands at the beginning of the file.
    ///
    /// # Errors
    /// When it cannot be encoded or written.
    pub fn begin(mut out: W, pictures: usize) -> Result<Self> {
        let encoder = Encoder::with_api_config(OpenH264API::from_source(), settings()).map_err(other)?;
        let reserved_moov_box_size = estimate_maximum_moov_box_size(&[pictures]);
        let options = Mp4FileMuxerOptions { reserved_moov_box_size, ..Default::default() };
        let film = Mp4FileMuxer::with_options(options).map_err(other)?;
        let begin = film.initial_boxes_bytes();
        out.write_all(begin)?;
        let data_offset = begin.len() as u64;
        Ok(Self { out, encoder, film, data_offset, begun: false })
    }

    /// Adds a picture that is shown for so long (ms).
    ///
    /// # Errors
    /// When it cannot be encoded or written.
    pub fn add(&mut self, picture: RgbImage, duration: u32) -> Result<()> {
        let length_size = LengthSize::FourBytes;
        let picture = encodable(picture);
        let size = (picture.width() as usize, picture.height() as usize);
        let yuv = YUVBuffer::from_rgb_source(RgbSliceU8::new(picture.as_raw(), size));
        let encoded = self.encoder.encode(&yuv).map_err(other)?;
        let keyframe = matches!(encoded.frame_type(), FrameType::IDR);
        let stream = encoded.to_vec();
        let sample_entry = (!self.begun).then(|| {
            build_avc1_box_from_annexb(&stream, &H264SampleEntryConfig { length_size }).map(SampleEntry::Avc1)
        });
        let data = annexb_to_length_prefixed(&stream, length_size).map_err(other)?;
        self.out.write_all(&data)?;
        let sample = Sample {
            track_kind: TrackKind::Video,
            sample_entry: sample_entry.transpose().map_err(other)?,
            keyframe,
            timescale: MILLISECONDS,
            duration,
            composition_time_offset: None,
            data_offset: self.data_offset,
            data_size: data.len(),
        };
        self.film.append_sample(&sample).map_err(other)?;
        self.data_offset += data.len() as u64;
        self.begun = true;
        Ok(())
    }

    /// Its size so far (bytes).
    #[cfg(feature = "explore")]
    pub(crate) fn bytes(&self) -> u64 {
        self.data_offset
    }

    /// Writes what a player needs to know of all pictures.
    ///
    /// # Errors
    /// When it cannot be written.
    pub fn end(mut self) -> Result<W> {
        for (at, bytes) in self.film.finalize().map_err(other)?.offset_and_bytes_pairs() {
            self.out.seek(SeekFrom::Start(at)).and_then(|_| self.out.write_all(bytes))?;
        }
        self.out.seek(SeekFrom::End(0))?;
        Ok(self.out)
    }
}

fn other(error: impl Display) -> IoError {
    IoError::other(error.to_string())
}

/// Writes every picture once, with the time for which it is shown.
pub(super) fn write(pictures: &Pictures, out: &mut (impl Write + Seek), refuse: &Refuse) -> error::Result<()> {
    let mut film = Film::begin(out, pictures.len()).map_err(refuse)?;
    for next in pictures.iter() {
        let (picture, duration) = next?;
        film.add(picture, duration).map_err(refuse)?;
    }
    film.end().map(|_| ()).map_err(refuse)
}

/// The same bits on every machine: one thread, and nothing that is left to the rate of the bits.
fn settings() -> EncoderConfig {
    EncoderConfig::new()
        .usage_type(UsageType::ScreenContentRealTime)
        .profile(Profile::High)
        .complexity(Complexity::Medium)
        .rate_control_mode(RateControlMode::Bufferbased)
        .bitrate(BitRate::from_bps(NO_BOUND))
        .qp(QpRange::new(QUANTISER, QUANTISER))
        .skip_frames(false)
        .adaptive_quantization(false)
        .background_detection(false)
        .num_threads(1)
        // What the conversion from RGB gives.
        .vui(VuiConfig::bt601())
}

/// A picture with an even width and height, as 4:2:0 needs it, within what the encoder takes.
fn encodable(picture: RgbImage) -> RgbImage {
    let [width, height] = [picture.width(), picture.height()].map(f64::from);
    let [longer, shorter] = [width.max(height), width.min(height)];
    let factor = (LEAST / shorter).max(1.0).min(LARGEST[0] / longer).min(LARGEST[1] / shorter);
    let even = |side: f64| ((side * factor).round() as u32 & !1).max(LEAST as u32);
    let [w, h] = [even(width), even(height)];
    match (factor != 1.0, [w, h] == [picture.width(), picture.height()]) {
        (true, _) => imageops::resize(&picture, w, h, imageops::FilterType::Triangle),
        (false, true) => picture,
        (false, false) => imageops::crop_imm(&picture, 0, 0, w, h).to_image(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sides_are_even_and_no_picture_is_too_large() {
        for (size, right) in [
            ([96, 54], [96, 54]),
            ([97, 55], [96, 54]),
            ([8192, 4608], [3840, 2160]),
            ([2000, 4000], [1920, 3840]),
            ([24, 15], [26, 16]),
            ([8192, 120], [3840, 56]),
        ] {
            let film = encodable(RgbImage::new(size[0], size[1]));
            assert_eq!([film.width(), film.height()], right);
        }
    }
}
