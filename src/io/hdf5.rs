//! Helpers for `hdf5-metno`: files that are written whole, datasets that are checked, errors that name the file.
//!
//! The library trusts a file: damaged texts of variable length make it crash or hang, and links take it to other files. So
//! texts are written with fixed lengths, a file without a seal is read only where the user trusts it, and whatever leads out of
//! a file is an error.

mod datasets;
mod within;

pub use datasets::{put, put_rows};

use std::io::Read;
use std::path::Path;

use hdf5_metno as h5;
use hdf5_metno::LinkType;
use hdf5_metno::plist::dataset_create::Layout;
use hdf5_metno::types::{FixedUnicode, FloatSize, TypeDescriptor, VarLenAscii, VarLenUnicode};

use super::pending::{Pending, check_folder};
use super::regular;
use super::seal::{self, Seal};
use crate::built;
use crate::error::{Error, Place, Result};
use crate::file::memory;

/// Bytes per chunk: large enough for the disk, small enough for HDF5's cache of 1 MiB.
pub(super) const CHUNK_BYTES: usize = 256 * 1024;
/// Arrays below this many bytes are stored whole, as chunks would only add overhead.
const SMALL_BYTES: usize = 8 * 1024;
/// Deflate compresses at most 1032 to 1. A dataset that claims more bytes than this times those that it stores is damaged.
const LARGEST_RATIO: u64 = 1100;
/// After a byte shuffle, levels 1, 4, 9 compress a smooth S2 state to .467, .463, .457 of its size at 70, 40, 6 MB/s.
pub(super) const DEFLATE_LEVEL: u8 = 1;

/// A file that is open for reading, with its path and remedy for messages.
pub struct Reader {
    file: h5::File,
    place: Place,
    bytes: u64,
    sealed: bool,
    remedy: String,
}

/// Values of a dataset, as they are in the file, widened to 64 bits.
#[derive(Debug, Clone, PartialEq)]
pub enum Values {
    /// Real numbers.
    F64(Vec<f64>),
    /// Signed integers.
    I64(Vec<i64>),
    /// Unsigned integers.
    U64(Vec<u64>),
    /// Texts.
    Text(Vec<String>),
}

/// When a file counts as written.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kept {
    /// Once it has its name: it outlives the program.
    Named,
    /// Once the disk has it: it outlives a power cut.
    OnDisk,
}

/// Creates a file by `fill`, with a seal that shows later damage. The file appears whole, or not at all.
pub fn create_sealed(path: &Path, kept: Kept, fill: impl FnOnce(&h5::File) -> h5::Result<()>) -> Result<()> {
    let write = || {
        let pending = fill_pending(path, fill)?;
        seal::put(pending.path()).map_err(|e| Error::output(path, e))?;
        match kept {
            Kept::Named => pending.commit(),
            Kept::OnDisk => pending.commit_to_disk(),
        }
    };
    // A folder that went away while the file was written is the reason of whatever failed.
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    write().or_else(|why| folder.map_or(Ok(()), check_folder).and(Err(why)))
}

fn fill_pending(path: &Path, fill: impl FnOnce(&h5::File) -> h5::Result<()>) -> Result<Pending> {
    let pending = Pending::new(path)?;
    let file = open_new(pending.path()).map_err(|e| Error::output(path, reason(&e)))?;
    let filled = fill(&file).and_then(|()| file.flush());
    let closed = file.close();
    filled.and(closed).map_err(|e| Error::output(path, reason(&e)))?;
    Ok(pending)
}

/// The cause of an error of HDF5, on one line: the text of the operating system if HDF5 quotes it, otherwise the first line
/// without times and addresses.
pub fn reason(error: &h5::Error) -> String {
    let text = error.to_string();
    let quoted =
        text.split_once("error message = '").and_then(|(_, rest)| rest.split_once('\'')).map(|(words, _)| words);
    let first = || text.split([':', '\n']).map(str::trim).take_while(|part| !part.starts_with("time = "));
    quoted.map_or_else(|| first().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(": "), str::to_owned)
}

/// Opens a new file for writing, in the format that every HDF5 since 1.8 reads.
pub fn open_new(path: &Path) -> h5::Result<h5::File> {
    without_locks().create(path)
}

/// The files of this program appear whole, by rename, and are not changed after that: a lock has nothing to guard. It would do
/// harm: network file systems often have none, and a process that another thread starts holds it beyond the end of the writing.
fn without_locks() -> h5::FileBuilder {
    let mut options = h5::File::with_options();
    options.with_fapl(|access| access.file_locking(false));
    options
}

/// Lengths of texts in a file, bytes: a list of texts takes the first that all of them fit into.
const SHORT: usize = 64;
const MIDDLE: usize = 512;
const LONG: usize = 4096;

/// Writes a list of texts, of a fixed length; of variable length, which only sealed files are read with, where one is longer than
/// 4096 bytes.
pub fn put_texts(group: &h5::Group, name: &str, texts: &[String]) -> h5::Result<()> {
    match texts.iter().map(String::len).max().unwrap_or(0) {
        length if length <= SHORT => put_fixed::<SHORT>(group, name, texts),
        length if length <= MIDDLE => put_fixed::<MIDDLE>(group, name, texts),
        length if length <= LONG => put_fixed::<LONG>(group, name, texts),
        _ => {
            let values = texts.iter().map(|text| variable(text)).collect::<h5::Result<Vec<_>>>()?;
            let new = group.new_dataset::<VarLenUnicode>().obj_track_times(false).shape(values.len());
            new.create(name)?.write_raw(&values)
        }
    }
}

fn put_fixed<const N: usize>(group: &h5::Group, name: &str, texts: &[String]) -> h5::Result<()> {
    let values = texts.iter().map(|text| fixed::<N>(text)).collect::<h5::Result<Vec<_>>>()?;
    let dataset = group.new_dataset::<FixedUnicode<N>>().obj_track_times(false).shape(values.len()).create(name)?;
    if values.is_empty() { Ok(()) } else { dataset.write_raw(&values) }
}

/// Writes a text attribute, of a fixed length as far as [`put_texts`] has them.
pub fn put_attribute(group: &h5::Group, name: &str, text: &str) -> h5::Result<()> {
    match text.len() {
        length if length <= SHORT => put_fixed_attribute::<SHORT>(group, name, text),
        length if length <= MIDDLE => put_fixed_attribute::<MIDDLE>(group, name, text),
        length if length <= LONG => put_fixed_attribute::<LONG>(group, name, text),
        _ => group.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&variable(text)?),
    }
}

/// The attributes of the program that wrote a file, and of its commit.
pub const PROGRAM: [&str; 2] = ["program", "commit"];

/// Writes which program makes the file.
pub fn put_program(group: &h5::Group) -> h5::Result<()> {
    let texts = [built::PROGRAM, built::commit()];
    PROGRAM.into_iter().zip(texts).try_for_each(|(name, text)| put_attribute(group, name, text))
}

fn put_fixed_attribute<const N: usize>(group: &h5::Group, name: &str, text: &str) -> h5::Result<()> {
    group.new_attr::<FixedUnicode<N>>().create(name)?.write_scalar(&fixed::<N>(text)?)
}

fn variable(text: &str) -> h5::Result<VarLenUnicode> {
    text.parse().map_err(|_| h5::Error::from("a text holds a zero byte"))
}

fn fixed<const N: usize>(text: &str) -> h5::Result<FixedUnicode<N>> {
    if text.contains('\0') {
        return Err(h5::Error::from("a text holds a zero byte"));
    }
    text.parse().map_err(|_| h5::Error::from(format!("a text has {} bytes, more than {N}", text.len()).as_str()))
}

/// A text attribute of a file's root, if the file is whole and has it.
pub fn peek_attribute(path: &Path, name: &str) -> Option<String> {
    regular::about(path).ok()?;
    // A file that may be damaged must not reach the HDF5 library.
    seal::check(path).ok().filter(|seal| *seal == Seal::Whole)?;
    let file = without_locks().open(path).ok()?;
    read_attribute(&file, name, true).ok()
}

/// `sealed`: texts of variable length are read too, as this program wrote them once.
fn read_attribute(group: &h5::Group, name: &str, sealed: bool) -> h5::Result<String> {
    let attribute = group.attr(name)?;
    if !attribute.is_scalar() {
        return Err(h5::Error::from("it is not one text"));
    }
    let bytes = match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::FixedUnicode(0..=SHORT) | TypeDescriptor::FixedAscii(0..=SHORT) => {
            attribute.read_scalar::<FixedUnicode<SHORT>>()?.as_bytes().to_vec()
        }
        TypeDescriptor::FixedUnicode(..=LONG) | TypeDescriptor::FixedAscii(..=LONG) => {
            attribute.read_scalar::<FixedUnicode<LONG>>()?.as_bytes().to_vec()
        }
        TypeDescriptor::VarLenAscii if sealed => attribute.read_scalar::<VarLenAscii>()?.as_bytes().to_vec(),
        TypeDescriptor::VarLenUnicode if sealed => attribute.read_scalar::<VarLenUnicode>()?.as_bytes().to_vec(),
        other => return Err(h5::Error::from(format!("it is {other}, not a text of a fixed length").as_str())),
    };
    String::from_utf8(bytes).map_err(|_| h5::Error::from("it is not UTF-8 text"))
}

impl Reader {
    /// Opens a file; `remedy` ends every message about it.
    ///
    /// # Errors
    /// A file that is not there, is damaged, or has no seal and is not trusted ([`seal::trust`]).
    pub fn open(path: &Path, remedy: &str) -> Result<Self> {
        let place = Place::file(path);
        let fail = |what: String| Error::at(place.clone(), what, remedy);
        let about = regular::about(path).map_err(|why| fail(format!("cannot be read: {why}")))?;
        let seal = seal::check(path).map_err(|e| fail(format!("cannot be read: {e}")))?;
        if seal == Seal::Broken {
            return Err(fail("the file is damaged: its bytes are not those that were written".to_owned()));
        }
        if !begins_as_hdf5(path) {
            return Err(fail("not a whole HDF5 file: it does not begin as one".to_owned()));
        }
        if seal == Seal::None && !seal::is_trusted() {
            let what =
                "the file has no seal of dgmpm: it was cut off, was changed by another program, or is not of dgmpm";
            let remedy = format!("{remedy}, or give --trust if you know that its writer means no harm");
            return Err(Error::at(place, what, remedy));
        }
        let file = without_locks().open(path).map_err(|e| fail(format!("not a whole HDF5 file: {}", reason(&e))))?;
        Ok(Self { file, place, bytes: about.len(), sealed: seal == Seal::Whole, remedy: remedy.to_owned() })
    }

    /// The error that the file is damaged or has wrong contents.
    pub fn error(&self, what: impl Into<String>) -> Error {
        Error::at(self.place.clone(), what, self.remedy.clone())
    }

    /// Names of all datasets of the root group.
    ///
    /// # Errors
    /// A link that is not one to an object of the file itself: it may lead to any file of the machine.
    pub fn names(&self) -> Result<Vec<String>> {
        let (mut names, mut link) = (Vec::new(), None);
        let visited = self.file.iter_visit_default(|name, about| {
            match about.link_type {
                LinkType::Hard => names.push(name.to_owned()),
                LinkType::Soft | LinkType::External => link = Some(name.to_owned()),
            }
            Ok(())
        });
        visited.map_err(|e| self.error(format!("its contents cannot be listed: {}", reason(&e))))?;
        match link {
            Some(name) => Err(self.error(format!("`{name}` is a link, and links are not followed"))),
            None => Ok(names),
        }
    }

    /// Names of all attributes of the root group.
    pub fn attribute_names(&self) -> Result<Vec<String>> {
        self.file.attr_names().map_err(|e| self.error(format!("its attributes cannot be listed: {}", reason(&e))))
    }

    /// A text attribute of the root group.
    pub fn attribute(&self, name: &str) -> Result<String> {
        read_attribute(&self.file, name, self.sealed)
            .map_err(|e| self.error(format!("attribute `{name}` cannot be read: {}", reason(&e))))
    }

    /// Shape and values of a dataset.
    pub fn get(&self, name: &str) -> Result<(Vec<usize>, Values)> {
        let fail = |e: h5::Error| self.error(format!("array `{name}` cannot be read: {}", reason(&e)));
        let dataset = self.file.dataset(name).map_err(fail)?;
        self.check_place(name, &dataset)?;
        let shape = dataset.get_shape().map_err(fail)?;
        let kind = dataset.dtype().and_then(|t| t.to_descriptor()).map_err(fail)?;
        self.check_size(name, &dataset, &shape, &kind)?;
        let values = match kind {
            TypeDescriptor::Float(FloatSize::U4 | FloatSize::U8) => Values::F64(dataset.read_raw().map_err(fail)?),
            TypeDescriptor::Integer(_) => Values::I64(dataset.read_raw().map_err(fail)?),
            TypeDescriptor::Unsigned(_) => Values::U64(dataset.read_raw().map_err(fail)?),
            kind => Values::Text(self.texts(name, &dataset, &kind)?),
        };
        Ok((shape, values))
    }

    /// An error if the numbers of a dataset are in other files: raw storage, or a virtual dataset.
    fn check_place(&self, name: &str, dataset: &h5::Dataset) -> Result<()> {
        let fail = |e: h5::Error| self.error(format!("array `{name}` cannot be read: {}", reason(&e)));
        let plan = dataset.dcpl().map_err(fail)?;
        let outside = !plan.get_external().map_err(fail)?.is_empty();
        match outside || plan.get_layout().map_err(fail)? == Layout::Virtual {
            true => {
                Err(self.error(format!("array `{name}` takes its numbers from other files, which are not followed")))
            }
            false => Ok(()),
        }
    }

    /// An error if the size is more than what is stored can give, or than the file can hold. It is tested before memory is
    /// allocated.
    fn check_size(&self, name: &str, dataset: &h5::Dataset, shape: &[usize], kind: &TypeDescriptor) -> Result<()> {
        let bytes = shape.iter().try_fold(kind.size().max(8) as u64, |product, &n| product.checked_mul(n as u64));
        // Numbers of fewer than 8 bytes are widened.
        let stored = dataset.storage_size().min(self.bytes).saturating_mul(8);
        match bytes {
            Some(bytes) if bytes <= stored.saturating_mul(LARGEST_RATIO) => {
                memory::check(bytes).map_err(|why| self.error(format!("array `{name}`: {why}")))
            }
            _ => Err(self.error(format!("array `{name}` claims the shape {shape:?}, more than the file can hold"))),
        }
    }

    fn texts(&self, name: &str, dataset: &h5::Dataset, kind: &TypeDescriptor) -> Result<Vec<String>> {
        let bytes = match kind {
            TypeDescriptor::FixedUnicode(0..=SHORT) | TypeDescriptor::FixedAscii(0..=SHORT) => {
                fixed_bytes::<SHORT>(dataset)
            }
            TypeDescriptor::FixedUnicode(..=MIDDLE) | TypeDescriptor::FixedAscii(..=MIDDLE) => {
                fixed_bytes::<MIDDLE>(dataset)
            }
            TypeDescriptor::FixedUnicode(..=LONG) | TypeDescriptor::FixedAscii(..=LONG) => fixed_bytes::<LONG>(dataset),
            // As this program wrote texts once.
            TypeDescriptor::VarLenUnicode if self.sealed => {
                dataset.read_raw::<VarLenUnicode>().map(|all| all.iter().map(|text| text.as_bytes().to_vec()).collect())
            }
            TypeDescriptor::VarLenAscii if self.sealed => {
                dataset.read_raw::<VarLenAscii>().map(|all| all.iter().map(|text| text.as_bytes().to_vec()).collect())
            }
            other => return Err(self.error(format!("array `{name}` holds {other}, which is not used here"))),
        };
        let bytes: Vec<Vec<u8>> =
            bytes.map_err(|e| self.error(format!("array `{name}` cannot be read: {}", reason(&e))))?;
        let text = |bytes| String::from_utf8(bytes).map_err(|_| self.error(format!("a text of `{name}` is not UTF-8")));
        bytes.into_iter().map(text).collect()
    }
}

fn fixed_bytes<const N: usize>(dataset: &h5::Dataset) -> h5::Result<Vec<Vec<u8>>> {
    let all = dataset.read_raw::<FixedUnicode<N>>()?;
    Ok(all.iter().map(|text| text.as_bytes().to_vec()).collect())
}

/// Whether a file has the signature of HDF5 at its start, where this program writes it.
pub fn begins_as_hdf5(path: &Path) -> bool {
    let signature = b"\x89HDF\r\n\x1a\n";
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(signature.len() as u64).read_to_end(&mut start));
    read.is_ok() && start == signature
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As a process that another thread of a run has just started does: it shares the file until its own program begins.
    #[test]
    fn a_file_on_which_another_holds_a_lock_is_read() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("part.h5");
        create_sealed(&path, Kept::Named, |file| put(file, "numbers", &[2], &[1.0, 2.0])).unwrap();
        let held = std::fs::File::open(&path).unwrap();
        held.lock().unwrap();
        assert_eq!(Reader::open(&path, "write it again").unwrap().names().unwrap(), ["numbers"]);
        assert!(peek_attribute(&path, "absent").is_none());
    }
}
