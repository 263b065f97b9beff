//! What the program was built from, and the effects that it was built with: all of them, but for `make proof`, which compares programs with and without one to show
//! that what a scene does not ask for costs nothing. A program without an effect refuses scenes that ask for it;
//! entries of the registry that it was built without are unknown names.

use crate::error::Error;
use std::sync::OnceLock;

/// The commit, once the program has said it.
static COMMIT: OnceLock<&'static str> = OnceLock::new();

/// Says from which commit the program was built, for the files that it writes; the first word counts. It is the program that says it, and
/// not the library: a new commit then compiles a file of three lines again, and not the library.
pub fn from_commit(commit: Option<&'static str>) {
    let _ = COMMIT.set(commit.filter(|commit| !commit.is_empty()).unwrap_or(UNKNOWN));
}

/// The commit of the program, or `unknown`.
pub fn commit() -> &'static str {
    COMMIT.get().copied().unwrap_or(UNKNOWN)
}

const UNKNOWN: &str = "unknown";

/// The program with its version.
pub const PROGRAM: &str = concat!("dgmpm ", env!("CARGO_PKG_VERSION"));

/// The meter of forces.
pub const FORCES: bool = cfg!(feature = "effect-forces");
/// The balance of energy.
pub const BALANCE: bool = cfg!(feature = "effect-balance");
/// Sources.
pub const SOURCES: bool = cfg!(feature = "effect-sources");
/// Limiter, rescue and other corrections.
pub const CORRECTIONS: bool = cfg!(feature = "effect-corrections");
/// The control of the curl.
pub const CURL: bool = cfg!(feature = "effect-curl");
/// Contact of bodies, cracks that close, cohesive edges.
pub const CONTACT: bool = cfg!(feature = "effect-contact");
/// Obstacles that are finer than the points of a face.
pub const OBSTACLES: bool = cfg!(feature = "effect-conditions");

/// Program and commit as a comment of XML in a line of its own.
pub fn comment() -> String {
    format!("<!-- program: {PROGRAM}, commit: {} -->\n", commit())
}

/// Refuses what is asked for and not there; `asked` has whether it is there, whether it is asked for, and its name.
///
/// # Errors
/// The first that is missing.
pub fn refuse(asked: &[(bool, bool, &str)]) -> Result<(), Error> {
    match asked.iter().find(|(is_there, is_asked, _)| *is_asked && !is_there) {
        None => Ok(()),
        Some((_, _, name)) => {
            let what = format!("the scene asks for {name}, and this program was built without");
            Err(Error::input(what, "build it with all features, as `make build` does"))
        }
    }
}
