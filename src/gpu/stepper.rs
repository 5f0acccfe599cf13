//! The steps of an engine on a device.
//!
//! All numbers of the particles lie in columns on the device, from the first step to the last. A block of steps is one
//! submission; after it the engine takes up what came of it, so that rows, ruptures, ledger and checkpoints are its own. Where
//! a bond has to be broken, the block ends at that step: the engine breaks it and books it, and the next block begins with what
//! the engine then has.

use super::adapter::Device;
use super::stage::{self, GROUP, Places};
use crate::base::error::{Error, Result};
use crate::base::recorder::Function;
use crate::engine::Engine;
use crate::engine::elsewhere::{Block, End, LONGEST, Outcome, SUMS};

/// Stages that end the steps when one of their signals is up, besides those that end nothing.
const MOTION: usize = 0;
const BYTES: u64 = size_of::<f64>() as u64;

/// An engine whose steps are done on a device.
pub struct Stepper<'d> {
    device: &'d Device,
    engine: Engine,
    places: Places,
    /// Columns before this one never change.
    constant: u64,
    stages: Vec<wgpu::ComputePipeline>,
    sums: wgpu::ComputePipeline,
    /// Sums that are measured at each step.
    measured: usize,
    buffers: Buffers,
    bound: wgpu::BindGroup,
    /// Bytes of a row of numbers and of a row of sums.
    rows: [u64; 2],
}

struct Buffers {
    columns: wgpu::Buffer,
    end: wgpu::Buffer,
    steps: wgpu::Buffer,
    sums: wgpu::Buffer,
    read: wgpu::Buffer,
}

impl<'d> Stepper<'d> {
    /// Takes over the steps of `engine`.
    ///
    /// # Errors
    /// [`Error::Missing`] when the engine has a stage that cannot be recorded ([`Engine::record_step`]), or the driver refuses
    /// the work; [`Error::Input`] when the scene is too large for the device.
    pub fn new(device: &'d Device, engine: Engine) -> Result<Self> {
        let functions = engine.record_step()?;
        let names = engine.step_names();
        let measured = engine.measured();
        let (places, constant) = places(&functions, &names, engine.state().len() as u32);
        let stages = functions.len();
        let row = |numbers: usize| {
            let alignment = u64::from(device.device.limits().min_storage_buffer_offset_alignment);
            (numbers as u64 * BYTES).next_multiple_of(alignment)
        };
        let rows = [row(names.len() + 1), row(measured.len().max(1))];
        let columns = places.columns.len() as u64 * u64::from(places.particles) * BYTES;
        let changing = columns - constant * u64::from(places.particles) * BYTES;
        let most = device.adapter.largest_binding.min(device.adapter.largest_buffer);
        if columns > most {
            return Err(Error::input(
                format!("{} particles take {columns} bytes on {}", places.particles, device.adapter.name),
                format!("it gives a shader {most} bytes at most: use another device, or a larger strand.spacing"),
            ));
        }
        let lists = lists(&measured, &places);
        device
            .checked(|gpu| {
                use wgpu::BufferUsages as Use;
                let buffer = |size: u64, usage| {
                    gpu.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
                };
                let buffers = Buffers {
                    columns: buffer(columns, Use::STORAGE | Use::COPY_DST | Use::COPY_SRC),
                    end: buffer(BYTES, Use::STORAGE | Use::COPY_DST | Use::COPY_SRC),
                    steps: buffer(LONGEST * rows[0], Use::STORAGE | Use::COPY_DST),
                    sums: buffer(LONGEST * rows[1], Use::STORAGE | Use::COPY_SRC),
                    read: buffer(changing + LONGEST * rows[1] + BYTES, Use::MAP_READ | Use::COPY_DST),
                };
                let listed = buffer(lists.len() as u64 * 4, Use::STORAGE | Use::COPY_DST);
                device.queue.write_buffer(&listed, 0, bytemuck::cast_slice(&lists));
                let layout = layout(gpu);
                let row = |buffer, bytes| {
                    let size = std::num::NonZeroU64::new(bytes);
                    wgpu::BindingResource::Buffer(wgpu::BufferBinding { buffer, offset: 0, size })
                };
                let resources = [
                    buffers.columns.as_entire_binding(),
                    buffers.end.as_entire_binding(),
                    row(&buffers.steps, rows[0]),
                    listed.as_entire_binding(),
                    row(&buffers.sums, rows[1]),
                ];
                let entries: Vec<_> = (0..)
                    .zip(resources)
                    .map(|(binding, resource)| wgpu::BindGroupEntry { binding, resource })
                    .collect();
                let bound = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
                    label: None,
                    layout: &layout,
                    entries: &entries,
                });
                let compile = |name: &str, text: String| pipeline(gpu, &layout, name, text);
                let numbered = functions.iter().enumerate();
                let stages: Vec<_> = numbered.map(|(k, f)| compile(f.name(), places.shader(f, k, stages))).collect();
                let sums = compile("sums", stage::sums(stages.len()));
                let measured = measured.len();
                Self { device, engine, places, constant, stages, sums, measured, buffers, bound, rows }
            })
            .and_then(|stepper| {
                stepper.upload()?;
                Ok(stepper)
            })
    }

    /// The engine, as it is after all steps so far.
    pub fn engine(&self) -> &Engine {
        &self.engine
    }

    /// See [`Self::engine`]; for what is taken out of it, such as ruptures. What its particles do is kept on the device.
    pub fn engine_mut(&mut self) -> &mut Engine {
        &mut self.engine
    }

    /// Gives the engine back.
    pub fn into_engine(self) -> Engine {
        self.engine
    }

    /// Advances by `steps` steps; tells how many were done. They are fewer when contacts have come in: the engine itself goes
    /// on from there.
    ///
    /// # Errors
    /// As for [`Engine::step`], and [`Error::Missing`] when the device fails: the engine is then as it was before the block.
    pub fn advance(&mut self, steps: u64) -> Result<u64> {
        let begun = self.engine.steps();
        while self.engine.steps() - begun < steps {
            let block = self.engine.plan_block(steps - (self.engine.steps() - begun))?;
            if block.steps.is_empty() {
                break;
            }
            let outcome = self.run(&block)?;
            self.engine.take_block(&block, &outcome)?;
            if outcome.end == End::Due {
                self.upload()?;
            }
        }
        Ok(self.engine.steps() - begun)
    }

    /// Bytes of a column.
    fn column(&self) -> u64 {
        u64::from(self.places.particles) * BYTES
    }

    /// Writes what the engine has into the columns.
    fn upload(&self) -> Result<()> {
        self.device.checked(|_| {
            for (name, column) in &self.places.columns {
                let zeros = || vec![0.0; self.places.particles as usize];
                let numbers = self.engine.numbers(name).unwrap_or_else(zeros);
                let at = u64::from(*column) * self.column();
                self.device.queue.write_buffer(&self.buffers.columns, at, bytemuck::cast_slice(&numbers));
            }
        })
    }

    /// Does a block of steps.
    fn run(&self, block: &Block) -> Result<Outcome> {
        let Self { device, places, buffers, rows: [step_row, sum_row], .. } = self;
        let steps = block.steps.len() as u64;
        let changing = places.columns.len() as u64 * self.column() - self.constant * self.column();
        let numbers = device.checked(|gpu| {
            device.queue.write_buffer(&buffers.steps, 0, bytemuck::cast_slice(&self.step_rows(block)));
            device.queue.write_buffer(&buffers.end, 0, &[0xff; BYTES as usize]);
            let mut encoder = gpu.create_command_encoder(&Default::default());
            for name in SUMS {
                if let Some(column) = places.columns.get(name) {
                    encoder.clear_buffer(&buffers.columns, u64::from(*column) * self.column(), Some(self.column()));
                }
            }
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                for step in 0..steps {
                    pass.set_bind_group(0, &self.bound, &[step * step_row, step * sum_row].map(|at| at as u32));
                    for (k, stage) in self.stages.iter().enumerate() {
                        pass.set_pipeline(stage);
                        pass.dispatch_workgroups(places.particles.div_ceil(GROUP), 1, 1);
                        if k == MOTION && self.measured > 0 {
                            pass.set_pipeline(&self.sums);
                            pass.dispatch_workgroups(self.measured as u32, 1, 1);
                        }
                    }
                }
            }
            let first = self.constant * self.column();
            encoder.copy_buffer_to_buffer(&buffers.columns, first, &buffers.read, 0, changing);
            encoder.copy_buffer_to_buffer(&buffers.sums, 0, &buffers.read, changing, steps * sum_row);
            encoder.copy_buffer_to_buffer(&buffers.end, 0, &buffers.read, changing + LONGEST * sum_row, BYTES);
            device.queue.submit([encoder.finish()]);
            device.read(&buffers.read)
        })??;
        Ok(self.outcome(&numbers, steps))
    }

    /// The numbers of the steps of a block, row below row.
    fn step_rows(&self, block: &Block) -> Vec<f64> {
        let width = (self.rows[0] / BYTES) as usize;
        let mut rows = vec![0.0; block.steps.len() * width];
        for (k, (row, numbers)) in rows.chunks_mut(width).zip(&block.steps).enumerate() {
            row[0] = k as f64;
            for (name, number) in numbers {
                row[self.places.step[name] as usize] = *number;
            }
        }
        rows
    }

    /// What was read back after a block of `steps`.
    fn outcome(&self, read: &[f64], steps: u64) -> Outcome {
        let particles = self.places.particles as usize;
        let (columns, rest) = read.split_at((self.places.columns.len() - self.constant as usize) * particles);
        let ended = read.last().map_or(u32::MAX, |bits| bits.to_bits() as u32);
        let (done, end) = match (ended as usize / self.stages.len(), ended as usize % self.stages.len()) {
            _ if ended == u32::MAX => (steps as usize, End::Whole),
            (step, MOTION) => (step + 1, End::RanAway),
            (step, _) => (step + 1, End::Due),
        };
        let width = (self.rows[1] / BYTES) as usize;
        let changing = self.places.columns.iter().filter(|(_, column)| u64::from(**column) >= self.constant);
        Outcome {
            measured: rest.chunks(width).take(done).map(|row| row[..self.measured].to_vec()).collect(),
            end,
            numbers: changing
                .map(|(name, column)| {
                    let first = (*column as usize - self.constant as usize) * particles;
                    (name.clone(), columns[first..first + particles].to_vec())
                })
                .collect(),
        }
    }
}

/// Places of all numbers, those that never change first, and how many columns those are.
fn places(functions: &[Function], names: &[String], particles: u32) -> (Places, u64) {
    let [taken, put] = stage::columns(functions, |name| names.iter().any(|known| known == name));
    let mut places = Places { particles, ..Default::default() };
    let add = |places: &mut Places, name: &str| {
        let next = places.columns.len() as u32;
        places.columns.entry(name.to_owned()).or_insert(next);
    };
    taken.iter().filter(|name| !put.contains(name)).for_each(|name| add(&mut places, name));
    let constant = places.columns.len() as u64;
    put.iter().for_each(|name| add(&mut places, name));
    places.step = (1..).zip(names).map(|(place, name)| (name.clone(), place)).collect();
    (places, constant)
}

/// What is measured: for each sum the place of its column, and the first and the end of its particles, which follow below.
fn lists(measured: &[crate::engine::elsewhere::Measured], places: &Places) -> Vec<u32> {
    let mut lists = vec![0; 3 * measured.len().max(1)];
    for (k, sum) in measured.iter().enumerate() {
        let first = lists.len() as u32;
        lists.extend(&sum.particles);
        let column = places.columns[sum.number] * places.particles;
        lists[3 * k..3 * k + 3].copy_from_slice(&[column, first, first + sum.particles.len() as u32]);
    }
    lists
}

fn layout(gpu: &wgpu::Device) -> wgpu::BindGroupLayout {
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
