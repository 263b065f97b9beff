//! Points and the fields at them from a VTU file, as VTK, ParaView, pyvista, meshio and this program write it: arrays inline or
//! appended, as text, base64 or raw bytes, not compressed or by zlib.
//!
//! Only the points and their data are read. No file makes this part panic, or take memory or time out of proportion to its
//! bytes.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

use super::decode::{Coding, Number};
use crate::io::grid::{Field, Kind};

/// Elements within each other beyond which a file is refused; a VTU file has 5.
const DEPTH: usize = 16;
/// Attributes of an element beyond which a file is refused; VTK writes up to 9.
const ATTRIBUTES: usize = 32;
/// Elements beyond which a file is refused: a hundred fields in a hundred pieces.
const ELEMENTS: usize = 20_000;
/// Fields beyond which a file is refused: each is looked for by its name in each piece.
const FIELDS: usize = 1000;

/// Points with their fields.
type Found = (Vec<[f64; 3]>, Vec<Field>);

/// How an array is stored.
#[derive(Clone, Copy, PartialEq)]
enum Format {
    Text,
    Base64,
    Appended(usize),
}

/// An array of a piece: its header, and its text where it is inline.
struct Array {
    /// Whether it holds the points, and not a field at them.
    is_place: bool,
    /// Points of its piece.
    points: usize,
    name: String,
    number: Number,
    components: usize,
    format: Format,
    text: Vec<u8>,
}

/// The document on the way through it.
#[derive(Default)]
struct Document {
    coding: Coding,
    path: Vec<Vec<u8>>,
    points: usize,
    arrays: Vec<Array>,
    /// Where the appended data begin, behind their `_`, and whether they are raw bytes.
    appended: Option<(usize, bool)>,
    elements: usize,
}

/// Reads the points of a file, and all fields at them with 1, 3 or 9 components that each piece of the file has.
///
/// # Errors
/// What is wrong, in words.
pub fn points(bytes: &[u8]) -> Result<Found, String> {
    let document = Document::read(bytes)?;
    let appended = document.appended.map(|(at, raw)| (&bytes[at..], raw));
    let (mut points, mut fields): Found = (Vec::new(), Vec::new());
    for array in &document.arrays {
        let values = array.values(&document.coding, appended)?;
        if array.is_place {
            points.extend(values.as_chunks::<3>().0);
            continue;
        }
        let kinds = [Kind::Scalar, Kind::Vector, Kind::Tensor];
        let Some(kind) = kinds.into_iter().find(|kind| kind.components() == array.components) else { continue };
        let known = fields.len();
        match fields.iter_mut().find(|field| field.name == array.name) {
            Some(field) => field.values.extend(values),
            None if known == FIELDS => return Err(format!("it has more than {FIELDS} fields")),
            None => fields.push(Field::new(&array.name, kind, values)),
        }
    }
    fields.retain(|field| field.values.len() == points.len() * field.kind.components());
    Ok((points, fields))
}

impl Array {
    fn values(&self, coding: &Coding, appended: Option<(&[u8], bool)>) -> Result<Vec<f64>, String> {
        let count = self.points.checked_mul(self.components).ok_or("it claims more points than there are numbers")?;
        let named = |why: String| format!("array `{}`: {why}", self.name);
        let values = match (self.format, appended) {
            (Format::Text, _) => coding.text(&self.text, count),
            (Format::Base64, _) => coding.base64(&self.text, self.number, count),
            (Format::Appended(_), None) => Err("it is appended, and the file has no appended data".to_owned()),
            (Format::Appended(at), Some((all, raw))) => match (all.get(at..), raw) {
                (None, _) => Err(format!("it begins at byte {at} of the appended data, behind their end")),
                (Some(rest), true) => coding.raw(rest, self.number, count),
                (Some(rest), false) => coding.base64(rest, self.number, count),
            },
        };
        values.map_err(named)
    }
}

impl Document {
    fn read(bytes: &[u8]) -> Result<Self, String> {
        let mut reader = Reader::from_reader(bytes);
        let mut document = Self::default();
        loop {
            let event = reader.read_event().map_err(|why| format!("byte {}: {why}", reader.error_position()))?;
            match event {
                Event::Start(element) => {
                    document.open(&element)?;
                    let raw = document.is_appended(&element)?;
                    document.path.push(element.name().as_ref().to_vec());
                    if let Some(raw) = raw {
                        let start = usize::try_from(reader.buffer_position()).map_err(|why| why.to_string())?;
                        let mark = bytes[start..].iter().position(|byte| *byte == b'_');
                        let mark = mark.ok_or("the appended data have no `_` at their start")?;
                        document.appended = Some((start + mark + 1, raw));
                        // What follows may be any bytes.
                        break;
                    }
                }
                Event::Empty(element) => document.open(&element)?,
                Event::End(_) => drop(document.path.pop()),
                Event::Text(text) if document.is_in_array() => {
                    if let Some(array) = document.arrays.last_mut() {
                        array.text.extend_from_slice(&text);
                    }
                }
                Event::Eof => break,
                _ => {}
            }
        }
        match document.arrays.iter().any(|array| array.is_place) {
            true => Ok(document),
            false => Err("it is not an unstructured grid with points".to_owned()),
        }
    }

    /// Whether a text stands in the last array that was begun.
    fn is_in_array(&self) -> bool {
        self.path.len() == 5 && self.path[4] == b"DataArray" && self.section(&self.path[..4]).is_some()
    }

    /// Whether an array at this path holds points (true) or their data.
    fn section(&self, path: &[Vec<u8>]) -> Option<bool> {
        let names: [&[u8]; 4] = path.iter().map(Vec::as_slice).collect::<Vec<_>>().try_into().ok()?;
        match names {
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"Points"] => Some(true),
            [b"VTKFile", b"UnstructuredGrid", b"Piece", b"PointData"] => Some(false),
            _ => None,
        }
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
            let points = attribute(element, "NumberOfPoints")?.ok_or("a piece does not say its NumberOfPoints")?;
            self.points = points.trim().parse().map_err(|_| format!("NumberOfPoints is `{points}`, not a number"))?;
        } else if name == b"DataArray"
            && let Some(is_place) = self.section(&self.path)
        {
            let array = self.array(element, is_place)?;
            self.arrays.push(array);
        }
        Ok(())
    }

    fn root(&mut self, name: &[u8], element: &BytesStart) -> Result<(), String> {
        let kind = attribute(element, "type")?.unwrap_or_default();
        if name != b"VTKFile" || kind != "UnstructuredGrid" {
            return Err("it is not an unstructured grid".to_owned());
        }
        let texts = ["byte_order", "header_type", "compressor"];
        let [order, header, compressor] = texts.map(|name| attribute(element, name));
        self.coding = Coding::of(order?.as_deref(), header?.as_deref(), compressor?.as_deref())?;
        Ok(())
    }

    fn array(&self, element: &BytesStart, is_place: bool) -> Result<Array, String> {
        let text = |name: &str| attribute(element, name);
        let number = |name: &str, usual: usize| match text(name)? {
            None => Ok(usual),
            Some(text) => text.trim().parse::<usize>().map_err(|_| format!("{name} is `{text}`, not a number")),
        };
        let components = number("NumberOfComponents", if is_place { 3 } else { 1 })?;
        if is_place && components != 3 {
            return Err(format!("its points have {components} coordinates, not 3"));
        }
        let format = match text("format")?.as_deref() {
            Some("ascii") => Format::Text,
            Some("binary") => Format::Base64,
            Some("appended") => Format::Appended(number("offset", 0)?),
            other => return Err(format!("the format of an array is {other:?}: ascii, binary and appended are known")),
        };
        let kind = text("type")?.unwrap_or_default();
        let number = Number::of(&kind).ok_or_else(|| format!("the type `{kind}` of an array is not known"))?;
        let name = text("Name")?.unwrap_or_else(|| "points".to_owned());
        Ok(Array { is_place, points: self.points, name, number, components, format, text: Vec::new() })
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

/// An attribute of an element; the first of its name.
fn attribute(element: &BytesStart, name: &str) -> Result<Option<String>, String> {
    let mut found = None;
    // A check for names that are there twice takes the square of their number.
    for (k, attribute) in element.attributes().with_checks(false).enumerate() {
        if k >= ATTRIBUTES {
            return Err(format!("an element has more than {ATTRIBUTES} attributes"));
        }
        let attribute = attribute.map_err(|why| why.to_string())?;
        if attribute.key.as_ref() == name.as_bytes() && found.is_none() {
            let text = std::str::from_utf8(&attribute.value).map_err(|_| format!("{name} is not UTF-8 text"))?;
            found = Some(quick_xml::escape::unescape(text).map_err(|why| why.to_string())?.into_owned());
        }
    }
    Ok(found)
}
