//! Reading a recording back: for tests, and to check a finished run against its tables.

use super::names::{CONTACT_PRESSURE, PLASTIC_STRAIN, STRESS, UTILISATION};
use super::{names, stream};
use crate::base::error::{Error, Result};
use rerun::blueprint::components::{AbsoluteTimeRange, VisualizerComponentMapping};
use rerun::external::arrow::array::Array as _;
use rerun::external::re_log_encoding::{Decodable as _, DecoderApp, StreamFooter};
use rerun::external::re_sdk_types::blueprint::archetypes::{TimePanelBlueprint, ViewBlueprint, VisualizerInstruction};
use rerun::log::{Chunk, LogMsg};
use rerun::{ComponentDescriptor, ComponentIdentifier, Points3D, Scalars, StoreKind, TextDocument, TextLog};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::File;
use std::io::{BufReader, Read, Seek, SeekFrom};
use std::path::Path;

/// Paths of entities, as a recording that is read back has them.
pub mod paths {
    use super::names;
    use crate::engine::view::RunInfo;

    fn root(name: &str) -> String {
        format!("/{name}")
    }

    /// Strain of the body.
    pub fn body_strain() -> String {
        root(names::BODY_STRAIN)
    }

    /// Nominal stress of the body.
    pub fn body_stress() -> String {
        root(names::BODY_STRESS)
    }

    /// Stress of the layers.
    pub fn layer_stress() -> String {
        root(names::LAYER_STRESS)
    }

    /// Force of the layers.
    pub fn layer_force() -> String {
        root(names::LAYER_FORCE)
    }

    /// Force of the materials.
    pub fn material_force() -> String {
        root(names::MATERIAL_FORCE)
    }

    /// Stress of the wires of a layer.
    pub fn wire_stress(info: &RunInfo, layer: usize) -> String {
        names::layer(names::WIRE_STRESS, info, layer).to_string()
    }

    /// Wires and bonds broken so far.
    pub fn broken() -> String {
        root(names::BROKEN)
    }

    /// Energy ledger.
    pub fn energy() -> String {
        root(names::ENERGY)
    }

    /// Particles of a wire.
    pub fn wire(info: &RunInfo, wire: usize) -> String {
        names::wire(names::STRAND, info, wire).to_string()
    }
}

/// What one entity holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Entity {
    /// Rows that lie on timelines.
    pub rows: usize,
    /// Rows that hold at all times.
    pub static_rows: usize,
    /// Timelines of its rows.
    pub timelines: BTreeSet<String>,
    /// Components by name, such as `Points3D:positions`.
    pub components: BTreeMap<String, Component>,
}

/// What an entity holds of one component.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Component {
    /// Type of its values, such as `rerun.components.Position3D`.
    pub kind: Option<String>,
    /// Rows that say something of it.
    pub rows: usize,
    /// Values of all rows.
    pub values: usize,
    /// Bytes of those values, without offsets and padding.
    pub bytes: usize,
}

/// What a layout says about views and time.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Layout {
    /// Names of its views.
    pub views: Vec<String>,
    /// The timeline that it opens with.
    pub timeline: String,
    /// Units of that timeline that pass in a second, where it counts (1/s).
    pub per_second: Option<f64>,
    /// Speed against the clock, where the timeline is one of time (-).
    pub speed: Option<f64>,
    /// Selected stretch of that timeline.
    pub selection: Option<[i64; 2]>,
    /// What views draw in a way of their own: entity, and the component that it is drawn from.
    pub sources: BTreeSet<(String, String)>,
}

impl Layout {
    fn add(&mut self, chunk: &Chunk) {
        let text = |component: ComponentDescriptor| {
            let all: Vec<String> =
                chunk.iter_slices::<String>(component.component).flatten().map(|t| t.to_string()).collect();
            all
        };
        let number =
            |component: ComponentDescriptor| chunk.iter_slices::<f64>(component.component).flatten().next().copied();
        self.views.extend(text(ViewBlueprint::descriptor_display_name()));
        self.timeline.extend(text(TimePanelBlueprint::descriptor_timeline()));
        self.per_second = number(TimePanelBlueprint::descriptor_fps()).or(self.per_second);
        self.speed = number(TimePanelBlueprint::descriptor_playback_speed()).or(self.speed);
        let selection =
            chunk.iter_component::<AbsoluteTimeRange>(TimePanelBlueprint::descriptor_time_selection().component);
        let ends = selection.flat_map(|range| range.as_slice().to_vec()).next();
        self.selection = ends.map(|range| [range.min.0, range.max.0]).or(self.selection);
        let path = chunk.entity_path().to_string();
        let entity = path.split("/overrides").nth(1).and_then(|path| path.split("/visualizers").next());
        let map = VisualizerInstruction::descriptor_component_map().component;
        for mapping in chunk.iter_component::<VisualizerComponentMapping>(map).flat_map(|all| all.as_slice().to_vec()) {
            if let (Some(entity), Some(source)) = (entity, &mapping.source_component) {
                self.sources.insert((entity.to_owned(), source.to_string()));
            }
        }
    }
}

/// What a recording holds.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct RecordingContents {
    /// Id of the recording.
    pub id: String,
    /// Entities by path.
    pub entities: BTreeMap<String, Entity>,
    /// Lines of the rupture log with their strain (10⁻⁶), in the order of the file.
    pub log: Vec<(i64, String)>,
    /// Positions of points in space (mm) by entity: those of the last row.
    pub last_positions: BTreeMap<String, Vec<[f32; 3]>>,
    /// Level of each line of the log.
    pub levels: Vec<String>,
    /// Fields of the particles by entity, then by name: those of the last row.
    pub last_fields: BTreeMap<String, BTreeMap<String, Vec<f32>>>,
    /// What the headline says in the end.
    pub headline: String,
    /// Strain (10⁻⁶) and nominal stress of the body (MPa), in the order of the file.
    pub nominal_stress: Vec<(i64, f64)>,
    /// Scalars by entity: step and values of each row, in the order of steps.
    pub series: BTreeMap<String, Vec<(i64, Vec<f64>)>>,
    /// Whether a layout is embedded, ahead of all data, so that a viewer opens with it.
    pub layout: bool,
    /// Layouts: one from the start, one from the end, when the place of the first break is known.
    pub layouts: usize,
    /// The layout that stands when all is read.
    pub last_layout: Layout,
    /// Messages, for an estimate of overhead.
    pub messages: usize,
}

/// Reads a recording.
///
/// # Errors
/// [`Error::Io`] when the file cannot be read or is not a whole recording.
pub fn contents(path: &Path) -> Result<RecordingContents> {
    let broken = |e: &dyn std::fmt::Display| Error::io("cannot read", path, std::io::Error::other(e.to_string()));
    let mut file = crate::base::regular::open(path)?;
    check_end(&mut file).map_err(|e| Error::io("cannot read", path, e))?;
    let mut all = RecordingContents::default();
    for message in DecoderApp::decode_eager(BufReader::new(file)).map_err(|e| broken(&e))? {
        let message = message.map_err(|e| broken(&e))?;
        all.messages += 1;
        if let LogMsg::BlueprintActivationCommand(_) = message {
            all.layout |= all.entities.is_empty();
            all.layouts += 1;
        }
        if let LogMsg::SetStoreInfo(store) = &message
            && store.info.store_id.kind() == StoreKind::Blueprint
        {
            all.last_layout = Layout::default();
        }
        if let LogMsg::ArrowMsg(store, arrow) = &message
            && store.kind() == StoreKind::Blueprint
        {
            all.last_layout.add(&Chunk::from_arrow_msg(arrow).map_err(|e| broken(&e))?);
        }
        if let LogMsg::ArrowMsg(store, arrow) = message
            && store.kind() == StoreKind::Recording
        {
            all.id = store.recording_id().to_string();
            all.add(&Chunk::from_arrow_msg(&arrow).map_err(|e| broken(&e))?);
        }
    }
    // Within a chunk rows may lie in the order of strain, which falls where a grip pushes or swings back.
    all.series.values_mut().for_each(|rows| rows.sort_by_key(|(step, _)| *step));
    Ok(all)
}

/// A whole recording ends with a footer; the decoder alone takes a file that was cut off for a short one.
fn check_end(file: &mut File) -> std::io::Result<()> {
    let mut end = [0; StreamFooter::ENCODED_SIZE_BYTES];
    let whole = file.seek(SeekFrom::End(-(end.len() as i64))).is_ok();
    if whole {
        file.read_exact(&mut end)?;
    }
    file.rewind()?;
    if whole && StreamFooter::from_rrd_bytes(&end).is_ok() {
        return Ok(());
    }
    Err(std::io::Error::new(std::io::ErrorKind::UnexpectedEof, "it is no recording, or its end is missing"))
}

impl RecordingContents {
    fn add(&mut self, chunk: &Chunk) {
        let path = chunk.entity_path().to_string();
        self.add_entity(&path, chunk);
        self.add_log(&path, chunk);
        self.add_stress(&path, chunk);
        self.add_fields(&path, chunk);
        self.add_series(&path, chunk);
        if path == format!("/{}", names::HEADLINE)
            && let Some(text) = chunk.iter_slices::<String>(TextDocument::descriptor_text().component).last()
        {
            self.headline = text.iter().map(ToString::to_string).collect();
        }
        let positions = Points3D::descriptor_positions().component;
        if let Some(last) = last_row(chunk, positions, chunk.iter_slices::<[f32; 3]>(positions)) {
            self.last_positions.insert(path, last.to_vec());
        }
    }

    fn add_entity(&mut self, path: &str, chunk: &Chunk) {
        let entity = self.entities.entry(path.to_owned()).or_default();
        *(if chunk.is_static() { &mut entity.static_rows } else { &mut entity.rows }) += chunk.num_rows();
        entity.timelines.extend(chunk.timelines().keys().map(ToString::to_string));
        for column in chunk.components().values() {
            let component = entity.components.entry(column.descriptor.component.to_string()).or_default();
            component.kind = column.descriptor.component_type.map(|kind| kind.to_string());
            component.rows += column.list_array.len() - column.list_array.null_count();
            let values = column.list_array.values();
            component.values += values.len();
            component.bytes += values.to_data().get_slice_memory_size().unwrap_or(0);
        }
    }

    fn add_log(&mut self, path: &str, chunk: &Chunk) {
        if path == format!("/{}", names::LOG) {
            let lines = chunk.iter_slices::<String>(TextLog::descriptor_text().component);
            let lines = lines.flatten().map(|line| line.to_string());
            self.log.extend(strains(chunk).zip(lines));
            let levels = chunk.iter_slices::<String>(TextLog::descriptor_level().component);
            self.levels.extend(levels.flatten().map(|level| level.to_string()));
        }
    }

    fn add_fields(&mut self, path: &str, chunk: &Chunk) {
        for field in [STRESS, PLASTIC_STRAIN, UTILISATION, CONTACT_PRESSURE] {
            if let Some(last) = last_row(chunk, field.into(), chunk.iter_slices::<f32>(field.into())) {
                self.last_fields.entry(path.to_owned()).or_default().insert(field.to_owned(), last.to_vec());
            }
        }
    }

    fn add_series(&mut self, path: &str, chunk: &Chunk) {
        let values = chunk.iter_slices::<f64>(Scalars::descriptor_scalars().component);
        let steps = chunk.iter_indices(&stream::STEP.into()).map(|(time, _)| time.as_i64());
        let rows: Vec<(i64, Vec<f64>)> = steps.zip(values).map(|(step, values)| (step, values.to_vec())).collect();
        if !rows.is_empty() {
            self.series.entry(path.to_owned()).or_default().extend(rows);
        }
    }

    fn add_stress(&mut self, path: &str, chunk: &Chunk) {
        if path == format!("/{}", names::BODY_STRESS) {
            let values = chunk.iter_slices::<f64>(Scalars::descriptor_scalars().component);
            self.nominal_stress.extend(strains(chunk).zip(values.flatten().copied()));
        }
    }
}

/// Of the rows of a chunk that say something of a component, what that of the greatest step says; the last of rows without
/// steps.
fn last_row<T>(chunk: &Chunk, component: ComponentIdentifier, values: impl Iterator<Item = T>) -> Option<T> {
    let steps = chunk.iter_component_indices(stream::STEP.into(), component).map(|(time, _)| time.as_i64());
    steps.chain(std::iter::repeat(i64::MIN)).zip(values).max_by_key(|(step, _)| *step).map(|(_, value)| value)
}

fn strains(chunk: &Chunk) -> impl Iterator<Item = i64> + '_ {
    chunk.iter_indices(&stream::STRAIN.into()).map(|(time, _)| time.as_i64())
}
