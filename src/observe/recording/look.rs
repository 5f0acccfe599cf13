//! Where the close view looks: at the main fracture; before there is one, at the first break; before that, at
//! mid-length.

use super::first_break::ViewDirection;
use super::marks::place;
use super::sections::thickness;
use crate::base::units::mm;
use crate::engine::view::{RunInfo, Rupture};
use crate::observe::fracture::{LENGTH, MAIN, densest};
use glam::Vec3;

/// What the close view shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Subject {
    Middle,
    FirstBreak,
    MainFracture,
}

/// A section, and what broke there.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Look {
    subject: Subject,
    /// z before loading (mm).
    pub rest_z: f32,
    /// The outermost layer below the surface in which a wire broke there.
    pub layer: Option<usize>,
    /// What broke there.
    there: Vec<Rupture>,
}

impl Look {
    /// Where to look after `ruptures`; at `middle` (mm) when nothing broke.
    pub fn new(info: &RunInfo, ruptures: &[Rupture], middle: f32) -> Self {
        let Some(first) = ruptures.first() else {
            return Self { subject: Subject::Middle, rest_z: middle, layer: None, there: Vec::new() };
        };
        let rest_z = |r: &Rupture| mm(r.rest_z) as f32;
        let length = LENGTH * 0.5 * thickness(info);
        let fracture = densest(ruptures.iter().map(|r| (rest_z(r), r.wire)), length);
        let (subject, z) = match fracture.wires {
            MAIN.. => (Subject::MainFracture, fracture.z),
            _ => (Subject::FirstBreak, rest_z(first)),
        };
        let near = |r: &&Rupture| match subject {
            Subject::MainFracture => (rest_z(r) - z).abs() <= 0.5 * length,
            _ => r.order == first.order,
        };
        let there: Vec<Rupture> = ruptures.iter().filter(near).cloned().collect();
        let outermost = info.layers.len().saturating_sub(1);
        let layer = there.iter().map(|r| r.layer).filter(|layer| *layer < outermost).max();
        Self { subject, rest_z: z, layer, there }
    }

    /// From the side on which bonds broke, as seen from where the middle of the section was at that step (mm).
    pub fn direction(&self, axis: impl Fn(u64) -> [f32; 3]) -> ViewDirection {
        let off = self.there.iter().map(|r| Vec3::from(place(r)) - Vec3::from(axis(r.step)));
        let sum: Vec3 = off.map(|off| off.with_z(0.0).normalize_or_zero()).sum();
        ViewDirection::towards(sum.to_array(), [0.0; 3])
    }

    /// What is shown, such as `Main fracture, z = 60 mm`.
    pub fn name(&self) -> String {
        match self.subject {
            Subject::Middle => "Mid-section".to_owned(),
            Subject::FirstBreak => format!("Where it first broke, z = {:.0} mm", self.rest_z),
            Subject::MainFracture => format!("Main fracture, z = {:.0} mm", self.rest_z),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::WireInfo;

    /// Three layers of a bundle with a radius of a millimetre, each wire of one particle.
    fn bundle() -> RunInfo {
        let wire = |layer| WireInfo { layer, material: 0, first: layer, len: 1, diameter: 1e-3 };
        RunInfo {
            layers: ["inner", "middle", "outer"].map(str::to_owned).to_vec(),
            wires: (0..3).map(wire).collect(),
            wire_particles: 3,
            particles: 3,
            radius: vec![0.5e-3; 3],
            rest_position: vec![[0.0; 3], [0.2e-3, 0.0, 0.0], [0.5e-3, 0.0, 0.0]],
            ..RunInfo::default()
        }
    }

    fn rupture(wire: usize, layer: usize, z: f64) -> Rupture {
        Rupture { order: wire, wire, layer, rest_z: z * 1e-3, position: [1e-3, 0.0, z * 1e-3], ..Rupture::default() }
    }

    #[test]
    fn the_main_fracture_takes_the_place_of_the_first_break() {
        let (info, first) = (bundle(), rupture(8, 1, 39.0));
        let look = |ruptures: &[Rupture]| Look::new(&info, ruptures, 50.0);
        assert_eq!((look(&[]).name(), look(&[]).rest_z), ("Mid-section".to_owned(), 50.0));
        let two = [first.clone(), rupture(20, 2, 60.0), rupture(21, 2, 60.5)];
        assert_eq!((look(&two).name(), look(&two).layer), ("Where it first broke, z = 39 mm".to_owned(), Some(1)));
        let many = [first, rupture(20, 2, 60.0), rupture(21, 2, 60.5), rupture(1, 0, 61.0)];
        assert_eq!((look(&many).name(), look(&many).layer), ("Main fracture, z = 60 mm".to_owned(), Some(0)));
        assert_eq!(look(&many).direction(|_| [0.0; 3]).eye, [1.0, 0.0, 0.0]);
    }
}
