//! Structure-of-arrays storage of 3-vectors, read and written as [`glam::DVec3`].

use glam::DVec3;
use serde::{Deserialize, Serialize};

/// `n` vectors stored as three streams.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Vectors {
    /// x components.
    pub x: Vec<f64>,
    /// y components.
    pub y: Vec<f64>,
    /// z components.
    pub z: Vec<f64>,
}

impl Vectors {
    /// `n` zero vectors.
    pub fn zeros(n: usize) -> Self {
        Self { x: vec![0.0; n], y: vec![0.0; n], z: vec![0.0; n] }
    }

    /// The three streams.
    pub fn rows(&self) -> [&[f64]; 3] {
        [&self.x, &self.y, &self.z]
    }

    /// The three streams, to write to.
    pub fn rows_mut(&mut self) -> [&mut [f64]; 3] {
        [&mut self.x, &mut self.y, &mut self.z]
    }

    /// None yet, with room for `n`.
    pub fn with_capacity(n: usize) -> Self {
        Self { x: Vec::with_capacity(n), y: Vec::with_capacity(n), z: Vec::with_capacity(n) }
    }

    /// Number of vectors.
    pub fn len(&self) -> usize {
        self.x.len()
    }

    /// True when there are none.
    pub fn is_empty(&self) -> bool {
        self.x.is_empty()
    }

    /// Vector `i`.
    #[inline(always)]
    pub fn get(&self, i: usize) -> DVec3 {
        DVec3::new(self.x[i], self.y[i], self.z[i])
    }

    /// Overwrites vector `i`.
    #[inline(always)]
    pub fn set(&mut self, i: usize, v: DVec3) {
        self.x[i] = v.x;
        self.y[i] = v.y;
        self.z[i] = v.z;
    }

    /// Adds to vector `i`.
    #[inline(always)]
    pub fn add(&mut self, i: usize, v: DVec3) {
        self.x[i] += v.x;
        self.y[i] += v.y;
        self.z[i] += v.z;
    }

    /// Appends a vector.
    pub fn push(&mut self, v: DVec3) {
        self.x.push(v.x);
        self.y.push(v.y);
        self.z.push(v.z);
    }

    /// All vectors in order.
    pub fn iter(&self) -> impl Iterator<Item = DVec3> + '_ {
        (0..self.len()).map(|i| self.get(i))
    }
}

impl FromIterator<DVec3> for Vectors {
    fn from_iter<I: IntoIterator<Item = DVec3>>(iter: I) -> Self {
        let mut all = Self::default();
        iter.into_iter().for_each(|v| all.push(v));
        all
    }
}
