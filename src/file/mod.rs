//! Input files as a whole: regular files alone, since a device never ends and a pipe may never begin; and the checksums of
//! files ([`seal`]); how much memory there is for them ([`memory`]).

pub mod memory;
pub mod seal;

use std::fs::{self, Metadata};
use std::path::Path;

/// What a path must be, or in words why it is not.
///
/// # Errors
/// Nothing there, a folder, a device, a pipe or a socket.
pub fn about(path: &Path) -> Result<Metadata, String> {
    let about = fs::metadata(path).map_err(|why| why.to_string())?;
    match () {
        () if about.is_dir() => Err("this is a folder, not a file".to_owned()),
        () if !about.is_file() => Err("it is no file but a device, a pipe or a socket".to_owned()),
        () => Ok(about),
    }
}

/// Refuses a place for a folder of results where a file stands, at its end or on the way to it.
///
/// # Errors
/// Bad input, which names the file.
pub fn check_place_of_folder(path: &Path) -> crate::Result<()> {
    // The nearest that is there.
    match path.ancestors().find(|place| place.symlink_metadata().is_ok()) {
        Some(there) if !there.is_dir() => {
            let what = format!("{} is no folder, and results go into a folder", there.display());
            Err(crate::Error::input(what, "give another folder by --out"))
        }
        _ => Ok(()),
    }
}

/// All bytes of a regular file that has at most `most` of them.
///
/// # Errors
/// As for [`about`]; a file that is larger or cannot be read.
pub fn bytes(path: &Path, most: u64) -> Result<Vec<u8>, String> {
    let length = about(path)?.len();
    if length > most {
        return Err(format!("it has {length} bytes, and {most} are the most that are read"));
    }
    fs::read(path).map_err(|why| why.to_string())
}

/// All of a text file, as [`bytes`]; a mark of the byte order before it is left out.
///
/// # Errors
/// As for [`bytes`]; bytes that are not UTF-8, with their line.
pub fn text(path: &Path, most: u64) -> Result<String, String> {
    let text = String::from_utf8(bytes(path, most)?).map_err(|why| {
        let good = &why.as_bytes()[..why.utf8_error().valid_up_to()];
        format!("line {} is not UTF-8 text", good.iter().filter(|&&byte| byte == b'\n').count() + 1)
    })?;
    // Spreadsheets write a byte order mark at the start of UTF-8.
    Ok(text.strip_prefix('\u{feff}').map(str::to_owned).unwrap_or(text))
}
