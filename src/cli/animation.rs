//! The options of an animation, for `run` and `render` alike.

use crate::observe::animation::Animation;
use std::path::{Path, PathBuf};

/// Whether and where to make an animation.
#[derive(Debug, clap::Args)]
pub struct AnimationArgs {
    /// Also make an animation of the pictures: .gif, .png for an animated PNG (both loop), or .mp4 for a film (H.264), as
    /// slides and phones play it [default: frames.gif in the folder of the results]
    #[arg(long, value_name = "FILE", num_args = 0..=1)]
    animation: Option<Option<PathBuf>>,
    /// Make the animation smaller than the pictures
    #[arg(long, value_name = "PIXELS", value_parser = clap::value_parser!(u32).range(16..=8192), requires = "animation")]
    animation_width: Option<u32>,
}

impl AnimationArgs {
    /// What is asked for; `usual` is the file where none is named.
    pub fn resolve(self, usual: &Path) -> Option<Animation> {
        let width = self.animation_width;
        self.animation.map(|file| Animation { file: file.unwrap_or_else(|| usual.into()), width })
    }
}
