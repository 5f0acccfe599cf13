//! Units of what leaves the engine for pictures.

/// A place in mm.
pub fn millimetres(p: glam::DVec3) -> [f32; 3] {
    (p * 1e3).as_vec3().to_array()
}
