//! Pictures of a run in memory.

/// How a picture is to look; what is not given is as the scene says.
#[cfg_attr(not(feature = "frames"), expect(dead_code, reason = "without frames nothing is drawn"))]
pub struct Look<'a> {
    pub colour: Option<&'a str>,
    pub theme: Option<&'a str>,
    /// Pixels.
    pub width: Option<u32>,
    /// Pixels.
    pub height: Option<u32>,
    /// Degrees.
    pub azimuth: Option<f64>,
    /// Degrees.
    pub elevation: Option<f64>,
    pub zoom: Option<f64>,
    /// mm.
    pub focus_z: Option<f64>,
}

#[cfg(feature = "frames")]
pub use drawn::frame;
#[cfg(not(feature = "frames"))]
pub use refused::frame;

#[cfg(not(feature = "frames"))]
mod refused {
    use super::Look;
    use crate::error::raise;
    use crate::results::PyRun;
    use pyo3::prelude::*;
    use strandsnap::base::error::Error;

    pub fn frame<'py>(
        py: Python<'py>,
        _run: &PyRun,
        _which: (Option<f64>, Option<isize>),
        _view: Option<&Bound<'py, PyAny>>,
        _look: &Look,
    ) -> PyResult<Bound<'py, PyAny>> {
        let help = "install it with: pip install ./src/python --config-settings build-args=\"--features frames\"";
        let what = "this package was built without frames (feature `frames`)".into();
        Err(raise(py, &Error::Missing { what, help: Some(help.into()) }))
    }
}

#[cfg(feature = "frames")]
mod drawn {
    use super::Look;
    use crate::arrays::{Numbers, array};
    use crate::error::OrRaise;
    use crate::options::word;
    use crate::results::PyRun;
    use pyo3::exceptions::PyValueError;
    use pyo3::prelude::*;
    use std::path::Path;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicBool, Ordering};
    use strandsnap::base::error::{Error, Result};
    use strandsnap::engine::view::{RunInfo, Rupture, Sample, Snapshot};
    use strandsnap::observe::Observer;
    use strandsnap::render::{History, Renderer};
    use strandsnap::run::folder::SCENE;
    use strandsnap::run::replay::{Replay, Selection};
    use strandsnap::scene;
    use strandsnap::scene::look::ZOOM;
    use strandsnap::scene::spec::{ColourBy, OutputSpec, Theme, View};

    pub fn frame<'py>(
        py: Python<'py>,
        run: &PyRun,
        (strain, index): (Option<f64>, Option<isize>),
        view: Option<&Bound<'py, PyAny>>,
        look: &Look,
    ) -> PyResult<Bound<'py, PyAny>> {
        py.import("strandsnap._mesa")?.call_method0("quiet")?;
        let number = run.number(py, strain, index)?;
        let file = run.path().join(SCENE);
        let mut output = scene::load(&file.to_string_lossy(), &[]).or_raise(py)?.spec.output;
        if let Some(view) = view {
            let words: Vec<String> = match view.extract::<String>() {
                Ok(word) => vec![word],
                Err(_) => view.extract()?,
            };
            let views = words.iter().map(|one| word("view", one, &View::ALL, View::word));
            output.views = views.collect::<PyResult<_>>()?;
        }
        look.apply(&mut output)?;
        let (pixels, [width, height]) = py.detach(|| draw(run.path(), number, &output)).or_raise(py)?;
        let array = array(py, Numbers::Byte(pixels), &[height, width, 3])?;
        array.call_method1("view", (py.import("strandsnap._frame")?.getattr("Frame")?,))
    }

    impl Look<'_> {
        fn apply(&self, output: &mut OutputSpec) -> PyResult<()> {
            if let Some(colour) = self.colour {
                output.colour = word("colour", colour, &ColourBy::ALL, ColourBy::word)?;
            }
            if let Some(theme) = self.theme {
                output.theme = word("theme", theme, &Theme::ALL, Theme::word)?;
            }
            let [width, height] = output.frame_size;
            output.frame_size = [self.width.unwrap_or(width), self.height.unwrap_or(height)];
            let camera = &mut output.camera;
            for (name, degrees, angle) in
                [("azimuth", self.azimuth, &mut camera.azimuth), ("elevation", self.elevation, &mut camera.elevation)]
            {
                if let Some(degrees) = degrees {
                    within(name, degrees, -360.0, 360.0)?;
                    *angle = degrees.to_radians();
                }
            }
            if let Some(zoom) = self.zoom {
                within("zoom", zoom, *ZOOM.start(), *ZOOM.end())?;
                camera.zoom = zoom;
            }
            if let Some(z) = self.focus_z {
                within("focus_z", z, -1e8, 1e8)?;
                camera.focus_z = Some(z * 1e-3);
            }
            Ok(())
        }
    }

    fn within(name: &str, number: f64, least: f64, most: f64) -> PyResult<()> {
        if (least..=most).contains(&number) {
            return Ok(());
        }
        Err(PyValueError::new_err(format!("{name} is {number}; it is from {least} to {most}")))
    }

    /// The bytes of a picture, row by row, with its width and height.
    fn draw(run: &Path, number: usize, look: &OutputSpec) -> Result<(Vec<u8>, [usize; 2])> {
        let replay = Replay::open(run, &Selection::default())?;
        let stop = AtomicBool::new(false);
        let history = History::knowing(replay.ruptures().to_vec());
        let mut drawer = Drawer { look, left: number, renderer: None, history, drawn: None, stop: &stop };
        replay.show(&mut drawer, &stop)?;
        drawer.drawn.ok_or_else(|| {
            let what = format!("the run in {} has changed: snapshot {number} is gone", run.display());
            Error::input(what, "open it again")
        })
    }

    /// Follows a run up to a snapshot, and draws it.
    struct Drawer<'a> {
        look: &'a OutputSpec,
        left: usize,
        renderer: Option<Renderer>,
        history: History,
        drawn: Option<(Vec<u8>, [usize; 2])>,
        stop: &'a AtomicBool,
    }

    impl Observer for Drawer<'_> {
        fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
            self.renderer = Some(Renderer::new(info, self.look)?);
            Ok(())
        }

        fn sample(&mut self, sample: &Sample) -> Result<()> {
            self.history.rows.push(sample.into());
            Ok(())
        }

        fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
            self.history.ruptures.push(rupture.clone());
            Ok(())
        }

        fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
            let Some(renderer) = self.renderer.as_mut().filter(|_| self.drawn.is_none()) else { return Ok(()) };
            renderer.follow(&mut self.history, snapshot);
            if self.left == 0 {
                let picture = renderer.draw(snapshot, &self.history)?;
                let size = [picture.width(), picture.height()].map(|side| side as usize);
                self.drawn = Some((picture.into_raw(), size));
                self.stop.store(true, Ordering::Relaxed);
            }
            self.left = self.left.saturating_sub(1);
            Ok(())
        }

        fn finish(&mut self) -> Result<()> {
            Ok(())
        }
    }
}
