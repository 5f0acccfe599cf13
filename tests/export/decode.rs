//! Reads exported files as their formats say, apart from the code that writes them.

use flate2::read::ZlibDecoder;
use std::io::Read;
use std::path::Path;

/// A file of VTK's XML polygonal data with raw appended arrays.
pub struct Vtp {
    head: String,
    data: Vec<u8>,
}

/// A number of an array.
pub trait Scalar: Sized {
    const TYPE: &'static str;
    const SIZE: usize;
    fn from_bytes(bytes: &[u8]) -> Self;
}

macro_rules! scalar {
    ($($name:ident $word:literal)+) => {
        $(impl Scalar for $name {
            const TYPE: &'static str = $word;
            const SIZE: usize = size_of::<$name>();

            fn from_bytes(bytes: &[u8]) -> Self {
                Self::from_le_bytes(bytes.try_into().unwrap())
            }
        })+
    };
}

scalar! { f32 "Float32" i64 "Int64" u64 "UInt64" u8 "UInt8" }

impl Vtp {
    pub fn read(path: &Path) -> Self {
        let bytes = std::fs::read(path).unwrap_or_else(|e| panic!("{}: {e}", path.display()));
        let mark = b"<AppendedData encoding=\"raw\">\n_";
        let at = bytes.windows(mark.len()).position(|window| window == mark).expect("appended data") + mark.len();
        let head = String::from_utf8(bytes[..at].to_vec()).unwrap();
        for word in
            ["type=\"PolyData\"", "byte_order=\"LittleEndian\"", "header_type=\"UInt64\"", "vtkZLibDataCompressor"]
        {
            assert!(head.contains(word), "{word} in {head}");
        }
        Self { head, data: bytes[at..].to_vec() }
    }

    /// An array of a section such as `PointData`.
    pub fn array<T: Scalar>(&self, section: &str, name: &str) -> Vec<T> {
        let inside = self.head.split(&format!("<{section}>")).nth(1).unwrap_or_else(|| panic!("no {section}"));
        let inside = inside.split(&format!("</{section}>")).next().unwrap();
        let named = format!("Name=\"{name}\"");
        let element = inside.lines().find(|line| line.contains(&named)).unwrap_or_else(|| panic!("no {name}"));
        assert!(element.contains(&format!("type=\"{}\"", T::TYPE)), "{element}");
        let offset: usize = element.split("offset=\"").nth(1).unwrap().split('"').next().unwrap().parse().unwrap();
        let bytes = self.decompressed(offset);
        bytes.chunks(T::SIZE).map(T::from_bytes).collect()
    }

    /// Blocks: their number, their size, that of the last if it is shorter, their compressed sizes, their contents.
    fn decompressed(&self, offset: usize) -> Vec<u8> {
        let number = |k: usize| u64::from_bytes(&self.data[offset + 8 * k..offset + 8 * k + 8]) as usize;
        let (blocks, size, last) = (number(0), number(1), number(2));
        let mut at = offset + 8 * (3 + blocks);
        let mut bytes = Vec::new();
        for block in 0..blocks {
            let length = number(3 + block);
            let before = bytes.len();
            ZlibDecoder::new(&self.data[at..at + length]).read_to_end(&mut bytes).expect("a zlib stream");
            let whole = if block + 1 == blocks && last > 0 { last } else { size };
            assert_eq!(bytes.len() - before, whole);
            at += length;
        }
        bytes
    }
}

/// The parts of a text that begin with a mark at the start of a line, without it.
pub fn frames<'a>(text: &'a str, mark: &'a str) -> impl Iterator<Item = &'a str> {
    let mut starts: Vec<usize> = Vec::new();
    for (at, _) in text.match_indices(mark) {
        if at == 0 || text.as_bytes()[at - 1] == b'\n' {
            starts.push(at);
        }
    }
    let ends: Vec<usize> = starts.iter().skip(1).copied().chain([text.len()]).collect();
    starts.into_iter().zip(ends).map(move |(start, end)| &text[start + mark.len()..end])
}

/// Rows of numbers, up to the first line that is none.
pub fn floats(text: &str) -> Vec<Vec<f64>> {
    let row = |line: &str| line.split_whitespace().map(|word| word.parse().ok()).collect::<Option<Vec<f64>>>();
    text.lines().map_while(row).collect()
}
