//! A checksum at the end of a file. It shows damage before the HDF5 library reads the file: on a damaged file the library
//! may allocate very much memory or crash.
//!
//! The seal is one line of text after the last byte of HDF5. Every HDF5 library ignores it. A program that changes the file
//! through HDF5 cuts the seal off; the file is then read without a check.

use std::fs::{File, OpenOptions};
use std::io::{Read, Result, Seek, SeekFrom, Write};
use std::path::Path;

/// The text before the 64 hexadecimal digits. The digits are the blake3 hash of all bytes before the seal.
const MARK: &[u8] = b"\ndgmpm-seal ";
/// Bytes of a seal: the mark, the digits, an end of line.
const LENGTH: u64 = MARK.len() as u64 + 64 + 1;

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

/// Adds the seal to a file that is complete.
pub fn put(path: &Path) -> Result<()> {
    let mut file = OpenOptions::new().read(true).append(true).open(path)?;
    let length = file.metadata()?.len();
    let digits = digits(&mut file, length)?;
    file.write_all(&[MARK, digits.as_bytes(), b"\n"].concat())
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
