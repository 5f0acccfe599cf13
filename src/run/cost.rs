//! Processor time and versions, for the summary.

use std::collections::BTreeMap;
use std::sync::LazyLock;

/// The lock file that this program was built from: it names the version of everything in it.
const LOCK: &str = include_str!("../../Cargo.lock");

/// Processor time of this process so far, all threads (s); `None` where the system does not tell.
#[cfg(unix)]
pub fn cpu_time() -> Option<f64> {
    clock(rustix::time::ClockId::ProcessCPUTime)
}

/// Processor time of this thread alone so far (s); `None` where the system does not tell.
#[cfg(unix)]
pub fn thread_cpu_time() -> Option<f64> {
    clock(rustix::time::ClockId::ThreadCPUTime)
}

#[cfg(unix)]
fn clock(id: rustix::time::ClockId) -> Option<f64> {
    let time = rustix::time::clock_gettime(id);
    Some(time.tv_sec as f64 + time.tv_nsec as f64 * 1e-9)
}

/// Processor time of this process so far (s); `None`, because this system does not tell.
#[cfg(not(unix))]
pub fn cpu_time() -> Option<f64> {
    None
}

/// Processor time of this thread so far (s); `None`, because this system does not tell.
#[cfg(not(unix))]
pub fn thread_cpu_time() -> Option<f64> {
    None
}

/// Version of this program, of the libraries that its output depends on and that were built in, and the machine's
/// kind.
pub fn versions() -> BTreeMap<String, String> {
    let mut versions = BTreeMap::from([
        ("strandsnap".to_string(), env!("CARGO_PKG_VERSION").to_string()),
        ("platform".to_string(), format!("{}-{}", std::env::consts::ARCH, std::env::consts::OS)),
    ]);
    let built = [("rerun", super::outputs::HAS_RECORD), ("wgpu", super::outputs::HAS_RENDER), ("rayon", true)];
    for (name, _) in built.into_iter().filter(|(_, is_in)| *is_in) {
        if let Some(version) = locked(name) {
            versions.insert(name.into(), version);
        }
    }
    versions
}

/// Version of a package in the lock file, which is read once: that takes as long as hundreds of steps.
fn locked(package: &str) -> Option<String> {
    static LOCKED: LazyLock<Option<toml::Table>> = LazyLock::new(|| LOCK.parse().ok());
    let packages = LOCKED.as_ref()?.get("package")?.as_array()?;
    let entry = packages.iter().find(|p| p.get("name").and_then(|n| n.as_str()) == Some(package))?;
    Some(entry.get("version")?.as_str()?.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn versions_come_from_the_lock_file() {
        assert_eq!(locked("strandsnap").as_deref(), Some(env!("CARGO_PKG_VERSION")));
        assert!(locked("rayon").is_some_and(|v| v.starts_with("1.")));
        assert_eq!(locked("no such package"), None);
    }

    #[cfg(unix)]
    #[test]
    fn processor_time_passes_while_one_works() {
        let begin = cpu_time().unwrap();
        let sum: f64 = (0..2_000_000).map(|i| f64::from(i).sqrt()).sum();
        assert!(sum > 0.0 && cpu_time().unwrap() > begin);
    }
}
