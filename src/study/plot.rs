//! Figures of studies, written as SVG or PNG: series with names, markers and error bars on linear or logarithmic axes,
//! reference slopes, limits. Text is set in the program's own font, so that no font of the system is needed.

mod axis;
mod draw;
mod painter;

use crate::base::error::{Error, Result};
use crate::observe::files::write_whole;
use std::path::{Path, PathBuf};

/// How an axis runs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Equal steps of the value are equal lengths.
    Linear,
    /// Evenly in decades; values that are not positive are left out.
    Log,
}

/// One axis.
#[derive(Debug, Clone, PartialEq)]
pub struct Axis {
    /// What it shows, with its unit: "run time (s)".
    pub label: String,
    /// How it runs.
    pub scale: Scale,
    /// Least and greatest value shown; what holds all series and limits when `None`.
    pub range: Option<[f64; 2]>,
    /// Names of the values 0, 1, 2, … instead of numbers; empty for numbers.
    pub names: Vec<String>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Linear, range: None, names: Vec::new() }
    }

    /// A logarithmic axis.
    pub fn log(label: impl Into<String>) -> Self {
        Self { label: label.into(), scale: Scale::Log, range: None, names: Vec::new() }
    }

    /// An axis of names, at 0, 1, 2, ….
    pub fn named(label: impl Into<String>, names: Vec<String>) -> Self {
        Self { range: Some([-0.5, names.len() as f64 - 0.5]), names, ..Self::linear(label) }
    }

    /// Shows `low` to `high`.
    pub fn from_to(mut self, low: f64, high: f64) -> Self {
        self.range = Some([low, high]);
        self
    }
}

/// How a series is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Mark {
    /// Markers alone.
    Points,
    /// A line alone.
    Line,
    /// A dashed line alone: theory, a reference.
    Dashed,
    /// Markers joined by a line.
    LineAndPoints,
    /// A broad grey line behind everything: what the points add up to.
    Behind,
}

/// Points that belong together. Those that are not finite, or not positive on a logarithmic axis, are left out.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// Its name in the legend; an empty one has no entry there.
    pub name: String,
    /// (x, y) in the units of the axes.
    pub points: Vec<[f64; 2]>,
    /// Half the height of each point's error bar, in the unit of y; empty for none.
    pub errors: Vec<f64>,
    /// How it is drawn.
    pub mark: Mark,
    /// Its place on a colour map that is even to the eye, from 0 to 1, for series that are in an order; `None` for a
    /// colour of its own.
    pub shade: Option<f64>,
}

impl Series {
    /// A series without error bars.
    pub fn new(name: impl Into<String>, mark: Mark, points: Vec<[f64; 2]>) -> Self {
        Self { name: name.into(), points, errors: Vec::new(), mark, shade: None }
    }

    /// The same with error bars: half their heights, in the unit of y.
    pub fn with_errors(mut self, errors: Vec<f64>) -> Self {
        self.errors = errors;
        self
    }

    /// The same in the colour of this place, from 0 to 1.
    pub fn shaded(mut self, shade: f64) -> Self {
        self.shade = Some(shade);
        self
    }
}

/// A straight line y ∝ x^`order` on two logarithmic axes, to compare slopes with.
#[derive(Debug, Clone, PartialEq)]
pub struct Slope {
    /// The exponent (-).
    pub order: f64,
    /// A point that it runs through.
    pub through: [f64; 2],
    /// Its name in the legend.
    pub name: String,
}

/// A value that matters, as a line across the figure.
#[derive(Debug, Clone, PartialEq)]
pub enum Limit {
    /// A vertical line at this x.
    X(f64, String),
    /// A horizontal line at this y.
    Y(f64, String),
}

/// A point that must be found at once: a ring around it, and its name beside it.
#[derive(Debug, Clone, PartialEq)]
pub struct Highlight {
    /// (x, y) in the units of the axes.
    pub at: [f64; 2],
    /// What it is.
    pub name: String,
}

/// Where the legend stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Legend {
    /// In the corner of the frame where it hides least.
    Inside,
    /// To the right of the frame: for many series.
    Beside,
}

/// One pair of axes with what they show.
#[derive(Debug, Clone, PartialEq)]
pub struct Figure {
    /// Stands above it.
    pub title: String,
    /// The horizontal axis.
    pub x: Axis,
    /// The vertical axis.
    pub y: Axis,
    /// Series, in the order of the legend.
    pub series: Vec<Series>,
    /// Reference slopes.
    pub slopes: Vec<Slope>,
    /// Lines across.
    pub limits: Vec<Limit>,
    /// Points that stand out.
    pub highlights: Vec<Highlight>,
    /// Where the legend stands.
    pub legend: Legend,
    /// Width and height (px of an SVG).
    pub size: [u32; 2],
}

/// Size of a figure unless it says otherwise (px of an SVG).
const SIZE: [u32; 2] = [620, 440];

impl Figure {
    /// Axes that show nothing yet.
    pub fn new(title: impl Into<String>, x: Axis, y: Axis) -> Self {
        Self {
            title: title.into(),
            x,
            y,
            series: Vec::new(),
            slopes: Vec::new(),
            limits: Vec::new(),
            highlights: Vec::new(),
            legend: Legend::Inside,
            size: SIZE,
        }
    }

    /// Writes the figure alone; see [`write()`].
    ///
    /// # Errors
    /// See [`write()`].
    pub fn write(&self, path: &Path) -> Result<()> {
        write(std::slice::from_ref(self), 1, path)
    }
}

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
        std::fs::create_dir_all(folder).map_err(|e| Error::io("cannot make the folder", folder, e))?;
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
        f.limits.push(Limit::Y(5e-3, "target".into()));
        f
    }

    #[test]
    fn svg_holds_every_word_and_names_a_fallback_font() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("made/on/the/way.svg");
        figure().write(&path).unwrap();
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
        let error = figure().write(Path::new("/tmp/figure.pdf")).unwrap_err();
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
