//! Small disks, to be full.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;

/// A file system in memory, mounted until it is dropped.
pub struct Disk(PathBuf);

impl Disk {
    /// Mounts one of `size` bytes at `folder`, which exists. `None`, which is said, where this may not be done: `test` then
    /// did not run.
    pub fn mount(folder: &Path, size: usize, test: &str) -> Option<Self> {
        let option = format!("size={size}");
        let mount = Command::new("mount").args(["-t", "tmpfs", "-o", &option, "tmpfs"]).arg(folder).output();
        if mount.is_ok_and(|output| output.status.success()) {
            return Some(Self(folder.into()));
        }
        // Past the test harness, which hides what passing tests print.
        let _ = writeln!(std::io::stderr(), "SKIPPED (no file system can be mounted here): {test}");
        None
    }
}

impl Drop for Disk {
    fn drop(&mut self) {
        let _ = Command::new("umount").arg(&self.0).status();
    }
}
