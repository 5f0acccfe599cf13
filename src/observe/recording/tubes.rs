//! Wires as smooth tubes: at each particle a capsule along a bond.
//!
//! A capsule stands at its particle, whose position, radius and colour it shares, so that only its turn and its length
//! are recorded: the layout tells the viewer where the rest is. They hardly change while a strand is stretched, so those
//! of a wire are recorded anew only when one would be seen to be off, and in half precision where that is enough.

use super::names::{LENGTH, TURN};
use super::stream::in_mm;
use crate::engine::view::{BondState, Snapshot, WireInfo};
use glam::{Quat, Vec3};
use rerun::blueprint::VisualizerComponentMapping;
use rerun::{Archetype as _, Capsules3D, ComponentDescriptor, Points3D};

/// How far the end of a capsule may lie beside its particle, over the wire's radius (-): less than a pixel where a wire is
/// fifty wide.
const ASIDE: f32 = 0.03;
/// How much longer than its bond a capsule is drawn, over the wire's radius (-): its end then lies in the next one. The
/// round end of one that is too short would be seen.
const OVERLAP: f32 = 0.1;
/// How much the bond may become shorter before its capsule does, over the wire's radius (-).
const SHORTER: f32 = 0.15;
/// By how much a radius may differ from what is drawn, over itself (-).
const THINNER: f32 = 0.02;

/// What of a wire was recorded last.
#[derive(Default)]
pub(super) struct Drawn {
    turned: Vec<Capsule>,
    long: Vec<Capsule>,
    radii: Vec<f32>,
    states: Vec<BondState>,
}

/// A capsule: the particle that it leads to, counted along the wire, its axis and its radius (mm).
#[derive(Clone, Copy)]
pub(super) struct Capsule {
    to: usize,
    axis: Vec3,
    radius: f32,
}

impl Capsule {
    /// Its turn from the z axis, as a quaternion.
    pub fn turn(&self) -> [f32; 4] {
        Quat::from_rotation_arc(Vec3::Z, self.axis.normalize_or(Vec3::Z)).to_array()
    }

    /// The length that is drawn (mm); none where it leads nowhere.
    pub fn length(&self) -> f32 {
        let bond = self.axis.length();
        if bond > 0.0 { bond + OVERLAP * self.radius } else { 0.0 }
    }

    /// Whether the turn of `drawn` is as good as its own.
    fn turned_like(&self, drawn: &Self) -> bool {
        self.to == drawn.to
            && self.axis.reject_from_normalized(drawn.axis.normalize_or(Vec3::Z)).length() <= ASIDE * self.radius
    }

    /// Whether the length of `drawn` is as good as its own.
    fn as_long_as(&self, drawn: &Self) -> bool {
        let longer = self.length() - drawn.length();
        self.to == drawn.to && (-SHORTER * self.radius..=OVERLAP * self.radius).contains(&longer)
    }
}

/// The capsules of a wire.
pub(super) fn capsules(snapshot: &Snapshot, wire: &WireInfo) -> Vec<Capsule> {
    let holds = |bond: usize| bond + 1 < wire.len && snapshot.bond_state[wire.first + bond] != BondState::Broken;
    let place = |k: usize| Vec3::from(in_mm(snapshot.position[wire.first + k]));
    let capsule = |k: usize| {
        let to = leads_to(holds, k);
        let [radius] = in_mm([snapshot.radius[wire.first + k]]);
        Capsule { to, axis: place(to) - place(k), radius }
    };
    (0..wire.len).map(capsule).collect()
}

/// Puts `now` in the place of what was `drawn` unless that is near enough; says whether it did.
fn renew(drawn: &mut Vec<Capsule>, now: &[Capsule], near: impl Fn(&Capsule, &Capsule) -> bool) -> bool {
    let off = drawn.len() != now.len() || !now.iter().zip(&*drawn).all(|(now, drawn)| near(now, drawn));
    if off {
        now.clone_into(drawn);
    }
    off
}

impl Drawn {
    /// Whether the turns of a wire's capsules must be recorded anew.
    pub fn turns(&mut self, now: &[Capsule]) -> bool {
        renew(&mut self.turned, now, Capsule::turned_like)
    }

    /// Whether their lengths must be recorded anew.
    pub fn lengths(&mut self, now: &[Capsule]) -> bool {
        renew(&mut self.long, now, Capsule::as_long_as)
    }

    /// The radii of a wire's particles (m), when they must be recorded anew.
    pub fn radii(&mut self, snapshot: &Snapshot, wire: &WireInfo) -> Option<&[f32]> {
        let now = &snapshot.radius[wire.particles()];
        let near = |(drawn, now): (&f32, &f32)| (drawn - now).abs() <= THINNER * drawn;
        if self.radii.len() == now.len() && self.radii.iter().zip(now).all(near) {
            return None;
        }
        self.radii = now.to_vec();
        Some(&self.radii)
    }

    /// The states of the bonds that a wire's particles show, when one has changed.
    pub fn states(&mut self, now: Vec<BondState>) -> Option<&[BondState]> {
        if self.states == now {
            return None;
        }
        self.states = now;
        Some(&self.states)
    }
}

/// Where the viewer finds what it draws a wire's capsules from.
pub(super) fn mappings() -> Vec<VisualizerComponentMapping> {
    let from = |target: ComponentDescriptor, source: &str| {
        VisualizerComponentMapping::new_source_component(target.component.as_str(), source)
    };
    let shared = [
        (Capsules3D::descriptor_translations(), Points3D::descriptor_positions()),
        (Capsules3D::descriptor_radii(), Points3D::descriptor_radii()),
        (Capsules3D::descriptor_colors(), Points3D::descriptor_colors()),
    ];
    let own = [(Capsules3D::descriptor_quaternions(), TURN), (Capsules3D::descriptor_lengths(), LENGTH)];
    let shared = shared.into_iter().map(|(target, source)| from(target, source.component.as_str()));
    shared.chain(own.into_iter().map(|(target, source)| from(target, source))).collect()
}

/// The viewer's name for what draws capsules.
pub(super) fn visualizer() -> &'static str {
    Capsules3D::name().short_name()
}

/// The particle that the capsule of particle `k` leads to: the next one; from the last one before a gap, whose colour
/// is to be seen, the one before. That one then stays where it is, so that no bond is drawn twice.
fn leads_to(holds: impl Fn(usize) -> bool, k: usize) -> usize {
    match (k > 0 && holds(k - 1), holds(k), holds(k + 1)) {
        (_, true, true) => k + 1,
        (true, false, _) => k - 1,
        _ => k,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_bond_that_holds_is_drawn_once_and_no_other() {
        let len = 23;
        for broken in [vec![], vec![0], vec![21], vec![3, 4], vec![1, 3, 20], vec![8, 9, 10, 17]] {
            let holds = |bond: usize| bond + 1 < len && !broken.contains(&bond);
            let drawn = (0..len).map(|k| (k, leads_to(holds, k))).filter(|(k, to)| k != to);
            let mut drawn: Vec<usize> = drawn.map(|(k, to)| k.min(to)).collect();
            drawn.sort_unstable();
            let expected: Vec<usize> = (0..len - 1).filter(|bond| holds(*bond)).collect();
            assert_eq!(drawn, expected, "{broken:?}");
        }
    }

    /// A straight wire along z, with a radius of 0.1 mm and a particle each 0.2 mm times `stretch`, the last one aside (m).
    fn wire(stretch: f32, aside: f32) -> (Snapshot, WireInfo) {
        let len = 9;
        let mut position: Vec<[f32; 3]> = (0..len).map(|k| [0.0, 0.0, 2e-4 * stretch * k as f32]).collect();
        position[len - 1][0] = aside;
        let (radius, bond_state) = (vec![1e-4; len], vec![BondState::Whole; len]);
        let snapshot = Snapshot { position, radius, bond_state, ..Snapshot::default() };
        (snapshot, WireInfo { layer: 0, material: 0, first: 0, len, diameter: 2e-4 })
    }

    #[test]
    fn turns_and_lengths_are_recorded_when_what_is_drawn_is_off() {
        let first = |stretch: f32, aside: f32| {
            let (snapshot, of) = wire(stretch, aside);
            capsules(&snapshot, &of)
        };
        let drawn = || {
            let mut drawn = Drawn::default();
            let now = first(1.0, 0.0);
            assert!(drawn.turns(&now) && drawn.lengths(&now), "nothing was drawn before");
            drawn
        };
        for (stretch, aside, turns, lengths) in [
            (1.0, 2.5e-6, false, false),
            (1.0, 3.5e-6, true, false),
            (1.04, 0.0, false, false),
            (1.06, 0.0, false, true),
            (0.94, 0.0, false, false),
            (0.91, 0.0, false, true),
        ] {
            let (now, mut drawn) = (first(stretch, aside), drawn());
            assert_eq!([drawn.turns(&now), drawn.lengths(&now)], [turns, lengths], "{stretch}, {aside}");
        }
        let (mut snapshot, of) = wire(1.0, 0.0);
        snapshot.bond_state[4] = BondState::Broken;
        let (now, mut drawn) = (capsules(&snapshot, &of), drawn());
        assert!(drawn.turns(&now) && drawn.lengths(&now), "a bond broke");
        assert_eq!([now[3].length(), now[4].axis.z], [0.0, -now[0].axis.z], "a gap after the fifth");
        assert!((now[0].length() - 0.21).abs() < 1e-6, "a bond of 0.2 mm, and a tenth of the radius");
    }

    #[test]
    fn a_turn_brings_the_z_axis_onto_the_axis() {
        for axis in [Vec3::Z, Vec3::NEG_Z, Vec3::new(0.3, -0.2, 0.9), Vec3::X] {
            let turned = Quat::from_array(Capsule { to: 1, axis, radius: 1.0 }.turn()) * Vec3::Z;
            assert!((turned - axis.normalize()).length() < 1e-6, "{axis}: {turned}");
        }
    }

    #[test]
    fn radii_are_recorded_when_one_has_changed() {
        let mut drawn = Drawn::default();
        let (mut snapshot, of) = wire(1.0, 0.0);
        assert!(drawn.radii(&snapshot, &of).is_some());
        snapshot.radius[3] *= 0.99;
        assert!(drawn.radii(&snapshot, &of).is_none());
        snapshot.radius[3] *= 0.98;
        assert!(drawn.radii(&snapshot, &of).is_some());
    }
}
