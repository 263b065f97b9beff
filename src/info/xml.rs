//! The exports for ParaView: VTU, PVD and XDMF, by their first element.

use super::{Info, LARGEST, READ};
use crate::error::{Error, Place, Result};
use crate::file;
use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};
use serde_json::json;
use std::path::Path;

/// What has been found in the elements of a file.
#[derive(Default)]
struct Found {
    root: String,
    kind: String,
    points: usize,
    cells: usize,
    arrays: Vec<String>,
    times: Vec<f64>,
}

/// What a file holds; none where it is XML of another kind.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn info(path: &Path) -> Result<Option<Info>> {
    let bytes = file::bytes(path, LARGEST)
        .map_err(|why| Error::at(Place::file(path), format!("cannot be read: {why}"), READ))?;
    let mut reader = Reader::from_reader(&bytes[..]);
    let (mut found, mut buffer) = (Found::default(), Vec::new());
    // Raw data behind the elements are no XML: what stands before them counts.
    while let Ok(event) = reader.read_event_into(&mut buffer) {
        match event {
            Event::Start(element) | Event::Empty(element) => found.take(&element),
            Event::Eof => break,
            _ => {}
        }
        buffer.clear();
    }
    Ok(found.info())
}

fn attribute(element: &BytesStart, name: &str) -> Option<String> {
    let found = element.try_get_attribute(name).ok().flatten()?;
    String::from_utf8(found.value.into_owned()).ok()
}

impl Found {
    fn take(&mut self, element: &BytesStart) {
        let name = String::from_utf8_lossy(element.name().as_ref()).into_owned();
        let number = |key: &str| attribute(element, key).and_then(|text| text.parse::<usize>().ok()).unwrap_or(0);
        match &name[..] {
            "VTKFile" => self.kind = attribute(element, "type").unwrap_or_default(),
            "Piece" => {
                self.points += number("NumberOfPoints");
                self.cells += number("NumberOfCells");
            }
            "DataArray" | "Attribute" => self.array(attribute(element, "Name")),
            "DataSet" => self.time(attribute(element, "timestep")),
            "Time" => self.time(attribute(element, "Value")),
            "Topology" => self.cells = self.cells.max(number("NumberOfElements")),
            _ => {}
        }
        if self.root.is_empty() {
            self.root = name;
        }
    }

    fn array(&mut self, name: Option<String>) {
        const SHAPE: [&str; 4] = ["Points", "connectivity", "offsets", "types"];
        let name = name.filter(|name| !SHAPE.contains(&&name[..]) && !self.arrays.contains(name));
        self.arrays.extend(name);
    }

    fn time(&mut self, text: Option<String>) {
        let time = text.and_then(|text| text.parse().ok()).filter(|time| !self.times.contains(time));
        self.times.extend(time);
    }

    fn info(self) -> Option<Info> {
        let kind = match (&self.root[..], &self.kind[..]) {
            ("VTKFile", "UnstructuredGrid") => "VTU: an unstructured grid with its fields",
            ("VTKFile", "Collection") => "PVD: a series of VTU files",
            ("VTKFile", other) => return Some(Info::new(format!("VTK file of type {other}"))),
            ("Xdmf", _) => "XDMF: grids with their fields, whose numbers are in an .h5 file",
            _ => return None,
        };
        let ends = self.times.first().zip(self.times.last()).map(|(first, last)| json!([first, last]));
        let info = Info::new(kind).maybe("points", (self.points > 0).then_some(self.points));
        let info = info.maybe("cells", (self.cells > 0).then_some(self.cells)).with("fields", self.arrays);
        Some(info.with("times", self.times.len()).maybe("t_from_to_s", ends))
    }
}
