//! VTK's XML polygonal data (`.vtp`), one file per snapshot, and collections of them over time (`.pvd`), which ParaView,
//! VTK and PyVista open. Lengths are in mm, stresses in MPa, as in the tables.
//!
//! `wires.pvd`: every piece of a wire that still holds together is one polyline, so what is broken is apart; single particles
//! and free spheres are vertices. `bonds.pvd`: every bond is a line, broken ones too, with its state.
//!
//! Format: VTK file formats, XML (docs.vtk.org): arrays appended raw, in blocks compressed by zlib.

use super::body::Body;
use super::target::Target;
use crate::base::error::{Error, Result};
use crate::base::units::{mm, mpa, percent};
use crate::engine::view::{RunInfo, Snapshot};
use crate::observe::Observer;
use bytemuck::{NoUninit, cast_slice};
use flate2::Compression;
use flate2::write::ZlibEncoder;
use std::fmt::Write as _;
use std::io::Write as _;
use std::sync::Arc;

/// Bytes that are compressed together.
const BLOCK: usize = 1 << 18;

pub struct Writer {
    target: Target,
    open: Option<Open>,
}

struct Open {
    body: Body,
    title: String,
    /// Names of the snapshots' files, and their simulated times (s).
    written: Vec<(String, f64)>,
}

impl Writer {
    pub fn new(target: Target) -> Self {
        Self { target, open: None }
    }

    fn write(&self, name: &str, content: &[u8]) -> Result<()> {
        let path = self.target.folder.join(name);
        std::fs::write(&path, content).map_err(|e| Error::io("cannot write", path, e))
    }
}

impl Observer for Writer {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        let title = self.target.title(info);
        self.open = Some(Open { body: Body::new(info), title, written: Vec::new() });
        Ok(())
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        let Some(open) = &self.open else { return Ok(()) };
        let number = format!("{:04}", open.written.len());
        self.write(&format!("wires-{number}.vtp"), &wires(&open.body, &open.title, snapshot))?;
        self.write(&format!("bonds-{number}.vtp"), &bonds(&open.body, &open.title, snapshot))?;
        self.open.iter_mut().for_each(|open| open.written.push((number.clone(), snapshot.sample.time)));
        Ok(())
    }

    fn finish(&mut self) -> Result<()> {
        let Some(open) = self.open.take() else { return Ok(()) };
        ["bonds", "wires"].iter().try_for_each(|kind| {
            self.write(&format!("{kind}.pvd"), collection(kind, &open.title, &open.written).as_bytes())
        })
    }
}

/// The collection of the files of a kind.
fn collection(kind: &str, title: &str, written: &[(String, f64)]) -> String {
    let title = comment(title);
    let mut text = format!("<?xml version=\"1.0\"?>\n<!-- {title} -->\n");
    text.push_str("<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n<Collection>\n");
    for (number, time) in written {
        let _ = writeln!(text, "<DataSet timestep=\"{time:e}\" part=\"0\" file=\"{kind}-{number}.vtp\"/>");
    }
    text + "</Collection>\n</VTKFile>\n"
}

/// Text as an XML comment may hold it.
fn comment(text: &str) -> String {
    text.replace("--", "- -")
}

/// Pieces of wires that hold together.
fn wires(body: &Body, title: &str, snapshot: &Snapshot) -> Vec<u8> {
    let info = &body.info;
    let (mut single, mut lines) = (Cells::default(), Cells::default());
    for wire in &info.wires {
        let mut begin = wire.first;
        for end in wire.particles() {
            if end + 1 == wire.first + wire.len || !snapshot.bond_state[end].holds() {
                let cells = if begin == end { &mut single } else { &mut lines };
                cells.push(body, begin..=end);
                begin = end + 1;
            }
        }
    }
    (info.wire_particles..info.particles).for_each(|sphere| single.push(body, sphere..=sphere));
    let mut file = File::new(&single, &lines);
    points(&mut file, body, snapshot);
    file.end_of_points();
    single.append(lines, &mut file);
    file.finish(title, info, snapshot)
}

/// Every bond.
fn bonds(body: &Body, title: &str, snapshot: &Snapshot) -> Vec<u8> {
    let mut lines = Cells::default();
    body.bonds().for_each(|(_, slot)| lines.push(body, slot..=slot + 1));
    let of = |value: &[f32], unit: fn(f64) -> f64| -> Vec<f32> {
        body.bonds().map(|(_, slot)| unit(f64::from(value[slot])) as f32).collect()
    };
    let single = Cells::default();
    let mut file = File::new(&single, &lines);
    file.array("radius_mm", 1, &scaled(&snapshot.radius, mm));
    file.end_of_points();
    file.array("stress_mpa", 1, &of(&snapshot.bond_stress, mpa));
    file.array("plastic_strain_percent", 1, &of(&snapshot.plastic_strain, percent));
    file.array("utilisation_percent", 1, &of(&snapshot.utilisation, percent));
    file.array("state", 1, &body.bonds().map(|(_, slot)| snapshot.bond_state[slot] as u8).collect::<Vec<_>>());
    let number = |(wire, slot): (usize, usize)| (slot - body.info.wires[wire].first) as i32 + 1;
    file.array("bond", 1, &body.bonds().map(number).collect::<Vec<_>>());
    single.append(lines, &mut file);
    file.finish(title, &body.info, snapshot)
}

/// What is known of particles.
fn points(file: &mut File, body: &Body, snapshot: &Snapshot) {
    let displacement: Vec<f32> = snapshot
        .position
        .iter()
        .zip(&body.info.rest_position)
        .flat_map(|(now, rest)| std::array::from_fn::<f32, 3, _>(|k| mm(f64::from(now[k]) - f64::from(rest[k])) as f32))
        .collect();
    file.array("radius_mm", 1, &scaled(&snapshot.radius, mm));
    file.array("displacement_mm", 3, &displacement);
    file.array("speed_m_s", 1, &snapshot.speed);
    file.array("contact_pressure_mpa", 1, &scaled(&snapshot.contact_pressure, mpa));
    let mut of_bonds = |name: &str, quantity: &[f32], unit: fn(f64) -> f64| {
        file.array(name, 1, &scaled(&Body::at_particles(snapshot, quantity), unit));
    };
    of_bonds("stress_mpa", &snapshot.bond_stress, mpa);
    of_bonds("plastic_strain_percent", &snapshot.plastic_strain, percent);
    of_bonds("utilisation_percent", &snapshot.utilisation, percent);
    file.array("broken", 1, &Body::at_breaks(snapshot));
    file.array("wire", 1, &body.wire);
    file.array("layer", 1, &body.layer);
}

fn scaled(values: &[f32], unit: fn(f64) -> f64) -> Vec<f32> {
    values.iter().map(|value| unit(f64::from(*value)) as f32).collect()
}

/// Cells of one kind: runs of particles.
#[derive(Default)]
struct Cells {
    connectivity: Vec<i64>,
    offsets: Vec<i64>,
    wire: Vec<i32>,
    layer: Vec<i32>,
}

impl Cells {
    fn push(&mut self, body: &Body, particles: std::ops::RangeInclusive<usize>) {
        self.wire.push(body.wire[*particles.start()]);
        self.layer.push(body.layer[*particles.start()]);
        self.connectivity.extend(particles.map(|p| p as i64));
        self.offsets.push(self.connectivity.len() as i64);
    }

    /// Writes wire and layer of these cells and of those that follow.
    fn append(mut self, others: Self, file: &mut File) {
        self.wire.extend(others.wire);
        self.layer.extend(others.layer);
        file.array("wire", 1, &self.wire);
        file.array("layer", 1, &self.layer);
    }
}

/// A number as VTK names it.
trait Scalar: NoUninit {
    const NAME: &'static str;
}

impl Scalar for f32 {
    const NAME: &'static str = "Float32";
}
impl Scalar for i64 {
    const NAME: &'static str = "Int64";
}
impl Scalar for i32 {
    const NAME: &'static str = "Int32";
}
impl Scalar for u8 {
    const NAME: &'static str = "UInt8";
}

/// A file of polygonal data: XML, and the arrays appended to it.
struct File {
    vertices: usize,
    lines: usize,
    topology: String,
    points: String,
    /// Arrays described since the last kind of them was complete.
    described: String,
    data: Vec<u8>,
}

impl File {
    fn new(single: &Cells, lines: &Cells) -> Self {
        let (topology, points, described) = (String::new(), String::new(), String::new());
        let numbers = [single, lines].map(|cells| cells.offsets.len());
        let mut file = Self { vertices: numbers[0], lines: numbers[1], topology, points, described, data: Vec::new() };
        for (kind, cells) in [("Verts", single), ("Lines", lines)] {
            file.array("connectivity", 1, &cells.connectivity);
            file.array("offsets", 1, &cells.offsets);
            let _ = writeln!(file.topology, "<{kind}>\n{}</{kind}>", file.described);
            file.described.clear();
        }
        file
    }

    /// Appends an array with so many components.
    fn array<T: Scalar>(&mut self, name: &str, components: usize, values: &[T]) {
        let offset = self.data.len();
        let _ = writeln!(
            self.described,
            "<DataArray type=\"{}\" Name=\"{name}\" NumberOfComponents=\"{components}\" format=\"appended\" offset=\"{offset}\"/>",
            T::NAME
        );
        append(&mut self.data, cast_slice(values));
    }

    /// What comes next is known of cells.
    fn end_of_points(&mut self) {
        self.points = std::mem::take(&mut self.described);
    }

    fn finish(mut self, title: &str, info: &RunInfo, snapshot: &Snapshot) -> Vec<u8> {
        let cells = std::mem::take(&mut self.described);
        let positions: Vec<f32> = scaled(cast_slice(&snapshot.position), mm);
        self.array("Points", 3, &positions);
        let order = if cfg!(target_endian = "little") { "LittleEndian" } else { "BigEndian" };
        let mut text = format!("<?xml version=\"1.0\"?>\n<!-- {} -->\n", comment(title));
        let _ = writeln!(
            text,
            "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"{order}\" header_type=\"UInt64\" \
             compressor=\"vtkZLibDataCompressor\">\n<PolyData>\n{}<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"{}\" \
             NumberOfLines=\"{}\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">\n<PointData>\n{}</PointData>\n<CellData>\n\
             {cells}</CellData>\n<Points>\n{}</Points>\n{}</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_",
            fields(info, snapshot),
            info.particles,
            self.vertices,
            self.lines,
            self.points,
            self.described,
            self.topology
        );
        let mut bytes = text.trim_end().as_bytes().to_vec();
        bytes.extend(self.data);
        bytes.extend(b"\n</AppendedData>\n</VTKFile>\n");
        bytes
    }
}

/// What holds for the whole snapshot.
fn fields(info: &RunInfo, snapshot: &Snapshot) -> String {
    let s = &snapshot.sample;
    let number = |name: &str, value: f64| {
        format!(
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfTuples=\"1\" format=\"ascii\">{value:e}</DataArray>\n"
        )
    };
    // Text is written as the codes of its letters, each name ended by a zero.
    let names: String =
        info.layers.iter().flat_map(|name| name.bytes().chain([0])).fold(String::new(), |mut text, code| {
            let _ = write!(text, "{code} ");
            text
        });
    format!(
        "<FieldData>\n{}{}{}{}<Array type=\"String\" Name=\"layers\" NumberOfTuples=\"{}\" format=\"ascii\">{names}</Array>\n\
         </FieldData>\n",
        number("TimeValue", s.time),
        number("step", s.step as f64),
        number("strain_percent", percent(s.strain)),
        number("nominal_stress_mpa", mpa(s.stress)),
        info.layers.len()
    )
}

/// Appends an array in compressed blocks: their number, their size, that of the last where it is shorter, their sizes when
/// compressed, and they themselves.
fn append(data: &mut Vec<u8>, bytes: &[u8]) {
    let blocks: Vec<Vec<u8>> = bytes.chunks(BLOCK).map(compressed).collect();
    let sizes = [blocks.len(), BLOCK, bytes.len() % BLOCK].into_iter().chain(blocks.iter().map(Vec::len));
    sizes.for_each(|size| data.extend((size as u64).to_ne_bytes()));
    blocks.iter().for_each(|block| data.extend(block));
}

fn compressed(bytes: &[u8]) -> Vec<u8> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::fast());
    let written = encoder.write_all(bytes).and_then(|()| encoder.finish());
    written.expect("memory takes what is written")
}
