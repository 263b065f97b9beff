//! How much memory is free.

/// What is taken for free, bytes, where the system does not tell: 64 GiB.
const UNKNOWN: usize = 64 << 30;

const GIB: f64 = (1_u64 << 30) as f64;

/// Memory that this process can still have, bytes: what is free in the system, in its control group, and in its address space.
pub fn available() -> usize {
    let limits = [of_system(), of_group(), of_process()];
    limits.into_iter().flatten().min().unwrap_or(UNKNOWN)
}

/// The number behind a word at the start of a line of a file, in the units of the file.
fn told(file: &str, word: &str) -> Option<usize> {
    let text = std::fs::read_to_string(file).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix(word))?;
    line.split_whitespace().next()?.parse().ok()
}

fn of_system() -> Option<usize> {
    told("/proc/meminfo", "MemAvailable:")?.checked_mul(1024)
}

/// Of a container or a batch job: its limit without what it has in use.
fn of_group() -> Option<usize> {
    let two = ["/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"];
    let one = ["/sys/fs/cgroup/memory/memory.limit_in_bytes", "/sys/fs/cgroup/memory/memory.usage_in_bytes"];
    // `max` stands for no limit.
    [two, one].into_iter().find_map(|[limit, used]| Some(told(limit, "")?.saturating_sub(told(used, "")?)))
}

/// Of `ulimit -v`: the limit without what is mapped.
fn of_process() -> Option<usize> {
    let limit = told("/proc/self/limits", "Max address space")?;
    Some(limit.saturating_sub(told("/proc/self/status", "VmSize:")?.checked_mul(1024)?))
}

/// An error, in words, if so many bytes are more than what is free.
///
/// # Errors
/// What is needed and what is free, GiB.
pub fn check(bytes: u64) -> Result<(), String> {
    let (needed, free) = (bytes as f64 / GIB, available() as f64 / GIB);
    match needed <= free {
        true => Ok(()),
        false => Err(format!("it needs about {needed:.1} GiB of memory, and {free:.1} GiB are free")),
    }
}
