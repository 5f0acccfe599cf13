//! A line along a wire that is straight before loading: where a grip turns, it shows how the wire is twisted.

use super::wires::{END, JOINT, Looks, Segment};
use crate::engine::view::{RunInfo, Snapshot, WireInfo};
use glam::Vec3;

/// Radius of the line over that of the wire (-).
const WIDTH: f32 = 0.08;
/// Most that the line winds about the wire within one piece (rad).
const WIND: f32 = 0.2;
/// Most pieces of a bond.
const MOST: f32 = 64.0;
/// Linear light of the line (-).
const LIGHT: f32 = 0.8;

/// The lines of all wires, of one layer alone where `layer` names it, and of what a camera `sees` between two places; none where no
/// grip turns.
pub fn segments(
    info: &RunInfo,
    snapshot: &Snapshot,
    looks: &Looks,
    layer: Option<usize>,
    sees: impl Fn([f32; 4], [f32; 4]) -> bool,
) -> Vec<Segment> {
    let mut all = Vec::new();
    let turned = info.wires.iter().enumerate().filter(|_| !snapshot.roll.is_empty());
    for (number, wire) in turned.filter(|(_, wire)| layer.is_none_or(|layer| layer == wire.layer)) {
        add(snapshot, looks, wire, looks.shade_of(number), &sees, &mut all);
    }
    all
}

/// Adds the line of a wire in its `shade`, as far as the wire is drawn and a camera `sees` it.
fn add(
    snapshot: &Snapshot,
    looks: &Looks,
    wire: &WireInfo,
    shade: f32,
    sees: &impl Fn([f32; 4], [f32; 4]) -> bool,
    all: &mut Vec<Segment>,
) {
    let drawn = |bond: usize| {
        wire.bonds().contains(&bond) && snapshot.bond_state[bond].holds() && looks.shows(bond) && looks.shows(bond + 1)
    };
    for bond in wire.bonds().filter(|bond| drawn(*bond)) {
        let ends = [bond, bond + 1].map(|i| Side::of(snapshot, looks, i));
        let wind = ends[1].roll - ends[0].roll;
        let pieces = (wind.abs() / WIND).ceil().clamp(1.0, MOST);
        let outside = [bond.checked_sub(1), Some(bond + 1)].map(|next| next.is_some_and(&drawn));
        for k in 0..pieces as u32 {
            let [from, to] = [k, k + 1].map(|k| ends[0].towards(&ends[1], k as f32 / pieces));
            let along = (Vec3::from_slice(&to) - Vec3::from_slice(&from)).normalize_or_zero();
            let goes_on = [k > 0 || outside[0], (k + 1) as f32 != pieces || outside[1]];
            let [first, last] = goes_on.map(|on| along.extend(if on { JOINT } else { END }).to_array());
            if along != Vec3::ZERO && sees(from, to) {
                let colour = [LIGHT, LIGHT, LIGHT, shade];
                let (tangent_a, tangent_b) = (first, last);
                let [occlusion_a, occlusion_b] = [bond, bond + 1].map(|i| looks.occlusion(i));
                let (colour_a, colour_b) = (colour, colour);
                all.push(Segment {
                    a: from,
                    b: to,
                    tangent_a,
                    tangent_b,
                    colour_a,
                    colour_b,
                    occlusion_a,
                    occlusion_b,
                });
            }
        }
    }
}

/// Where the line lies on the surface around a particle.
struct Side {
    centre: Vec3,
    radius: f32,
    tangent: Vec3,
    roll: f32,
}

impl Side {
    fn of(snapshot: &Snapshot, looks: &Looks, i: usize) -> Self {
        let (centre, tangent) = looks.place(i);
        Self { centre, radius: snapshot.radius[i], tangent, roll: snapshot.roll[i] }
    }

    /// A point of the line and its radius (m), at `share` of the way to the next side (-).
    fn towards(&self, next: &Self, share: f32) -> [f32; 4] {
        let centre = self.centre.lerp(next.centre, share);
        let radius = self.radius + (next.radius - self.radius) * share;
        let tangent = self.tangent.lerp(next.tangent, share).try_normalize().unwrap_or(Vec3::Z);
        let roll = self.roll + (next.roll - self.roll) * share;
        // Before loading it faces the eye of an unturned view, which looks along +x; of wires along x, it lies on top.
        let facing = if tangent.x.abs() < 0.9 { Vec3::NEG_X } else { Vec3::Y };
        let unturned = facing.reject_from_normalized(tangent).normalize();
        let outward = unturned * roll.cos() + tangent.cross(unturned) * roll.sin();
        (centre + radius * outward).extend(WIDTH * radius).to_array()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::BondState;

    /// A wire along z of three particles, 1 apart and of radius 0.5, turned by a quarter from each to the next.
    fn wire() -> (RunInfo, Snapshot) {
        let wires = vec![WireInfo { len: 3, diameter: 1.0, ..WireInfo::default() }];
        let position: Vec<[f32; 3]> = (0..3u8).map(|k| [0.0, 0.0, f32::from(k)]).collect();
        let info = RunInfo {
            wires,
            wire_particles: 3,
            particles: 3,
            radius: vec![0.5; 3],
            rest_position: position.clone(),
            ..RunInfo::default()
        };
        let quarter = std::f32::consts::FRAC_PI_2;
        let bond_state = vec![BondState::Whole, BondState::Whole, BondState::Absent];
        let roll = vec![0.0, quarter, 2.0 * quarter];
        (info, Snapshot { position, radius: vec![0.5; 3], bond_state, roll, ..Snapshot::default() })
    }

    fn line(snapshot: &Snapshot, info: &RunInfo) -> Vec<Segment> {
        let looks = Looks::new(info, snapshot, snapshot.position.clone(), &[[90; 3]; 3], vec![1.0], Vec::new());
        let mut all = Vec::new();
        add(snapshot, &looks, &info.wires[0], 1.0, &|_, _| true, &mut all);
        all
    }

    #[test]
    fn a_line_winds_about_its_wire_as_the_wire_is_twisted() {
        let (info, snapshot) = wire();
        let all = line(&snapshot, &info);
        // From -x over -y to +x: right-handed about +z.
        let near = |point: [f32; 4], right: [f32; 3]| {
            let off = Vec3::from_slice(&point).distance(Vec3::from(right));
            assert!(off < 1e-5, "{point:?} is not {right:?}");
        };
        near(all[0].a, [-0.5, 0.0, 0.0]);
        near(all[all.len() / 2].a, [0.0, -0.5, 1.0]);
        near(all[all.len() - 1].b, [0.5, 0.0, 2.0]);
        assert!(all.windows(2).all(|pair| pair[0].b == pair[1].a), "the line is whole");
        assert!(all.iter().all(|s| (Vec3::from_slice(&s.a).truncate().length() - 0.5).abs() < 1e-5));
        assert_eq!((all[0].tangent_a[3], all[0].tangent_b[3]), (END, JOINT));
        assert_eq!(all[all.len() - 1].tangent_b[3], END);
    }

    #[test]
    fn a_broken_wire_has_a_broken_line() {
        let (info, mut snapshot) = wire();
        snapshot.bond_state[1] = BondState::Broken;
        let all = line(&snapshot, &info);
        assert!(all.iter().all(|s| s.b[2] <= 1.0));
        assert_eq!(all[all.len() - 1].tangent_b[3], END);
    }
}
