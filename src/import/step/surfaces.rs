//! Surfaces.

use super::model::Read;
use super::reader::Reader;
use super::{placement, splines};
use crate::import::fault::Why;
use crate::import::surface::Surface;

/// A surface that `from` refers to.
pub fn surface(reader: &Reader, from: u64, number: u64) -> Read<Surface> {
    let model = reader.model;
    let instance = model.instance(from, number)?;
    let frame = |name: &str| -> Read<Option<_>> {
        let Some(surface) = model.record(number, name) else { return Ok(None) };
        let frame = placement::frame(model, number, surface.reference(1, "position: a placement")?)?;
        Ok(Some((surface, frame)))
    };
    let angle = reader.angle;
    if let Some((_, frame)) = frame("PLANE")? {
        return Ok(Surface::Plane(frame));
    }
    if let Some((surface, frame)) = frame("CYLINDRICAL_SURFACE")? {
        let radius = surface.positive(2, "radius: a number greater than 0")?;
        return Ok(Surface::Cone { frame, radius, widening: 0.0, angle });
    }
    if let Some((surface, frame)) = frame("CONICAL_SURFACE")? {
        let radius = surface.real(2, "radius: a number")?;
        let widening = (surface.real(3, "half angle: a number")? * angle).tan();
        return Ok(Surface::Cone { frame, radius, widening, angle });
    }
    for name in ["TOROIDAL_SURFACE", "DEGENERATE_TOROIDAL_SURFACE"] {
        if let Some((surface, frame)) = frame(name)? {
            let what = "radii: numbers greater than 0";
            let (major, minor) = (surface.positive(2, what)?, surface.positive(3, what)?);
            return Ok(Surface::Torus { frame, major, minor, angle });
        }
    }
    if instance.records.iter().any(|record| splines::SURFACES.contains(&record.name.as_str())) {
        return splines::surface(model, number).map(Surface::Spline);
    }
    Err(model.fault(number, Why::Kind))
}
