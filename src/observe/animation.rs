//! An animation of the frames, as it is asked for.

use crate::base::error::{Error, Result};
use crate::base::regular::{check_target, check_writable};
use std::path::PathBuf;

/// Where it goes.
#[derive(Debug, Clone, PartialEq)]
pub struct Animation {
    /// Its file: `.gif`, `.mp4`, or `.png` or `.apng` for an animated PNG.
    pub file: PathBuf,
    /// Width, when it is to be smaller than the frames (px).
    pub width: Option<u32>,
}

/// The file formats.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// GIF.
    Gif,
    /// Animated PNG.
    Apng,
    /// H.264 in MP4.
    Film,
}

impl Animation {
    /// Its format, by the ending of the file's name.
    ///
    /// # Errors
    /// [`Error::Input`] for another ending.
    pub fn format(&self) -> Result<Format> {
        let ending = self.file.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        match ending.as_str() {
            "gif" => Ok(Format::Gif),
            "png" | "apng" => Ok(Format::Apng),
            "mp4" => Ok(Format::Film),
            _ => {
                let what = format!("an animation cannot be written as {}", self.file.display());
                Err(Error::input(
                    what,
                    "give a name that ends in .gif, in .mp4 for a film, or in .png for an animated PNG",
                ))
            }
        }
    }

    /// Checks that it can be written without replacing anything.
    ///
    /// # Errors
    /// [`Error::Input`] for a file name with another ending, or one that is taken while `overwrite` is not set; [`Error::Io`]
    /// where no file can be written.
    pub fn check(&self, overwrite: bool) -> Result<()> {
        self.format()?;
        check_target(&self.file, overwrite, "--animation")?;
        check_writable(&self.file)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_endings_are_refused_and_the_right_ones_named() {
        for right in ["a.gif", "a.PNG", "b/a.apng", "a.mp4"] {
            assert!(Animation { file: right.into(), width: None }.format().is_ok(), "{right}");
        }
        for wrong in ["a.mov", "gif", "a"] {
            let Error::Input { help: Some(help), .. } =
                Animation { file: wrong.into(), width: None }.format().unwrap_err()
            else {
                panic!("{wrong} is bad input")
            };
            assert!(help.contains(".gif"), "{help}");
        }
    }
}
