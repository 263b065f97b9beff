//! Ctrl-C: the first one asks the run to stop and to keep its state, the second ends the program.

use std::sync::atomic::{AtomicBool, Ordering};

/// Exit code of a program that was ended by a second Ctrl-C, as shells have it: nothing was saved.
const KILLED: i32 = 130;
/// Set by the first Ctrl-C.
pub static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// Begins to listen.
pub fn listen() {
    // A second handler (in a test that runs twice in one process) is no reason to stop.
    let _ = ctrlc::set_handler(|| {
        if INTERRUPT.swap(true, Ordering::Relaxed) {
            std::process::exit(KILLED);
        }
    });
}
