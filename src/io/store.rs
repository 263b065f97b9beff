//! Named arrays and text attributes in one sealed HDF5 file, with the name and version of the format and of the program. Mesh, cloud and
//! snapshot files are stores. Any other data that has to outlive a process may be a store too.

use std::collections::BTreeMap;
use std::io::Read;
use std::ops::Range;
use std::path::Path;

use super::hdf5::{self, Reader, Values};
use super::regular;
use crate::built;
use crate::error::{Error, Result};

/// The format of a file, and the command that makes the file again.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Format {
    /// The name, such as `dgmpm mesh`.
    pub name: &'static str,
    /// The version that this program writes. It reads this version and all before it.
    pub version: u32,
    /// What the user can do about a file that cannot be used.
    pub remedy: &'static str,
}

/// Values to write.
#[derive(Debug, Clone, Copy)]
pub enum ArrayRef<'a> {
    /// Real numbers.
    F64(&'a [f64]),
    /// Signed integers.
    I64(&'a [i64]),
    /// Unsigned integers.
    U64(&'a [u64]),
    /// Counts or indices, stored as signed integers, with which other programs compute best.
    Index(&'a [usize]),
    /// Texts; the shape is one number.
    Text(&'a [String]),
    /// Real numbers that are made while they are written.
    Rows(Rows<'a>),
}

/// Makes the real numbers of some rows of the first axis of an array.
#[derive(Clone, Copy)]
pub struct Rows<'a>(pub &'a dyn Fn(Range<usize>) -> Vec<f64>);

impl std::fmt::Debug for Rows<'_> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("rows")
    }
}

/// A file that was read. Its arrays are taken out by name.
#[derive(Debug)]
pub struct Store {
    place: crate::error::Place,
    remedy: &'static str,
    attributes: BTreeMap<String, String>,
    arrays: BTreeMap<String, (Vec<usize>, Values)>,
}

const FORMAT: &str = "format";
const VERSION: &str = "version";

/// Writes a store: text attributes, and arrays (name, shape, values in row-major order). Whole or not at all.
pub fn write_arrays(
    path: &Path,
    format: Format,
    attributes: &[(&str, String)],
    arrays: &[(&str, Vec<usize>, ArrayRef)],
) -> Result<()> {
    write_kept(path, format, attributes, arrays, hdf5::Kept::Named)
}

/// The same, kept as `kept` says.
pub(super) fn write_kept(
    path: &Path,
    format: Format,
    attributes: &[(&str, String)],
    arrays: &[(&str, Vec<usize>, ArrayRef)],
    kept: hdf5::Kept,
) -> Result<()> {
    let mut all: BTreeMap<String, String> = attributes.iter().map(|(k, v)| ((*k).to_owned(), v.clone())).collect();
    for (name, text) in hdf5::PROGRAM.into_iter().zip([built::PROGRAM, built::commit()]) {
        all.entry(name.to_owned()).or_insert_with(|| text.to_owned());
    }
    all.insert(FORMAT.to_owned(), format.name.to_owned());
    all.insert(VERSION.to_owned(), format.version.to_string());
    hdf5::create_sealed(path, kept, |file| {
        for (name, text) in &all {
            hdf5::put_attribute(file, name, text)?;
        }
        arrays.iter().try_for_each(|(name, shape, array)| match *array {
            ArrayRef::F64(values) => hdf5::put(file, name, shape, values),
            ArrayRef::I64(values) => hdf5::put(file, name, shape, values),
            ArrayRef::U64(values) => hdf5::put(file, name, shape, values),
            ArrayRef::Index(values) => {
                let values: Vec<i64> = values.iter().map(|&v| v as i64).collect();
                hdf5::put(file, name, shape, &values)
            }
            ArrayRef::Rows(Rows(rows)) => hdf5::put_rows(file, name, shape, rows),
            ArrayRef::Text(values) => hdf5::put_texts(file, name, values),
        })
    })
}

impl Store {
    /// Reads a whole file and checks its seal, format and version.
    pub fn read(path: &Path, format: Format) -> Result<Self> {
        let reader = Reader::open(path, format.remedy)?;
        let mut attributes = BTreeMap::new();
        for name in reader.attribute_names()? {
            attributes.insert(name.clone(), reader.attribute(&name)?);
        }
        check_format(&reader, &attributes, format)?;
        let mut arrays = BTreeMap::new();
        for name in reader.names()? {
            arrays.insert(name.clone(), reader.get(&name)?);
        }
        Ok(Self { place: crate::error::Place::file(path), remedy: format.remedy, attributes, arrays })
    }

    /// The error that the file is damaged or has wrong contents.
    pub fn error(&self, what: impl Into<String>) -> Error {
        Error::at(self.place.clone(), what, self.remedy)
    }

    /// Names of the arrays, sorted.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.arrays.keys().map(String::as_str)
    }

    /// A text attribute.
    pub fn attribute(&self, name: &str) -> Result<&str> {
        let text = self.attributes.get(name).map(String::as_str);
        text.ok_or_else(|| self.error(format!("the attribute `{name}` is missing")))
    }

    /// Shape of an array that has not been taken yet.
    pub fn shape(&self, name: &str) -> Result<&[usize]> {
        let found = self.arrays.get(name).map(|(shape, _)| shape.as_slice());
        found.ok_or_else(|| self.error(format!("the array `{name}` is missing")))
    }

    /// Takes an array out, with its shape.
    pub fn take(&mut self, name: &str) -> Result<(Vec<usize>, Values)> {
        self.arrays.remove(name).ok_or_else(|| self.error(format!("the array `{name}` is missing")))
    }

    /// Takes real numbers whose shape is `[any, tail..]`.
    pub fn reals(&mut self, name: &str, tail: &[usize]) -> Result<Vec<f64>> {
        match self.with_tail(name, tail)? {
            Values::F64(values) => Ok(values),
            _ => Err(self.error(format!("the array `{name}` does not hold real numbers"))),
        }
    }

    /// Takes a single real number.
    pub fn real(&mut self, name: &str) -> Result<f64> {
        match self.take(name)? {
            (_, Values::F64(values)) if values.len() == 1 => Ok(values[0]),
            _ => Err(self.error(format!("`{name}` is not one real number"))),
        }
    }

    /// Takes unsigned integers whose shape is `[any, tail..]`; signed ones are accepted if none is negative.
    pub fn unsigned(&mut self, name: &str, tail: &[usize]) -> Result<Vec<u64>> {
        let values = match self.with_tail(name, tail)? {
            Values::U64(values) => Some(values),
            Values::I64(values) => values.into_iter().map(|v| u64::try_from(v).ok()).collect(),
            _ => None,
        };
        values.ok_or_else(|| self.error(format!("the array `{name}` does not hold numbers from 0")))
    }

    /// Takes counts or indices whose shape is `[any, tail..]`.
    pub fn indices(&mut self, name: &str, tail: &[usize]) -> Result<Vec<usize>> {
        let values = self.unsigned(name, tail)?;
        let values: Option<Vec<usize>> = values.into_iter().map(|v| usize::try_from(v).ok()).collect();
        values.ok_or_else(|| self.error(format!("the array `{name}` holds a number that is too large")))
    }

    /// Takes a list of texts.
    pub fn texts(&mut self, name: &str) -> Result<Vec<String>> {
        match self.with_tail(name, &[])? {
            Values::Text(values) => Ok(values),
            _ => Err(self.error(format!("the array `{name}` does not hold texts"))),
        }
    }

    fn with_tail(&mut self, name: &str, tail: &[usize]) -> Result<Values> {
        let (shape, values) = self.take(name)?;
        if shape.is_empty() || shape[1..] != *tail {
            return Err(self.error(format!("the array `{name}` has the shape {shape:?} instead of [n, {tail:?}]")));
        }
        Ok(values)
    }
}

fn check_format(reader: &Reader, attributes: &BTreeMap<String, String>, format: Format) -> Result<()> {
    match attributes.get(FORMAT) {
        Some(name) if name == format.name => {}
        Some(name) => return Err(reader.error(format!("this is a `{name}` file, not a `{}` file", format.name))),
        None => return Err(reader.error(format!("not a `{}` file: the attribute `{FORMAT}` is missing", format.name))),
    }
    let text = attributes.get(VERSION).map(String::as_str).unwrap_or("");
    match text.parse::<u32>() {
        Ok(version) if (1..=format.version).contains(&version) => Ok(()),
        Ok(version) => {
            Err(reader.error(format!("its version is {version}; this program reads 1 to {}", format.version)))
        }
        Err(_) => Err(reader.error(format!("its version `{text}` is not a number"))),
    }
}

/// Whether a file should be a store, by its name or its first bytes. It may be damaged.
pub fn is_meant_as_store(path: &Path) -> bool {
    path.extension().is_some_and(|ending| ending == "h5") || regular::about(path).is_ok() && hdf5::begins_as_hdf5(path)
}

/// Bytes at the start of a file in which its attributes stand, where they are looked for without the HDF5 library.
const HEAD: u64 = 1 << 20;

/// Whether a file is a store of this program, of any format, damaged or not. An output of another kind must never replace it.
pub fn is_store(path: &Path) -> bool {
    if regular::about(path).is_err() || !hdf5::begins_as_hdf5(path) {
        return false;
    }
    let mut head = Vec::new();
    // Each name of a format begins so; the version of the program, which exports have too, is a number.
    let mark = b"dgmpm ";
    let is_format = |text: &[u8]| text.strip_prefix(mark).is_some_and(|name| name.iter().all(u8::is_ascii_alphabetic));
    let read = std::fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    read.is_ok() && head.windows(mark.len() + 1).any(is_format)
}
