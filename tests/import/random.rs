//! Strands of any kind, at any place.

use super::by_hand::{found, step};
use super::*;
use glam::{DAffine3, DQuat};
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::fmt::Write;

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// Whatever the wires, pitch, lay and place: the import finds what the points were made with.
    #[test]
    fn strands_are_found_wherever_they_lie(
        wires in 2_usize..9,
        radius in 0.5..3.0_f64,
        pitch_over_radius in 8.0..40.0_f64,
        turns in 0.3..2.5_f64,
        is_right in any::<bool>(),
        direction in prop::array::uniform3(-1.0..1.0_f64),
        at in prop::array::uniform3(-50.0..50.0_f64),
    ) {
        let direction = DVec3::from(direction);
        prop_assume!(direction.length() > 0.2);
        let turn = DQuat::from_rotation_arc(DVec3::Z, direction.normalize());
        let place = DAffine3::from_rotation_translation(turn, DVec3::from(at));
        let (pitch, lay) = (pitch_over_radius * radius, if is_right { 1.0 } else { -1.0 });
        let (mut text, mut number, mut lines) = (String::new(), 100, Vec::new());
        for wire in 0..wires {
            let first = number;
            let count = (turns * 40.0).ceil() as usize;
            for k in 0..=count {
                let share = turns * k as f64 / count as f64;
                let (sin, cos) = (TAU * (wire as f64 / wires as f64 + lay * share)).sin_cos();
                let p = place.transform_point3(DVec3::new(radius * cos, radius * sin, pitch * share));
                let _ = writeln!(text, "#{number} = CARTESIAN_POINT('',({:.9},{:.9},{:.9}));", p.x, p.y, p.z);
                number += 1;
            }
            let points: Vec<String> = (first..number).map(|n| format!("#{n}")).collect();
            let _ = writeln!(text, "#{number} = POLYLINE('',({}));", points.join(","));
            lines.push(format!("#{number}"));
            number += 1;
        }
        let _ = writeln!(text, "#20 = GEOMETRIC_CURVE_SET('',({}));\n#21 = SHAPE_REPRESENTATION('',(#20),#3);", lines.join(","));
        let found = found("a.step", &step(&text), with_diameter()).unwrap();
        prop_assert_eq!(found.layers.len(), 1);
        let layer = &found.layers[0];
        prop_assert_eq!((layer.wires.len(), layer.lay), (wires, lay));
        // Coordinates have a nanometre at least.
        prop_assert!((layer.radius * 1e3 / radius - 1.0).abs() < 1e-6, "{} {}", layer.radius, radius);
        prop_assert!((layer.pitch * 1e3 / pitch - 1.0).abs() < 1e-6, "{} {}", layer.pitch, pitch);
        prop_assert!(layer.deviation < 1e-8, "{}", layer.deviation);
    }
}
