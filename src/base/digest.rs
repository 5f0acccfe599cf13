//! What tells whether a text or a file is the one that it was.

use super::error::{Error, Result};
use super::regular;
use serde::{Deserialize, Deserializer, Serialize, Serializer, de};
use sha2::{Digest as _, Sha256};
use std::fmt;
use std::io::{BufRead, BufReader};
use std::path::Path;
use std::str::FromStr;

/// SHA-256, written as 64 hexadecimal digits, as `sha256sum` does.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct Digest([u8; Self::LEN]);

impl Digest {
    /// Bytes in a binary file.
    pub const LEN: usize = 32;

    /// Of bytes.
    pub fn of(bytes: impl AsRef<[u8]>) -> Self {
        Self(Sha256::digest(bytes).into())
    }

    /// Of all of a file.
    ///
    /// # Errors
    /// As for [`regular::open`], and when it cannot be read.
    pub fn of_file(path: &Path) -> Result<Self> {
        let mut file = BufReader::with_capacity(1 << 20, regular::open(path)?);
        let mut hash = Sha256::new();
        loop {
            let part = file.fill_buf().map_err(|cause| Error::io("cannot read", path, cause))?;
            if part.is_empty() {
                return Ok(Self(hash.finalize().into()));
            }
            hash.update(part);
            let read = part.len();
            file.consume(read);
        }
    }

    /// As it stands in binary files.
    pub fn to_bytes(self) -> [u8; Self::LEN] {
        self.0
    }

    /// Back from there.
    pub fn from_bytes(bytes: [u8; Self::LEN]) -> Self {
        Self(bytes)
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl FromStr for Digest {
    type Err = String;

    fn from_str(text: &str) -> std::result::Result<Self, String> {
        let byte = |k: usize| text.get(2 * k..2 * k + 2).and_then(|two| u8::from_str_radix(two, 16).ok());
        let bytes: Option<Vec<u8>> = (0..Self::LEN).map(byte).collect();
        let bytes = bytes.and_then(|bytes| bytes.try_into().ok()).filter(|_| text.len() == 2 * Self::LEN);
        bytes.map(Self).ok_or_else(|| format!("{text} is not the digest of a file"))
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
        let bytes: Vec<u8> = (0..100_000_u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        std::fs::write(&path, &bytes).unwrap();
        let digest = Digest::of(&bytes);
        assert_eq!(Digest::of_file(&path).unwrap(), digest);
        assert_eq!(digest.to_string().parse(), Ok(digest));
        assert_eq!(Digest::from_bytes(digest.to_bytes()), digest);
        assert_ne!(Digest::of(&bytes[1..]), digest);
        for wrong in ["", "ab", "µµ"] {
            assert!(wrong.parse::<Digest>().is_err());
        }
    }

    /// The published value for no input (FIPS 180-2), so that `sha256sum` can check a file.
    #[test]
    fn it_is_sha_256() {
        let empty = "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855";
        assert_eq!(Digest::of("").to_string(), empty);
    }
}
