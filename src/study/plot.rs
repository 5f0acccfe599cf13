//! Figures of studies, written as SVG or PNG: series with names, markers and error bars on linear or logarithmic axes,
//! reference slopes, limits. Text is set in the program's own font, so that no font of the system is needed.

mod axis;
mod draw;
mod figure;
mod painter;

pub use figure::{Axis, Figure, Highlight, Legend, Limit, Mark, Scale, Series, Slope};

use crate::base::error::{Error, Result};
use crate::base::regular;
use crate::observe::files::write_whole;
use std::path::{Path, PathBuf};

/// Writes `figures`, all as large as the largest, side by side in rows of `columns`, as SVG or PNG by the extension of `path`. Folders that are
/// missing are made.
///
/// # Errors
/// Another extension; no figure; a folder that cannot be written.
pub fn write(figures: &[Figure], columns: usize, path: &Path) -> Result<()> {
    if figures.is_empty() {
        return Err(Error::input("there is nothing to draw", "give at least one figure"));
    }
    let content = match path.extension().and_then(|e| e.to_str()) {
        Some("svg") => draw::svg(figures, columns)?.into_bytes(),
        Some("png") => draw::png(figures, columns)?,
        _ => {
            let what = format!("no figure can be written as {}", path.display());
            return Err(Error::input(what, "end its name in .svg or .png"));
        }
    };
    if let Some(folder) = path.parent() {
        regular::make_folder(folder)?;
    }
    write_whole(path, &content)
}

/// Writes `figures` in rows of `columns` as `name.svg` and `name.png` into `folder`. Gives the files, SVG before PNG.
///
/// # Errors
/// See [`write()`].
pub fn write_pair(figures: &[Figure], columns: usize, folder: &Path, name: &str) -> Result<Vec<PathBuf>> {
    let files: Vec<PathBuf> = ["svg", "png"].iter().map(|end| folder.join(format!("{name}.{end}"))).collect();
    files.iter().try_for_each(|path| write(figures, columns, path))?;
    Ok(files)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn figure() -> Figure {
        let mut f = Figure::new("Error of the tip", Axis::log("a/L [-]"), Axis::log("relative error [-]"));
        let points = vec![[0.1, 1e-2], [0.05, 2.5e-3], [0.025, 6e-4], [0.01, 0.0]];
        f.series.push(Series::new("cantilever", Mark::LineAndPoints, points));
        f.slopes.push(Slope { order: 2.0, through: [0.1, 1e-2], name: "order 2".into() });
        f.limits.push(Limit { y: 5e-3, name: "target".into() });
        f
    }

    #[test]
    fn svg_holds_every_word_and_names_a_fallback_font() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made/on/the/way.svg");
        write(&[figure()], 1, &path).unwrap();
        let text = std::fs::read_to_string(&path).unwrap();
        for word in ["Error of the tip", "a/L [-]", "relative error [-]", "cantilever", "order 2", "target", "0.001"] {
            assert!(text.contains(word), "{word}");
        }
        assert!(text.contains("Inter, "));
    }

    #[test]
    fn png_is_a_picture_of_several_colours() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.png");
        write(&[figure(), figure(), figure()], 2, &path).unwrap();
        let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut pixels = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut pixels).unwrap();
        assert!(info.width > info.height);
        let colours: std::collections::HashSet<&[u8]> = pixels.chunks(3).collect();
        assert!(colours.len() > 20, "{}", colours.len());
    }

    #[test]
    fn a_legend_beside_the_frame_hides_no_point_and_a_highlight_is_named() {
        let mut f = figure();
        f.legend = Legend::Beside;
        f.size = [900, 500];
        f.highlights.push(Highlight { at: [0.05, 2.5e-3], name: "default".into() });
        let text = draw::svg(&[f], 1).unwrap();
        assert!(text.contains("width=\"900\"") && text.contains("default"));
        // Both ways, the entries stand right of the frame, whose right edge is where the longest grid lines end.
        let legend_x = |word: &str| {
            let tag = text[..text.find(word).unwrap()].rfind("<text x=\"").unwrap() + 9;
            text[tag..].split('"').next().unwrap().parse::<i32>().unwrap()
        };
        assert!(legend_x("cantilever") > 700, "{}", legend_x("cantilever"));
    }

    #[test]
    fn names_stand_where_numbers_would() {
        let mut f = Figure::new("By grip", Axis::named("grip", vec!["all".into(), "jaw".into()]), Axis::linear("y"));
        f.series.push(Series::new("mean", Mark::Points, vec![[0.0, 1.0], [1.0, 2.0]]).with_errors(vec![0.1, 0.2]));
        let text = draw::svg(&[f], 1).unwrap();
        assert!(text.contains("\nall\n") && text.contains("\njaw\n"), "{text}");
        assert!(!text.contains("\n0.5\n"));
    }

    #[test]
    fn series_in_an_order_have_colours_in_an_order() {
        let mut f = figure();
        let line =
            |shade: f64| Series::new(format!("at {shade}"), Mark::Line, vec![[0.1, 1e-2], [0.01, 1e-3]]).shaded(shade);
        f.series = vec![line(0.0), line(1.0)];
        let text = draw::svg(&[f], 1).unwrap();
        // The ends of viridis, as it is published.
        assert!(text.contains("#440154"), "{text}");
    }

    #[test]
    fn what_cannot_be_written_is_said() {
        let error = write(&[figure()], 1, Path::new("/tmp/figure.pdf")).unwrap_err();
        assert_eq!(error.exit_code(), 2);
        assert!(write(&[], 1, Path::new("/tmp/a.svg")).is_err());
    }

    #[test]
    fn a_figure_without_points_is_still_drawn() {
        let mut empty = figure();
        empty.series[0].points = vec![[f64::NAN, 1.0], [-1.0, 1.0]];
        empty.slopes.clear();
        empty.limits.clear();
        assert!(draw::svg(&[empty], 1).unwrap().contains("</svg>"));
    }
}
