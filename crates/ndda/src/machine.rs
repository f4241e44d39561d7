//! Program and machine, on which a result depends besides its scene.

use std::fs;

use crate::summary::Machine;

/// Commit that the program was built from.
pub const COMMIT: &str = env!("NDDA_COMMIT");
/// Compiler that it was built with.
pub const RUSTC: &str = env!("NDDA_RUSTC");
/// Cargo features that it was built with.
pub const FEATURES: &str = env!("NDDA_FEATURES");

/// This process and what it runs on, with its peak of memory and its processor time so far.
pub fn describe() -> Machine {
    Machine {
        processor: processor(),
        commit: COMMIT.into(),
        features: FEATURES.split_whitespace().map(String::from).collect(),
        peak_memory_b: peak_memory_bytes(),
        processor_time_s: processor_time_s(),
    }
}

/// Name of the processor, or of its architecture where the system does not report it.
pub fn processor() -> String {
    let text = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    field(&text, "model name").map_or_else(|| std::env::consts::ARCH.into(), String::from)
}

/// Most memory that this process has had [B], where the system reports it.
pub fn peak_memory_bytes() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes: u64 = field(&text, "VmHWM")?.strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Time that the threads of this process have been computing [s], where the system reports it.
pub fn processor_time_s() -> Option<f64> {
    let mut nanoseconds = 0u64;
    for thread in fs::read_dir("/proc/self/task").ok()? {
        // `schedstat` counts to the nanosecond, `stat` in hundredths of a second.
        let text = fs::read_to_string(thread.ok()?.path().join("schedstat")).ok()?;
        nanoseconds += text.split_whitespace().next()?.parse::<u64>().ok()?;
    }
    Some(nanoseconds as f64 * 1e-9)
}

/// Value of the first line `name: value`.
pub(crate) fn field<'a>(text: &'a str, name: &str) -> Option<&'a str> {
    let lines = text.lines().filter_map(|line| line.split_once(':'));
    lines.map(|(key, value)| (key.trim(), value.trim())).find(|(key, _)| *key == name).map(|found| found.1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_read_by_their_name() {
        let text = "processor\t: 0\nmodel name\t: Some CPU: fast\nVmHWM:\t  123 kB\n";
        assert_eq!(field(text, "model name"), Some("Some CPU: fast"));
        assert_eq!(field(text, "VmHWM"), Some("123 kB"));
        assert_eq!(field(text, "VmPeak"), None);
    }
}
