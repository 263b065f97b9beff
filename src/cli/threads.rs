//! The number of threads and the instruction set that a user asks for.

use super::ranks;
use crate::error::{Error, Result};
use crate::lane::Kernel;
use std::sync::atomic::{AtomicBool, Ordering};

/// Threads a core that are still taken for a wish: more are a slip of the pen, and steps wait for the last of them.
const THREADS_PER_CORE: usize = 4;

/// Whether threads have been started by number.
static STARTED: AtomicBool = AtomicBool::new(false);

/// Refuses a number of threads that this machine has no use for.
pub fn check_threads(threads: usize) -> Result<()> {
    // A system that does not tell refuses none.
    let cores = std::thread::available_parallelism().map_or(usize::MAX / THREADS_PER_CORE, usize::from);
    let most = THREADS_PER_CORE * cores;
    if (1..=most).contains(&threads) {
        return Ok(());
    }
    let what = match threads {
        0 => "--threads is 0".to_owned(),
        _ => format!("--threads is {threads}, and this machine has {cores} core(s)"),
    };
    Err(Error::input(what, format!("give a number of threads from 1 to {most}; {cores} use all cores")))
}

/// Starts so many threads for the steps of a run, by default those of this rank.
pub fn start(threads: Option<usize>) -> Result<()> {
    threads.or_else(ranks::threads).map_or(Ok(()), start_threads)
}

/// Starts so many threads for all that follows; the first call of a command counts.
pub fn start_threads(threads: usize) -> Result<()> {
    check_threads(threads)?;
    if STARTED.swap(true, Ordering::Relaxed) {
        return Ok(());
    }
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|why| Error::input(format!("cannot start {threads} threads: {why}"), "give a smaller --threads"))
}

/// The instruction set of `--kernel`; the widest of this processor where none is named.
pub fn kernel(name: Option<&str>) -> Result<Kernel> {
    let Some(name) = name else { return Ok(Kernel::widest()) };
    let names: Vec<&str> = Kernel::NAMES.iter().map(|(name, _)| *name).collect();
    let remedy = format!("give one of {}, or none for the widest that this processor has", names.join(", "));
    let known = Kernel::NAMES.iter().find(|(known, _)| *known == name).map(|(_, kernel)| *kernel);
    match known {
        Some(kernel) if kernel.is_available() => Ok(kernel),
        Some(_) => Err(Error::input(format!("this processor has no {name}"), remedy)),
        None => Err(Error::input(format!("there is no kernel `{name}`"), remedy)),
    }
}
