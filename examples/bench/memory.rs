//! Memory of a process.

/// Greatest resident memory of this process so far (bytes); `None` where the system does not tell (it does on Linux).
pub fn peak() -> Option<u64> {
    high_water(&std::fs::read_to_string("/proc/self/status").ok()?)
}

/// The peak from the text of `/proc/self/status`.
fn high_water(status: &str) -> Option<u64> {
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix(" kB")?.parse().ok()?;
    Some(kibibytes * 1024)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_peak_is_read_from_its_line() {
        assert_eq!(high_water("VmPeak:\t  9 kB\nVmHWM:\t  1536 kB\nVmRSS:\t 7 kB\n"), Some(1536 * 1024));
        assert_eq!(high_water("VmPeak:\t  9 kB\n"), None);
    }
}
