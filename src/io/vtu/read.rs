//! Arrays of a VTU file, as VTK, ParaView, pyvista, meshio and this program write it: arrays inline or
//! appended, as text, base64 or raw bytes, not compressed, by zlib or by LZMA.
//!
//! Only the arrays of the sections that are asked for are read. No file makes this part panic, or take memory or time out of
//! proportion to its bytes.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::DEFORMED;
use super::decode::{Coding, Number};
use crate::io::grid::{Field, Kind};
use crate::io::unstructured::AtNodes;
use crate::io::xml::{DEPTH, attribute};

/// Elements beyond which a file is refused: a hundred fields in a hundred pieces.
const ELEMENTS: usize = 20_000;
/// Bytes at the end of a file in which the comment on where it comes from stands.
const COMMENT: usize = 2048;
/// Fields beyond which a file is refused: each is looked for by its name in each piece.
const FIELDS: usize = 1000;

/// Points with their fields.
type Found = (Vec<[f64; 3]>, Vec<Field>);

/// Where an array stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Section {
    /// `Points`.
    Place,
    /// `PointData`.
    PointData,
    /// `Cells`.
    Cells,
    /// `CellData`.
    CellData,
    /// `FieldData`, of no piece.
    FieldData,
}

/// How an array is stored.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Text,
    Base64,
    Appended(usize),
}

/// An array of a piece: its header, and its text where it is inline.
pub(super) struct Array {
    pub section: Section,
    /// The number of its piece.
    pub piece: usize,
    pub name: String,
    pub number: Number,
    pub components: usize,
    /// Rows of an array of `FieldData`, if it says them.
    pub tuples: Option<usize>,
    format: Format,
    text: Vec<u8>,
}

/// A document with the arrays of some sections.
pub(super) struct Document<'a> {
    bytes: &'a [u8],
    wanted: &'static [Section],
    coding: Coding,
    path: Vec<Vec<u8>>,
    /// Points and cells of each piece.
    pub pieces: Vec<[usize; 2]>,
    pub arrays: Vec<Array>,
    /// Where the appended data begin, behind their `_`, and whether they are raw bytes.
    appended: Option<(usize, bool)>,
    elements: usize,
    /// Whether the array that was begun last is not read.
    skipped: bool,
}

/// Reads the points of a file, and all fields at them with 1, 3 or 9 components that each piece of the file has.
///
/// # Errors
/// What is wrong, in words.
pub fn points(bytes: &[u8]) -> Result<Found, String> {
    let document = Document::read(bytes, &[Section::Place, Section::PointData])?;
    let of = |data: AtNodes| {
        let kind = [Kind::Scalar, Kind::Vector, Kind::Tensor].into_iter().find(|k| k.components() == data.components);
        kind.map(|kind| Field { name: data.name, kind, values: data.values })
    };
    let fields = document.at_points()?.into_iter().filter_map(of).collect();
    Ok((document.points()?, fields))
}

/// Reads all numbers at the points that each piece of the file has.
///
/// # Errors
/// What is wrong, in words.
pub fn at_nodes(bytes: &[u8]) -> Result<Vec<AtNodes>, String> {
    Document::read(bytes, &[Section::Place, Section::PointData])?.at_points()
}

/// Whether the comment behind the document says that it is an export of the deformed body.
fn is_deformed(bytes: &[u8]) -> bool {
    let end = &bytes[bytes.len().saturating_sub(COMMENT)..];
    end.windows(DEFORMED.len()).any(|words| words == DEFORMED.as_bytes())
}

impl<'a> Document<'a> {
    /// Reads a document, and of its arrays those of some sections.
    ///
    /// # Errors
    /// What is wrong, in words.
    pub fn read(bytes: &'a [u8], wanted: &'static [Section]) -> Result<Self, String> {
        let mut document = Self {
            bytes,
            wanted,
            coding: Coding::default(),
            path: vec![],
            pieces: vec![],
            arrays: vec![],
            appended: None,
            elements: 0,
            skipped: false,
        };
        document.walk()?;
        if is_deformed(bytes) {
            return Err("its points are where they were at a time, x = X + u, and not in the initial configuration: take the file of the export \
                        without `_deformed` in its name"
                .to_owned());
        }
        match document.arrays.iter().any(|array| array.section == Section::Place) {
            true => Ok(document),
            false => Err("it is not an unstructured grid with points".to_owned()),
        }
    }

    /// The points of all pieces.
    pub fn points(&self) -> Result<Vec<[f64; 3]>, String> {
        let mut points = Vec::new();
        for array in self.arrays.iter().filter(|array| array.section == Section::Place) {
            points.extend(self.values(array)?.as_chunks::<3>().0);
        }
        Ok(points)
    }

    /// All numbers at the points that each piece has.
    fn at_points(&self) -> Result<Vec<AtNodes>, String> {
        let mut all: Vec<AtNodes> = Vec::new();
        for array in self.arrays.iter().filter(|array| array.section == Section::PointData) {
            let (values, known) = (self.values(array)?, all.len());
            match all.iter_mut().find(|data| data.name == array.name) {
                Some(data) => data.values.extend(values),
                None if known == FIELDS => return Err(format!("it has more than {FIELDS} fields")),
                None => all.push(AtNodes { name: array.name.clone(), components: array.components, values }),
            }
        }
        let points = self.pieces.iter().fold(0_usize, |sum, piece| sum.saturating_add(piece[0]));
        all.retain(|data| data.components > 0 && points.checked_mul(data.components) == Some(data.values.len()));
        Ok(all)
    }

    /// All numbers of an array.
    ///
    /// # Errors
    /// As for [`Document::counted`]; an array that does not say how many numbers it has.
    pub fn values(&self, array: &Array) -> Result<Vec<f64>, String> {
        let piece = self.pieces.get(array.piece).copied().unwrap_or_default();
        let rows = match array.section {
            Section::Place | Section::PointData => piece[0],
            Section::CellData | Section::Cells => piece[1],
            Section::FieldData => {
                array.tuples.ok_or_else(|| format!("array `{}` does not say its length", array.name))?
            }
        };
        let count = rows.checked_mul(array.components).ok_or("it claims more points than there are numbers")?;
        self.counted(array, count)
    }

    /// The numbers of an array that has so many.
    ///
    /// # Errors
    /// Another number of numbers; bytes that cannot be decoded.
    pub fn counted(&self, array: &Array, count: usize) -> Result<Vec<f64>, String> {
        let appended = self.appended.map(|(at, raw)| (&self.bytes[at..], raw));
        let named = |why: String| format!("array `{}`: {why}", array.name);
        let coding = &self.coding;
        let values = match (array.format, appended) {
            (Format::Text, _) => coding.text(&array.text, count),
            (Format::Base64, _) => coding.base64(&array.text, array.number, count),
            (Format::Appended(_), None) => Err("it is appended, and the file has no appended data".to_owned()),
            (Format::Appended(at), Some((all, raw))) => match (all.get(at..), raw) {
                (None, _) => Err(format!("it begins at byte {at} of the appended data, behind their end")),
                (Some(rest), true) => coding.raw(rest, array.number, count),
                (Some(rest), false) => coding.base64(rest, array.number, count),
            },
        };
        values.map_err(named)
    }

    /// Goes through the document.
    fn walk(&mut self) -> Result<(), String> {
        let bytes = self.bytes;
        let mut reader = Reader::from_reader(bytes);
        loop {
            let event = reader.read_event().map_err(|why| format!("byte {}: {why}", reader.error_position()))?;
            match event {
                Event::Start(element) => {
                    self.open(&element)?;
                    let raw = self.is_appended(&element)?;
                    self.path.push(element.name().as_ref().to_vec());
                    if let Some(raw) = raw {
                        let start = usize::try_from(reader.buffer_position()).map_err(|why| why.to_string())?;
                        let mark = bytes[start..].iter().position(|byte| *byte == b'_');
                        let mark = mark.ok_or("the appended data have no `_` at their start")?;
                        self.appended = Some((start + mark + 1, raw));
                        // What follows may be any bytes.
                        return Ok(());
                    }
                }
                Event::Empty(element) => self.open(&element)?,
                Event::End(_) => drop(self.path.pop()),
                Event::Text(text) if self.is_in_array() => {
                    if let Some(array) = self.arrays.last_mut() {
                        array.text.extend_from_slice(&text);
                    }
                }
                Event::Eof => return Ok(()),
                _ => {}
            }
        }
    }

    /// Whether a text stands in the last array that was begun, and that array is one that is read.
    fn is_in_array(&self) -> bool {
        let Some((last, above)) = self.path.split_last() else { return false };
        let section = self.section(above);
        last == b"DataArray"
            && !self.skipped
            && section.is_some()
            && self.arrays.last().map(|array| array.section) == section
    }

    /// The section of an array at this path, if it is one that is read.
    fn section(&self, path: &[Vec<u8>]) -> Option<Section> {
        let names: Vec<&[u8]> = path.iter().map(Vec::as_slice).collect();
        let section = match names[..] {
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"Points"] => Section::Place,
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"PointData"] => Section::PointData,
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"Cells"] => Section::Cells,
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"CellData"] => Section::CellData,
            [b"VTKFile", b"UnstructuredGrid", b"FieldData"] => Section::FieldData,
            _ => return None,
        };
        self.wanted.contains(&section).then_some(section)
    }

    /// Looks at an element that begins here.
    fn open(&mut self, element: &BytesStart) -> Result<(), String> {
        self.elements += 1;
        if self.elements > ELEMENTS {
            return Err(format!("it has more than {ELEMENTS} elements"));
        }
        if self.path.len() >= DEPTH {
            return Err(format!("it has more than {DEPTH} elements within each other"));
        }
        let name = element.name();
        let name = name.as_ref();
        if self.path.is_empty() {
            return self.root(name, element);
        }
        if name == b"Piece" && self.path.len() == 2 {
            let number = |name: &str| match attribute(element, name)? {
                None if name == "NumberOfCells" => Ok(0),
                None => Err(format!("a piece does not say its {name}")),
                Some(text) => text.trim().parse().map_err(|_| format!("{name} is `{text}`, not a number")),
            };
            self.pieces.push([number("NumberOfPoints")?, number("NumberOfCells")?]);
        } else if name == b"DataArray"
            && let Some(section) = self.section(&self.path)
        {
            match self.array(element, section)? {
                Some(array) => (self.skipped, _) = (false, self.arrays.push(array)),
                None => self.skipped = true,
            }
        }
        Ok(())
    }

    fn root(&mut self, name: &[u8], element: &BytesStart) -> Result<(), String> {
        let kind = attribute(element, "type")?.unwrap_or_default();
        if name != b"VTKFile" || kind != "UnstructuredGrid" {
            return Err(match &kind[..] {
                "" => "it is not an unstructured grid".to_owned(),
                kind => format!("it is not an unstructured grid but `{kind}`"),
            });
        }
        let texts = ["byte_order", "header_type", "compressor"];
        let [order, header, compressor] = texts.map(|name| attribute(element, name));
        self.coding = Coding::of(order?.as_deref(), header?.as_deref(), compressor?.as_deref())?;
        Ok(())
    }

    /// The array of an element; none where its type is not one of numbers, and it is not needed.
    fn array(&self, element: &BytesStart, section: Section) -> Result<Option<Array>, String> {
        let text = |name: &str| attribute(element, name);
        let number = |name: &str| match text(name)? {
            None => Ok(None),
            Some(text) => {
                text.trim().parse::<usize>().map(Some).map_err(|_| format!("{name} is `{text}`, not a number"))
            }
        };
        let is_place = section == Section::Place;
        let components = number("NumberOfComponents")?.unwrap_or(if is_place { 3 } else { 1 });
        if is_place && components != 3 {
            return Err(format!("its points have {components} coordinates, not 3"));
        }
        let kind = text("type")?.unwrap_or_default();
        let data = [Section::CellData, Section::FieldData].contains(&section);
        let number_type = match Number::of(&kind) {
            None if data => return Ok(None),
            found => found.ok_or_else(|| format!("the type `{kind}` of an array is not known"))?,
        };
        let format = match text("format")?.as_deref() {
            Some("ascii") => Format::Text,
            Some("binary") => Format::Base64,
            Some("appended") => Format::Appended(number("offset")?.unwrap_or(0)),
            other => return Err(format!("the format of an array is {other:?}: ascii, binary and appended are known")),
        };
        let (name, tuples) = (text("Name")?.unwrap_or_else(|| "points".to_owned()), number("NumberOfTuples")?);
        let piece = self.pieces.len().saturating_sub(1);
        Ok(Some(Array { section, piece, name, number: number_type, components, tuples, format, text: Vec::new() }))
    }

    /// Whether the element begins the appended data, and then whether these are raw.
    fn is_appended(&self, element: &BytesStart) -> Result<Option<bool>, String> {
        if self.path.len() != 1 || element.name().as_ref() != b"AppendedData" {
            return Ok(None);
        }
        match attribute(element, "encoding")?.as_deref() {
            Some("raw") => Ok(Some(true)),
            Some("base64") => Ok(Some(false)),
            other => Err(format!("the appended data are encoded by {other:?}: raw and base64 are known")),
        }
    }
}
