//! The trajectory of a run (`trajectory.bin`): everything that is needed to draw it again without simulating.
//!
//! Format: the magic bytes, a version (u32, little endian), the run's [`Origin`], then an LZ4 frame of records. A record is its length
//! (u32, little endian) and that many bytes of postcard. The first record is the [`RunInfo`], each further one a
//! [`Record`]; a record of length 0 ends the run, so a file that was cut off is recognised. A block of the frame ends with
//! every snapshot and is handed to the system then: what a run that is killed has told up to its last snapshot can be read.

use super::origin::Origin;
use super::peaks::Peaks;
use super::{Observer, partial};
use crate::base::error::{Error, Result};
use crate::base::finding::Notice;
use crate::base::regular;
use crate::engine::view::{RunInfo, Rupture, Sample, Snapshot, WireInfo};
use lz4_flex::frame::{FrameDecoder, FrameEncoder, FrameInfo};
use serde::{Deserialize, Serialize, de::DeserializeOwned};
use std::fs::File;
use std::io::{BufReader, BufWriter, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

const MAGIC: [u8; 12] = *b"strandsnap\0T";
/// Raised whenever what is written changes its meaning or order.
const VERSION: u32 = 7;
/// No record is this long (bytes); a length above it is damage.
const LONGEST_RECORD: u32 = 1 << 30;

/// What a trajectory tells, in the order of the run.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[expect(clippy::large_enum_variant, reason = "one record at a time is read")]
pub enum Record {
    /// A row of the curve.
    Sample(Sample),
    /// Every particle.
    Snapshot(Snapshot),
    /// A bond broke.
    Rupture(Rupture),
    /// Something that the user must know was found.
    Notice(Notice),
    /// The greatest stresses of the run.
    Peaks(Peaks),
}

/// The same, borrowed: variants in the same order give the same bytes.
#[derive(Serialize)]
enum Borrowed<'a> {
    Sample(&'a Sample),
    Snapshot(&'a Snapshot),
    Rupture(&'a Rupture),
    Notice(&'a Notice),
    Peaks(&'a Peaks),
}

/// An observer that writes a trajectory.
pub struct TrajectoryWriter {
    file: PathBuf,
    partial: PathBuf,
    encoder: Option<FrameEncoder<BufWriter<File>>>,
}

impl TrajectoryWriter {
    /// Opens `<file>.partial` for writing; it is renamed to `file` when the run is finished.
    ///
    /// # Errors
    /// [`Error::Io`] when the file cannot be created.
    pub fn new(file: &Path, origin: Origin) -> Result<Self> {
        let partial = partial::name(file);
        let mut writer = BufWriter::new(partial::create(file)?);
        let open = || {
            writer.write_all(&MAGIC)?;
            writer.write_all(&VERSION.to_le_bytes())?;
            writer.write_all(&origin.to_bytes())?;
            Ok(FrameEncoder::with_frame_info(FrameInfo::new().block_checksums(true), writer))
        };
        let encoder = open().map_err(|e| Error::io("cannot write", &partial, e))?;
        Ok(Self { file: file.to_owned(), partial, encoder: Some(encoder) })
    }

    fn write(&mut self, record: &impl Serialize) -> Result<()> {
        let Some(encoder) = &mut self.encoder else { return Ok(()) };
        append(encoder, record).map_err(|e| {
            // An encoder that could not write has lost its thread, and panics when it goes on.
            self.encoder = None;
            Error::io("cannot write", &self.partial, e)
        })
    }
}

fn append(writer: &mut impl Write, record: &impl Serialize) -> std::io::Result<()> {
    let bytes = postcard::to_stdvec(record).map_err(std::io::Error::other)?;
    let length = u32::try_from(bytes.len()).map_err(std::io::Error::other)?;
    writer.write_all(&length.to_le_bytes())?;
    writer.write_all(&bytes)
}

fn end(mut encoder: FrameEncoder<BufWriter<File>>) -> std::io::Result<()> {
    encoder.write_all(&0u32.to_le_bytes())?;
    encoder.finish().map_err(std::io::Error::from)?.flush()
}

impl Observer for TrajectoryWriter {
    fn start(&mut self, info: &Arc<RunInfo>) -> Result<()> {
        self.write(info.as_ref())
    }

    fn sample(&mut self, sample: &Sample) -> Result<()> {
        self.write(&Borrowed::Sample(sample))
    }

    fn snapshot(&mut self, snapshot: &Arc<Snapshot>) -> Result<()> {
        self.write(&Borrowed::Snapshot(snapshot))?;
        let Some(encoder) = &mut self.encoder else { return Ok(()) };
        let flushed = encoder.flush().and_then(|()| encoder.get_mut().flush());
        flushed.map_err(|e| Error::io("cannot write", &self.partial, e))
    }

    fn rupture(&mut self, rupture: &Rupture) -> Result<()> {
        self.write(&Borrowed::Rupture(rupture))
    }

    fn notice(&mut self, notice: &Notice) -> Result<()> {
        self.write(&Borrowed::Notice(notice))
    }

    fn peaks(&mut self, peaks: &Peaks) -> Result<()> {
        self.write(&Borrowed::Peaks(peaks))
    }

    fn finish(&mut self) -> Result<()> {
        let Some(encoder) = self.encoder.take() else { return Ok(()) };
        end(encoder).map_err(|e| Error::io("cannot write", &self.partial, e))?;
        partial::complete(&self.file)
    }
}

/// A trajectory that is being read: an iterator over its records, which holds one of them at a time.
///
/// An item is an error when the file is damaged or ends before the run does; it is the last item then.
pub struct Trajectory {
    path: PathBuf,
    origin: Origin,
    info: Arc<RunInfo>,
    decoder: FrameDecoder<BufReader<File>>,
    records: usize,
    ended: bool,
}

impl Trajectory {
    /// Opens a trajectory, also one that was not finished (under its partial name).
    ///
    /// # Errors
    /// [`Error::Io`] when it cannot be read or is cut off in its head; [`Error::Input`] when it is no trajectory or
    /// one of another version.
    pub fn open(path: &Path) -> Result<Self> {
        let file = regular::open(path)?;
        let mut reader = BufReader::new(file);
        let origin = head(path, &mut reader)?;
        let mut decoder = FrameDecoder::new(reader);
        let info = match next(&mut decoder) {
            Ok(Some(info)) if is_whole(&info) => Arc::new(info),
            Ok(Some(_)) => return Err(Error::io("cannot read", path, damaged("its body does not fit together"))),
            Ok(None) => return Err(Error::io("cannot read", path, damaged("it does not describe its run"))),
            Err(e) => return Err(Error::io("cannot read", path, explained(e, 0))),
        };
        Ok(Self { path: path.to_owned(), origin, info, decoder, records: 0, ended: false })
    }

    /// Which run it is of.
    pub fn origin(&self) -> Origin {
        self.origin
    }

    /// What does not change during the run.
    pub fn info(&self) -> &Arc<RunInfo> {
        &self.info
    }
}

impl Iterator for Trajectory {
    type Item = Result<Record>;

    fn next(&mut self) -> Option<Self::Item> {
        if self.ended {
            return None;
        }
        match next(&mut self.decoder) {
            Ok(Some(record)) if fits(&record, &self.info) => {
                self.records += 1;
                Some(Ok(record))
            }
            Ok(Some(_)) => {
                self.ended = true;
                Some(Err(Error::io("cannot read", &self.path, damaged("a record does not fit its body"))))
            }
            Ok(None) => {
                self.ended = true;
                None
            }
            Err(e) => {
                self.ended = true;
                Some(Err(Error::io("cannot read", &self.path, explained(e, self.records))))
            }
        }
    }
}

/// Reads what is before the records.
fn head(path: &Path, reader: &mut impl Read) -> Result<Origin> {
    let mut head = [0; MAGIC.len() + 4];
    let complete = match reader.read_exact(&mut head) {
        Ok(()) => true,
        Err(e) if e.kind() == ErrorKind::UnexpectedEof => false,
        Err(e) => return Err(Error::io("cannot read", path, e)),
    };
    if !complete || head[..MAGIC.len()] != MAGIC {
        return Err(Error::input(
            format!("{} is not a trajectory of strandsnap", path.display()),
            "give the trajectory.bin of a run's output folder",
        ));
    }
    let version = u32::from_le_bytes([head[12], head[13], head[14], head[15]]);
    if version != VERSION {
        return Err(Error::input(
            format!("{} is a trajectory of version {version}; this program reads version {VERSION}", path.display()),
            "run the scene again with this program",
        ));
    }
    let mut origin = [0; Origin::LEN];
    reader.read_exact(&mut origin).map_err(|e| Error::io("cannot read", path, explained(e, 0)))?;
    Ok(Origin::from_bytes(&origin))
}

/// The next record, or `None` at the mark that ends the run.
fn next<T: DeserializeOwned>(reader: &mut impl Read) -> std::io::Result<Option<T>> {
    let mut length = [0; 4];
    reader.read_exact(&mut length)?;
    let length = u32::from_le_bytes(length);
    if length == 0 {
        return Ok(None);
    }
    if length > LONGEST_RECORD {
        return Err(damaged("a record has an impossible length"));
    }
    // A length may be damage: room is made for what is there.
    let mut bytes = Vec::new();
    if reader.take(u64::from(length)).read_to_end(&mut bytes)? < length as usize {
        return Err(ErrorKind::UnexpectedEof.into());
    }
    postcard::from_bytes(&bytes).map(Some).map_err(|e| damaged(&e.to_string()))
}

/// Whether what is said of the body can be shown: every index leads somewhere.
fn is_whole(info: &RunInfo) -> bool {
    let n = info.particles;
    let wire = |w: &WireInfo| {
        let end = w.first.checked_add(w.len);
        let known = w.layer < info.layers.len() && w.material < info.materials.len();
        known && w.len > 1 && end.is_some_and(|end| end <= info.wire_particles)
    };
    n > 0
        && info.wire_particles <= n
        && (info.radius.len(), info.rest_position.len()) == (n, n)
        && info.sphere_material.len() == n - info.wire_particles
        && info.sphere_material.iter().all(|material| *material < info.materials.len())
        && info.wires.iter().all(wire)
}

/// Whether a record is one of this body's.
fn fits(record: &Record, info: &RunInfo) -> bool {
    let row = |s: &Sample| {
        let of_wires = [s.wire_stress.len(), s.wire_pull.len()];
        [0, info.layers.len()].contains(&s.layer_stress.len())
            && of_wires.iter().all(|n| [0, info.wires.len()].contains(n))
    };
    match record {
        Record::Sample(sample) => row(sample),
        Record::Snapshot(s) => {
            let lengths = [s.position.len(), s.radius.len(), s.speed.len(), s.bond_state.len(), s.bond_stress.len()];
            let others = [s.plastic_strain.len(), s.utilisation.len(), s.contact_pressure.len()];
            row(&s.sample) && lengths.iter().chain(&others).all(|n| *n == info.particles)
        }
        Record::Rupture(r) => {
            let bond = |w: &WireInfo| r.bond_in_wire + 1 < w.len && w.first + r.bond_in_wire == r.bond;
            r.layer < info.layers.len() && info.wires.get(r.wire).is_some_and(bond)
        }
        Record::Notice(_) | Record::Peaks(_) => true,
    }
}

fn damaged(what: &str) -> std::io::Error {
    std::io::Error::new(ErrorKind::InvalidData, format!("the file is damaged: {what}"))
}

fn explained(error: std::io::Error, records: usize) -> std::io::Error {
    match error.kind() {
        ErrorKind::UnexpectedEof => std::io::Error::new(
            ErrorKind::UnexpectedEof,
            format!("the trajectory is cut off after {records} records: its run was not finished"),
        ),
        _ => error,
    }
}
