//! The pictures of an animation, and what changes from one to the next.

use crate::base::error::{Error, Result};
use image::RgbImage;
use image::imageops::{FilterType, resize};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// How long a picture is shown (ms). The pictures lie denser around ruptures, so that there the same pace is slow
/// motion.
const SHOWN: u32 = 70;
/// How long the first picture after a rupture is shown (ms).
const PAUSE: u32 = 500;
/// How long the last picture is shown before it begins again (ms).
const END: u32 = 2500;

/// A picture of an animation.
#[derive(Debug, Clone, PartialEq)]
pub struct Still {
    /// A PNG file.
    pub picture: PathBuf,
    /// It is the first one after a wire snapped.
    pub pause: bool,
}

/// What went wrong with the file that is being written.
pub(super) type Refuse<'a> = dyn Fn(std::io::Error) -> Error + 'a;

/// The pictures of an animation, read one by one.
pub(super) struct Pictures<'a> {
    pub stills: &'a [Still],
    /// Width that they are made smaller to (px), where one is asked for.
    pub width: Option<u32>,
    /// Ends it.
    pub stop: &'a AtomicBool,
}

impl Pictures<'_> {
    pub fn len(&self) -> usize {
        self.stills.len()
    }

    /// Each picture, made smaller where that is asked for, and how long it is shown (ms); [`Error::Interrupted`] where it was
    /// stopped.
    pub fn iter(&self) -> impl Iterator<Item = Result<(RgbImage, u32)>> + '_ {
        let last = self.stills.len() - 1;
        self.stills.iter().enumerate().map(move |(i, still)| {
            let shown = match (i == last, still.pause) {
                (true, _) => END,
                (false, true) => PAUSE,
                (false, false) => SHOWN,
            };
            if self.stop.load(Ordering::Relaxed) {
                return Err(Error::Interrupted);
            }
            Ok((self.read(&still.picture)?, shown))
        })
    }

    fn read(&self, file: &Path) -> Result<RgbImage> {
        let refuse = |e: image::ImageError| Error::io("cannot read", file, std::io::Error::other(e));
        let picture = image::open(file).map_err(refuse)?.into_rgb8();
        Ok(match self.width.filter(|width| *width < picture.width()) {
            Some(width) => {
                let height = (f64::from(picture.height()) * f64::from(width) / f64::from(picture.width())).round();
                resize(&picture, width, (height as u32).max(1), FilterType::Triangle)
            }
            None => picture,
        })
    }
}

/// A part of a picture: left, top, width, height (px).
pub(super) type Part = [u32; 4];

/// The least part that holds every pixel that differs; a corner pixel when none does, because a picture must show
/// something to take its time. `width` is that of both pictures.
pub(super) fn changed<P: PartialEq>(before: &[P], now: &[P], width: u32) -> Part {
    let width = width as usize;
    let rows = || before.chunks_exact(width).zip(now.chunks_exact(width)).enumerate();
    let mut differing = rows().filter(|(_, (a, b))| a != b).map(|(y, _)| y);
    let Some(top) = differing.next() else { return [0, 0, 1, 1] };
    let bottom = differing.last().unwrap_or(top) + 1;
    let (mut left, mut right) = (width, 0);
    for (_, (a, b)) in rows().take(bottom).skip(top) {
        if let Some(first) = a[..left].iter().zip(b).position(|(a, b)| a != b) {
            left = first;
        }
        if let Some(last) = a[right..].iter().zip(&b[right..]).rposition(|(a, b)| a != b) {
            right += last + 1;
        }
    }
    [left, top, right - left, bottom - top].map(|pixels| pixels as u32)
}

/// The pixels of a part, row by row.
pub(super) fn cut<P: Copy>(pixels: &[P], width: u32, [left, top, w, h]: Part) -> Vec<P> {
    let row = |y: u32| {
        let start = (y * width + left) as usize;
        &pixels[start..start + w as usize]
    };
    (top..top + h).flat_map(row).copied().collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_part_that_changed_holds_every_change_and_no_more() {
        let before = vec![0u8; 60];
        let at = |x: usize, y: usize| y * 10 + x;
        for points in [vec![(3, 2)], vec![(3, 2), (7, 4)], vec![(9, 0), (0, 5)], vec![(5, 1), (2, 3), (4, 2)]] {
            let mut now = before.clone();
            points.iter().for_each(|&(x, y)| now[at(x, y)] = 1);
            let [left, top, w, h] = changed(&before, &now, 10).map(|p| p as usize);
            let (xs, ys) = (points.iter().map(|p| p.0), points.iter().map(|p| p.1));
            assert_eq!((left, left + w), (xs.clone().min().unwrap(), xs.max().unwrap() + 1), "{points:?}");
            assert_eq!((top, top + h), (ys.clone().min().unwrap(), ys.max().unwrap() + 1), "{points:?}");
            let part = cut(&now, 10, changed(&before, &now, 10));
            assert_eq!(part.iter().filter(|p| **p == 1).count(), points.len());
        }
        assert_eq!(changed(&before, &before, 10), [0, 0, 1, 1]);
    }
}
