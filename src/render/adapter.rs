//! The graphics adapter, without a window.

use crate::base::error::{Error, Result};

/// A device ready to draw.
pub struct Gpu {
    /// The device.
    pub device: wgpu::Device,
    /// Its queue.
    pub queue: wgpu::Queue,
    /// Name of adapter and driver, for people.
    pub name: String,
    /// Whether fragment shaders may run once per sample of a pixel. Where they cannot, edges are cut by whole pixels.
    pub samples_shaded: bool,
}

/// Whether frames can be drawn on this machine. Cheap (well below a second), to be called before a simulation.
///
/// # Errors
/// [`Error::Missing`] when there is no graphics adapter, with the package to install.
pub fn check() -> Result<()> {
    request_adapter().map(|_| ())
}

/// Name of the adapter that frames would be drawn with, and of its driver.
///
/// # Errors
/// [`Error::Missing`] when there is none.
pub fn name() -> Result<String> {
    request_adapter().map(|adapter| name_of(&adapter))
}

fn name_of(adapter: &wgpu::Adapter) -> String {
    let info = adapter.get_info();
    let interface = match info.backend {
        wgpu::Backend::Vulkan => "Vulkan",
        wgpu::Backend::Gl => "OpenGL",
        other => other.to_str(),
    };
    // A driver of OpenGL has no name beside its version.
    let driver = [info.driver.as_str(), &info.driver_info, interface].map(str::trim);
    let driver: Vec<&str> = driver.into_iter().filter(|part| !part.is_empty()).collect();
    format!("{} ({})", info.name, driver.join(", "))
}

impl Gpu {
    /// Opens the best adapter: a real one if there is one, else a software one.
    ///
    /// # Errors
    /// [`Error::Missing`] when there is none or when it refuses a device.
    pub fn open() -> Result<Self> {
        let adapter = request_adapter()?;
        let name = name_of(&adapter);
        let descriptor = wgpu::DeviceDescriptor {
            label: Some("strandsnap"),
            required_limits: wgpu::Limits::downlevel_defaults().using_resolution(adapter.limits()),
            ..Default::default()
        };
        let (device, queue) = pollster::block_on(adapter.request_device(&descriptor))
            .map_err(|e| failure(format!("the graphics adapter {name} refused to open: {e}")))?;
        let flags = adapter.get_downlevel_capabilities().flags;
        let samples_shaded = flags.contains(wgpu::DownlevelFlags::MULTISAMPLED_SHADING);
        Ok(Self { device, queue, name, samples_shaded })
    }
}

/// An error of the graphics driver, with the way to do without pictures.
pub fn failure(what: impl Into<String>) -> Error {
    let help = "update the graphics driver, or leave pictures out with --no-frames";
    Error::Missing { what: what.into(), help: Some(help.into()) }
}

fn request_adapter() -> Result<wgpu::Adapter> {
    // GL only when there is nothing else: there edges may not be smoothed (see `Gpu::samples_shaded`).
    let found = request_from(wgpu::Backends::PRIMARY).or_else(|_| request_from(wgpu::Backends::GL));
    found.map_err(|e| Error::Missing {
        what: format!("no graphics adapter to draw frames with ({e})"),
        help: Some(
            "a software one will do: on Debian and Ubuntu `apt-get install mesa-vulkan-drivers libvulkan1`, on Fedora \
             `dnf install mesa-vulkan-drivers vulkan-loader`, on Arch `pacman -S vulkan-swrast vulkan-icd-loader`; \
             or leave frames out with --no-frames"
                .into(),
        ),
    })
}

fn request_from(backends: wgpu::Backends) -> std::result::Result<wgpu::Adapter, wgpu::RequestAdapterError> {
    let mut descriptor = wgpu::InstanceDescriptor::new_without_display_handle();
    descriptor.backends = backends;
    let options = wgpu::RequestAdapterOptions {
        power_preference: wgpu::PowerPreference::HighPerformance,
        force_fallback_adapter: false,
        compatible_surface: None,
        ..Default::default()
    };
    pollster::block_on(wgpu::Instance::new(descriptor).request_adapter(&options))
}
