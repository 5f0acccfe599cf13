//! Draws segments through cameras into memory: the only pipeline there is.

use super::adapter::{Gpu, failure};
use super::camera::Camera;
use super::canvas::Rect;
use super::style::Style;
use super::target::{COLOUR, DEPTH, SAMPLES, Target};
use super::wires::{JOINT, Segment};
use crate::base::error::{Error, Result};
use glam::{Vec2, Vec3};
use std::f32::consts::PI;
use std::ops::Range;
use wgpu::util::DeviceExt;

/// Source of the shader.
pub const SHADER: &str = include_str!("wires.wgsl");

/// What the shader knows of a view; the layout of `View` in `wires.wgsl`.
#[repr(C)]
#[derive(Debug, Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct ViewUniform {
    rotation: [[f32; 4]; 3],
    centre: [f32; 4],
    scale: [f32; 4],
    rim: [f32; 4],
    fade: [f32; 4],
    signal: [f32; 4],
    cut: [f32; 4],
}

/// Segments of a list, seen through a camera into its panel.
pub struct Drawing {
    camera: Camera,
    /// Which segments, by [`Shape`].
    segments: [Range<u32>; SHAPES],
    /// Facets of a roof and of a tube.
    facets: [u32; 2],
    fade: f32,
    /// Component of a wire's direction along the line of sight up to which it is a roof (-).
    steep: f32,
}

/// What a segment is drawn as: see `wires.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Shape {
    /// A piece of wire that goes on at both ends.
    Roof,
    /// The same, where it points to the eye or turns.
    Tube,
    /// An end, a neck, a sphere.
    Capsule,
}

const SHAPES: usize = 3;
/// Component of a wire's direction along the line of sight up to which it is a roof (-), where lines of sight are parallel.
const STEEP: f32 = 0.85;
/// By how much a roof may turn in the picture, and a tube in space: cosines (-).
const TURN: [f32; 2] = [0.95, 0.5];
/// Radius up to which a roof is flat (px): by how much wires press into one another is too little to be seen.
const FLAT: f32 = 2.5;
/// Fewest and most facets of a tube.
const FACETS: std::ops::RangeInclusive<u32> = 8..=40;

impl Drawing {
    /// Adds those of `segments` that `camera` sees to the list `all`; its panel is in pixels of the frame. Things darken over
    /// the depth `fade` (m).
    pub fn new(camera: Camera, fade: f32, segments: &[Segment], all: &mut Vec<Segment>) -> Self {
        Self::up_to(STEEP, camera, fade, segments, all)
    }

    /// The same without roofs: where lines of sight are not parallel, wires pass from roof to tube within the picture, and what
    /// they press into one another would jump there.
    #[cfg(feature = "explore")]
    pub fn round(camera: Camera, fade: f32, segments: &[Segment], all: &mut Vec<Segment>) -> Self {
        Self::up_to(-1.0, camera, fade, segments, all)
    }

    fn up_to(steep: f32, camera: Camera, fade: f32, segments: &[Segment], all: &mut Vec<Segment>) -> Self {
        let towards_eye = camera.to_eye();
        let mut seen: [Vec<(f32, u32)>; SHAPES] = Default::default();
        let mut widest = [0f32; SHAPES];
        for (number, segment) in segments.iter().enumerate().filter(|(_, s)| camera.sees(s.a, s.b)) {
            let shape = Shape::of(segment, &camera, steep);
            widest[shape as usize] = widest[shape as usize].max(segment.a[3]);
            seen[shape as usize].push((towards_eye.dot(xyz(segment.a) + xyz(segment.b)), number as u32));
        }
        let ranges = seen.map(|mut seen| {
            // From the eye into the depth: what is hidden is then not shaded.
            seen.sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
            let start = all.len() as u32;
            all.extend(seen.iter().map(|(_, number)| segments[*number as usize]));
            start..all.len() as u32
        });
        let [roof, tube, _] = widest.map(|radius| radius * camera.scale);
        // The outline of a tube is off by a tenth of a pixel at most: by the radius times (π / facets)² / 2.
        let of_tube = (PI * (5.0 * tube).sqrt()).ceil() as u32;
        let facets = [if roof < FLAT { 1 } else { 2 }, of_tube.clamp(*FACETS.start(), *FACETS.end())];
        Self { camera, segments: ranges, facets, fade, steep }
    }
}

impl Shape {
    fn of(segment: &Segment, camera: &Camera, steep: f32) -> Self {
        if segment.tangent_a[3] != JOINT || segment.tangent_b[3] != JOINT {
            return Self::Capsule;
        }
        let [a, b] = [segment.tangent_a, segment.tangent_b].map(|t| camera.rotation * xyz(t));
        let turn = |a: Vec2, b: Vec2| a.dot(b) / (a.length_squared() * b.length_squared()).sqrt();
        if a.z.abs().max(b.z.abs()) < steep && turn(a.truncate(), b.truncate()) > TURN[0] {
            Self::Roof
        } else if a.dot(b) > TURN[1] {
            Self::Tube
        } else {
            Self::Capsule
        }
    }
}

fn xyz([x, y, z, _]: [f32; 4]) -> Vec3 {
    Vec3::new(x, y, z)
}

/// The adapter, ready to draw wires into memory: what frames and the explorer share. Its functions fail when the
/// adapter is lost or cannot draw the size that is asked for.
pub struct Painter {
    gpu: Gpu,
    /// By [`Shape`]; the last one is for thin roofs.
    pipelines: [wgpu::RenderPipeline; SHAPES + 1],
    layout: wgpu::BindGroupLayout,
    target: Target,
}

impl Painter {
    /// Opens the adapter for pictures of `size` (px) that are drawn `times` finer, and compiles the shader.
    pub fn open(size: [u32; 2], times: u32) -> Result<Self> {
        let gpu = Gpu::open()?;
        check(&gpu, size, times)?;
        let target = Target::new(&gpu, size, times);
        // Two scopes, because what a backend cannot translate is reported as an internal error, not a validation one.
        let internal = gpu.device.push_error_scope(wgpu::ErrorFilter::Internal);
        let validation = gpu.device.push_error_scope(wgpu::ErrorFilter::Validation);
        let (layout, pipelines) = compile(&gpu);
        let errors = [pollster::block_on(validation.pop()), pollster::block_on(internal.pop())];
        match errors.into_iter().flatten().next() {
            Some(e) => Err(failure(format!("the graphics adapter {} refused a shader: {e}", gpu.name))),
            None => Ok(Self { gpu, pipelines, layout, target }),
        }
    }

    /// Name of the adapter.
    pub fn adapter(&self) -> &str {
        &self.gpu.name
    }

    /// From now on draws pictures of `size` (px), `times` finer.
    #[cfg(feature = "explore")]
    pub fn resize(&mut self, size: [u32; 2], times: u32) -> Result<()> {
        if (size, times) != (self.target.size, self.target.times) {
            check(&self.gpu, size, times)?;
            self.target = Target::new(&self.gpu, size, times);
        }
        Ok(())
    }

    fn upload(&self, segments: &[Segment]) -> wgpu::Buffer {
        self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("segments"),
            contents: bytemuck::cast_slice(segments),
            usage: wgpu::BufferUsages::VERTEX,
        })
    }

    /// Begins to draw a picture whose top left corner is pixel `origin` of the panels; it is there when it is read.
    pub fn draw(&self, origin: [f32; 2], style: &Style, segments: &[Segment], drawings: &[Drawing]) {
        // Where all is hidden there is only the ground.
        let nothing = segments.is_empty();
        let times = self.target.times as f32;
        let segments = self.upload(segments);
        let views: Vec<_> = drawings.iter().map(|d| self.bind(d, style)).collect();
        self.target.draw(&self.gpu, super::colour::linear4(style.panel), |pass| {
            for (drawing, view) in drawings.iter().zip(&views).filter(|_| !nothing) {
                let Rect { x, y, w, h } = drawing.camera.panel;
                let [x, y, w, h] = [x - origin[0], y - origin[1], w, h].map(|pixels| pixels * times);
                pass.set_viewport(x, y, w, h, 0.0, 1.0);
                pass.set_scissor_rect(x as u32, y as u32, w as u32, h as u32);
                pass.set_bind_group(0, view, &[]);
                pass.set_vertex_buffer(0, segments.slice(..));
                let [roof, tube] = drawing.facets.map(|facets| 2 * (facets + 1));
                let corners = [roof, tube, 4];
                let [thick, tubes, capsules, thin] = &self.pipelines;
                let pipelines = [if drawing.facets[0] == 1 { thin } else { thick }, tubes, capsules];
                for ((pipeline, corners), which) in pipelines.into_iter().zip(corners).zip(&drawing.segments) {
                    if !which.is_empty() {
                        pass.set_pipeline(pipeline);
                        pass.draw(0..corners, which.clone());
                    }
                }
            }
            // On the GL backend the last scissor also cuts what is resolved when the pass ends.
            let [width, height] = self.target.size.map(|side| side * self.target.times);
            pass.set_scissor_rect(0, 0, width, height);
        });
    }

    /// Waits for the picture that was drawn last and hands its rows, top first, as RGBA bytes (sRGB) to `row(y, bytes)`.
    pub fn read(&self, row: impl FnMut(u32, &[u8])) -> Result<()> {
        self.target.read(&self.gpu, row)
    }

    fn bind(&self, drawing: &Drawing, style: &Style) -> wgpu::BindGroup {
        let camera = &drawing.camera;
        let [rx, ry, rz] = camera.rotation.to_cols_array_2d();
        let column = |c: [f32; 3]| [c[0], c[1], c[2], 0.0];
        let [r, g, b] = style.rim;
        let uniform = ViewUniform {
            rotation: [column(rx), column(ry), column(rz)],
            centre: camera.centre.extend(0.0).to_array(),
            scale: [
                2.0 * camera.scale / camera.panel.w,
                2.0 * camera.scale / camera.panel.h,
                camera.depth,
                1.0 / (camera.scale * self.target.times as f32),
            ],
            rim: [r, g, b, style.edge],
            fade: [drawing.facets[1] as f32, drawing.fade, drawing.facets[0] as f32, drawing.steep],
            signal: super::colour::signal4(),
            cut: super::colour::linear4(style.cut),
        };
        let buffer = self.gpu.device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("view"),
            contents: bytemuck::bytes_of(&uniform),
            usage: wgpu::BufferUsages::UNIFORM,
        });
        self.gpu.device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("view"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        })
    }
}

fn check(gpu: &Gpu, [w, h]: [u32; 2], times: u32) -> Result<()> {
    let limit = gpu.device.limits().max_texture_dimension_2d / times;
    if w == 0 || h == 0 || w > limit || h > limit {
        let finer = if times > 1 { format!(", each {times} times finer") } else { String::new() };
        let what = format!("the graphics adapter {} cannot draw {w} × {h} pixels{finer}", gpu.name);
        return Err(Error::input(what, format!("choose a size from 1 × 1 to {limit} × {limit} pixels")));
    }
    Ok(())
}

fn compile(gpu: &Gpu) -> (wgpu::BindGroupLayout, [wgpu::RenderPipeline; SHAPES + 1]) {
    let device = &gpu.device;
    let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some("wires"),
        source: wgpu::ShaderSource::Wgsl(SHADER.into()),
    });
    let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("view"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    });
    let attributes = wgpu::vertex_attr_array![0 => Float32x4, 1 => Float32x4, 2 => Float32x4, 3 => Float32x4,
        4 => Float32x4, 5 => Float32x4, 6 => Float32x4, 7 => Float32x4];
    let of_capsules = if gpu.samples_shaded { "fs_sampled" } else { "fs_whole" };
    let pipelines = [["vs_roof", "fs_roof"], ["vs_tube", "fs_tube"], ["vs", of_capsules], ["vs_roof", "fs_thin_roof"]]
        .map(|[vertex, fragment]| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some("wires"),
                layout: Some(&device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
                    label: None,
                    bind_group_layouts: &[Some(&layout)],
                    immediate_size: 0,
                })),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some(vertex),
                    compilation_options: Default::default(),
                    buffers: &[Some(wgpu::VertexBufferLayout {
                        array_stride: size_of::<Segment>() as u64,
                        step_mode: wgpu::VertexStepMode::Instance,
                        attributes: &attributes,
                    })],
                },
                primitive: wgpu::PrimitiveState {
                    topology: wgpu::PrimitiveTopology::TriangleStrip,
                    ..Default::default()
                },
                depth_stencil: Some(wgpu::DepthStencilState {
                    format: DEPTH,
                    depth_write_enabled: Some(true),
                    depth_compare: Some(wgpu::CompareFunction::Less),
                    stencil: Default::default(),
                    bias: Default::default(),
                }),
                multisample: wgpu::MultisampleState {
                    count: SAMPLES,
                    // What is see-through covers some of a pixel's samples, so that no order matters.
                    alpha_to_coverage_enabled: true,
                    ..Default::default()
                },
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(fragment),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format: COLOUR,
                        blend: None,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        });
    (layout, pipelines)
}
