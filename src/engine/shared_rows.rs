//! Rows of numbers that many blocks share. What does not change from step to step is alike in nearly all blocks of a
//! strand: kept once per kind it stays in the processor's cache, where kept once per block it would be half of what a
//! step reads from memory.

use super::bytes::behind;
use std::collections::HashMap;

/// Each kind of rows once.
#[derive(Default)]
pub struct SharedRows {
    rows: Vec<f64>,
    /// Place of each kind by its bits.
    places: HashMap<Box<[u64]>, u32>,
}

impl SharedRows {
    /// Forgets all kinds.
    pub fn clear(&mut self) {
        self.rows.clear();
        self.places.clear();
    }

    /// Where these rows are among [`Self::rows`].
    pub fn place(&mut self, rows: &[f64]) -> u32 {
        let next = self.rows.len() as u32;
        let place = *self.places.entry(rows.iter().map(|number| number.to_bits()).collect()).or_insert(next);
        if place == next {
            self.rows.extend_from_slice(rows);
        }
        place
    }

    /// No more kinds come: forgets what only these would need.
    pub fn close(&mut self) {
        self.places = HashMap::new();
        self.rows.shrink_to_fit();
    }

    /// All rows.
    pub fn rows(&self) -> &[f64] {
        &self.rows
    }

    /// Memory behind it once it is closed (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.rows)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_kind_is_kept_once() {
        let mut kinds = SharedRows::default();
        let (a, b) = ([1.0, 2.0], [1.0, -0.0]);
        assert_eq!([kinds.place(&a), kinds.place(&b), kinds.place(&a), kinds.place(&[1.0, 0.0])], [0, 2, 0, 4]);
        assert_eq!(kinds.rows(), [1.0, 2.0, 1.0, -0.0, 1.0, 0.0]);
        kinds.close();
        assert_eq!((kinds.rows().len(), kinds.bytes()), (6, 48));
        kinds.clear();
        assert_eq!(kinds.place(&b), 0);
    }
}
