//! Helpers for `hdf5-metno`: files that are written whole, datasets that are checked, errors that name the file.

use std::path::Path;

use hdf5_metno as h5;
use hdf5_metno::H5Type;
use hdf5_metno::types::{FloatSize, TypeDescriptor, VarLenAscii, VarLenUnicode};

use super::pending::Pending;
use super::seal::{self, Seal};
use crate::error::{Error, Place, Result};

/// Bytes per chunk: large enough for the disk, small enough for HDF5's cache of 1 MiB.
const CHUNK_BYTES: usize = 256 * 1024;
/// Arrays below this many bytes are stored whole, as chunks would only add overhead.
const SMALL_BYTES: usize = 8 * 1024;
/// Deflate compresses at most 1032 to 1. A dataset that claims more bytes than this times the size of the file is damaged.
const LARGEST_RATIO: u64 = 1100;
/// After a byte shuffle, levels 1, 4, 9 compress a smooth S2 state to .467, .463, .457 of its size at 70, 40, 6 MB/s.
const DEFLATE_LEVEL: u8 = 1;

/// A file that is open for reading, with its path and remedy for messages.
pub struct Reader {
    file: h5::File,
    place: Place,
    bytes: u64,
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

/// Creates a file by `fill`. The file appears whole, or not at all.
pub fn create(path: &Path, fill: impl FnOnce(&h5::File) -> h5::Result<()>) -> Result<()> {
    fill_pending(path, fill)?.commit()
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
    let pending = fill_pending(path, fill)?;
    seal::put(pending.path()).map_err(|e| Error::output(path, e))?;
    match kept {
        Kept::Named => pending.commit(),
        Kept::OnDisk => pending.commit_to_disk(),
    }
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
    h5::File::create(path)
}

/// Writes one dataset (row-major, `shape` may be empty for a single number), packed where that pays.
/// The same values give the same bytes in the file: no time stamps.
pub fn put<T: H5Type>(group: &h5::Group, name: &str, shape: &[usize], values: &[T]) -> h5::Result<()> {
    let count: usize = shape.iter().product();
    if count != values.len() {
        return Err(h5::Error::from(format!("array `{name}` of shape {shape:?} has {} values", values.len()).as_str()));
    }
    let mut builder = group.new_dataset::<T>().obj_track_times(false).create_intermediate_group(true);
    let row = count.checked_div(shape.first().copied().unwrap_or(1)).unwrap_or(0) * size_of::<T>();
    if count * size_of::<T>() > SMALL_BYTES && row > 0 {
        let mut chunk = shape.to_vec();
        chunk[0] = (CHUNK_BYTES / row).clamp(1, chunk[0]);
        builder = builder.chunk(chunk);
        if h5::filters::deflate_available() {
            builder = builder.shuffle().deflate(DEFLATE_LEVEL);
        }
    }
    let dataset = if shape.is_empty() { builder.create(name)? } else { builder.shape(shape).create(name)? };
    if values.is_empty() { Ok(()) } else { dataset.write_raw(values) }
}

/// Writes a list of texts.
pub fn put_texts(group: &h5::Group, name: &str, texts: &[String]) -> h5::Result<()> {
    let values = texts.iter().map(|t| text_value(t)).collect::<h5::Result<Vec<_>>>()?;
    let dataset = group.new_dataset::<VarLenUnicode>().obj_track_times(false).shape(values.len()).create(name)?;
    if values.is_empty() { Ok(()) } else { dataset.write_raw(&values) }
}

/// Writes a text attribute.
pub fn put_attribute(group: &h5::Group, name: &str, text: &str) -> h5::Result<()> {
    group.new_attr::<VarLenUnicode>().create(name)?.write_scalar(&text_value(text)?)
}

fn text_value(text: &str) -> h5::Result<VarLenUnicode> {
    text.parse().map_err(|_| h5::Error::from("a text holds a zero byte"))
}

/// A text attribute of a file's root, if the file can be read and has it.
pub fn peek_attribute(path: &Path, name: &str) -> Option<String> {
    // A damaged file must not reach the HDF5 library.
    seal::check(path).ok().filter(|seal| *seal != Seal::Broken)?;
    let file = h5::File::open(path).ok()?;
    read_attribute(&file, name).ok()
}

fn read_attribute(group: &h5::Group, name: &str) -> h5::Result<String> {
    let attribute = group.attr(name)?;
    let bytes = match attribute.dtype()?.to_descriptor()? {
        TypeDescriptor::VarLenAscii => attribute.read_scalar::<VarLenAscii>()?.as_bytes().to_vec(),
        TypeDescriptor::VarLenUnicode => attribute.read_scalar::<VarLenUnicode>()?.as_bytes().to_vec(),
        other => return Err(h5::Error::from(format!("attribute `{name}` is {other}, not a text").as_str())),
    };
    String::from_utf8(bytes).map_err(|_| h5::Error::from("a text is not UTF-8"))
}

impl Reader {
    /// Opens a file; `remedy` ends every message about it.
    pub fn open(path: &Path, remedy: &str) -> Result<Self> {
        let place = Place::file(path);
        let fail = |what: String| Error::at(place.clone(), what, remedy);
        let about = std::fs::metadata(path).map_err(|e| fail(format!("cannot be read: {e}")))?;
        if about.is_dir() {
            return Err(fail("this is a folder, not a file".to_owned()));
        }
        if seal::check(path).map_err(|e| fail(format!("cannot be read: {e}")))? == Seal::Broken {
            return Err(fail("the file is damaged: its bytes are not those that were written".to_owned()));
        }
        let file = h5::File::open(path).map_err(|e| fail(format!("not a whole HDF5 file: {}", reason(&e))))?;
        Ok(Self { file, place, bytes: about.len(), remedy: remedy.to_owned() })
    }

    /// The error that the file is damaged or has wrong contents.
    pub fn error(&self, what: impl Into<String>) -> Error {
        Error::at(self.place.clone(), what, self.remedy.clone())
    }

    /// Names of all datasets of the root group.
    pub fn names(&self) -> Result<Vec<String>> {
        self.file.member_names().map_err(|e| self.error(format!("its contents cannot be listed: {}", reason(&e))))
    }

    /// Names of all attributes of the root group.
    pub fn attribute_names(&self) -> Result<Vec<String>> {
        self.file.attr_names().map_err(|e| self.error(format!("its attributes cannot be listed: {}", reason(&e))))
    }

    /// A text attribute of the root group.
    pub fn attribute(&self, name: &str) -> Result<String> {
        read_attribute(&self.file, name)
            .map_err(|e| self.error(format!("attribute `{name}` cannot be read: {}", reason(&e))))
    }

    /// Shape and values of a dataset.
    pub fn get(&self, name: &str) -> Result<(Vec<usize>, Values)> {
        let fail = |e: h5::Error| self.error(format!("array `{name}` cannot be read: {}", reason(&e)));
        let dataset = self.file.dataset(name).map_err(fail)?;
        let shape = dataset.get_shape().map_err(fail)?;
        let kind = dataset.dtype().and_then(|t| t.to_descriptor()).map_err(fail)?;
        self.check_size(name, &shape, &kind)?;
        let values = match kind {
            TypeDescriptor::Float(FloatSize::U4 | FloatSize::U8) => Values::F64(dataset.read_raw().map_err(fail)?),
            TypeDescriptor::Integer(_) => Values::I64(dataset.read_raw().map_err(fail)?),
            TypeDescriptor::Unsigned(_) => Values::U64(dataset.read_raw().map_err(fail)?),
            TypeDescriptor::VarLenUnicode => {
                let texts: Vec<VarLenUnicode> = dataset.read_raw().map_err(fail)?;
                Values::Text(self.texts(name, texts.iter().map(|t| t.as_bytes()))?)
            }
            TypeDescriptor::VarLenAscii => {
                let texts: Vec<VarLenAscii> = dataset.read_raw().map_err(fail)?;
                Values::Text(self.texts(name, texts.iter().map(|t| t.as_bytes()))?)
            }
            other => return Err(self.error(format!("array `{name}` holds {other}, which is not used here"))),
        };
        Ok((shape, values))
    }

    /// An error if the size is more than the file can hold. It is tested before memory is allocated.
    fn check_size(&self, name: &str, shape: &[usize], kind: &TypeDescriptor) -> Result<()> {
        let bytes = shape.iter().try_fold(kind.size() as u64, |product, &n| product.checked_mul(n as u64));
        match bytes {
            Some(bytes) if bytes <= self.bytes.saturating_mul(LARGEST_RATIO) => Ok(()),
            _ => Err(self.error(format!("array `{name}` claims the shape {shape:?}, more than the file can hold"))),
        }
    }

    fn texts<'a>(&self, name: &str, texts: impl Iterator<Item = &'a [u8]>) -> Result<Vec<String>> {
        texts
            .map(|t| String::from_utf8(t.to_vec()).map_err(|_| self.error(format!("a text of `{name}` is not UTF-8"))))
            .collect()
    }
}
