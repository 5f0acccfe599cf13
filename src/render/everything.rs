//! Everything in one view from an angle: what free bodies get.

use super::camera::Camera;
use super::canvas::{Align, Canvas, Rect, Type, Weight};
use super::data::Data;
use super::kind::{Kind, most_deflected};
use super::labels;
use super::panel::{Panel, Shot};
use crate::base::ticks::label;
use crate::base::units::mm;
use crate::scene::spec::View;
use glam::Vec3;

/// Turn of the eye from the plain side view (rad), about the vertical and the horizontal: of spheres; of wires, which bend
/// across their axis in both directions; and of what is held between grips, so long that seen from the side it is thin.
const TURN: [f64; 2] = [-28f64.to_radians(), 22f64.to_radians()];
const WIRE_TURN: [f64; 2] = [-14f64.to_radians(), 45f64.to_radians()];
const STRAND_TURN: [f64; 2] = [-62f64.to_radians(), 24f64.to_radians()];
/// Room around everything at rest, and by how much the field grows when something leaves it (-).
const ROOM: f32 = 1.15;
const GROWTH: f32 = 1.15;

/// The panel.
pub struct Everything;

impl Panel for Everything {
    fn shots(&self, data: &Data, panel: Rect, unit: f32) -> Vec<Shot> {
        let fade = 2.0 * (data.body.high - data.body.low).length();
        let (caption, remark) = match Kind::of(data.info) {
            Kind::Bent => ("all wires", "line: before loading"),
            _ => ("", ""),
        };
        vec![Shot {
            view: View::Scene,
            camera: camera(data, panel, unit),
            layer: None,
            caption: caption.to_owned(),
            remark: remark.to_owned(),
            fade,
            measures: true,
        }]
    }

    fn annotate(&self, canvas: &mut Canvas, shot: &Shot, data: &Data, _frame: &[Shot]) {
        match Kind::of(data.info) {
            Kind::Bent => deflection(canvas, &shot.camera, data),
            Kind::Collision => speeds(canvas, &shot.camera, data),
            Kind::Pulled | Kind::Held | Kind::Free => (),
        }
    }
}

/// Its field grows by fixed factors when something leaves it.
fn camera(data: &Data, panel: Rect, unit: f32) -> Camera {
    let (body, look) = (data.body, data.camera);
    let turn = match Kind::of(data.info) {
        Kind::Pulled | Kind::Held => STRAND_TURN,
        Kind::Bent => WIRE_TURN,
        Kind::Collision | Kind::Free => TURN,
    };
    let rotation = Camera::orientation(look.azimuth + turn[0], look.elevation + turn[1]);
    // What is pulled becomes longer.
    let high = body.high.with_z(body.high.z + data.stretch());
    let centre = 0.5 * (body.low + high);
    let reach = |points: &mut dyn Iterator<Item = (Vec3, f32)>| {
        points.fold([1e-9f32; 2], |m, (p, r)| {
            let v = rotation * (p - centre);
            [m[0].max(v.x.abs() + r), m[1].max(v.y.abs() + r)]
        })
    };
    let rest = data.info.rest_position.iter().zip(&data.info.radius);
    let rest = rest.flat_map(|(p, r)| [0.0, data.stretch()].map(|dz| (Vec3::from(*p) + Vec3::Z * dz, *r)));
    let [rest_x, rest_y] = reach(&mut rest.into_iter());
    let now = data.snapshot.position.iter().zip(&data.snapshot.radius).map(|(p, r)| (Vec3::from(*p), *r));
    let [now_x, now_y] = reach(&mut now.into_iter());
    let inside = panel.inset(12.0 * unit, 24.0 * unit, 12.0 * unit, 24.0 * unit);
    let fit = |x: f32, y: f32| (0.5 * inside.w / x).min(0.5 * inside.h / y);
    let mut scale = fit(rest_x, rest_y) / ROOM;
    let needed = fit(now_x, now_y);
    while scale > needed && needed > 0.0 {
        scale /= GROWTH;
    }
    let depth = 4.0 * (high - body.low).length() * (fit(rest_x, rest_y) / scale);
    Camera { rotation, centre, panel, scale: scale * look.zoom as f32, depth }
}

/// Each wire's axis before loading, and how far the place has come that moved most.
fn deflection(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    for wire in &data.info.wires {
        let axis: Vec<[f32; 2]> =
            data.info.rest_position[wire.particles()].iter().map(|p| camera.project(Vec3::from(*p))).collect();
        canvas.polyline(&axis, 1.4 * u, data.style.text, 0.8);
    }
    let Some((most, by)) = most_deflected(data.info, data.snapshot) else { return };
    let [from, to] =
        [data.info.rest_position[most], data.snapshot.position[most]].map(|p| camera.project(Vec3::from(p)));
    canvas.line(from, to, 2.4 * u, data.style.signal, 1.0);
    for at in [from, to] {
        canvas.disc(at[0], at[1], 3.4 * u, data.style.text, 1.0);
        canvas.disc(at[0], at[1], 2.2 * u, data.style.signal, 1.0);
    }
    let words = format!("{} mm", label(mm(by), 3));
    let half = 0.5 * canvas.fonts.width(&words, 11.0 * u, Weight::Bold) + 6.0 * u;
    let panel = camera.panel;
    let x = from[0].clamp(panel.x + half, panel.right() - half);
    labels::word(canvas, [x, from[1].min(to[1]) - 24.0 * u], data, &words);
}

/// The speed of each sphere, on it.
fn speeds(canvas: &mut Canvas, camera: &Camera, data: &Data) {
    let u = canvas.unit;
    for (p, speed) in data.snapshot.position.iter().zip(&data.snapshot.speed) {
        let [x, y] = camera.project(Vec3::from(*p));
        let text = format!("{speed:.3} m/s");
        let width = canvas.fonts.width(&text, 13.0 * u, Weight::Bold) + 14.0 * u;
        canvas.fill_rounded(Rect::new(x - 0.5 * width, y - 11.0 * u, width, 22.0 * u), 4.0 * u, data.style.page, 0.8);
        let kind = Type { size: 13.0 * u, weight: Weight::Bold, colour: data.style.text, align: Align::Centre };
        canvas.text(x, y + 4.7 * u, kind, &text);
    }
}
