//! The layout that the file opens with.
//!
//! Rerun's blueprint builder cannot set cameras, backgrounds, grids or axis ranges, so the blueprint is logged by
//! hand: entity by entity into a store of its own, which is then sent with the recording.

use super::map::{Map, extent};
use super::{names, stream};
use crate::base::error::Result;
use crate::engine::view::RunInfo;
use rerun::blueprint::components::{
    BackgroundKind, ContainerKind, Corner2D, Eye3DKind, IncludedContent, PanelState, PlayState, RootContainer,
    VisualBounds2D,
};
use rerun::blueprint::datatypes::{TextLogColumn, TextLogColumnKind, TimelineColumn};
use rerun::datatypes::{Range2D, TimeRange};
use rerun::external::re_log_types::BlueprintActivationCommand;
use rerun::external::re_sdk_types::blueprint::archetypes as blueprint;
use rerun::external::uuid::Uuid;
use rerun::log::LogMsg;
use rerun::{RecordingStream, RecordingStreamBuilder, RecordingStreamResult};

/// Background of the strand's views: dark, so that bright stresses stand out.
const BACKGROUND: [u8; 3] = [17, 20, 26];
/// Length of strand that the close view shows [mm].
const CLOSE_VIEW: f32 = 20.0;
/// Width over height that the view of the whole strand and the close view have in a window of usual shape [-].
const ASPECTS: [f32; 2] = [6.0, 3.2];
/// Rerun's vertical field of view [rad].
const FIELD_OF_VIEW: f32 = 0.96;

/// Sends the default layout of a run with the recording.
///
/// # Errors
/// [`crate::base::error::Error::Io`] when Rerun refuses it.
pub(super) fn send(
    stream: &stream::Stream,
    application: &'static str,
    id: &str,
    info: &RunInfo,
    map: &Map,
) -> Result<()> {
    let messages = stream.checked(messages(application, id, info, map))?;
    let store = messages.iter().find_map(|message| match message {
        LogMsg::SetStoreInfo(store) => Some(store.info.store_id.clone()),
        _ => None,
    });
    let blueprint_id = stream.checked(store.ok_or("the layout has no store"))?;
    stream
        .rerun
        .send_blueprint(messages, BlueprintActivationCommand { blueprint_id, make_active: true, make_default: true });
    Ok(())
}

fn messages(application: &'static str, id: &str, info: &RunInfo, map: &Map) -> RecordingStreamResult<Vec<LogMsg>> {
    let (store, memory) = RecordingStreamBuilder::new(application)
        .enabled(true)
        .recording_id(format!("{id}-layout"))
        .blueprint()
        .memory()?;
    // Clock times would make two recordings of the same run differ.
    store.set_log_time_enabled(false);
    store.set_log_tick_enabled(false);
    store.set_time_sequence("blueprint", 0);
    let mut layout = Layout { store, ids: 0 };
    let root = layout.root(info, map)?;
    layout.panels(root)?;
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
    fn root(&mut self, info: &RunInfo, map: &Map) -> RecordingStreamResult<Item> {
        let whole = self.strand_view("Whole strand", info, None)?;
        let close = self.strand_view("Mid-section", info, Some(CLOSE_VIEW))?;
        let map = self.map_view(map)?;
        let states = self.view("StateTimeline", "State of each wire", "states", &["/states/**"])?;
        let lower = self.container(ContainerKind::Tabs, &[map, states], &[])?;
        let left = self.container(ContainerKind::Vertical, &[whole, close, lower], &[1.0, 2.4, 3.0])?;

        let curve = self.plot("Nominal stress over strain [MPa]", names::BODY_STRESS, Corner2D::RightBottom)?;
        let layers = self.plot("Stress by layer [MPa]", names::LAYER_STRESS, Corner2D::RightBottom)?;
        let wires = self.plot("Stress by wire [MPa]", names::WIRE_STRESS, Corner2D::RightTop)?;
        let broken = self.plot("Broken wires and bonds", names::BROKEN, Corner2D::LeftTop)?;
        let energy = self.plot("Energy [J]", names::ENERGY, Corner2D::LeftTop)?;
        let stresses = self.container(ContainerKind::Tabs, &[layers, wires, broken, energy], &[])?;
        let log = self.log_view()?;
        let about = self.view("TextDocument", "About this run", names::ABOUT, &["/about"])?;
        let notes = self.container(ContainerKind::Tabs, &[log, about], &[])?;
        let right = self.container(ContainerKind::Vertical, &[curve, stresses, notes], &[1.0, 1.0, 1.1])?;
        self.container(ContainerKind::Horizontal, &[left, right], &[1.7, 1.0])
    }

    fn strand_view(&mut self, name: &str, info: &RunInfo, length: Option<f32>) -> RecordingStreamResult<Item> {
        let mut contents = vec!["/strand/**".to_owned(), "/spheres/**".to_owned(), "/grips/**".to_owned()];
        if length.is_none() {
            // At this scale labels would only cover each other.
            let labels = (0..info.wires.len()).map(|w| names::marks(names::STRAND, info, w).join(&names::LABEL.into()));
            contents.extend(labels.map(|path| format!("- {path}")));
        }
        let contents: Vec<_> = contents.iter().map(String::as_str).collect();
        let view = self.view("3D", name, "/", &contents)?;
        let eye = eye(info, length);
        self.property(&view, "EyeControls3D", &eye)?;
        let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(BACKGROUND);
        self.property(&view, "Background", &background)?;
        self.property(&view, "LineGrid3D", &blueprint::LineGrid3D::new().with_visible(false))?;
        Ok(view)
    }

    fn map_view(&mut self, map: &Map) -> RecordingStreamResult<Item> {
        let view =
            self.view("2D", "Unrolled: a row per wire, position before loading [mm]", names::MAP, &["/map/**"])?;
        let length = f64::from(map.z[1] - map.z[0]);
        let range = Range2D {
            x_range: [f64::from(map.z[0]) - 0.14 * length, f64::from(map.z[1]) + 0.03 * length].into(),
            y_range: [-0.04 * length, f64::from(map.height + 6.0 * map.row)].into(),
        };
        self.property(&view, "VisualBounds2D", &blueprint::VisualBounds2D::new(VisualBounds2D(range)))?;
        let background = blueprint::Background::new(BackgroundKind::SolidColor).with_color(BACKGROUND);
        self.property(&view, "Background", &background)?;
        Ok(view)
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

    fn panels(&self, root: Item) -> RecordingStreamResult<()> {
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
            .with_timeline(stream::STRAIN)
            .with_play_state(PlayState::Following)
            .with_state(PanelState::Collapsed);
        self.store.log("time_panel", &time)
    }

    /// Ids are counted, not drawn, so that the same run gives the same file.
    fn item(&mut self, kind: &str) -> Item {
        self.ids += 1;
        let id = Uuid::from_u128(self.ids);
        Item { path: format!("{kind}/{id}"), id }
    }
}

/// The camera: the strand's axis to the right, seen from the side; either all of it at its longest, or a length
/// about its middle.
fn eye(info: &RunInfo, length: Option<f32>) -> blueprint::EyeControls3D {
    let [low, high] = extent(info);
    let longest = (high - low) * (1.0 + info.strain_end.unwrap_or(0.0) as f32);
    let middle = low + 0.5 * longest;
    let width = length.unwrap_or(1.04 * longest).min(1.04 * longest);
    let aspect = ASPECTS[usize::from(length.is_some())];
    // Room for labels above.
    let up = length.map_or(0.0, |length| 0.04 * length);
    let distance = 0.5 * width / aspect / (0.5 * FIELD_OF_VIEW).tan();
    blueprint::EyeControls3D::new()
        .with_kind(Eye3DKind::Orbital)
        .with_position([-distance, up + 0.15 * distance, middle])
        .with_look_target([0.0, up, middle])
        .with_eye_up([0.0, 1.0, 0.0])
}
