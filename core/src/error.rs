//! What can go wrong, as one message for the user and one exit code for scripts.
//!
//! Every part has a small error enum of its own with the fields that it knows (cell, point, line, key);
//! each converts into [`Error`], which `main` prints and turns into the exit code.

use std::fmt;
use std::path::{Path, PathBuf};

/// Where bad input stands: a file, and in it a line and column where they are known (both from 1).
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Place {
    /// The file, if the input came from one.
    pub file: Option<PathBuf>,
    /// Line and column, from 1.
    pub position: Option<(usize, usize)>,
}

impl Place {
    /// A whole file.
    pub fn file(path: &Path) -> Self {
        Self { file: Some(path.to_owned()), position: None }
    }

    /// A line and column (from 1) of a file.
    pub fn line(path: &Path, line: usize, column: usize) -> Self {
        Self { file: Some(path.to_owned()), position: Some((line, column)) }
    }
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (&self.file, self.position) {
            (Some(file), Some((line, column))) => write!(f, "{}:{line}:{column}: ", file.display()),
            (Some(file), None) => write!(f, "{}: ", file.display()),
            (None, Some((line, column))) => write!(f, "line {line}, column {column}: "),
            (None, None) => Ok(()),
        }
    }
}

/// The one error of the library's surface. `Debug` prints the message as `Display` does: `main` may return it.
#[derive(thiserror::Error)]
pub enum Error {
    /// Input that cannot be used (exit code 2): what is wrong, where, and what would be right.
    #[error("{place}{what}\n  {remedy}")]
    Input {
        /// What is wrong, in one sentence.
        what: String,
        /// Where it stands.
        place: Place,
        /// What would be right.
        remedy: String,
    },
    /// The run lost stability (exit code 3): NaN, J <= 0 or loss of hyperbolicity.
    #[error("step {step}, t = {time:.9e} s: {what}\n  {remedy}")]
    Unstable {
        /// What was lost, in which cell, at which point, node or face point, and its reference coordinates.
        what: String,
        /// Time at the start of the step that failed, in s.
        time: f64,
        /// Number of the step that failed.
        step: usize,
        /// Where a good state lies that the run can go on from, and what may help.
        remedy: String,
    },
    /// The run was interrupted and its state saved (exit code 4).
    #[error("interrupted: {0}")]
    Interrupted(String),
    /// Output could not be written (exit code 5).
    #[error("cannot write {path}: {why}")]
    Output {
        /// The file or folder.
        path: String,
        /// The system's reason.
        why: String,
    },
    /// Another rank of the run has failed, and says why; this one ends with it, with the same exit code.
    #[error("rank {rank} has failed")]
    OtherRank {
        /// Which one.
        rank: usize,
        /// Its exit code.
        code: u8,
    },
    /// The folder of a run is not whole, or this machine does not give its bits (exit code 6).
    #[error("{}", .0.join("\n  "))]
    NotWhole(Vec<String>),
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(self, f)
    }
}

impl Error {
    /// Bad input without a file.
    pub fn input(what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Self::at(Place::default(), what, remedy)
    }

    /// Bad input at a place.
    pub fn at(place: Place, what: impl Into<String>, remedy: impl Into<String>) -> Self {
        Error::Input { what: what.into(), place, remedy: remedy.into() }
    }

    /// The same with another remedy, made from the present one; of bad input only.
    #[must_use]
    pub fn with_remedy(self, change: impl FnOnce(String) -> String) -> Self {
        match self {
            Error::Input { what, place, remedy } => Error::Input { what, place, remedy: change(remedy) },
            other => other,
        }
    }

    /// Bad input that has no place gets this one.
    #[must_use]
    pub fn or_at(self, at: Place) -> Self {
        match self {
            Error::Input { what, place, remedy } if place == Place::default() => {
                Error::Input { what, place: at, remedy }
            }
            other => other,
        }
    }

    /// Output that could not be written.
    pub fn output(path: &Path, why: impl fmt::Display) -> Self {
        Error::Output { path: path.display().to_string(), why: why.to_string() }
    }

    /// The exit code of the program: 2 bad input, 3 lost stability, 4 interrupted, 5 output, 6 a folder that is not whole.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Input { .. } => 2,
            Error::Unstable { .. } => 3,
            Error::Interrupted(_) => 4,
            Error::Output { .. } => 5,
            Error::NotWhole(_) => 6,
            Error::OtherRank { code, .. } => *code,
        }
    }
}

/// Results of the library's surface.
pub type Result<T> = std::result::Result<T, Error>;
