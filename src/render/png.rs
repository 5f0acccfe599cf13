//! PNG files that are either whole or absent.

use crate::base::error::{Error, Result};
use crate::observe::origin::{Origin, RUN_KEYWORD, STEP_KEYWORD};
use image::RgbImage;
use png::{BitDepth, ColorType, Compression, Encoder, EncodingError, Filter};
use std::io::Write;
use std::path::Path;

/// The picture as PNG bytes, compressed fast (a few milliseconds; twice the size of the slowest setting). One of which it is
/// known which run it shows, and at which step, carries both in text chunks.
///
/// # Errors
/// When the picture is empty.
pub fn encode(picture: &RgbImage, shows: Option<(Origin, u64)>) -> Result<Vec<u8>> {
    let mut bytes = Vec::with_capacity(picture.len() / 4);
    let refuse = |e: EncodingError| {
        Error::input(format!("cannot encode a picture: {e}"), "choose a size of at least 1 × 1 pixel")
    };
    let mut encoder = Encoder::new(&mut bytes, picture.width(), picture.height());
    encoder.set_color(ColorType::Rgb);
    encoder.set_depth(BitDepth::Eight);
    encoder.set_compression(Compression::Fast);
    encoder.set_filter(Filter::Adaptive);
    if let Some((origin, step)) = shows {
        encoder.add_text_chunk(RUN_KEYWORD.into(), origin.run.to_string()).map_err(refuse)?;
        encoder.add_text_chunk(STEP_KEYWORD.into(), step.to_string()).map_err(refuse)?;
    }
    let mut writer = encoder.write_header().map_err(refuse)?;
    writer.write_image_data(picture).map_err(refuse)?;
    writer.finish().map_err(refuse)?;
    Ok(bytes)
}

/// Whether a file is a whole picture: everything in it can be decoded, checksums included.
pub fn is_whole(path: &Path) -> bool {
    image::open(path).is_ok()
}

/// Writes `bytes` to `path` through a temporary file in the same folder, so that nobody ever sees half a file.
///
/// # Errors
/// [`Error::Io`] when the folder cannot be written or is full.
pub fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let io = |e| Error::io("cannot write", path, e);
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".frame-").suffix(".tmp").tempfile_in(folder).map_err(io)?;
    file.write_all(bytes).map_err(io)?;
    make_readable(file.as_file()).map_err(io)?;
    file.persist(path).map_err(|e| io(e.error))?;
    Ok(())
}

/// Temporary files are private to their owner; pictures are for everyone.
fn make_readable(file: &std::fs::File) -> std::io::Result<()> {
    #[cfg(unix)]
    {
        use std::os::unix::fs::PermissionsExt;
        file.set_permissions(std::fs::Permissions::from_mode(0o644))?;
    }
    let _ = file;
    Ok(())
}
