//! How many threads a rank has where nobody names a number: all processors of its machine, shared with the ranks beside it.

use crate::arguments::hash;
use crate::engine::Engine;
use std::fs::read_to_string;

/// Threads of each rank: the same number for all, since parts of the body are as many as threads.
pub fn of_rank(engine: &Engine) -> usize {
    let processors = std::thread::available_parallelism().map_or(1, usize::from);
    // Ranks on one machine that may run on the same processors share them. Where each is bound to its own, nobody has its place.
    let place = hash((read_to_string("/proc/sys/kernel/hostname").ok(), may_run_on()));
    let beside = engine.numbers_of_all(place).into_iter().filter(|other| *other == place).count();
    let own = (processors / beside.max(1)).max(1);
    engine.numbers_of_all(own as f64).into_iter().fold(f64::INFINITY, f64::min) as usize
}

/// The processors that this process may run on, as Linux lists them.
fn may_run_on() -> Option<String> {
    let status = read_to_string("/proc/self/status").ok()?;
    status.lines().find_map(|line| line.strip_prefix("Cpus_allowed_list:")).map(|list| list.trim().to_owned())
}
