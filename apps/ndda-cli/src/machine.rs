//! What a result depends on besides its scene: program and machine.

use std::fs;

/// Commit that the program was built from.
pub const COMMIT: &str = env!("NDDA_COMMIT");
/// Compiler that it was built with.
pub const RUSTC: &str = env!("NDDA_RUSTC");
/// Cargo features that it was built with.
pub const FEATURES: &str = env!("NDDA_FEATURES");

/// Name of the processor, or of its architecture where the system does not tell.
pub fn processor() -> String {
    let info = fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    let model = info.lines().find_map(|line| line.strip_prefix("model name")?.split_once(": "));
    model.map_or_else(|| std::env::consts::ARCH.to_string(), |(_, name)| name.trim().to_string())
}

/// Most memory that this process has had [B], where the system tells.
pub fn peak_memory_bytes() -> Option<u64> {
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    Some(1024 * line.trim().strip_suffix(" kB")?.parse::<u64>().ok()?)
}
