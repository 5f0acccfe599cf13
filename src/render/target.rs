//! An off-screen picture on the adapter: four samples a pixel, read back into memory.

use super::adapter::{Gpu, failure};
use super::supersample::average;
use crate::base::error::Result;

/// Format of what is drawn: shaders write linear light, the adapter stores sRGB.
pub const COLOUR: wgpu::TextureFormat = wgpu::TextureFormat::Rgba8UnormSrgb;
/// Format of depth.
pub const DEPTH: wgpu::TextureFormat = wgpu::TextureFormat::Depth32Float;
/// Samples per pixel; 4 is what every adapter has.
pub const SAMPLES: u32 = 4;

/// The picture and what it takes to read it back.
pub struct Target {
    /// Width and height of the picture (px).
    pub size: [u32; 2],
    /// How many times finer it is drawn.
    pub times: u32,
    resolved: wgpu::Texture,
    samples: wgpu::TextureView,
    depth: wgpu::TextureView,
    staging: wgpu::Buffer,
    row_bytes: u32,
}

impl Target {
    /// A target of `size` (px), at least one pixel, that is drawn `times` finer in either direction.
    pub fn new(gpu: &Gpu, size: [u32; 2], times: u32) -> Self {
        let [width, height] = size.map(|side| side * times);
        let extent = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
        let texture = |format, sample_count, usage| {
            gpu.device.create_texture(&wgpu::TextureDescriptor {
                label: Some("frame"),
                size: extent,
                mip_level_count: 1,
                sample_count,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        let resolved = texture(COLOUR, 1, attachment | wgpu::TextureUsages::COPY_SRC);
        let samples = texture(COLOUR, SAMPLES, attachment).create_view(&Default::default());
        let depth = texture(DEPTH, SAMPLES, attachment).create_view(&Default::default());
        // Rows of a copied texture must start at multiples of 256 bytes.
        let row_bytes = (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let staging = gpu.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("read-back"),
            size: u64::from(row_bytes) * u64::from(height),
            usage: wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        Self { size, times, resolved, samples, depth, staging, row_bytes }
    }

    /// Clears to `background` (linear RGB), lets `draw` record, and has it drawn and copied back, without waiting for it.
    pub fn draw(&self, gpu: &Gpu, background: [f32; 4], draw: impl FnOnce(&mut wgpu::RenderPass)) {
        let [r, g, b, a] = background.map(f64::from);
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        {
            let resolved = self.resolved.create_view(&Default::default());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("frame"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: &self.samples,
                    depth_slice: None,
                    resolve_target: Some(&resolved),
                    ops: wgpu::Operations {
                        load: wgpu::LoadOp::Clear(wgpu::Color { r, g, b, a }),
                        store: wgpu::StoreOp::Discard,
                    },
                })],
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: &self.depth,
                    depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Discard }),
                    stencil_ops: None,
                }),
                ..Default::default()
            });
            draw(&mut pass);
        }
        encoder.copy_texture_to_buffer(
            self.resolved.as_image_copy(),
            wgpu::TexelCopyBufferInfo {
                buffer: &self.staging,
                layout: wgpu::TexelCopyBufferLayout {
                    offset: 0,
                    bytes_per_row: Some(self.row_bytes),
                    rows_per_image: Some(self.size[1] * self.times),
                },
            },
            self.resolved.size(),
        );
        gpu.queue.submit([encoder.finish()]);
    }

    /// Waits for the picture that was drawn last and hands its rows, top first, as RGBA bytes (sRGB) to `row(y, bytes)`.
    pub fn read(&self, gpu: &Gpu, mut row: impl FnMut(u32, &[u8])) -> Result<()> {
        // A failed mapping shows as an error of `get_mapped_range` below.
        self.staging.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        wait(gpu)?;
        {
            let bytes = self
                .staging
                .slice(..)
                .get_mapped_range()
                .map_err(|e| failure(format!("cannot read the picture back from {}: {e}", gpu.name)))?;
            let [width, times] = [self.size[0], self.times].map(|count| count as usize);
            let rows: Vec<&[u8]> =
                bytes.chunks_exact(self.row_bytes as usize).map(|row| &row[..width * times * 4]).collect();
            let mut mean = vec![0; width * 4];
            for (y, rows) in (0..).zip(rows.chunks_exact(times)) {
                match rows {
                    [one] => row(y, one),
                    several => {
                        average(several, times, y, &mut mean);
                        row(y, &mean);
                    }
                }
            }
        }
        self.staging.unmap();
        Ok(())
    }
}

fn wait(gpu: &Gpu) -> Result<()> {
    gpu.device
        .poll(wgpu::PollType::wait_indefinitely())
        .map(|_| ())
        .map_err(|e| failure(format!("the graphics adapter {} was lost: {e}", gpu.name)))
}
