//! Frames and animation of a run.

use super::finding::{InvariantOutcome, Search};
use super::folder::Folder;
use super::invariant::Invariant;
use crate::base::digest::Digest;
use crate::base::finding::StopReason;
use crate::base::regular;
use crate::observe::animation::{Animation, Format};
use crate::observe::origin::{RUN_KEYWORD, STEP_KEYWORD};
use crate::run::folder::{FRAMES, PICTURES as FOLDER_OF_NAMED, is_undrawn};
use crate::run::identity;
use rayon::prelude::*;
use shiguredo_mp4::demux::{Input, Mp4FileDemuxer};
use std::io::Cursor;
use std::path::{Path, PathBuf};

/// A run that draws has one frame for each snapshot, in order and in the size that its scene asks for; one that was stopped
/// while it drew lacks the last of them, and its folder says so. Pictures that were drawn again are as many and as large as
/// whoever drew them wanted. Either carry the id of their run and the step that they show, but for those of earlier programs.
pub const PICTURES: Invariant = Invariant {
    name: "frames",
    about: "a run that drew frames has one of each snapshot, in order, and all pictures in its folder are whole and its own",
    check: pictures,
};

/// An animation in another folder is the user's own, who may have moved it.
pub const ANIMATION: Invariant = Invariant {
    name: "animation",
    about: "the animation that the run made is there and whole, and shows every frame",
    check: animation,
};

/// Those that were left out, because the run never came to what they were to show, are not there.
pub const NAMED: Invariant = Invariant {
    name: "pictures",
    about: "pictures that the scene asks for are whole, as large as it says, and show a snapshot of this run",
    check: named,
};

/// Where pictures of a run are drawn again.
const AGAIN: &str = "render";

/// What is found in a picture.
#[derive(Debug, Clone, PartialEq)]
struct Picture {
    /// Width and height (px).
    size: [u32; 2],
    /// Pictures in it, when it is animated.
    frames: usize,
    /// Run that it says it shows.
    run: Option<String>,
    /// Step whose state it says it shows.
    step: Option<String>,
}

/// Decodes all of a PNG file.
fn picture(path: &Path) -> Result<Picture, String> {
    let bytes = regular::read(path, regular::LONGEST_TABLE).map_err(|e| e.to_string())?;
    let damaged = |e: png::DecodingError| format!("it is damaged: {e}");
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().map_err(damaged)?;
    let mut pixels = vec![0; reader.output_buffer_size().ok_or("it is too large")?];
    let frames = reader.info().animation_control.map_or(1, |animation| animation.num_frames as usize);
    for _ in 0..frames {
        reader.next_frame(&mut pixels).map_err(damaged)?;
    }
    reader.finish().map_err(damaged)?;
    let info = reader.info();
    let says = |keyword| {
        let chunk = info.uncompressed_latin1_text.iter().find(|chunk| chunk.keyword == keyword);
        chunk.map(|chunk| chunk.text.clone())
    };
    Ok(Picture { size: [info.width, info.height], frames, run: says(RUN_KEYWORD), step: says(STEP_KEYWORD) })
}

fn pictures(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let frames = run.path.join(FRAMES);
    let numbered = |folder: &str| identity::pictures(&run.path.join(folder)).unwrap_or_default();
    let drawn = numbered(FRAMES);
    let own = run.drew_frames();
    if own {
        let left_out = run.summary.cost.frames.map_or(0, |frames| frames.not_drawn as usize);
        let snapshots = run.trajectory.snapshots.len().saturating_sub(left_out);
        // Whoever draws the rest may have been killed before he told.
        let drawing = is_undrawn(&frames) && drawn.len() > snapshots;
        let sealed = run.seal.as_ref().and_then(|seal| seal.files.get(FRAMES)).filter(|_| !drawing);
        if let (Some(right), Ok(found)) = (sealed, identity::digest(&frames)) {
            search.same(found.to_string(), right.to_string(), || format!("digest of the pictures in {FRAMES}"));
        }
        let snapshots = if drawing { drawn.len().min(run.trajectory.snapshots.len()) } else { snapshots };
        search.same(drawn.len(), snapshots, || format!("pictures in {FRAMES}"));
        let last = drawn.last_key_value().map_or(0, |(number, _)| number + 1);
        search.same(last, snapshots, || format!("number of the last picture in {FRAMES}, from 1"));
        if let Some(timings) = run.summary.cost.frames.filter(|_| !drawing) {
            search.same(timings.frames as usize, snapshots, || "frames, count in summary.json".into());
        }
    }
    let again = numbered(AGAIN);
    let all: Vec<(&str, usize, &PathBuf)> = [(FRAMES, &drawn), (AGAIN, &again)]
        .into_iter()
        .flat_map(|(folder, pictures)| pictures.iter().map(move |(number, path)| (folder, *number, path)))
        .collect();
    let seen: Vec<Result<Picture, String>> = all.par_iter().map(|(_, _, path)| picture(path)).collect();
    let right = run.trajectory.origin.run.to_string();
    for folder in [FRAMES, AGAIN] {
        let of = || all.iter().zip(&seen).filter(|((of, _, _), _)| *of == folder);
        let says = |what: fn(&Picture) -> &Option<String>| {
            of().any(|(_, seen)| seen.as_ref().is_ok_and(|seen| what(seen).is_some()))
        };
        let (any_named, any_dated) = (says(|seen| &seen.run), says(|seen| &seen.step));
        if any_dated && own && folder == FRAMES {
            let left_out = run.summary.cost.frames.is_some_and(|frames| frames.unfinished());
            let unfinished = left_out || run.summary.stopped == StopReason::Interrupted;
            search.same(is_undrawn(&frames), unfinished, || format!("{FRAMES} are marked as unfinished"));
        }
        let mut steps = run.trajectory.snapshots.iter();
        for ((_, number, _), seen) in of() {
            let place = || format!("{folder}, picture {number}");
            match seen {
                Err(what) => search.add(f64::NAN, || format!("{}: {what}", place())),
                Ok(seen) => {
                    if any_named {
                        let named = seen.run.as_deref().unwrap_or("none");
                        search.same(named, right.as_str(), || format!("{}, id of its run", place()));
                    }
                    let step = seen.step.as_deref().unwrap_or("none");
                    if any_dated && own && folder == FRAMES {
                        let right = run.trajectory.snapshots.get(*number).map_or("none".into(), u64::to_string);
                        search.same(step, right.as_str(), || format!("{}, step that it shows", place()));
                    } else if any_dated {
                        // Some snapshots may have been left out.
                        let later = steps.any(|later| step == later.to_string());
                        search.same(later, true, || format!("{} shows step {step}, a snapshot in order", place()));
                    }
                    if own && folder == FRAMES {
                        let [found, wanted] =
                            [seen.size, run.spec.output.frame_size].map(|[w, h]| format!("{w} × {h}"));
                        search.same(found, wanted, || format!("{}, size in pixels", place()));
                    }
                }
            }
        }
    }
    search.end(0.0, "-", "the run drew no frames")
}

fn named(run: &Folder) -> InvariantOutcome {
    let mut search = Search::new();
    let id = run.trajectory.origin.run.to_string();
    for wanted in &run.spec.output.pictures {
        let file = run.path.join(FOLDER_OF_NAMED).join(format!("{}.png", wanted.name));
        if !file.exists() {
            continue;
        }
        let place = || format!("{FOLDER_OF_NAMED}, {}", wanted.name);
        match picture(&file) {
            Err(what) => search.add(f64::NAN, || format!("{}: {what}", place())),
            Ok(seen) => {
                search.same(seen.run.as_deref().unwrap_or("none"), &id, || format!("{}, id of its run", place()));
                let [found, right] = [seen.size, wanted.size].map(|[w, h]| format!("{w} × {h}"));
                search.same(found, right, || format!("{}, size in pixels", place()));
                let step = seen.step.as_deref().unwrap_or("none");
                let known = step.parse().is_ok_and(|step: u64| run.trajectory.snapshots.contains(&step));
                search.same(known, true, || format!("{} shows step {step}, that of a snapshot", place()));
            }
        }
    }
    search.end(0.0, "-", "the scene asks for no pictures, or none was drawn")
}

fn animation(run: &Folder) -> InvariantOutcome {
    let not = |why: String| InvariantOutcome::NotApplicable(why);
    let Some(name) = run.summary.written.as_ref().and_then(|written| written.animation.as_ref()) else {
        return not("the run made no animation".into());
    };
    if run.summary.cost.frames.is_some_and(|frames| frames.unfinished()) {
        return not("the run was stopped while it drew".into());
    }
    let file = run.path.join(name);
    let elsewhere = Path::new(name).is_absolute();
    if elsewhere && !file.exists() {
        return not(format!("the animation lay in another folder: {name}"));
    }
    let mut search = Search::new();
    match frames_in(&file) {
        Ok(frames) => search.same(frames, run.trajectory.snapshots.len(), || format!("frames of {name}")),
        Err(what) => search.add(f64::NAN, || format!("{name}: {what}")),
    }
    if let (Some(timings), Ok(there)) = (&run.summary.cost.frames, file.metadata()) {
        search.same(there.len(), timings.animation_bytes, || format!("bytes of {name}"));
    }
    let sealed = run.seal.as_ref().and_then(|seal| seal.files.get(name));
    if let (Some(right), Ok(found)) = (sealed, Digest::of_file(&file)) {
        search.same(found.to_string(), right.to_string(), || format!("digest of {name}"));
    }
    search.end(0.0, "-", "")
}

/// How many pictures an animation has, which must be whole.
fn frames_in(file: &Path) -> Result<usize, String> {
    if !file.is_file() {
        return Err("it is missing".into());
    }
    let animation = Animation { file: file.into(), width: None };
    match animation.format().map_err(|e| e.to_string())? {
        Format::Apng => picture(file).map(|picture| picture.frames),
        Format::Film => {
            let bytes = regular::read(file, regular::LONGEST_TABLE).map_err(|e| e.to_string())?;
            film_frames(&bytes).map_err(|e| format!("it is damaged, or cut off: {e}"))
        }
        Format::Gif => {
            let bytes = regular::read(file, regular::LONGEST_TABLE).map_err(|e| e.to_string())?;
            gif_frames(&bytes).ok_or_else(|| "it is damaged, or cut off".into())
        }
    }
}

/// Pictures of an MP4 file, all of which must lie in it.
fn film_frames(bytes: &[u8]) -> Result<usize, String> {
    let mut film = Mp4FileDemuxer::new();
    // It asks for one part after the other, and for no more once something is wrong.
    while film.required_input().is_some() {
        film.handle_input(Input { position: 0, data: bytes });
    }
    let mut frames = 0;
    while let Some(sample) = film.next_sample().map_err(|e| e.to_string())? {
        if sample.data_offset + sample.data_size as u64 > bytes.len() as u64 {
            return Err(format!("picture {} lies beyond its end", frames + 1));
        }
        frames += 1;
    }
    Ok(frames)
}

/// Pictures of a GIF file; `None` unless its blocks follow each other up to the trailer, which ends it. (GIF89a
/// specification, CompuServe 1990.)
fn gif_frames(bytes: &[u8]) -> Option<usize> {
    /// Bytes of the table of colours that a block's flags tell of.
    fn colours(flags: u8) -> usize {
        if flags & 0x80 == 0 { 0 } else { 3 << ((flags & 7) + 1) }
    }
    /// Where the data that begin at `at` end: blocks with their length before them, the last of length 0.
    fn end_of_data(bytes: &[u8], mut at: usize) -> Option<usize> {
        loop {
            let length = usize::from(*bytes.get(at)?);
            at += 1 + length;
            if length == 0 {
                return Some(at);
            }
        }
    }
    if !(bytes.starts_with(b"GIF89a") || bytes.starts_with(b"GIF87a")) {
        return None;
    }
    // Width, height, flags, background, aspect; then the table of colours.
    let mut at = 13 + colours(*bytes.get(10)?);
    let mut frames = 0;
    loop {
        match bytes.get(at)? {
            // An extension: its kind, then data.
            0x21 => at = end_of_data(bytes, at + 2)?,
            // A picture: place, size and flags, colours, width of the codes, data.
            0x2c => {
                at = end_of_data(bytes, at + 11 + colours(*bytes.get(at + 9)?))?;
                frames += 1;
            }
            0x3b => return (at + 1 == bytes.len()).then_some(frames),
            _ => return None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two pictures of one pixel, the second with colours of its own, and a comment.
    fn gif() -> Vec<u8> {
        let mut bytes = b"GIF89a\x01\0\x01\0\x80\0\0".to_vec();
        bytes.extend([0, 0, 0, 255, 255, 255]);
        bytes.extend(b"\x21\xfe\x02hi\0");
        bytes.extend([0x2c, 0, 0, 0, 0, 1, 0, 1, 0, 0, 2, 2, 0x4c, 1, 0]);
        bytes.extend([0x2c, 0, 0, 0, 0, 1, 0, 1, 0, 0x80, 0, 0, 0, 255, 255, 255, 2, 2, 0x4c, 1, 0]);
        bytes.push(0x3b);
        bytes
    }

    #[test]
    fn pictures_of_a_gif_are_counted_and_a_cut_is_seen() {
        let whole = gif();
        assert_eq!(gif_frames(&whole), Some(2));
        for length in 0..whole.len() {
            assert_eq!(gif_frames(&whole[..length]), None, "cut at {length}");
        }
        assert_eq!(gif_frames(&[&whole[..], b"more"].concat()), None);
    }
}
