//! Animated PNG: all colours, two to five times the size of a GIF.

use super::pictures::{Pictures, Refuse, changed, cut};
use crate::base::error::Result;
use image::RgbImage;
use png::{BitDepth, BlendOp, ColorType, Compression, DisposeOp, Encoder, EncodingError};
use std::io::Write;

/// Writes every picture, the first whole and of the others the part that changed.
pub(super) fn write(pictures: &Pictures, out: &mut impl Write, refuse: &Refuse) -> Result<()> {
    let refuse = |e: EncodingError| refuse(e.into());
    let mut all = pictures.iter();
    let Some((mut before, shown)) = all.next().transpose()? else { return Ok(()) };
    let mut encoder = Encoder::new(out, before.width(), before.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Balanced);
    encoder.set_animated(pictures.len() as u32, 0).map_err(refuse)?;
    encoder.set_dispose_op(DisposeOp::None).map_err(refuse)?;
    encoder.set_blend_op(BlendOp::Source).map_err(refuse)?;
    encoder.set_frame_delay(shown as u16, 1000).map_err(refuse)?;
    let mut writer = encoder.write_header().map_err(refuse)?;
    writer.write_image_data(&before).map_err(refuse)?;
    for next in all {
        let (now, shown) = next?;
        let part = changed(pixels(&before), pixels(&now), now.width());
        let [left, top, width, height] = part;
        // The place first: a part must lie inside the picture at every moment.
        writer.set_frame_position(0, 0).map_err(refuse)?;
        writer.set_frame_dimension(width, height).map_err(refuse)?;
        writer.set_frame_position(left, top).map_err(refuse)?;
        writer.set_frame_delay(shown as u16, 1000).map_err(refuse)?;
        let bytes: Vec<u8> = cut(pixels(&now), now.width(), part).concat();
        writer.write_image_data(&bytes).map_err(refuse)?;
        before = now;
    }
    writer.finish().map_err(refuse)
}

fn pixels(picture: &RgbImage) -> &[[u8; 3]] {
    picture.as_raw().as_chunks().0
}
