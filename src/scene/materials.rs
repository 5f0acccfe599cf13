//! Materials of a scene. A scene of one material keeps it in [`Spec::material`] and [`Spec::bond`], whether it has a name or
//! not; the others of a scene with several stand in [`Spec::further`]. A material's number is its place in that order, which
//! is the order in which bodies name them: layers from the inside out, wires, spheres.

use super::spec::{BondSpec, ContactSpec, NormalSpec, OneMaterial, RuptureSpec, Spec};

impl OneMaterial<'_> {
    /// Name of the material of `[material]` and `[bond]` beside others.
    pub const UNNAMED: &'static str = "default";

    /// Its name for people.
    pub fn label(&self) -> &str {
        self.name.unwrap_or(Self::UNNAMED)
    }
}

impl Spec {
    /// All materials of which there are bodies, by number.
    pub fn materials(&self) -> impl ExactSizeIterator<Item = OneMaterial<'_>> {
        (0..self.further.len() + 1).map(|number| self.material_at(number))
    }

    /// Material `number`; there is one of number 0 always.
    pub fn material_at(&self, number: usize) -> OneMaterial<'_> {
        match number.checked_sub(1).map(|k| &self.further[k]) {
            None => OneMaterial {
                name: self.material_name.as_deref(),
                material: &self.material,
                bond: &self.bond,
                limiting_pressure: self.contact.as_ref().and_then(|contact| match contact.normal {
                    NormalSpec::Hertz => None,
                    NormalSpec::Thornton { limiting_pressure } => Some(limiting_pressure),
                }),
            },
            Some(further) => OneMaterial {
                name: further.name.as_deref(),
                material: &further.material,
                bond: &further.bond,
                limiting_pressure: further.limiting_pressure,
            },
        }
    }

    /// What bonds do, of all materials by number, to be changed.
    pub fn bonds_mut(&mut self) -> impl Iterator<Item = &mut BondSpec> {
        std::iter::once(&mut self.bond).chain(self.further.iter_mut().map(|further| &mut further.bond))
    }

    /// Whether there is more than one material.
    pub fn has_several_materials(&self) -> bool {
        !self.further.is_empty()
    }

    /// Whether bonds of any material can break.
    pub fn breaks(&self) -> bool {
        self.ruptures().next().is_some()
    }

    /// What breaks bonds, of all materials whose bonds break.
    pub fn ruptures(&self) -> impl Iterator<Item = &RuptureSpec> {
        let further = self.further.iter().map(|further| &further.bond);
        std::iter::once(&self.bond).chain(further).filter_map(|bond| bond.rupture.as_ref())
    }
}

impl ContactSpec {
    /// Coulomb friction coefficient between bodies of two materials (-).
    pub fn friction_between(&self, a: usize, b: usize) -> f64 {
        let pair = self.pairs.iter().find(|pair| pair.materials == [a.min(b), a.max(b)]);
        pair.map_or(self.friction, |pair| pair.friction)
    }

    /// Whether bodies of no two materials rub: there are `materials` of them.
    pub fn is_smooth(&self, materials: usize) -> bool {
        let all = (0..materials).flat_map(|a| (a..materials).map(move |b| (a, b)));
        self.tangential.is_none() || all.into_iter().all(|(a, b)| self.friction_between(a, b) == 0.0)
    }
}
