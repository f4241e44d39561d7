//! How much memory a process may have: what the machine, its control group and its limits leave, or what was requested.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use crate::machine::field;

/// Value of `--memory` [B].
static ASKED: OnceLock<u64> = OnceLock::new();

/// Part of the address space that threads and libraries take before anything is built [B].
const ADDRESSES: u64 = 1 << 28;

/// Makes this the most memory to be used [B]; the first call counts.
pub fn limit(bytes: u64) {
    let _ = ASKED.set(bytes);
}

/// Value of `--memory` [B], if it was given.
pub fn asked() -> Option<u64> {
    ASKED.get().copied()
}

/// Most memory that may be used [B], where anything limits it: `--memory`, or the least of what the machine has left, what
/// the control group leaves, and the limit on addresses of this process.
pub fn budget() -> Option<u64> {
    asked().or_else(|| [available(), group(), addresses()].into_iter().flatten().min())
}

/// `8GB`, `500 MB`, `2GiB` or bytes.
///
/// # Errors
/// The expected form.
pub fn parse(text: &str) -> Result<u64, String> {
    let text = text.trim();
    let number = text.trim_end_matches(|c: char| c.is_ascii_alphabetic());
    let (number, unit) = (number.trim(), text[number.len()..].to_ascii_lowercase());
    let factor = match unit.as_str() {
        "" | "b" => 1.0,
        "kb" => 1e3,
        "mb" => 1e6,
        "gb" => 1e9,
        "tb" => 1e12,
        "kib" => 1024.0,
        "mib" => 1024f64.powi(2),
        "gib" => 1024f64.powi(3),
        _ => return Err("give a size such as 8GB, 500MB or 2GiB".into()),
    };
    let number: f64 = number.parse().map_err(|_| "give a size such as 8GB, 500MB or 2GiB")?;
    let bytes = number * factor;
    if bytes.is_finite() && bytes >= 1.0 { Ok(bytes as u64) } else { Err("give a size above zero".into()) }
}

/// Bytes as a person reads them.
pub fn readable(bytes: u64) -> String {
    let powers = [(1e9, "GB"), (1e6, "MB"), (1e3, "kB")];
    let found = powers.iter().find(|(size, _)| bytes as f64 >= *size);
    found.map_or_else(|| format!("{bytes} B"), |(size, unit)| format!("{:.1} {unit}", bytes as f64 / size))
}

/// Memory that the machine can give without swapping [B].
fn available() -> Option<u64> {
    kibibytes(&fs::read_to_string("/proc/meminfo").ok()?, "MemAvailable")
}

fn kibibytes(text: &str, name: &str) -> Option<u64> {
    let number: u64 = field(text, name)?.strip_suffix("kB")?.trim().parse().ok()?;
    Some(number * 1024)
}

/// Memory that the control group of this process, and those above it, leave [B].
fn group() -> Option<u64> {
    let text = fs::read_to_string("/proc/self/cgroup").ok()?;
    let path = text.lines().find_map(|line| line.strip_prefix("0::/"));
    let unified = Path::new("/sys/fs/cgroup").join(path.unwrap_or(""));
    let above = unified.ancestors().take_while(|folder| folder.starts_with("/sys/fs/cgroup"));
    let old = Path::new("/sys/fs/cgroup/memory");
    let old = left_of(old, "memory.limit_in_bytes", "total_rss");
    above.filter_map(|folder| left_of(folder, "memory.max", "anon")).chain(old).min()
}

/// The limit of a group less what its processes hold; pages of files make room when they have to.
fn left_of(folder: &Path, limit: &str, held: &str) -> Option<u64> {
    let most: u64 = fs::read_to_string(folder.join(limit)).ok()?.trim().parse().ok()?;
    let text = fs::read_to_string(folder.join("memory.stat")).unwrap_or_default();
    let of = |line: &str| line.strip_prefix(held)?.trim().parse::<u64>().ok();
    Some(most.saturating_sub(text.lines().find_map(of).unwrap_or(0)))
}

/// Memory that the limit on the address space leaves (`ulimit -v`) [B].
fn addresses() -> Option<u64> {
    let limits = fs::read_to_string("/proc/self/limits").ok()?;
    let line = limits.lines().find_map(|line| line.strip_prefix("Max address space"))?;
    let most: u64 = line.split_whitespace().next()?.parse().ok()?;
    let status = fs::read_to_string("/proc/self/status").unwrap_or_default();
    Some(most.saturating_sub(kibibytes(&status, "VmSize").unwrap_or(0).max(ADDRESSES)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_are_read_with_their_units() {
        for (text, bytes) in
            [("8GB", 8_000_000_000), ("500 MB", 500_000_000), ("2GiB", 1 << 31), ("1e3", 1000)]
        {
            assert_eq!(parse(text), Ok(bytes), "{text}");
        }
        for text in ["", "much", "8 apples", "-1GB", "0", "infGB"] {
            assert!(parse(text).is_err(), "{text}");
        }
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_machine_says_what_it_has_left() {
        assert!(available().is_some_and(|bytes| bytes > 1 << 20));
        assert!(budget().is_some());
    }
}
