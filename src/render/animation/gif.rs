//! GIF: plays everywhere; 255 colours, chosen once for the whole sequence.

use super::palette::{Census, TRANSPARENT};
use super::pictures::{Part, Pictures, Refuse, changed, cut};
use crate::base::error::Result;
use gif::{DisposalMethod, Encoder, EncodingError, Frame, Repeat};
use std::io::Write;

/// Writes every picture, the first whole and of the others what changed.
pub(super) fn write(pictures: &Pictures, out: &mut impl Write, refuse: &Refuse) -> Result<()> {
    let refuse = |e: EncodingError| {
        refuse(match e {
            EncodingError::Io(e) => e,
            other => std::io::Error::other(other),
        })
    };
    let mut census = Census::new();
    for next in pictures.iter() {
        census.count(&next?.0);
    }
    let palette = census.palette();
    let [width, height] = census.size();
    let mut encoder = Encoder::new(out, width as u16, height as u16, palette.rgb()).map_err(refuse)?;
    encoder.set_repeat(Repeat::Infinite).map_err(refuse)?;
    let mut before: Vec<u8> = Vec::new();
    for next in pictures.iter() {
        let (picture, shown) = next?;
        let now = palette.indices(&picture);
        let part = match before.is_empty() {
            true => [0, 0, width, height],
            false => changed(&before, &now, width),
        };
        let mut frame = frame(part, shown);
        frame.buffer = fresh(&before, &now, width, part).into();
        encoder.write_frame(&frame).map_err(refuse)?;
        before = now;
    }
    Ok(())
}

fn frame(part: Part, shown: u32) -> Frame<'static> {
    // A GIF has at most 65535 pixels a side, and so have the parts of one that was begun.
    let [left, top, width, height] = part.map(|pixels| pixels as u16);
    Frame {
        delay: (shown / 10) as u16,
        dispose: DisposalMethod::Keep,
        transparent: Some(TRANSPARENT),
        left,
        top,
        width,
        height,
        ..Frame::default()
    }
}

/// The part's pixels, transparent where the picture before shows the same: long runs of one index take next to no
/// room.
fn fresh(before: &[u8], now: &[u8], width: u32, part: Part) -> Vec<u8> {
    let mut fresh = cut(now, width, part);
    if !before.is_empty() {
        for (now, before) in fresh.iter_mut().zip(cut(before, width, part)) {
            if *now == before {
                *now = TRANSPARENT;
            }
        }
    }
    fresh
}
