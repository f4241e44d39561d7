//! What a run ran on, and as which program: figures mean nothing without it.

use ndda_io::summary::Machine;

/// Commit that the program was built from; `unknown` outside a repository.
pub const COMMIT: &str = match option_env!("NDDA_COMMIT") {
    Some(commit) => commit,
    None => "unknown",
};

/// This process and what it runs on, with its peak of memory so far.
pub fn describe() -> Machine {
    Machine {
        processor: processor(),
        commit: COMMIT.into(),
        features: features(),
        peak_memory_b: peak_memory_b(),
    }
}

/// Cargo features of the program.
pub fn features() -> Vec<String> {
    let all = [("plots", cfg!(feature = "plots")), ("png", cfg!(feature = "png"))];
    all.into_iter().filter(|feature| feature.1).map(|feature| feature.0.to_string()).collect()
}

/// Name of the processor, or its architecture where the system does not tell.
fn processor() -> String {
    let text = std::fs::read_to_string("/proc/cpuinfo").unwrap_or_default();
    field(&text, "model name").map_or_else(|| std::env::consts::ARCH.into(), String::from)
}

/// Most memory held at a time [B], where Linux tells it.
fn peak_memory_b() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/self/status").ok()?;
    let kibibytes: u64 = field(&text, "VmHWM")?.strip_suffix("kB")?.trim().parse().ok()?;
    Some(kibibytes * 1024)
}

/// Value of the first line `name: value`.
fn field<'a>(text: &'a str, name: &str) -> Option<&'a str> {
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
