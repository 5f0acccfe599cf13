//! The laws of a run by pairs of materials: one in most runs, which is asked for without looking at the particles.

use super::pair::Laws;
use crate::engine::bytes::behind;
use crate::law::contact::constants::reduced_mass;
use crate::strand::assembly::Assembly;

/// Laws of contacts between the materials of a run.
#[derive(Debug, Clone)]
pub struct LawTable<N, T> {
    /// By [`Self::place`]: every two materials, the lower one the faster.
    laws: Vec<Laws<N, T>>,
    /// Material of each particle; empty with one material.
    material_of: Vec<u32>,
    /// Whether damping is to give a coefficient of restitution.
    restitution: bool,
}

/// Place of the laws between materials `a` and `b`.
pub fn pair_place(a: usize, b: usize) -> usize {
    let (low, high) = (a.min(b), a.max(b));
    high * (high + 1) / 2 + low
}

impl<N, T> LawTable<N, T> {
    /// Laws between `materials` materials, `between(a, b)` those of two.
    pub fn new(materials: usize, assembly: &Assembly, between: impl Fn(usize, usize) -> Laws<N, T>) -> Self {
        let pairs = (0..materials).flat_map(|b| (0..=b).map(move |a| (a, b)));
        let mut material_of = Vec::new();
        if materials > 1 {
            material_of = (0..assembly.len()).map(|particle| assembly.material_of(particle) as u32).collect();
        }
        Self { laws: pairs.map(|(a, b)| between(a, b)).collect(), material_of, restitution: false }
    }

    /// The same, whose damping is to give a coefficient of restitution, or not: see [`Self::damped_mass`].
    pub fn with_restitution(self, restitution: bool) -> Self {
        Self { restitution, ..self }
    }

    /// Whether damping is to give a coefficient of restitution.
    pub fn gives_restitution(&self) -> bool {
        self.restitution
    }

    /// Number of laws.
    pub fn len(&self) -> usize {
        self.laws.len()
    }

    /// Which of the laws is that of two particles.
    #[inline(always)]
    pub fn place(&self, i: usize, j: usize) -> usize {
        if self.material_of.is_empty() {
            return 0;
        }
        pair_place(self.material_of[i] as usize, self.material_of[j] as usize)
    }

    /// Law at a place.
    #[inline(always)]
    pub fn at(&self, place: usize) -> &Laws<N, T> {
        &self.laws[place]
    }

    /// Law between two particles.
    #[inline(always)]
    pub fn between(&self, i: usize, j: usize) -> &Laws<N, T> {
        self.at(self.place(i, j))
    }

    /// Viscous damping of all of them, fraction of critical (-).
    pub fn damping(&self) -> f64 {
        self.laws[0].damping
    }

    /// Reduced mass of two particles for their damping (kg). For a coefficient of restitution one whose place is prescribed
    /// has the mass infinity; where both are, nothing is to be met, and they count as free.
    pub fn damped_mass(&self, masses: [f64; 2], fixed: [u8; 2]) -> f64 {
        const PLACE: u8 = 0b111;
        let still = fixed.map(|fixed| self.restitution && fixed & PLACE == PLACE);
        match (still, masses) {
            ([true, false], [_, mass]) | ([false, true], [mass, _]) => mass,
            (_, [a, b]) => reduced_mass(a, b),
        }
    }

    /// Memory behind it (bytes).
    pub fn bytes(&self) -> usize {
        behind(&self.laws) + behind(&self.material_of)
    }
}

#[cfg(test)]
mod tests {
    use super::pair_place;

    #[test]
    fn every_two_materials_have_a_place_whatever_their_order() {
        let places: Vec<usize> = (0..4).flat_map(|b| (0..=b).map(move |a| pair_place(a, b))).collect();
        assert_eq!(places, (0..10).collect::<Vec<_>>());
        assert_eq!(pair_place(3, 1), pair_place(1, 3));
    }
}
