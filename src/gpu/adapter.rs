//! Adapters and what they can do.

use crate::base::error::{Error, Result};
use serde::Serialize;

/// An adapter of this machine: a graphics processor, or a program that does its work on the processor.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Adapter {
    /// Its name.
    pub name: String,
    /// The interface by which it is reached: `vulkan`, `gl`, `metal` or `dx12`.
    pub backend: String,
    /// Driver and its version.
    pub driver: String,
    /// `discrete`, `integrated`, `virtual`, `software` or `other`.
    pub kind: &'static str,
    /// Whether its shaders have 64-bit numbers, real and whole: what recorded formulas need.
    pub f64: bool,
    /// Largest buffer (bytes).
    pub largest_buffer: u64,
    /// Largest part of a buffer that a shader sees at once (bytes).
    pub largest_binding: u64,
    /// How many buffers a shader sees at once.
    pub bindings: u32,
}

/// What the shaders of recorded formulas use.
const FEATURES: wgpu::Features = wgpu::Features::SHADER_F64.union(wgpu::Features::SHADER_INT64);

impl Adapter {
    fn of(adapter: &wgpu::Adapter) -> Self {
        let (info, limits) = (adapter.get_info(), adapter.limits());
        Self {
            backend: info.backend.to_str().to_owned(),
            driver: format!("{} {}", info.driver, info.driver_info).trim().to_owned(),
            kind: match info.device_type {
                wgpu::DeviceType::DiscreteGpu => "discrete",
                wgpu::DeviceType::IntegratedGpu => "integrated",
                wgpu::DeviceType::VirtualGpu => "virtual",
                wgpu::DeviceType::Cpu => "software",
                wgpu::DeviceType::Other => "other",
            },
            name: info.name,
            f64: adapter.features().contains(FEATURES),
            largest_buffer: limits.max_buffer_size,
            largest_binding: limits.max_storage_buffer_binding_size,
            bindings: limits.max_storage_buffers_per_shader_stage,
        }
    }
}

fn all() -> Vec<wgpu::Adapter> {
    let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle());
    pollster::block_on(instance.enumerate_adapters(wgpu::Backends::all()))
}

/// Every adapter of this machine.
pub fn adapters() -> Vec<Adapter> {
    all().iter().map(Adapter::of).collect()
}

/// An adapter that is open for work with 64-bit numbers. A clone is the same one.
#[derive(Clone)]
pub struct Device {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    /// What it is.
    pub adapter: Adapter,
}

impl Device {
    /// Opens the first adapter with 64-bit numbers: a discrete one if there is one, a software one if there is nothing else.
    ///
    /// # Errors
    /// [`Error::Missing`] when no adapter has 64-bit numbers, or when it refuses to open.
    pub fn open() -> Result<Self> {
        let order = ["discrete", "integrated", "virtual", "other", "software"];
        let able = all().into_iter().map(|adapter| (Adapter::of(&adapter), adapter)).filter(|(facts, _)| facts.f64);
        let best = able.min_by_key(|(facts, _)| order.iter().position(|kind| *kind == facts.kind));
        let (facts, adapter) = best.ok_or_else(|| Error::Missing {
            what: "no graphics adapter whose shaders have 64-bit numbers".into(),
            help: Some("`strandsnap devices` lists the adapters; a software one (Mesa's lavapipe) will do".into()),
        })?;
        Self::request(facts, &adapter)
    }

    /// Opens the first adapter whose name has `name` in it, in letters of either case.
    ///
    /// # Errors
    /// [`Error::Input`] when no adapter is called so; [`Error::Missing`] when it has no 64-bit numbers or refuses to open.
    pub fn open_named(name: &str) -> Result<Self> {
        let all: Vec<_> = all().into_iter().map(|adapter| (Adapter::of(&adapter), adapter)).collect();
        let called = |facts: &Adapter| facts.name.to_lowercase().contains(&name.to_lowercase());
        let mut named: Vec<_> = all.iter().filter(|(facts, _)| called(facts)).collect();
        named.sort_by_key(|(facts, _)| !facts.f64);
        let Some((facts, adapter)) = named.first() else {
            let names: Vec<&str> = all.iter().map(|(facts, _)| facts.name.as_str()).collect();
            let known = if names.is_empty() { "there is none".to_owned() } else { names.join(", ") };
            return Err(Error::input(
                format!("no graphics adapter is called {name}"),
                format!("those of this machine: {known}; cpu, gpu and auto are the other choices"),
            ));
        };
        if !facts.f64 {
            return Err(failure(facts, "has no 64-bit numbers in its shaders".into()));
        }
        Self::request(facts.clone(), adapter)
    }

    fn request(facts: Adapter, adapter: &wgpu::Adapter) -> Result<Self> {
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("strandsnap"),
            required_features: FEATURES,
            required_limits: adapter.limits(),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| failure(&facts, format!("refused to open: {e}")))?;
        Ok(Self { device, queue, adapter: facts })
    }

    /// Gives the adapter up: whatever is asked of it from now on fails, as when a driver loses it.
    pub fn destroy(&self) {
        self.device.destroy();
    }
}

/// An error of an adapter.
pub(super) fn failure(adapter: &Adapter, what: String) -> Error {
    Error::Missing {
        what: format!("the graphics adapter {} ({}) {what}", adapter.name, adapter.driver),
        help: Some("update the graphics driver".into()),
    }
}
