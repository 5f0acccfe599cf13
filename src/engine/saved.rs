//! The state of an engine in bytes, from which another engine of the same scene goes on to the same bits.
//!
//! Written field by field in the order of the stages, floating point numbers as they are. What a scene alone decides
//! (laws, constants, limits, groups of held particles) is not among them: the engine that takes them up has set it up for
//! itself. Nor is what the next step computes anew.

use serde::Serialize;
use serde::de::DeserializeOwned;

/// Takes in the state, part by part.
#[derive(Debug, Default)]
pub struct Writer {
    bytes: Vec<u8>,
}

/// Gives the parts back, in the order in which they were put in.
#[derive(Debug)]
pub struct Reader<'a> {
    bytes: &'a [u8],
}

/// Bytes that are not a state of this scene.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Unfit(pub String);

impl Writer {
    /// Puts a part in.
    pub fn put<T: Serialize + ?Sized>(&mut self, part: &T) {
        let bytes = std::mem::take(&mut self.bytes);
        // Nothing that an engine keeps is refused: no length is unknown, and memory is all that it takes.
        #[expect(
            clippy::expect_used,
            reason = "the format takes every type that an engine keeps; tests write all of them"
        )]
        let bytes = postcard::to_extend(part, bytes).expect("an engine's state has a binary form");
        self.bytes = bytes;
    }

    /// All bytes so far.
    pub fn into_bytes(self) -> Vec<u8> {
        self.bytes
    }
}

impl<'a> Reader<'a> {
    /// Reads what a [`Writer`] has written.
    pub fn new(bytes: &'a [u8]) -> Self {
        Self { bytes }
    }

    /// The next part.
    ///
    /// # Errors
    /// [`Unfit`] when there is none of this type.
    pub fn take<T: DeserializeOwned>(&mut self) -> Result<T, Unfit> {
        let (part, rest) = postcard::take_from_bytes(self.bytes).map_err(|_| Unfit("its bytes are damaged".into()))?;
        self.bytes = rest;
        Ok(part)
    }

    /// The next part, a list as long as `into`, which it replaces.
    ///
    /// # Errors
    /// [`Unfit`] also when it has another length.
    pub fn take_into<T: DeserializeOwned>(&mut self, into: &mut Vec<T>) -> Result<(), Unfit> {
        let list: Vec<T> = self.take()?;
        if list.len() != into.len() {
            return Err(Unfit(format!("a list has {} items instead of {}", list.len(), into.len())));
        }
        *into = list;
        Ok(())
    }

    /// After the last part.
    ///
    /// # Errors
    /// [`Unfit`] when something is left.
    pub fn end(self) -> Result<(), Unfit> {
        match self.bytes.len() {
            0 => Ok(()),
            left => Err(Unfit(format!("{left} bytes are left over"))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_come_back_in_order_and_to_the_bit() {
        let mut writer = Writer::default();
        writer.put(&[f64::NAN, -0.0, 1e-300][..]);
        writer.put(&(7_u64, "text"));
        let bytes = writer.into_bytes();
        let mut reader = Reader::new(&bytes);
        let mut numbers = vec![0.0_f64; 3];
        reader.take_into(&mut numbers).unwrap();
        assert_eq!(
            numbers.iter().map(|n: &f64| n.to_bits()).collect::<Vec<_>>(),
            [f64::NAN, -0.0, 1e-300].map(f64::to_bits)
        );
        assert_eq!(reader.take::<(u64, String)>().unwrap(), (7, "text".into()));
        reader.end().unwrap();
    }

    #[test]
    fn what_does_not_fit_is_refused() {
        let mut writer = Writer::default();
        writer.put(&vec![1.0; 4]);
        let bytes = writer.into_bytes();
        let mut five = vec![0.0; 5];
        assert!(Reader::new(&bytes).take_into(&mut five).unwrap_err().to_string().contains("4 items instead of 5"));
        assert!(Reader::new(&bytes[..9]).take::<Vec<f64>>().is_err());
        let mut reader = Reader::new(&bytes);
        reader.take::<u8>().unwrap();
        assert!(reader.end().is_err());
    }
}
