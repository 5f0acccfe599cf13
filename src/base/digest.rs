//! What tells whether a text or a file is the one that it was: a hash against accidents, not against forgery.

use super::error::{Error, Result};
use super::regular;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use std::fmt;
use std::io::Read;
use std::path::Path;
use std::str::FromStr;
use twox_hash::XxHash3_128;

/// XXH3 of 128 bits, written as 32 hexadecimal digits.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct Digest(u128);

impl Digest {
    /// Of bytes.
    pub fn of(bytes: impl AsRef<[u8]>) -> Self {
        Self(XxHash3_128::oneshot(bytes.as_ref()))
    }

    /// Of all of a file.
    ///
    /// # Errors
    /// As for [`regular::open`], and when it cannot be read.
    pub fn of_file(path: &Path) -> Result<Self> {
        let mut file = regular::open(path)?;
        let mut hash = XxHash3_128::new();
        let mut part = vec![0; 1 << 20];
        loop {
            match file.read(&mut part) {
                Ok(0) => return Ok(Self(hash.finish_128())),
                Ok(n) => hash.write(&part[..n]),
                Err(cause) if cause.kind() == std::io::ErrorKind::Interrupted => {}
                Err(cause) => return Err(Error::io("cannot read", path, cause)),
            }
        }
    }

    /// As it stands in binary files.
    pub fn to_bytes(self) -> [u8; 16] {
        self.0.to_le_bytes()
    }

    /// Back from there.
    pub fn from_bytes(bytes: [u8; 16]) -> Self {
        Self(u128::from_le_bytes(bytes))
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:032x}", self.0)
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Digest {
    type Err = std::num::ParseIntError;

    fn from_str(text: &str) -> std::result::Result<Self, Self::Err> {
        u128::from_str_radix(text, 16).map(Self)
    }
}

impl Serialize for Digest {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Digest {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        String::deserialize(deserializer)?.parse().map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_has_the_digest_of_its_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a");
        let bytes: Vec<u8> = (0..3_000_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        std::fs::write(&path, &bytes).unwrap();
        let digest = Digest::of(&bytes);
        assert_eq!(Digest::of_file(&path).unwrap(), digest);
        assert_eq!(digest.to_string().parse(), Ok(digest));
        assert_eq!(Digest::from_bytes(digest.to_bytes()), digest);
        assert_ne!(Digest::of(&bytes[1..]), digest);
    }

    /// The published value of XXH3 of 128 bits for no input: files of one build are read by another.
    #[test]
    fn it_is_xxh3() {
        assert_eq!(Digest::of("").to_string(), "99aa06d3014798d86001c324468d497f");
    }
}
