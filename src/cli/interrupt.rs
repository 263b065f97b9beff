//! Signals: SIGINT (Ctrl-C), SIGTERM and SIGHUP ask the run to stop and to keep its state, the second one ends the program; SIGUSR1
//! asks it to keep its state and to go on. A file above the limit of the shell (SIGXFSZ) is an error of that file.

use super::ranks;
use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM, SIGUSR1, SIGUSR2, SIGXFSZ};
use signal_hook::flag::{register, register_conditional_shutdown};
use std::sync::atomic::AtomicBool;
use std::sync::{Arc, LazyLock};

/// Exit code of a program that was ended by a second Ctrl-C, as shells have it: nothing was saved.
const KILLED: i32 = 130;
/// Set by the first signal to stop.
pub static INTERRUPT: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);
/// Set by the signal to save.
pub static SAVE: LazyLock<Arc<AtomicBool>> = LazyLock::new(Arc::default);

/// Begins to listen.
pub fn listen() {
    // A system that refuses a handler is no reason to stop.
    for signal in [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| !is_ignored(*signal)) {
        let _ = register_conditional_shutdown(signal, KILLED, INTERRUPT.clone());
        let _ = register(signal, INTERRUPT.clone());
    }
    let _ = register(SIGUSR1, SAVE.clone());
    // mpirun hands on this signal and the one before; one to end it ends the ranks a second later.
    if ranks::exchange().is_some() {
        let _ = register(SIGUSR2, INTERRUPT.clone());
    }
}

/// Takes a file above the limit of the shell for an error of that file, of any command.
pub fn outlive_large_files() {
    let _ = register(SIGXFSZ, Arc::default());
}

/// Whether the program was started with a signal ignored, as `nohup` does with SIGHUP: it stays so.
fn is_ignored(signal: i32) -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    let mask = mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0);
    mask >> (signal - 1) & 1 == 1
}
