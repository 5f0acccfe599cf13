//! What a figure shows.

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

/// A value that matters, as a horizontal line across the figure.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// Where it lies, in the unit of the axis.
    pub y: f64,
    /// What it is, written at it.
    pub name: String,
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
}
