//! Everything in one view from an angle: what free bodies get.

use super::camera::Camera;
use super::canvas::Rect;
use super::data::Data;
use super::panel::{Panel, Shot};
use crate::scene::spec::View;
use glam::Vec3;

/// Turn of the eye from the plain side view (rad): about the vertical and the horizontal.
const TURN: [f64; 2] = [-28f64.to_radians(), 22f64.to_radians()];

/// The panel.
pub struct Everything;

impl Panel for Everything {
    fn shots(&self, data: &Data, panel: Rect, _unit: f32) -> Vec<Shot> {
        let fade = 2.0 * (data.body.high - data.body.low).length();
        vec![Shot { view: View::Scene, camera: camera(data, panel), caption: "", remark: String::new(), fade }]
    }
}

/// Its field grows by fixed factors when something leaves it.
fn camera(data: &Data, panel: Rect) -> Camera {
    let (body, look) = (data.body, data.camera);
    let rotation = Camera::orientation(look.azimuth + TURN[0], look.elevation + TURN[1]);
    let centre = 0.5 * (body.low + body.high);
    let reach = |points: &mut dyn Iterator<Item = (Vec3, f32)>| {
        points.fold([1e-9f32; 2], |m, (p, r)| {
            let v = rotation * (p - centre);
            [m[0].max(v.x.abs() + r), m[1].max(v.y.abs() + r)]
        })
    };
    let corners = (0..8).map(|k| {
        let pick = |bit: usize, low: f32, high: f32| if k & bit == 0 { low } else { high };
        let p = Vec3::new(
            pick(1, body.low.x, body.high.x),
            pick(2, body.low.y, body.high.y),
            pick(4, body.low.z, body.high.z),
        );
        (p, 0.0)
    });
    let [rest_x, rest_y] = reach(&mut corners.into_iter());
    let now = data.snapshot.position.iter().zip(&data.snapshot.radius).map(|(p, r)| (Vec3::from(*p), *r));
    let [now_x, now_y] = reach(&mut now.into_iter());
    let fit = |x: f32, y: f32| (0.5 * panel.w / x).min(0.5 * panel.h / y);
    let mut scale = fit(rest_x, rest_y) / 1.3;
    let needed = fit(now_x, now_y);
    while scale > needed && needed > 0.0 {
        scale /= 1.5;
    }
    let depth = 4.0 * (body.high - body.low).length() * (fit(rest_x, rest_y) / scale);
    Camera { rotation, centre, panel, scale: scale * look.zoom as f32, depth }
}
