//! What all sessions share: the run, a second one beside it, and those who draw them.

use super::control::Control;
use super::draw::{Artist, Picture};
use super::record::{Record, Told};
use super::view::View;
use crate::base::error::{Error, Result};
use image::{RgbImage, imageops};
use serde_json::{Value, json};
use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, RwLock, RwLockReadGuard, TryLockError};

/// A run and the one who draws it.
pub(super) struct Pane {
    record: RwLock<Record>,
    /// What a run that is going has told since the record was last free.
    inbox: Mutex<Vec<Told>>,
    /// Its folder.
    run: PathBuf,
    artist: Mutex<Artist>,
    /// Name of the graphics adapter, which can be told while it draws.
    pub adapter: String,
}

impl Pane {
    /// Reads the run in a folder and opens the graphics adapter.
    ///
    /// # Errors
    /// When the run cannot be read, or there is no adapter.
    pub fn open(run: &Path) -> Result<Self> {
        Self::of(Record::read(run)?, run)
    }

    /// The same for a run whose record has begun.
    ///
    /// # Errors
    /// When there is no adapter.
    pub fn of(record: Record, run: &Path) -> Result<Self> {
        let artist = Artist::new(&record)?;
        let adapter = artist.adapter().to_owned();
        let (record, inbox) = (RwLock::new(record), Mutex::default());
        Ok(Self { record, inbox, run: run.into(), artist: Mutex::new(artist), adapter })
    }

    /// What is known of the run. Who draws too takes the artist first.
    pub fn record(&self) -> RwLockReadGuard<'_, Record> {
        self.record.read().unwrap_or_else(PoisonError::into_inner)
    }

    fn inbox(&self) -> MutexGuard<'_, Vec<Told>> {
        self.inbox.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes note of what the run tells. It never waits for those who draw.
    pub fn tell(&self, told: Told) {
        self.inbox().push(told);
        let mut record = match self.record.try_write() {
            Ok(record) => record,
            Err(TryLockError::Poisoned(record)) => record.into_inner(),
            Err(TryLockError::WouldBlock) => return,
        };
        self.inbox().drain(..).for_each(|told| record.hear(told));
    }

    /// Puts what the run told meanwhile into its record.
    pub fn catch_up(&self) {
        if self.inbox().is_empty() {
            return;
        }
        let mut record = self.record.write().unwrap_or_else(PoisonError::into_inner);
        self.inbox().drain(..).for_each(|told| record.hear(told));
    }

    /// The one who draws, when it is free. A picture that failed in the middle leaves nothing half done.
    pub fn artist(&self) -> MutexGuard<'_, Artist> {
        self.artist.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Draws a view that was checked.
    ///
    /// # Errors
    /// As for [`Artist::draw`].
    pub fn draw(&self, view: &View, size: [u32; 2]) -> Result<Picture> {
        let mut artist = self.artist();
        artist.draw(&self.record(), view, size)
    }
}

/// The run, the one that it is compared with, and whether the server ends.
pub(super) struct Shared {
    pub run: Pane,
    other: Option<Pane>,
    /// What a page can do to a run that is going.
    pub live: Option<Arc<Control>>,
    pub ended: AtomicBool,
}

impl Shared {
    /// # Errors
    /// [`Error::Input`] when one of the two is pulled and the other is not: their moments cannot be told from each other.
    pub fn new(run: Pane, other: Option<Pane>) -> Result<Self> {
        if let Some(other) = &other
            && other.record().info().is_pulled() != run.record().info().is_pulled()
        {
            return Err(Error::input(
                format!(
                    "{} and {} cannot be compared: only one of them is pulled",
                    run.record().name(),
                    other.record().name()
                ),
                "give two runs that are pulled, or two that are not",
            ));
        }
        Ok(Self { run, other, live: None, ended: AtomicBool::new(false) })
    }

    /// The same of a run that is going.
    pub fn going(self, control: Arc<Control>) -> Self {
        Self { live: Some(control), ..self }
    }

    /// Checks that the run has what a view names.
    ///
    /// # Errors
    /// [`Error::Input`] that names the key.
    pub fn check(&self, view: &View) -> Result<()> {
        let record = self.run.record();
        view.check(record.info(), record.states())
    }

    /// Size of a run's part of a picture (px).
    pub fn part(&self, [width, height]: [u32; 2]) -> [u32; 2] {
        [if self.other.is_some() { width / 2 } else { width }, height]
    }

    /// The run that is drawn at a place of the picture, given in shares of its width, and the place in its own part.
    pub fn pane_at(&self, right: f64) -> (&Pane, f64) {
        match &self.other {
            None => (&self.run, right),
            Some(_) if right < 0.5 => (&self.run, 2.0 * right),
            Some(other) => (other, 2.0 * right - 1.0),
        }
    }

    /// A view as it is of the run or of the other one.
    pub fn view_of(&self, pane: &Pane, view: &View) -> View {
        match &self.other {
            Some(other) if std::ptr::eq(other, pane) => self.other_view(&other.record(), view),
            _ => view.clone(),
        }
    }

    /// The same view of the other run: the same camera, layers, wires and colours, at the same strain or time.
    fn other_view(&self, other: &Record, view: &View) -> View {
        let (info, run) = (other.info(), self.run.record());
        let there = |of: &[usize], count: usize| of.iter().copied().filter(|number| *number < count).collect();
        View {
            state: other.state_at(run.moment_of(view.state)),
            range: view.range.or_else(|| run.range(view.colour)),
            hidden_layers: there(&view.hidden_layers, info.layers.len()),
            hidden_wires: there(&view.hidden_wires, info.wires.len()),
            selected: view.selected.filter(|wire| *wire < info.wires.len()),
            ..view.clone()
        }
    }

    /// Draws a view that [`Self::check`] has let through: both runs side by side, where there are two.
    ///
    /// # Errors
    /// [`Error::Input`] for a size that cannot be drawn, [`Error::Missing`] when the adapter is lost.
    pub fn draw(&self, view: &View, size: [u32; 2]) -> Result<Picture> {
        let Some(other) = &self.other else { return self.run.draw(view, size) };
        let part = self.part(size);
        let beside = self.view_of(other, view);
        let [left, right] = [self.run.draw(view, part)?, other.draw(&beside, part)?];
        let mut image = RgbImage::new(size[0], size[1]);
        imageops::replace(&mut image, &left.image, 0, 0);
        imageops::replace(&mut image, &right.image, i64::from(size[0] - part[0]), 0);
        Ok(Picture { image, took: left.took + right.took })
    }

    /// What does not depend on what is looked at, of both runs.
    pub fn facts(&self) -> Value {
        let mut facts = self.run.record().facts();
        facts["adapter"] = self.run.adapter.as_str().into();
        if let Some(live) = &self.live {
            facts["live"] = live.state();
        }
        if let Some(other) = &self.other {
            facts["other"] = other.record().facts();
            facts["label"] = self.label(&self.run).into();
            facts["other"]["label"] = self.label(other).into();
        }
        facts
    }

    /// What changes with the state, of both runs.
    pub fn state(&self, view: &View) -> Value {
        let mut state = self.run.record().state(view);
        if let Some(other) = &self.other {
            let beside = self.view_of(other, view);
            state["other"] = other.record().state(&beside);
        }
        state
    }

    /// What broke first, as markup, of each run.
    pub fn headlines(&self) -> Vec<(String, String)> {
        let all = [Some(&self.run), self.other.as_ref()];
        all.into_iter().flatten().map(|pane| (self.label(pane), pane.record().headline())).collect()
    }

    /// What a run is called: its scene, or its folder where the other one is a run of the same scene.
    fn label(&self, pane: &Pane) -> String {
        let name = |pane: &Pane| pane.record().name().to_owned();
        match &self.other {
            Some(other) if name(other) == name(&self.run) => pane.run.display().to_string(),
            _ => name(pane),
        }
    }

    /// What is wrong with the runs' folders, in sentences.
    pub fn notes(&self) -> Vec<String> {
        let others = self.other.iter().flat_map(|other| other.record().notes());
        self.run.record().notes().into_iter().chain(others).collect()
    }

    /// What a picture of a view shows, a line for each run.
    pub fn captions(&self, view: &View) -> Vec<String> {
        let Some(other) = &self.other else { return vec![self.run.record().caption(view.state)] };
        let beside = self.view_of(other, view);
        let of = |pane: &Pane, view: &View| format!("{}: {}", self.label(pane), pane.record().caption(view.state));
        vec![of(&self.run, view), of(other, &beside)]
    }

    /// A picked particle's numbers, and whether it is one of the other run.
    pub fn pick(&self, view: &View, size: [u32; 2], [right, down]: [f64; 2]) -> Option<Value> {
        let (pane, right) = self.pane_at(right);
        let view = self.view_of(pane, view);
        let mut artist = pane.artist();
        let picked = artist.pick(&pane.record(), &view, self.part(size), [right, down])?;
        drop(artist);
        let mut told = pane.record().particle(picked, view.state);
        told["other"] = json!(!std::ptr::eq(pane, &self.run));
        Some(told)
    }
}
