//! Vectors of numbers that come one at a time or several at once.

use super::lanes::Real;
use glam::DVec3;
use std::ops::{Add, Mul, Sub};

/// Three numbers, or three registers of them.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Triple<R = f64> {
    /// First axis.
    pub x: R,
    /// Second axis.
    pub y: R,
    /// Third axis.
    pub z: R,
}

impl<R: Real> Triple<R> {
    /// Scalar product.
    #[inline(always)]
    pub fn dot(self, o: Self) -> R {
        self.x.mul_add(o.x, self.y.mul_add(o.y, self.z * o.z))
    }

    /// Scalar product in which every product and every sum is rounded by itself.
    #[inline(always)]
    pub fn plain_dot(self, o: Self) -> R {
        self.x * o.x + self.y * o.y + self.z * o.z
    }

    /// Vector product.
    #[inline(always)]
    pub fn cross(self, o: Self) -> Self {
        Self { x: self.y * o.z - o.y * self.z, y: self.z * o.x - o.z * self.x, z: self.x * o.y - o.x * self.y }
    }

    /// Square of the length.
    #[inline(always)]
    pub fn length_squared(self) -> R {
        self.dot(self)
    }

    /// Zero, as many times as there are numbers in `like`.
    #[inline(always)]
    pub fn zero(like: R) -> Self {
        let zero = like.splat(0.0);
        Self { x: zero, y: zero, z: zero }
    }

    /// `yes` where the mask holds, `no` elsewhere.
    #[inline(always)]
    pub fn select(mask: R::Mask, yes: Self, no: Self) -> Self {
        Self { x: R::select(mask, yes.x, no.x), y: R::select(mask, yes.y, no.y), z: R::select(mask, yes.z, no.z) }
    }

    /// Vector `k` of several.
    #[inline(always)]
    pub fn at(self, k: usize) -> DVec3 {
        DVec3::new(self.x.at(k), self.y.at(k), self.z.at(k))
    }

    /// Puts `vector` in the place of vector `k`.
    #[inline(always)]
    pub fn put(&mut self, k: usize, vector: DVec3) {
        self.x.put(k, vector.x);
        self.y.put(k, vector.y);
        self.z.put(k, vector.z);
    }

    /// All three through `f`.
    #[inline(always)]
    pub fn map(self, f: impl Fn(R) -> R) -> Self {
        Self { x: f(self.x), y: f(self.y), z: f(self.z) }
    }
}

impl From<DVec3> for Triple<f64> {
    #[inline(always)]
    fn from(v: DVec3) -> Self {
        Self { x: v.x, y: v.y, z: v.z }
    }
}

impl From<Triple<f64>> for DVec3 {
    #[inline(always)]
    fn from(v: Triple<f64>) -> Self {
        DVec3::new(v.x, v.y, v.z)
    }
}

impl<R: Real> Add for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn add(self, o: Self) -> Self {
        Self { x: self.x + o.x, y: self.y + o.y, z: self.z + o.z }
    }
}

impl<R: Real> Sub for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn sub(self, o: Self) -> Self {
        Self { x: self.x - o.x, y: self.y - o.y, z: self.z - o.z }
    }
}

impl<R: Real> Mul<R> for Triple<R> {
    type Output = Self;
    #[inline(always)]
    fn mul(self, by: R) -> Self {
        Self { x: self.x * by, y: self.y * by, z: self.z * by }
    }
}
