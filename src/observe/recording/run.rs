//! One run on its way into a recording: what waits to be sent, and what is known so far.

use super::chart::Chart;
use super::first_break::{FirstBreak, ViewDirection};
use super::headline::{Headline, about};
use super::layout::{Playback, Scenery};
use super::look::Look;
use super::map::Map;
use super::marks::Marks;
use super::paint::Palette;
use super::sections::Sections;
use super::sink::RERUN_VERSION;
use super::states::States;
use super::stream::{Instant, Stream, in_mm};
use super::tubes::Drawn;
use super::{bodies, curve, grips, layout, names, paint, particles};
use crate::base::error::Result;
use crate::base::finding::Notice;
use crate::engine::view::{BondState, RunInfo, Rupture, Sample, Snapshot};
use crate::observe::Observer;
use crate::observe::peaks::Peaks;
use crate::observe::summary::{Closing, Summariser};
use crate::observe::wording::OneDraw;
use crate::scene::spec::Spec;
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::{
    AnnotationContext, DynamicArchetype, EntityPath, Points3D, RecordingInfo, TextDocument, ViewCoordinates, components,
};
use std::sync::Arc;

/// A run that has started.
pub(super) struct Run {
    pub stream: Stream,
    info: Arc<RunInfo>,
    id: String,
    palette: Palette,
    map: Map,
    chart: Option<Chart>,
    states: States,
    marks: Marks,
    sections: Sections,
    ruptures: Vec<Rupture>,
    first: Option<FirstBreak>,
    /// What was recorded of each wire.
    drawn: Vec<Drawn>,
    headline: Headline,
    summariser: Summariser,
    snapshots: Vec<Arc<Snapshot>>,
    samples: Vec<Sample>,
    /// Snapshots that go out together.
    batch: usize,
    /// The last sample, the greatest strain of all samples, and strains of the first and the last rupture (-).
    last: Option<Instant>,
    strain_most: f64,
    ruptured: Option<[f64; 2]>,
    /// Snapshots whose section the eye already follows, and places of the first break that are sent.
    followed: [usize; 2],
}

impl Run {
    /// Sends what holds at all times, layout first.
    pub fn start(stream: Stream, info: &Arc<RunInfo>, id: &str, scene: &Spec, batch: usize) -> Result<Self> {
        let mut summariser = Summariser::new();
        summariser.start(info)?;
        let mut run = Self {
            stream,
            info: info.clone(),
            id: id.to_owned(),
            palette: Palette::new(scene.output.colour, info),
            map: Map::new(info),
            chart: Chart::new(info),
            states: States::new(info.wires.len()),
            marks: Marks::default(),
            sections: Sections::new(info),
            ruptures: Vec::new(),
            first: None,
            drawn: info.wires.iter().map(|_| Drawn::default()).collect(),
            headline: Headline::new(OneDraw::of(scene)),
            summariser,
            snapshots: Vec::new(),
            samples: Vec::new(),
            batch,
            last: None,
            strain_most: 0.0,
            ruptured: None,
            followed: [0; 2],
        };
        run.send_fixed()?;
        Ok(run)
    }

    pub fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.summariser.sample(sample)?;
        self.last = Some(curve::instant(sample));
        self.strain_most = self.strain_most.max(sample.strain);
        self.samples.push(sample.clone());
        Ok(())
    }

    pub fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.states.snapshot(&self.info, snapshot, curve::instant(&snapshot.sample));
        self.sections.snapshot(snapshot);
        self.palette.expect(snapshot);
        if let Some(first) = &mut self.first {
            first.snapshot(snapshot);
        }
        self.snapshots.push(snapshot.clone());
        if self.snapshots.len() >= self.batch { self.send() } else { Ok(()) }
    }

    pub fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.summariser.rupture(rupture)?;
        let [from, to] = self.ruptured.unwrap_or([rupture.strain; 2]);
        self.ruptured = Some([from.min(rupture.strain), to.max(rupture.strain)]);
        self.states.set(rupture.wire, BondState::Broken, Instant::from(rupture));
        self.marks.add(&self.info, rupture);
        self.headline.rupture(rupture);
        self.ruptures.push(rupture.clone());
        if self.first.is_none() {
            self.first = Some(FirstBreak::new(rupture));
            self.palette.set_first(rupture.bond);
        }
        Ok(())
    }

    pub fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.summariser.peaks(peaks)
    }

    pub fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.marks.add_notice(notice);
        self.headline.notice(notice);
        self.summariser.notice(notice)
    }

    /// Sends the rest, and what only the end knows: the result, and a layout whose close view looks at the main fracture
    /// from the side where bonds broke.
    pub fn finish(&mut self, scene: &Spec, active: bool) -> Result<BlueprintActivationCommand> {
        self.send()?;
        // Bonds and cost are not shown.
        let summary = self.summariser.summary(scene, 0, Closing::default());
        self.headline.send_end(&self.stream, &self.info, &summary)?;
        let look = self.look();
        let direction = look.direction(|step| self.sections.before(step, look.rest_z).unwrap_or_default());
        if let Some(first) = &self.first {
            first.send(&self.stream, &self.info, direction, 0)?;
            self.sections.send_focus(&self.stream, &self.info, look.rest_z, 0)?;
        }
        layout::send(&self.stream, &format!("{}-layout-end", self.id), &self.scenery(&look, direction), active)
    }

    fn look(&self) -> Look {
        Look::new(&self.info, &self.ruptures, self.sections.middle())
    }

    fn scenery<'a>(&'a self, look: &'a Look, direction: ViewDirection) -> Scenery<'a> {
        Scenery {
            info: &self.info,
            map: &self.map,
            chart: self.chart.as_ref(),
            look,
            direction,
            target: self.sections.last(look.rest_z).unwrap_or([0.0, 0.0, look.rest_z]),
            playback: self.playback(),
        }
    }

    /// What is known so far of the range that is played; before the first sample, what the scene expects.
    fn playback(&self) -> Playback {
        let micro = |strain: f64| (strain * 1e6).round() as i64;
        if !self.info.is_pulled() {
            // Before anything is known, at the clock's speed.
            return Playback::Time { end: self.last.map_or(20.0, |last| last.time) };
        }
        let end = self.last.map_or(self.info.strain_end.unwrap_or(1.0), |_| self.strain_most);
        let selection = self.ruptured.map(|[from, to]| {
            let room = (0.05 * end).max(0.1 * (to - from));
            [micro((from - room).max(0.0)), micro((to + room).min(end))]
        });
        Playback::Strain { end: micro(end).max(1), selection }
    }

    fn send_fixed(&mut self) -> Result<()> {
        let (stream, info) = (&self.stream, &self.info);
        layout::send(stream, &format!("{}-layout", self.id), &self.scenery(&self.look(), ViewDirection::START), true)?;
        // Rerun hands on data before messages; without this the layout would come last, and a viewer that is still
        // loading would invent one.
        stream.checked(stream.rerun.flush_blocking())?;
        self.send_properties()?;
        stream.fixed("/", &ViewCoordinates::RIGHT_HAND_Z_UP())?;
        stream.fixed("/", &annotation())?;
        self.map.send(stream, info)?;
        if let Some(scale) = self.palette.scale() {
            self.map.send_colour_bar(stream, &scale)?;
        }
        curve::send_names(stream, info)?;
        if let Some(chart) = &self.chart {
            chart.send_fixed(stream, info)?;
        }
        grips::send_style(stream)?;
        bodies::send_style(stream, info)?;
        particles::send_styles(stream, info)?;
        Sections::send_style(stream)?;
        States::send_style(stream, info)?;
        self.send_sphere_radii()?;
        self.headline.send(&self.stream, &self.info)
    }

    fn send_properties(&self) -> Result<()> {
        let info = &self.info;
        self.stream.fixed(EntityPath::properties(), &RecordingInfo::new().with_name(info.name.as_str()))?;
        let text = |value: String| [components::Text::from(value)];
        let run = DynamicArchetype::new("strandsnap.Run")
            .with_component::<components::Text>("scene", text(info.name.clone()))
            .with_component::<components::Text>("about", text(info.about.clone()))
            .with_component::<components::Text>("layers", text(info.layers.join(", ")))
            .with_component::<components::Text>("wires", text(info.wires.len().to_string()))
            .with_component::<components::Text>("particles", text(info.particles.to_string()))
            .with_component::<components::Text>("strandsnap_version", text(env!("CARGO_PKG_VERSION").to_owned()))
            .with_component::<components::Text>("rerun_version", text(RERUN_VERSION.to_owned()));
        self.stream.fixed(EntityPath::properties().join(&EntityPath::from("run")), &run)?;
        self.stream.fixed(names::ABOUT, &TextDocument::from_markdown(about(info)))
    }

    fn send_sphere_radii(&self) -> Result<()> {
        let info = &self.info;
        if info.particles == info.wire_particles {
            return Ok(());
        }
        let radii = info.radius[info.wire_particles..].iter().map(|r| in_mm([*r])[0]);
        self.stream.fixed(names::SPHERES, &Points3D::update_fields().with_radii(radii))
    }

    /// Sends everything that waits.
    fn send(&mut self) -> Result<()> {
        let instants: Vec<_> = self.snapshots.iter().map(|s| curve::instant(&s.sample)).collect();
        if !instants.is_empty() {
            let (info, palette, snapshots) = (&self.info, &self.palette, &self.snapshots);
            let batch = particles::Batch { info, palette, instants: &instants, snapshots };
            batch.send(&self.stream, &mut self.drawn)?;
            grips::send(&self.stream, &self.info, &instants, &self.snapshots)?;
            bodies::send(&self.stream, &self.info, &instants, &self.snapshots)?;
        }
        if !self.samples.is_empty() {
            curve::send(&self.stream, &self.info, &self.samples)?;
            if let Some(chart) = &mut self.chart {
                chart.send(&self.stream, &self.info, &self.samples)?;
            }
        }
        self.states.send(&self.stream, &self.info)?;
        self.send_ruptures()?;
        self.snapshots.clear();
        self.samples.clear();
        Ok(())
    }

    fn send_ruptures(&mut self) -> Result<()> {
        let new = self.marks.send(&self.stream, &self.info, &self.map)?;
        if let Some(chart) = self.chart.as_ref().filter(|_| !new.is_empty()) {
            chart.send_ruptures(&self.stream, &self.info, &new)?;
        }
        self.headline.send(&self.stream, &self.info)?;
        let [focused, placed] = self.followed;
        if let Some(first) = &self.first {
            first.send(&self.stream, &self.info, ViewDirection::START, placed)?;
        }
        self.sections.send_focus(&self.stream, &self.info, self.look().rest_z, focused)?;
        self.followed = [self.sections.len(), self.first.as_ref().map_or(0, FirstBreak::len)];
        Ok(())
    }
}

/// Names and colours of bond states, shown where a particle is clicked.
fn annotation() -> AnnotationContext {
    let colours = [0x3E6F8EFF, 0xD9A441FF, paint::BROKEN, paint::NEUTRAL];
    let classes = particles::STATE_NAMES.iter().zip(colours).zip(0u16..);
    AnnotationContext::new(classes.map(|((name, colour), i)| (i, *name, rerun::Rgba32::from(colour))))
}
