//! Whether this process says anything.

use std::sync::atomic::{AtomicBool, Ordering};

/// Set where another rank speaks for this one.
static SILENT: AtomicBool = AtomicBool::new(false);

/// Says nothing from now on but why this process fails; or speaks again.
pub fn silence(silent: bool) {
    SILENT.store(silent, Ordering::Relaxed);
}

/// Whether it says nothing.
pub fn is_silent() -> bool {
    SILENT.load(Ordering::Relaxed)
}
