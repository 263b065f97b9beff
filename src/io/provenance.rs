//! Where a state comes from, as texts in its file: program, commit, instruction set, and hashes of scene and matrices. The hashes of
//! mesh, points and laws are in the [`super::fingerprint::Fingerprint`]. They change no result, and a run does not look at them.
//!
//! The number of threads is not among them: a state has the same bytes for any number.

use super::hdf5;
use crate::built;
use crate::step::Scheme;

/// The attributes, in the order of [`Provenance::texts`].
const KEYS: [&str; 5] = ["program", "commit", "kernel", "scene_hash", "operators_hash"];

/// Who made a state, from what; texts are empty where nothing is known.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The program with its version.
    pub program: String,
    /// The commit that it was built from, or `unknown`.
    pub commit: String,
    /// The instruction set that the state was stepped by.
    pub kernel: String,
    /// Hash of what the scene says ([`Scheme::scene`]).
    pub scene: String,
    /// Hash of the input of the matrices ([`crate::operators::Operators::key`]).
    pub operators: String,
}

impl Provenance {
    /// That of a state that this program steps by a scheme.
    pub fn of(scheme: &Scheme) -> Self {
        Self {
            program: built::PROGRAM.to_owned(),
            commit: built::commit().to_owned(),
            kernel: scheme.kernel.name().to_owned(),
            scene: scheme.scene.clone(),
            operators: scheme.operators.key.clone(),
        }
    }

    /// Puts what is known, and in words where points are, into an HDF5 file of an export, as attributes.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn label(&self, file: &hdf5_metno::File, positions: &str) -> hdf5_metno::Result<()> {
        let all = self.attributes().into_iter().chain([("positions", positions.to_owned())]);
        all.into_iter().try_for_each(|(name, text)| hdf5::put_attribute(file, name, &text))
    }

    /// What is known, under its names.
    pub fn attributes(&self) -> Vec<(&'static str, String)> {
        let texts = [&self.program, &self.commit, &self.kernel, &self.scene, &self.operators].map(Clone::clone);
        KEYS.into_iter().zip(texts).filter(|(_, text)| !text.is_empty()).collect()
    }

    /// By the attributes of a file, empty where it has none of a name.
    pub fn by(attribute: impl Fn(&str) -> String) -> Self {
        let [program, commit, kernel, scene, operators] = KEYS.map(attribute);
        Self { program, commit, kernel, scene, operators }
    }

    /// The same as one line for a comment.
    pub fn line(&self) -> String {
        let words: Vec<String> = self.attributes().into_iter().map(|(key, text)| format!("{key}: {text}")).collect();
        words.join(", ")
    }
}
