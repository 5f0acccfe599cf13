//! The layout that the file opens with.
//!
//! Rerun's blueprint builder cannot set cameras, backgrounds, grids or axis ranges, so the blueprint is logged by
//! hand: entity by entity into a store of its own, which is then sent with the recording.

use super::chart::Chart;
use super::first_break::ViewDirection;
use super::look::Look;
use super::map::{self, Map};
use super::sections::thickness;
use super::stream::in_mm;
use super::{names, stream, tubes};
use crate::base::error::Result;
use crate::engine::view::RunInfo;
use crate::observe::unrolled::ends;
use crate::observe::wording::layer_words;
use rerun::blueprint::VisualizerComponentMapping;
use rerun::blueprint::components::{
    self, AbsoluteTimeRange, BackgroundKind, ContainerKind, Corner2D, Eye3DKind, Fps, IncludedContent, PanelState,
    PlayState, PlaybackSpeed, RootContainer, VisualBounds2D, VisualizerInstructionId,
};
use rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use rerun::datatypes::{self, Range2D, TimeRange, TimeRangeBoundary, VisibleTimeRange};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use rerun::external::uuid::Uuid;
use rerun::log::LogMsg;
use rerun::{EntityPath, RecordingStream, RecordingStreamBuilder, RecordingStreamResult};
use std::hash::{DefaultHasher, Hash, Hasher};

/// Background of maps and charts: dark, so that bright stresses stand out.
const BACKGROUND: [u8; 3] = [17, 20, 26];
/// Background of the strand's views: light enough to see the dark end of the colour map on it, shaded.
const SPACE: [u8; 3] = [62, 68, 78];
/// Width over height that the view of the whole strand has in a window of usual shape (-).
const ASPECT: f32 = 6.5;
/// The same of the view of free spheres, which has the room of all others (-).
const SPHERES_ASPECT: f32 = 1.2;
/// Share of a view of everything that is left free about it (-).
const ROOM: f32 = 1.08;
/// How far below the middle of its view a strand lies, over half the height of the view (-).
const LABEL: f32 = 0.25;
/// How long the viewer takes to play a run (s).
const LASTS: f64 = 20.0;
/// Rerun's vertical field of view (rad).
const FIELD_OF_VIEW: f32 = 0.96;

/// What a layout shows.
pub(super) struct Scenery<'a> {
    pub info: &'a RunInfo,
    pub map: &'a Map,
    pub chart: Option<&'a Chart>,
    /// What the close view shows, and how it looks at the body, about `target` (mm).
    pub look: &'a Look,
    pub direction: ViewDirection,
    pub target: [f32; 3],
    pub playback: Playback,
}

/// What the viewer plays, from start to end in [`LASTS`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Playback {
    /// The timeline of simulated time, up to `end` (s): without strain nothing lies along the timeline of strain.
    Time { end: f64 },
    /// The timeline of strain, up to `end` (µm/m). `selection` is the stretch around the ruptures, which the viewer's
    /// button for loops repeats.
    Strain { end: i64, selection: Option<[i64; 2]> },
}

/// Sends a layout with the recording under an id of its own. A viewer that is open takes it up at once when `active`;
/// otherwise when the user asks for the default.
pub(super) fn send(
    stream: &stream::Stream,
    id: &str,
    scenery: &Scenery,
    active: bool,
) -> Result<BlueprintActivationCommand> {
    let messages = stream.checked(messages(id, scenery))?;
    let store = messages.iter().find_map(|message| match message {
        LogMsg::SetStoreInfo(store) => Some(store.info.store_id.clone()),
        _ => None,
    });
    let blueprint_id = stream.checked(store.ok_or("the layout has no store"))?;
    let activation = BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true };
    stream.rerun.send_blueprint(messages, BlueprintActivationCommand { make_active: active, ..activation.clone() });
    Ok(activation)
}

fn messages(id: &str, scenery: &Scenery) -> RecordingStreamResult<Vec<LogMsg>> {
    let (store, memory) = RecordingStreamBuilder::new(names::APPLICATION)
        .enabled(true)
        .recording_id(id.to_owned())
        .blueprint()
        .memory()?;
    // Clock times would make two recordings of the same run differ.
    store.set_log_time_enabled(false);
    store.set_log_tick_enabled(false);
    store.set_time_sequence("blueprint", 0);
    let mut layout = Layout { store, ids: first_id(id) };
    let root = layout.root(scenery)?;
    layout.panels(root, scenery.playback)?;
    Ok(memory.take())
}

struct Layout {
    store: RecordingStream,
    ids: u128,
}

/// A view or a container by its path in the blueprint store.
#[derive(Clone)]
struct Item {
    path: String,
    id: Uuid,
}

impl Layout {
    fn root(&mut self, scenery: &Scenery) -> RecordingStreamResult<Item> {
        let whole = self.whole_view(scenery)?;
        let left = if scenery.info.wires.is_empty() {
            let scale = self.scale_view(scenery.map)?;
            self.container(ContainerKind::Vertical, &[whole, scale], &[6.0, 1.0])?
        } else {
            let close = self.close_views(scenery)?;
            let map = self.map_view(scenery)?;
            let states = self.view("StateTimeline", "State of each wire", "states", &["/states/**"])?;
            let lower = self.container(ContainerKind::Tabs, &[map, states], &[])?;
            self.container(ContainerKind::Vertical, &[whole, close, lower], &[1.1, 2.2, 3.3])?
        };
        let headline =
            self.view("TextDocument", "What happened", names::HEADLINE, &[&format!("/{}", names::HEADLINE)])?;
        let curves = self.curves(scenery)?;
        let log = self.log_view()?;
        let about = self.view("TextDocument", "About this run", names::ABOUT, &["/about"])?;
        let notes = self.container(ContainerKind::Tabs, &[log, about], &[])?;
        let right = self.container(ContainerKind::Vertical, &[headline, curves, notes], &[1.45, 1.6, 1.1])?;
        self.container(ContainerKind::Horizontal, &[left, right], &[1.5, 1.0])
    }

    /// The drawing of stress over strain in front, where there is one, then plots over the time cursor.
    fn curves(&mut self, scenery: &Scenery) -> RecordingStreamResult<Item> {
        let mut tabs = Vec::new();
        if let Some(chart) = scenery.chart {
            tabs.push(self.chart_view(chart)?);
        }
        if !scenery.info.wires.is_empty() {
            tabs.push(self.plot("Nominal stress [MPa]", names::BODY_STRESS, Corner2D::RightBottom)?);
            tabs.push(self.plot("Layers [MPa]", names::LAYER_STRESS, Corner2D::RightBottom)?);
            tabs.push(self.plot("Wires [MPa]", names::WIRE_STRESS, Corner2D::RightTop)?);
            tabs.push(self.plot("Broken", names::BROKEN, Corner2D::LeftTop)?);
        }
        tabs.push(self.plot("Energy [J]", names::ENERGY, Corner2D::LeftTop)?);
        self.container(ContainerKind::Tabs, &tabs, &[])
    }

    fn whole_view(&mut self, scenery: &Scenery) -> RecordingStreamResult<Item> {
        // As particles, which are cheaper to draw, and as good at this scale.
        let mut contents =
            ["strand/**", "spheres/**", "grips/**", names::FIRST_BREAK_FAR].map(|what| format!("/{what}")).to_vec();
        contents.extend(bodies(scenery.info));
        let name = if scenery.info.wires.is_empty() { "Spheres" } else { "Whole strand" };
        self.strand_view(name, &contents, &whole_eye(scenery))
    }

    /// The main fracture close up. A break below the outermost layer is shown without the layers over it as well: nobody
    /// would see it otherwise.
    fn close_views(&mut self, scenery: &Scenery) -> RecordingStreamResult<Item> {
        let info = scenery.info;
        let outermost = info.layers.len().saturating_sub(1);
        let outside = self.close_view(&scenery.look.name(), scenery, outermost, Wires::Tubes)?;
        let mut shown = Vec::new();
        if let Some(layer) = scenery.look.layer {
            let off: Vec<_> = (layer + 1..=outermost).map(|layer| layer_words(info, layer)).collect();
            let name = format!("The same without the {}", off.join(" and "));
            let inside = self.close_view(&name, scenery, layer, Wires::Tubes)?;
            let name = format!("Particles without the {}", off.join(" and "));
            let particles = self.close_view(&name, scenery, layer, Wires::Particles)?;
            shown.push(self.container(ContainerKind::Tabs, &[inside, particles], &[])?);
        }
        let particles = self.close_view("Particles", scenery, outermost, Wires::Particles)?;
        shown.insert(0, self.container(ContainerKind::Tabs, &[outside, particles], &[])?);
        let shares = vec![1.0; shown.len()];
        self.container(ContainerKind::Horizontal, &shown, &shares)
    }

    /// Layers up to `outermost`.
    fn close_view(
        &mut self,
        name: &str,
        scenery: &Scenery,
        outermost: usize,
        wires: Wires,
    ) -> RecordingStreamResult<Item> {
        let info = scenery.info;
        let shown: Vec<_> = wires_of_all(info).filter(|number| info.wires[*number].layer <= outermost).collect();
        let wire = |number: &usize| names::wire(names::STRAND, info, *number);
        let mut contents = vec!["/spheres/**".to_owned()];
        contents.extend([names::FIRST_BREAK, names::FOCUS].map(|what| format!("/{what}")));
        contents.extend(bodies(info));
        contents.extend(
            shown.iter().flat_map(|n| [wire(n), names::marks(names::STRAND, info, *n)]).map(|path| path.to_string()),
        );
        let ViewDirection { eye, up } = scenery.direction;
        let distance = 2.0 * thickness(info).max(1e-3);
        let controls = blueprint::EyeControls3D::new()
            .with_kind(Eye3DKind::Orbital)
            .with_position(offset(scenery.target, eye, distance))
            .with_look_target(scenery.target)
            .with_eye_up(up)
            .with_tracking_entity(format!("/{}", names::FOCUS));
        let view = self.strand_view(name, &contents, &controls)?;
        if wires == Wires::Tubes {
            let mappings = tubes::mappings();
            shown.iter().try_for_each(|n| self.drawn_by(tubes::visualizer(), &mappings, &view, &wire(n)))?;
        }
        Ok(view)
    }

    /// Makes a view draw an entity by one visualizer alone, from the components that `mappings` name.
    fn drawn_by(
        &mut self,
        visualizer: &str,
        mappings: &[VisualizerComponentMapping],
        view: &Item,
        entity: &EntityPath,
    ) -> RecordingStreamResult<()> {
        let path = blueprint::ViewContents::blueprint_base_visualizer_path_for_entity(view.id, entity);
        let Item { id, .. } = self.item("visualizer");
        let only = VisualizerInstructionId(id.into());
        self.store.log(path.clone(), &blueprint::ActiveVisualizers::new([only]))?;
        let mappings = mappings.iter().cloned().map(components::VisualizerComponentMapping);
        let how = blueprint::VisualizerInstruction::new(visualizer).with_component_map(mappings);
        self.store.log(path.join(&EntityPath::from_single_string(id.to_string())), &how)
    }

    fn strand_view(
        &mut self,
        name: &str,
        contents: &[String],
        eye: &blueprint::EyeControls3D,
    ) -> RecordingStreamResult<Item> {
        let contents: Vec<_> = contents.iter().map(String::as_str).collect();
        let view = self.view("3D", name, "/", &contents)?;
        self.property(&view, "EyeControls3D", eye)?;
        self.background(&view, SPACE)?;
        self.property(&view, "LineGrid3D", &blueprint::LineGrid3D::new().with_visible(false))?;
        Ok(view)
    }

    fn map_view(&mut self, scenery: &Scenery) -> RecordingStreamResult<Item> {
        let wires: Vec<_> = wires_of_all(scenery.info).map(|n| names::wire(names::STRAND, scenery.info, n)).collect();
        let mut contents = vec![format!("/{}/**", names::MAP)];
        contents.extend(wires.iter().map(EntityPath::to_string));
        let contents: Vec<_> = contents.iter().map(String::as_str).collect();
        let view = self.view("2D", "Unrolled: a row per wire; numbers: order of break", "/", &contents)?;
        self.bounds(&view, scenery.map.bounds())?;
        self.background(&view, BACKGROUND)?;
        let mappings = map::mappings();
        wires.iter().try_for_each(|wire| self.drawn_by(map::visualizer(), &mappings, &view, wire))?;
        Ok(view)
    }

    /// The bar of colours alone, where there are no rows.
    fn scale_view(&mut self, map: &Map) -> RecordingStreamResult<Item> {
        let bar = format!("/{}/{}/**", names::MAP, names::COLOUR_BAR);
        let view = self.view("2D", "Colours", names::MAP, &[&bar])?;
        self.bounds(&view, map.bar_bounds())?;
        self.background(&view, BACKGROUND)?;
        Ok(view)
    }

    fn chart_view(&mut self, chart: &Chart) -> RecordingStreamResult<Item> {
        let view = self.view("2D", "Nominal stress over strain", names::CHART, &[&format!("/{}/**", names::CHART)])?;
        self.bounds(&view, chart.bounds())?;
        self.background(&view, BACKGROUND)?;
        // The curve is the sum of its pieces up to the cursor.
        let range = TimeRange { start: TimeRangeBoundary::Infinite, end: TimeRangeBoundary::AT_CURSOR };
        let timelines = [stream::STEP, stream::TIME, stream::STRAIN];
        let ranges = timelines.map(|timeline| VisibleTimeRange { timeline: timeline.into(), range });
        self.property(&view, "VisibleTimeRanges", &blueprint::VisibleTimeRanges::new(ranges))?;
        Ok(view)
    }

    fn bounds(&mut self, view: &Item, [x, y]: [[f64; 2]; 2]) -> RecordingStreamResult<()> {
        let range = Range2D { x_range: x.into(), y_range: y.into() };
        self.property(view, "VisualBounds2D", &blueprint::VisualBounds2D::new(VisualBounds2D(range)))
    }

    fn background(&mut self, view: &Item, colour: [u8; 3]) -> RecordingStreamResult<()> {
        let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(colour);
        self.property(view, "Background", &background)
    }

    fn plot(&mut self, name: &str, origin: &str, legend: Corner2D) -> RecordingStreamResult<Item> {
        let view = self.view("TimeSeries", name, origin, &[&format!("/{origin}/**")])?;
        self.property(&view, "PlotLegend", &blueprint::PlotLegend::new().with_corner(legend))?;
        // Otherwise a plot shows only what lies close to the time cursor.
        self.property(&view, "TimeAxis", &blueprint::TimeAxis::new().with_view_range(TimeRange::EVERYTHING))?;
        Ok(view)
    }

    fn log_view(&mut self) -> RecordingStreamResult<Item> {
        let view = self.view("TextLog", "Ruptures", names::LOG, &[&format!("/{}", names::LOG)])?;
        let time = TimelineColumn { visible: true.into(), timeline: stream::STRAIN.into() };
        let column = |kind, visible: bool| TextLogColumn { visible: visible.into(), kind };
        let columns = blueprint::TextLogColumns::new().with_timeline_columns([time]).with_text_log_columns([
            column(TextLogColumnKind::EntityPath, false),
            column(TextLogColumnKind::LogLevel, false),
            column(TextLogColumnKind::Body, true),
        ]);
        self.property(&view, "TextLogColumns", &columns)?;
        Ok(view)
    }

    fn view(&mut self, class: &str, name: &str, origin: &str, contents: &[&str]) -> RecordingStreamResult<Item> {
        let view = self.item("view");
        let settings = blueprint::ViewBlueprint::new(class).with_display_name(name).with_space_origin(origin);
        self.store.log(view.path.as_str(), &settings)?;
        self.property(&view, "ViewContents", &blueprint::ViewContents::new(contents.iter().copied()))?;
        Ok(view)
    }

    fn property(&self, view: &Item, name: &str, what: &dyn rerun::AsComponents) -> RecordingStreamResult<()> {
        self.store.log(format!("{}/{name}", view.path), what)
    }

    fn container(&mut self, kind: ContainerKind, contents: &[Item], shares: &[f32]) -> RecordingStreamResult<Item> {
        let container = self.item("container");
        let mut settings = blueprint::ContainerBlueprint::new(kind)
            .with_contents(contents.iter().map(|item| IncludedContent(item.path.as_str().into())));
        settings = match kind {
            ContainerKind::Horizontal => settings.with_col_shares(shares.iter().copied()),
            ContainerKind::Vertical => settings.with_row_shares(shares.iter().copied()),
            ContainerKind::Tabs => settings.with_active_tab(contents[0].path.as_str()),
            ContainerKind::Grid => settings,
        };
        self.store.log(container.path.as_str(), &settings)?;
        Ok(container)
    }

    fn panels(&self, root: Item, playback: Playback) -> RecordingStreamResult<()> {
        let viewport = blueprint::ViewportBlueprint::new()
            .with_root_container(RootContainer(root.id.into()))
            .with_auto_layout(false)
            .with_auto_views(false);
        self.store.log("viewport", &viewport)?;
        let collapsed = blueprint::PanelBlueprint::new().with_state(PanelState::Collapsed);
        self.store.log("blueprint_panel", &collapsed)?;
        self.store.log("selection_panel", &collapsed)?;
        // Following shows the last state of a finished run, and the newest of a running one.
        let time = blueprint::TimePanelBlueprint::new()
            .with_play_state(PlayState::Following)
            .with_state(PanelState::Collapsed);
        let time = match playback {
            Playback::Time { end } => {
                time.with_timeline(stream::TIME).with_playback_speed(PlaybackSpeed((end / LASTS).into()))
            }
            Playback::Strain { end, selection } => {
                let time = time.with_timeline(stream::STRAIN).with_fps(Fps((end as f64 / LASTS).into()));
                match selection {
                    Some([min, max]) => {
                        let range = datatypes::AbsoluteTimeRange { min: min.into(), max: max.into() };
                        time.with_time_selection(AbsoluteTimeRange(range))
                    }
                    None => time,
                }
            }
        };
        self.store.log("time_panel", &time)
    }

    /// Ids are counted, not drawn, so that the same run gives the same file; they start elsewhere in each layout,
    /// because the viewer keeps what it knows of a view under its id.
    fn item(&mut self, kind: &str) -> Item {
        self.ids = self.ids.wrapping_add(1);
        let id = Uuid::from_u128(self.ids);
        Item { path: format!("{kind}/{id}"), id }
    }
}

fn first_id(layout: &str) -> u128 {
    let mut hasher = DefaultHasher::new();
    layout.hash(&mut hasher);
    u128::from(hasher.finish()) << 64
}

/// How wires are drawn.
#[derive(Clone, Copy, PartialEq)]
enum Wires {
    Tubes,
    Particles,
}

/// Rigid bodies, where there are any.
fn bodies(info: &RunInfo) -> Option<String> {
    (!info.bodies.is_empty()).then(|| format!("/{}/**", names::BODIES))
}

fn wires_of_all(info: &RunInfo) -> std::ops::Range<usize> {
    0..info.wires.len()
}

/// The camera that sees everything at its longest, the axis to the right and below the middle, so that there is room for
/// a label.
fn whole_eye(scenery: &Scenery) -> blueprint::EyeControls3D {
    let info = scenery.info;
    let [low, high] = ends(info).map(|z| z as f32);
    let longest = (high - low) * (1.0 + info.strain_end.unwrap_or(0.0) as f32);
    let aspect = if info.wires.is_empty() { SPHERES_ASPECT } else { ASPECT };
    // Half of what is seen upwards: all of the length and all of the thickness are to be in it.
    let half = (0.5 * ROOM * longest / aspect).max(ROOM * across(info));
    let middle = [0.0, 0.0, low + 0.5 * longest];
    let distance = half / (0.5 * FIELD_OF_VIEW).tan();
    let ViewDirection { eye, up } = scenery.direction;
    let label = if info.wires.is_empty() { 0.0 } else { LABEL * half };
    let target = offset(middle, up, label);
    blueprint::EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position(offset(offset(target, eye, distance), up, 0.15 * distance))
        .with_look_target(target)
        .with_eye_up(up)
}

/// Largest distance of anything from the z axis before loading (mm).
fn across(info: &RunInfo) -> f32 {
    let bodies = info.rest_position.iter().zip(&info.radius);
    let [across] = in_mm([bodies.map(|([x, y, _], r)| x.hypot(*y) + r).fold(0.0, f32::max)]);
    across
}

fn offset(from: [f32; 3], direction: [f32; 3], by: f32) -> [f32; 3] {
    std::array::from_fn(|axis| from[axis] + by * direction[axis])
}
