//! A checksum at the end of a file. It shows damage before the HDF5 library reads the file: on a damaged file the library
//! may allocate very much memory or crash.
//!
//! The seal of an HDF5 file is one line of text after the last byte of HDF5. Every HDF5 library ignores it. A program that changes
//! the file through HDF5 cuts the seal off; the file is then read only where the user trusts it ([`trust`]). A text file has its seal
//! as a comment in its last line ([`text`]).
//!
//! A seal shows damage. It does not show who wrote a file: anyone can compute a hash.

use std::fs::{File, OpenOptions};
use std::io::{Read, Result, Seek, SeekFrom, Write};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// The text before the 64 hexadecimal digits. The digits are the blake3 hash of all bytes before the seal.
const MARK: &[u8] = b"\ndgmpm-seal ";
/// Hexadecimal digits of a hash.
const DIGITS: usize = 64;
/// Bytes of a seal: the mark, the digits, an end of line.
const LENGTH: u64 = (MARK.len() + DIGITS + 1) as u64;

/// Whether a file is as it was when it was sealed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Seal {
    /// It has a seal, and its bytes agree with it.
    Whole,
    /// It has a seal, but its bytes do not agree with it: it is damaged.
    Broken,
    /// It has no seal.
    None,
}

/// Whether files without a seal are read.
static TRUSTED: AtomicBool = AtomicBool::new(false);

/// From here on HDF5 files without a seal are read too: the user knows where they come from (`--trust`).
pub fn trust() {
    TRUSTED.store(true, Ordering::Relaxed);
}

/// Whether [`trust`] has been called.
pub fn is_trusted() -> bool {
    TRUSTED.load(Ordering::Relaxed)
}

/// Adds the seal to a file that is complete.
pub fn put(path: &Path) -> Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    let digits = digits(&mut file, length)?;
    file.write_all(&[MARK, digits.as_bytes(), b"\n"].concat())
}

/// The hash that stands in the seal of a file or a text, given by its last bytes; none where these hold no seal. Whether the bytes before
/// it have this hash, [`check`] says.
pub fn hash_in(bytes: &[u8]) -> Option<blake3::Hash> {
    let mark = MARK.trim_ascii_start();
    let start = bytes.windows(mark.len()).rposition(|window| window == mark)? + mark.len();
    let digits = std::str::from_utf8(bytes.get(start..start + DIGITS)?).ok()?;
    blake3::Hash::from_hex(digits).ok()
}

/// The same of a file.
pub fn hash_of(path: &Path) -> Option<blake3::Hash> {
    let mut file = File::open(path).ok()?;
    let length = file.metadata().ok()?.len();
    file.seek(SeekFrom::Start(length.saturating_sub(2 * LENGTH))).ok()?;
    let mut end = Vec::new();
    file.read_to_end(&mut end).ok()?;
    hash_in(&end)
}

/// Checks the seal of a file.
pub fn check(path: &Path) -> Result<Seal> {
    let mut file = File::open(path)?;
    let Some(length) = file.metadata()?.len().checked_sub(LENGTH) else { return Ok(Seal::None) };
    file.seek(SeekFrom::Start(length))?;
    let mut seal = Vec::new();
    file.read_to_end(&mut seal)?;
    let Some(rest) = seal.strip_prefix(MARK) else { return Ok(Seal::None) };
    let holds = rest.strip_suffix(b"\n") == Some(digits(&mut file, length)?.as_bytes());
    Ok(if holds { Seal::Whole } else { Seal::Broken })
}

fn digits(file: &mut File, length: u64) -> Result<String> {
    file.seek(SeekFrom::Start(0))?;
    let mut hasher = blake3::Hasher::new();
    hasher.update_reader(file.take(length))?;
    Ok(hasher.finalize().to_hex().to_string())
}

/// What begins and ends a comment of TOML and of tables of loads.
pub const TOML: [&str; 2] = ["# ", ""];
/// The same of Gmsh.
pub const GEO: [&str; 2] = ["// ", ""];
/// The same of XML.
pub const XML: [&str; 2] = ["<!-- ", " -->"];

/// A text with its seal as a comment in its last line; `[open, close]` are what begins and ends a comment.
pub fn text(text: &str, [open, close]: [&str; 2]) -> String {
    let text = unsealed(text);
    let end = if text.is_empty() || text.ends_with('\n') { "" } else { "\n" };
    let whole = format!("{text}{end}");
    let digits = blake3::hash(whole.as_bytes()).to_hex();
    format!("{whole}{}\n", line(open, &digits, close))
}

/// The line of a seal, without its end.
fn line(open: &str, digits: &str, close: &str) -> String {
    format!("{open}dgmpm-seal {digits}{close}")
}

/// Where the last line begins, if it has the mark of a seal.
fn last_line(text: &[u8]) -> Option<usize> {
    let mark = MARK.trim_ascii_start();
    let line = text.trim_ascii_end();
    let start = line.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
    line[start..].windows(mark.len()).any(|window| window == mark).then_some(start)
}

/// Checks the seal of a text.
pub fn check_text(text: &[u8]) -> Seal {
    let Some(start) = last_line(text) else { return Seal::None };
    let (digits, found) = (blake3::hash(&text[..start]).to_hex(), text[start..].trim_ascii_end());
    let is_whole = |[open, close]: [&str; 2]| found == line(open, &digits, close).as_bytes();
    if [TOML, GEO, XML].into_iter().any(is_whole) { Seal::Whole } else { Seal::Broken }
}

/// A text without the line of its seal.
pub fn unsealed(text: &str) -> &str {
    last_line(text.as_bytes()).and_then(|start| text.get(..start)).unwrap_or(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_byte_of_a_sealed_text_is_held() {
        let whole = text("a = 1\nb = 2", ["# ", ""]);
        assert!(whole.starts_with("a = 1\nb = 2\n# dgmpm-seal "), "{whole}");
        assert_eq!(check_text(whole.as_bytes()), Seal::Whole);
        assert_eq!(text(&whole, ["# ", ""]), whole, "sealed twice");
        let mark = whole.find("dgmpm-seal ").unwrap();
        assert_eq!(hash_in(whole.as_bytes()), Some(blake3::hash(b"a = 1\nb = 2\n")));
        for at in 0..whole.len() {
            let mut other = whole.clone().into_bytes();
            other[at] ^= 1;
            // Without its mark a seal is a comment of the user.
            let wanted = if (mark..mark + "dgmpm-seal ".len()).contains(&at) { Seal::None } else { Seal::Broken };
            assert_eq!(check_text(&other), wanted, "{at}");
        }
        assert_eq!(check_text(whole.replace('\n', "\r\n").as_bytes()), Seal::Broken);
        assert_eq!(check_text(whole.trim_end().as_bytes()), Seal::Whole, "an editor has cut off the end of the line");
        for text in ["", "\n", "a = 1\n", "# dgmpm\n"] {
            assert_eq!(check_text(text.as_bytes()), Seal::None, "{text:?}");
        }
    }
}
