//! The unrolled map as recording, frames and page draw it: a row per wire, layers apart, the place before loading (mm)
//! along it. Places never change, so that only colours do.

use super::wording::wire_number;
use crate::base::units::mm;
use crate::engine::view::{RunInfo, Rupture};

/// Rows and columns of a map.
#[derive(Debug, Clone, PartialEq)]
pub struct Unrolled {
    /// Middle of each wire's row, in rows from the map's edge (-).
    pub row: Vec<f64>,
    /// Rows in all, gaps between layers included (-).
    pub rows: f64,
    /// Ends of the body (mm).
    pub ends: [f64; 2],
    /// Faces of the grips (mm), where there are any.
    pub grips: Option<[f64; 2]>,
    /// Layers that have wires.
    pub layers: Vec<Layer>,
}

/// Rows of a layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// Its index.
    pub layer: usize,
    /// Its first and last wire, from 0.
    pub wires: [usize; 2],
    /// Middle of its rows (-).
    pub row: f64,
}

impl Layer {
    /// Numbers of its wires for people, such as `17–34`.
    pub fn numbers(&self) -> String {
        match self.wires.map(wire_number) {
            [first, last] if first == last => first.to_string(),
            [first, last] => format!("{first}–{last}"),
        }
    }
}

impl Unrolled {
    /// The map with `gap` rows between layers, taken in the order given.
    pub fn new(info: &RunInfo, gap: f64, order: impl Iterator<Item = usize>) -> Self {
        let mut map =
            Self { row: vec![0.0; info.wires.len()], rows: 0.0, ends: ends(info), grips: None, layers: Vec::new() };
        map.grips = info.gauge.map(|faces| faces.map(mm));
        for layer in order {
            let start = map.rows;
            let mut of = info.wires_of(layer).map(|(number, _)| number);
            let Some(first) = of.next() else { continue };
            let mut last = first;
            for (k, wire) in std::iter::once(first).chain(of).enumerate() {
                map.row[wire] = start + k as f64 + 0.5;
                map.rows = start + k as f64 + 1.0 + gap;
                last = wire;
            }
            map.layers.push(Layer { layer, wires: [first, last], row: 0.5 * (map.row[first] + map.row[last]) });
        }
        // None after the last.
        map.rows = (map.rows - gap).max(0.0);
        map
    }
}

/// z of the ends of a body before loading (mm).
pub fn ends(info: &RunInfo) -> [f64; 2] {
    let z = info.rest_position.iter().zip(&info.radius).map(|(p, r)| [p[2] - r, p[2] + r]);
    let [low, high] = z.fold([f32::INFINITY, f32::NEG_INFINITY], |[low, high], [a, b]| [low.min(a), high.max(b)]);
    if low < high { [low, high].map(|z| mm(z.into())) } else { [0.0, 1.0] }
}

/// Where the bonds of a wire are before loading (mm): z in a body between grips; for a free one, which may lie in any
/// direction, the length along the wire.
pub fn bonds(info: &RunInfo, wire: usize) -> Vec<f64> {
    let particles = &info.rest_position[info.wires[wire].particles()];
    if info.gauge.is_some() {
        return particles.windows(2).map(|pair| mm(0.5 * f64::from(pair[0][2] + pair[1][2]))).collect();
    }
    let lengths =
        particles.windows(2).map(|pair| (0..3).map(|k| f64::from(pair[1][k] - pair[0][k]).powi(2)).sum::<f64>().sqrt());
    let centres = lengths.scan(0.0, |so_far, length| {
        let centre = *so_far + 0.5 * length;
        *so_far += length;
        Some(mm(centre))
    });
    centres.collect()
}

/// Where a rupture is along the map (mm).
pub fn place(info: &RunInfo, rupture: &Rupture) -> f64 {
    match info.gauge {
        Some(_) => mm(rupture.rest_z),
        None => bonds(info, rupture.wire).get(rupture.bond_in_wire).copied().unwrap_or(0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::engine::view::WireInfo;

    #[test]
    fn rows_follow_the_order_of_layers_with_a_gap_between() {
        let wires = [0, 1, 1].map(|layer| WireInfo { layer, ..WireInfo::default() }).to_vec();
        let info = RunInfo { layers: vec!["core".into(), "outer".into(), "bare".into()], wires, ..RunInfo::default() };
        let inwards = Unrolled::new(&info, 1.5, (0..3).rev());
        assert_eq!((inwards.row, inwards.rows), (vec![4.0, 0.5, 1.5], 4.5), "a layer without wires takes no room");
        let outwards = Unrolled::new(&info, 1.5, 0..3);
        assert_eq!(outwards.row, [0.5, 3.0, 4.0]);
        let layers: Vec<_> = outwards.layers.iter().map(|of| (of.layer, of.numbers(), of.row)).collect();
        assert_eq!(layers, [(0, "1".to_owned(), 0.5), (1, "2–3".to_owned(), 3.5)]);
    }

    #[test]
    fn bonds_of_a_free_wire_lie_along_it_and_those_between_grips_along_the_axis() {
        let rest_position = vec![[0.0; 3], [3e-3, 0.0, 4e-3], [3e-3, 2e-3, 4e-3]];
        let wires = vec![WireInfo { len: 3, ..WireInfo::default() }];
        let mut info = RunInfo { wires, rest_position, ..RunInfo::default() };
        let near = |found: Vec<f64>, right: [f64; 2]| found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-5);
        assert!(near(bonds(&info, 0), [2.5, 6.0]), "{:?}", bonds(&info, 0));
        info.gauge = Some([0.0, 1.0]);
        assert!(near(bonds(&info, 0), [2.0, 4.0]), "{:?}", bonds(&info, 0));
    }
}
