//! Blocks of steps of some scenes on a device, all with the same functions, each with steps of its own length.

use super::adapter::Device;
use super::layout::{Layout, Own, Shape, places};
use super::stage::{ABREAST, Of, Places};
use crate::base::error::{Error, Result};
use crate::base::recorder::Function;
use crate::engine::Engine;
use crate::engine::elsewhere::{Block, End, LONGEST, Outcome, PAIR_SUMS, SUMS, StepFunctions};
use std::collections::BTreeMap;
use std::ops::Range;

const BYTES: u64 = size_of::<f64>() as u64;
/// Sums are measured after this stage.
const MOTION: usize = 0;

/// What a scene has that the device has not.
pub struct News {
    /// Numbers of its particles, column by column.
    numbers: Vec<(String, Vec<f64>)>,
    /// Its pairs.
    pub pairs: Vec<[u32; 2]>,
    /// Numbers of these, column by column.
    pair_numbers: Vec<(String, Vec<f64>)>,
}

/// Functions of a step, compiled for a device.
pub struct Program {
    device: Device,
    places: Places,
    /// Columns of particles and of pairs before these never change.
    constant: [u64; 2],
    stages: Vec<(Of, wgpu::ComputePipeline)>,
    sums: wgpu::ComputePipeline,
    bindings: wgpu::BindGroupLayout,
}

/// Scenes on a device.
pub struct Batch {
    layout: Layout,
    buffers: Buffers,
    bound: wgpu::BindGroup,
    /// Bytes of a row of numbers and of a row of sums.
    rows: [u64; 2],
}

struct Buffers {
    columns: wgpu::Buffer,
    ends: wgpu::Buffer,
    steps: wgpu::Buffer,
    lists: wgpu::Buffer,
    sums: wgpu::Buffer,
    pairs: wgpu::Buffer,
    read: wgpu::Buffer,
}

impl StepFunctions {
    /// All of them in order, and what they are of.
    pub(super) fn in_order(&self) -> Vec<(Of, &Function)> {
        let particles = self.particles.iter().map(|function| (Of::Particles, function));
        let pairs = self.pairs.iter().map(|function| (Of::Pairs, function));
        particles.chain(pairs).chain([(Of::Particles, &self.gather)]).collect()
    }
}

impl Program {
    /// Compiles `functions`, whose numbers of the step have these `names`, for `device`.
    ///
    /// # Errors
    /// [`Error::Missing`] when the driver refuses them.
    pub fn new(device: &Device, functions: &StepFunctions, names: &[String]) -> Result<Self> {
        let (places, constant) = places(functions, names);
        device.checked(|gpu| {
            let bindings = bindings(gpu);
            let compile = |name: &str, text: String| pipeline(gpu, &bindings, name, text);
            let in_order = functions.in_order();
            let numbered = in_order.iter().enumerate();
            let stages = numbered.map(|(k, (of, f))| (*of, compile(f.name(), places.shader(f, *of, k)))).collect();
            let sums = compile("sums", places.sums());
            Self { device: device.clone(), places, constant, stages, sums, bindings }
        })
    }

    /// What `engine` has, whole.
    pub fn news(&self, engine: &Engine) -> News {
        let count = engine.state().len();
        let pairs = engine.pairs();
        let number =
            |(name, _): (&String, &u32)| (name.clone(), engine.numbers(name).unwrap_or_else(|| vec![0.0; count]));
        let pair_number = |(name, _): (&String, &u32)| {
            (name.clone(), engine.pair_numbers(name).unwrap_or_else(|| vec![0.0; pairs.len()]))
        };
        let pair_numbers = self.places.pair_columns.iter().map(pair_number).collect();
        News { numbers: self.places.columns.iter().map(number).collect(), pair_numbers, pairs }
    }

    /// The most bytes of a buffer that some scenes take.
    fn largest(&self, layout: &Layout) -> u64 {
        let columns = self.places.columns.len() as u64 * layout.slots();
        let pairs = self.places.pair_columns.len() as u64 * layout.pair_slots();
        columns.max(pairs) * BYTES
    }

    /// Whether the device has room for scenes of these shapes, with room for as many pairs.
    pub fn fits(&self, scenes: impl IntoIterator<Item = (Shape, u32)>) -> Result<()> {
        let (layout, adapter) = (Layout::new(scenes), &self.device.adapter);
        let (needed, most) = (self.largest(&layout), adapter.largest_binding.min(adapter.largest_buffer));
        if needed > most {
            return Err(Error::input(
                format!("{} particles take {needed} bytes in one buffer of {}", layout.slots(), adapter.name),
                format!("it gives a shader {most} bytes at most: use another device, or a larger strand.spacing"),
            ));
        }
        Ok(())
    }

    /// Makes room for scenes of these shapes, with room for as many pairs; all of them have news then.
    ///
    /// # Errors
    /// [`Error::Input`] when they are too large for the device, [`Error::Missing`] when it fails.
    pub fn batch(&self, scenes: impl IntoIterator<Item = (Shape, u32)> + Clone) -> Result<Batch> {
        self.fits(scenes.clone())?;
        let layout = Layout::new(scenes);
        let alignment = u64::from(self.device.device.limits().min_storage_buffer_offset_alignment);
        let row = |numbers: usize| (numbers as u64 * BYTES).next_multiple_of(alignment);
        let rows = [row(1 + layout.scenes.len() * self.places.step.len()), row(layout.sums().max(1))];
        self.device.checked(|gpu| {
            let buffers = self.buffers(gpu, &layout, rows);
            let bound = self.bind(gpu, &buffers, rows);
            Batch { layout, buffers, bound, rows }
        })
    }

    fn buffers(&self, gpu: &wgpu::Device, layout: &Layout, rows: [u64; 2]) -> Buffers {
        use wgpu::BufferUsages as Use;
        let buffer = |size: u64, usage| {
            let size = size.max(BYTES);
            gpu.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
        };
        let kept = Use::STORAGE | Use::COPY_DST | Use::COPY_SRC;
        let [columns, pairs, sums, ends] = self.read_parts(layout, LONGEST * rows[1]).map(|part| part.end - part.start);
        Buffers {
            columns: buffer(self.places.columns.len() as u64 * layout.slots() * BYTES, kept),
            ends: buffer(ends, kept),
            steps: buffer(LONGEST * rows[0], Use::STORAGE | Use::COPY_DST),
            lists: buffer(layout.lists_length() * 4, Use::STORAGE | Use::COPY_DST),
            sums: buffer(sums, Use::STORAGE | Use::COPY_SRC),
            pairs: buffer(self.places.pair_columns.len() as u64 * layout.pair_slots() * BYTES, kept),
            read: buffer(columns + pairs + sums + ends, Use::MAP_READ | Use::COPY_DST),
        }
    }

    /// What is read after a block, in bytes: of columns, pairs, sums and ends.
    fn read_parts(&self, layout: &Layout, sums: u64) -> [Range<u64>; 4] {
        let changing =
            |columns: usize, constant: u64, length: u64| constant * length * BYTES..columns as u64 * length * BYTES;
        [
            changing(self.places.columns.len(), self.constant[0], layout.slots()),
            changing(self.places.pair_columns.len(), self.constant[1], layout.pair_slots()),
            0..sums,
            0..2 * 4 * layout.scenes.len() as u64,
        ]
    }

    fn bind(&self, gpu: &wgpu::Device, buffers: &Buffers, rows: [u64; 2]) -> wgpu::BindGroup {
        let row = |buffer, bytes| {
            let size = std::num::NonZeroU64::new(bytes);
            wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
        };
        let resources = [
            buffers.columns.as_entire_binding(),
            buffers.ends.as_entire_binding(),
            row(&buffers.steps, rows[0]),
            buffers.lists.as_entire_binding(),
            row(&buffers.sums, rows[1]),
            buffers.pairs.as_entire_binding(),
        ];
        let entries: Vec<_> =
            (0..).zip(resources).map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource }).collect();
        gpu.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout: &self.bindings, entries: &entries })
    }

    /// Does the blocks of the scenes of `batch` on the device, from what is new about them: one for each scene, of no steps where
    /// it waits.
    ///
    /// # Errors
    /// [`Error::Missing`] when the device fails.
    pub fn run(&self, batch: &mut Batch, blocks: &[&Block], news: &mut [Option<News>]) -> Result<Vec<Outcome>> {
        self.upload(batch, news)?;
        let Self { device, places, .. } = self;
        let Batch { layout, buffers, bound, rows: [step_row, sum_row] } = &*batch;
        let most = blocks.iter().map(|block| block.steps.len()).max().unwrap_or(0) as u64;
        let parts = self.read_parts(layout, most * sum_row);
        let numbers = device.checked(|gpu| {
            let rows = self.step_rows(blocks, most as usize, (step_row / BYTES) as usize);
            device.queue.write_buffer(&buffers.steps, 0, bytemuck::cast_slice(&rows));
            let ends: Vec<u32> = blocks.iter().flat_map(|block| [self.whole(block), 0]).collect();
            device.queue.write_buffer(&buffers.ends, 0, bytemuck::cast_slice(&ends));
            let mut encoder = gpu.create_command_encoder(&Default::default());
            let mut clear = |buffer, column: Option<&u32>, length: u64| {
                let first = column.map(|column| u64::from(*column) * length * BYTES);
                first.into_iter().for_each(|first| encoder.clear_buffer(buffer, first, Some(length * BYTES)));
            };
            SUMS.iter().for_each(|name| clear(&buffers.columns, places.columns.get(*name), layout.slots()));
            PAIR_SUMS
                .iter()
                .for_each(|name| clear(&buffers.pairs, places.pair_columns.get(*name), layout.pair_slots()));
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for step in 0..most {
                    pass.set_bind_group(0, bound, &[step * step_row, step * sum_row].map(|at| at as u32));
                    for (k, (of, stage)) in self.stages.iter().enumerate() {
                        pass.set_pipeline(stage);
                        dispatch(&mut pass, layout.groups(*of));
                        if k == MOTION && layout.sums() > 0 {
                            pass.set_pipeline(&self.sums);
                            dispatch(&mut pass, layout.sums() as u32);
                        }
                    }
                }
            }
            let mut at = 0;
            let sources = [&buffers.columns, &buffers.pairs, &buffers.sums, &buffers.ends];
            for (source, part) in sources.into_iter().zip(&parts) {
                let length = part.end - part.start;
                if length > 0 {
                    encoder.copy_buffer_to_buffer(source, part.start, &buffers.read, at, length);
                }
                at += length;
            }
            device.queue.submit([encoder.finish()]);
            device.read(&buffers.read, at)
        })??;
        let mut rest = &numbers[..];
        let parts = parts.map(|part| {
            let (own, after) = rest.split_at(((part.end - part.start) / BYTES) as usize);
            rest = after;
            own
        });
        let outcomes = layout.scenes.iter().zip(blocks).enumerate();
        Ok(outcomes.map(|(s, (own, block))| self.outcome(batch, parts, s, own, block)).collect())
    }

    /// The number of the last stage of the last step of a block, counted from 1.
    fn whole(&self, block: &Block) -> u32 {
        (block.steps.len() * self.places.stages) as u32
    }

    fn upload(&self, batch: &mut Batch, news: &mut [Option<News>]) -> Result<()> {
        if news.iter().all(Option::is_none) {
            return Ok(());
        }
        let own = batch.layout.scenes.iter_mut().zip(&mut *news);
        own.for_each(|(own, news)| news.iter_mut().for_each(|news| own.pairs = std::mem::take(&mut news.pairs)));
        let Batch { layout, buffers, .. } = &*batch;
        self.device.checked(|_| {
            let queue = &self.device.queue;
            queue.write_buffer(&buffers.lists, 0, bytemuck::cast_slice(&layout.lists(&self.places)));
            let write = |buffer, at: u64, numbers: &[f64]| {
                queue.write_buffer(buffer, at * BYTES, bytemuck::cast_slice(numbers));
            };
            for (own, news) in layout.scenes.iter().zip(&mut *news) {
                let Some(news) = news.take() else { continue };
                for (name, numbers) in &news.numbers {
                    let column = u64::from(self.places.columns[name]);
                    write(&buffers.columns, column * layout.slots() + u64::from(own.first), numbers);
                }
                for (name, numbers) in &news.pair_numbers {
                    let column = u64::from(self.places.pair_columns[name]);
                    write(&buffers.pairs, column * layout.pair_slots() + u64::from(own.first_pair), numbers);
                }
            }
        })
    }

    /// The numbers of the steps of all blocks, row below row of `width` numbers.
    fn step_rows(&self, blocks: &[&Block], count: usize, width: usize) -> Vec<f64> {
        let mut rows = vec![0.0; count * width];
        for (k, row) in rows.chunks_mut(width).enumerate() {
            row[0] = k as f64;
            for (s, block) in blocks.iter().enumerate() {
                let first = 1 + s * self.places.step.len();
                let numbers = block.steps.get(k).into_iter().flatten();
                numbers.for_each(|(name, number)| row[first + self.places.step[name] as usize] = *number);
            }
        }
        rows
    }

    /// What was read back of scene `s`.
    fn outcome(&self, batch: &Batch, parts: [&[f64]; 4], s: usize, own: &Own, block: &Block) -> Outcome {
        let [columns, pairs, sums, ends] = parts;
        let ends: &[u32] = bytemuck::cast_slice(ends);
        let (last, away) = (ends[2 * s], ends[2 * s + 1] > 0);
        let done = (last as usize).div_ceil(self.places.stages);
        let end = match away {
            true => End::RanAway,
            false if last < self.whole(block) => End::Due,
            false => End::Whole,
        };
        let width = (batch.rows[1] / BYTES) as usize;
        let part = |all, constant, read, length: u64, range: Range<u32>| {
            let range = range.start as usize..range.end as usize;
            let of = |(name, column): (&String, &[f64])| (name.clone(), column[range.clone()].to_vec());
            changing(all, constant, read, length as usize).map(of).collect()
        };
        let (places, layout, constant) = (&self.places, &batch.layout, self.constant);
        let particles = own.first..own.first + own.shape.particles;
        let own_pairs = own.first_pair..own.first_pair + own.pairs.len() as u32;
        Outcome {
            measured: sums.chunks(width).take(done).map(|row| row[own.sums.clone()].to_vec()).collect(),
            end,
            numbers: part(&places.columns, constant[0], columns, layout.slots(), particles),
            pair_numbers: part(&places.pair_columns, constant[1], pairs, layout.pair_slots(), own_pairs),
        }
    }
}

impl Batch {
    /// Pairs of a scene for which there is room.
    pub fn room(&self, scene: usize) -> u32 {
        self.layout.scenes[scene].room
    }
}

/// The columns that change, each `length` long, among the numbers that were read of them.
fn changing<'r>(
    all: &'r BTreeMap<String, u32>,
    constant: u64,
    read: &'r [f64],
    length: usize,
) -> impl Iterator<Item = (&'r String, &'r [f64])> {
    let changing = all.iter().filter(move |(_, column)| u64::from(**column) >= constant);
    changing.map(move |(name, column)| {
        let at = (u64::from(*column) - constant) as usize * length;
        (name, &read[at..at + length])
    })
}

fn dispatch(pass: &mut wgpu::ComputePass, groups: u32) {
    if groups > 0 {
        pass.dispatch_workgroups(groups.min(ABREAST), groups.div_ceil(ABREAST), 1);
    }
}

fn bindings(gpu: &wgpu::Device) -> wgpu::BindGroupLayout {
    let entry = |binding: u32, read_only: bool, has_dynamic_offset: bool| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::COMPUTE,
        ty: wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Storage { read_only },
            has_dynamic_offset,
            min_binding_size: None,
        },
        count: None,
    };
    gpu.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: None,
        entries: &[
            entry(0, false, false),
            entry(1, false, false),
            entry(2, true, true),
            entry(3, true, false),
            entry(4, false, true),
            entry(5, false, false),
        ],
    })
}

fn pipeline(gpu: &wgpu::Device, layout: &wgpu::BindGroupLayout, name: &str, text: String) -> wgpu::ComputePipeline {
    let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
        label: Some(name),
        source: wgpu::ShaderSource::Wgsl(text.into()),
    });
    let layout = gpu.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &[Some(layout)],
        ..Default::default()
    });
    gpu.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(name),
        layout: Some(&layout),
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    })
}
