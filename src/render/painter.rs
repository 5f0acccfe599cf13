//! Wires drawn on the graphics adapter into memory: what frames and the interactive stage share.

use super::adapter::Gpu;
use super::solid::{Drawing, SolidPipeline};
use super::style::Style;
use super::target::Target;
use super::wires::Segment;
use crate::base::error::{Error, Result};

/// The adapter, ready to draw pictures of one size.
pub struct Painter {
    gpu: Gpu,
    pipeline: SolidPipeline,
    target: Target,
}

impl Painter {
    /// Opens the adapter for pictures of `size` (px).
    ///
    /// # Errors
    /// When there is no adapter, or it cannot draw that size.
    pub fn open(size: [u32; 2]) -> Result<Self> {
        let gpu = Gpu::open()?;
        check(&gpu, size)?;
        let pipeline = SolidPipeline::new(&gpu)?;
        let target = Target::new(&gpu, size);
        Ok(Self { gpu, pipeline, target })
    }

    /// Name of the adapter.
    pub fn adapter(&self) -> &str {
        &self.gpu.name
    }

    /// From now on draws pictures of `size` (px).
    ///
    /// # Errors
    /// When the adapter cannot draw that size.
    pub fn resize(&mut self, size: [u32; 2]) -> Result<()> {
        if size != self.target.size {
            check(&self.gpu, size)?;
            self.target = Target::new(&self.gpu, size);
        }
        Ok(())
    }

    /// Copies segments to the adapter, to be drawn any number of times.
    pub fn upload(&self, segments: &[Segment]) -> wgpu::Buffer {
        self.pipeline.upload(&self.gpu, segments)
    }

    /// Draws into a picture whose top left corner is pixel `origin` of the panels.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn draw(&self, origin: [f32; 2], style: &Style, segments: &wgpu::Buffer, drawings: &[Drawing]) -> Result<()> {
        self.pipeline.draw(&self.gpu, &self.target, origin, style, segments, drawings)
    }

    /// Hands the rows of the picture, top first, as RGBA bytes (sRGB) to `row(y, bytes)`.
    ///
    /// # Errors
    /// When the adapter is lost.
    pub fn read(&self, row: impl FnMut(u32, &[u8])) -> Result<()> {
        self.target.read(&self.gpu, row)
    }
}

fn check(gpu: &Gpu, [w, h]: [u32; 2]) -> Result<()> {
    let limit = gpu.device.limits().max_texture_dimension_2d;
    if w == 0 || h == 0 || w > limit || h > limit {
        let what = format!("the graphics adapter {} cannot draw {w} × {h} pixels", gpu.name);
        return Err(Error::input(what, format!("choose a size from 1 × 1 to {limit} × {limit} pixels")));
    }
    Ok(())
}
