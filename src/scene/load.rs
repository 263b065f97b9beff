//! From a scene file to its text: a regular file of a reasonable size, as it was written, in UTF-8.

use super::Scene;
use super::origin::Origin;
use crate::error::{Error, Place, Result};
use crate::file::{bytes, seal, seal::Seal};
use std::path::Path;

/// Bytes of the largest scene that is read: a hundred times those of `meshes/`. A byte may take 200 of memory while it is parsed.
const LARGEST: u64 = 1 << 19;

impl Scene {
    /// Reads a scene file and applies overrides `key.path=value`.
    pub fn load(path: &Path, sets: &[String]) -> Result<Self> {
        let whole = |what: String, remedy: &str| Error::at(Place::file(path), what, remedy);
        let bytes = bytes(path, LARGEST)
            .map_err(|why| whole(format!("cannot read the scene: {why}"), "give the path of a scene file (.toml)"))?;
        if seal::check_text(&bytes) == Seal::Broken && !seal::is_trusted() {
            let what = "the scene is not as it was written: a byte is damaged, or someone has changed it";
            return Err(whole(
                what.to_owned(),
                "if the change is yours, remove the last line, which has the hash, or give --trust",
            ));
        }
        let text = String::from_utf8(bytes).map_err(|why| {
            let good = why.utf8_error().valid_up_to();
            let before = String::from_utf8_lossy(&why.as_bytes()[..good]).into_owned();
            Origin::error_at_byte(path, &before, good, "this is not UTF-8 text".to_owned(), "save the scene as UTF-8")
        })?;
        Self::parse(seal::unsealed(text.strip_prefix('\u{feff}').unwrap_or(&text)), path, sets)
    }
}
