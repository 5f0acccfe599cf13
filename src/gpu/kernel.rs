//! A recorded function, ready to be run on columns of numbers.

use super::adapter::{Device, failure};
use crate::base::error::{Error, Result};
use crate::base::recorder::Function;
use std::fmt::Write;

/// Rows that are worked out together.
const GROUP: usize = 64;

/// A function on a device.
pub struct Kernel<'d> {
    device: &'d Device,
    pipeline: wgpu::ComputePipeline,
    inputs: usize,
    outputs: usize,
}

impl<'d> Kernel<'d> {
    /// Compiles `function` for `device`.
    ///
    /// # Errors
    /// [`Error::Missing`] when the driver refuses it.
    pub fn new(device: &'d Device, function: &Function) -> Result<Self> {
        let text = shader(function);
        let pipeline = device.checked(|gpu| {
            let module = gpu.create_shader_module(wgpu::ShaderModuleDescriptor {
                label: Some(function.name()),
                source: wgpu::ShaderSource::Wgsl(text.into()),
            });
            gpu.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(function.name()),
                layout: None,
                module: &module,
                entry_point: Some("main"),
                compilation_options: Default::default(),
                cache: None,
            })
        })?;
        Ok(Self { device, pipeline, inputs: function.inputs().len(), outputs: function.outputs().len() })
    }

    /// The outputs of every row, column after column, from the inputs of every row, column after column.
    ///
    /// # Errors
    /// [`Error::Input`] when these are not whole columns, or more than the device takes at once; [`Error::Missing`] when it
    /// fails.
    pub fn run(&self, inputs: &[f64]) -> Result<Vec<f64>> {
        let rows = inputs.len() / self.inputs;
        let bytes = |columns: usize| (rows * columns * size_of::<f64>()) as u64;
        let (adapter, gpu) = (&self.device.adapter, &self.device.device);
        let most = adapter.largest_binding.min(adapter.largest_buffer);
        let groups = rows.div_ceil(GROUP) as u32;
        let too_many =
            bytes(self.inputs.max(self.outputs)) > most || groups > gpu.limits().max_compute_workgroups_per_dimension;
        if rows == 0 || !inputs.len().is_multiple_of(self.inputs) || too_many {
            let what = format!("{} numbers for a function of {} inputs", inputs.len(), self.inputs);
            return Err(Error::input(what, format!("give whole columns of at most {most} bytes together")));
        }
        self.device.checked(|gpu| {
            let buffer = |size, usage| {
                gpu.create_buffer(&wgpu::BufferDescriptor { label: None, size, usage, mapped_at_creation: false })
            };
            let given = buffer(bytes(self.inputs), wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
            let results = buffer(bytes(self.outputs), wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC);
            let read = buffer(bytes(self.outputs), wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST);
            self.device.queue.write_buffer(&given, 0, bytemuck::cast_slice(inputs));
            let bound = gpu.create_bind_group(&wgpu::BindGroupDescriptor {
                label: None,
                layout: &self.pipeline.get_bind_group_layout(0),
                entries: &[
                    wgpu::BindGroupEntry { binding: 0, resource: given.as_entire_binding() },
                    wgpu::BindGroupEntry { binding: 1, resource: results.as_entire_binding() },
                ],
            });
            let mut encoder = gpu.create_command_encoder(&Default::default());
            {
                let mut pass = encoder.begin_compute_pass(&Default::default());
                pass.set_pipeline(&self.pipeline);
                pass.set_bind_group(0, &bound, &[]);
                pass.dispatch_workgroups(groups, 1, 1);
            }
            encoder.copy_buffer_to_buffer(&results, 0, &read, 0, bytes(self.outputs));
            self.device.queue.submit([encoder.finish()]);
            self.device.read(&read, read.size())
        })?
    }
}

impl Device {
    /// What `work` makes, if the device has no complaint about it.
    pub(super) fn checked<T>(&self, work: impl FnOnce(&wgpu::Device) -> T) -> Result<T> {
        // What a backend cannot translate is an internal error, not one of validation.
        let filters = [wgpu::ErrorFilter::Internal, wgpu::ErrorFilter::OutOfMemory, wgpu::ErrorFilter::Validation];
        let scopes = filters.map(|filter| self.device.push_error_scope(filter));
        let made = work(&self.device);
        // The last scope that was opened is closed first.
        let mut errors = scopes.into_iter().rev().filter_map(|scope| pollster::block_on(scope.pop()));
        let first = errors.next();
        errors.for_each(drop);
        match first {
            Some(e) => Err(failure(&self.adapter, format!("refused the work: {e}"))),
            None => Ok(made),
        }
    }

    /// The numbers in the first `bytes` of `buffer`, when all work that was given is done.
    pub(super) fn read(&self, buffer: &wgpu::Buffer, bytes: u64) -> Result<Vec<f64>> {
        // A failed mapping shows as an error of `get_mapped_range` below.
        buffer.slice(..bytes).map_async(wgpu::MapMode::Read, |_| ());
        let done = self.device.poll(wgpu::PollType::wait_indefinitely());
        done.map_err(|e| failure(&self.adapter, format!("was lost: {e}")))?;
        let range = buffer.slice(..bytes).get_mapped_range();
        let bytes = range.map_err(|e| failure(&self.adapter, format!("does not give its results back: {e}")))?;
        let numbers = bytemuck::pod_collect_to_vec(&bytes);
        drop(bytes);
        buffer.unmap();
        Ok(numbers)
    }
}

/// The function with an entry point that does one row.
fn shader(function: &Function) -> String {
    let (inputs, outputs) = (function.inputs().len(), function.outputs().len());
    let take: Vec<String> = (0..inputs).map(|k| format!("given[{k}u * rows + row]")).collect();
    let mut text = function.wgsl();
    write!(
        text,
        "
@group(0) @binding(0) var<storage, read> given: array<f64>;
@group(0) @binding(1) var<storage, read_write> results: array<f64>;

@compute @workgroup_size({GROUP})
fn main(@builtin(global_invocation_id) id: vec3<u32>) {{
    let row = id.x;
    let rows = arrayLength(&results) / {outputs}u;
    if row >= rows {{ return; }}
    let found = {}({});
",
        function.name(),
        take.join(", ")
    )
    .expect("a String takes any text");
    for (k, name) in function.outputs().enumerate() {
        writeln!(text, "    results[{k}u * rows + row] = found.{name};").expect("a String takes any text");
    }
    text + "}\n"
}
