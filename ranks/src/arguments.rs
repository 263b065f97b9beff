//! What the command line says to the ranks; the rest is that of `dgmpm`.

use crate::partition::Partition;
use std::ffi::{OsStr, OsString};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::time::Duration;

/// Printed before the help of `dgmpm`.
pub const HELP: &str = "\
dgmpm on several ranks: mpirun -n 4 dgmpm-mpi run SCENE. The commands run, solve and resume are stepped by all ranks, all others by rank 0.
  --patience SECONDS  end the job where a rank does not answer for so long [default: 600]
  --partition NAME    how the cells are divided among ranks: metis or strips [default: metis]
  --meter             say at the end how much each rank has sent, and how long it has waited
All else is as for dgmpm:";

/// A rank waits for another one so long. Rank 0 writes files meanwhile, and a new grid takes its time.
const PATIENCE: Duration = Duration::from_secs(600);

/// The longest patience: a time that a clock still holds.
const LONGEST: f64 = 1e9;

/// What it says.
#[derive(Debug)]
pub struct Arguments {
    /// How long a rank waits for another.
    pub patience: Duration,
    /// Whether each rank tells at the end how much it has sent.
    pub meter: bool,
    /// Whether help is asked for.
    pub help: bool,
    /// How the blocks are divided.
    pub partition: Partition,
    /// What is wrong with one of these, and what would be right.
    pub fault: Option<(String, &'static str)>,
    /// What `dgmpm` gets.
    pub rest: Vec<OsString>,
}

impl Arguments {
    /// Takes what is meant for the ranks out of a command line.
    pub fn parse(all: impl IntoIterator<Item = OsString>) -> Self {
        let mut out = Self {
            patience: PATIENCE,
            meter: false,
            help: false,
            partition: Partition::default(),
            fault: None,
            rest: vec![],
        };
        let mut all = all.into_iter();
        while let Some(word) = all.next() {
            let text = word.to_str().unwrap_or_default();
            out.help |= ["-h", "--help"].contains(&text);
            if text == "--meter" {
                out.meter = true;
            } else if text == "--patience" {
                out.set_patience(all.next().as_deref().unwrap_or_default());
            } else if let Some(seconds) = text.strip_prefix("--patience=") {
                out.set_patience(OsStr::new(seconds));
            } else if text == "--partition" {
                out.set_partition(all.next().as_deref().unwrap_or_default());
            } else if let Some(name) = text.strip_prefix("--partition=") {
                out.set_partition(OsStr::new(name));
            } else {
                out.rest.push(word);
            }
        }
        out
    }

    fn set_patience(&mut self, text: &OsStr) {
        let seconds =
            text.to_str().and_then(|text| text.parse().ok()).filter(|seconds| (1e-3..=LONGEST).contains(seconds));
        match seconds {
            Some(seconds) => self.patience = Duration::from_secs_f64(seconds),
            None => {
                let what = format!("--patience is `{}`", text.to_string_lossy());
                self.fault = Some((what, "give a number of seconds above 0, such as --patience 60"));
            }
        }
    }

    fn set_partition(&mut self, name: &OsStr) {
        match Partition::NAMES.iter().find(|(known, _)| *known == name) {
            Some((_, partition)) => self.partition = *partition,
            None => {
                let what = format!("--partition is `{}`", name.to_string_lossy());
                self.fault = Some((what, "give --partition metis or --partition strips"));
            }
        }
    }
}

/// A number of something by which ranks tell whether they have the same: 48 bits of a hash, which a real number holds.
pub fn hash(of: impl Hash) -> f64 {
    let mut hasher = DefaultHasher::new();
    of.hash(&mut hasher);
    (hasher.finish() >> 16) as f64
}
