//! `.pvd`: the list of the files of a time series, which ParaView and pyvista open as one.

use std::path::{Path, PathBuf};

use quick_xml::Writer;
use quick_xml::events::{BytesDecl, Event};

use super::pending::write_text;
use crate::built;
use crate::error::{Error, Result};

/// Writes a series: (time, file) in rising order of time. Files in the folder of the series, or below it, are named
/// relative to it, so that the folder can be moved.
pub fn write_series(path: &Path, files: &[(f64, PathBuf)]) -> Result<()> {
    let mut xml = Writer::new_with_indent(Vec::new(), b' ', 2);
    let root = [("type", "Collection"), ("version", "0.1"), ("byte_order", "LittleEndian")];
    let written = xml.write_event(Event::Decl(BytesDecl::new("1.0", None, None))).and_then(|()| {
        xml.create_element("VTKFile").with_attributes(root).write_inner_content(|xml| {
            let list = xml.create_element("Collection");
            if files.is_empty() {
                return list.write_empty().map(drop);
            }
            list.write_inner_content(|xml| files.iter().try_for_each(|(time, file)| entry(xml, path, *time, file)))
                .map(drop)
        })
    });
    let fail = |e: &dyn std::fmt::Display| Error::output(path, e);
    written.map_err(|e| fail(&e))?;
    let text = String::from_utf8(xml.into_inner()).map_err(|e| fail(&e))?;
    write_text(path, &(text + "\n" + &built::comment()))
}

fn entry(xml: &mut Writer<Vec<u8>>, series: &Path, time: f64, file: &Path) -> std::io::Result<()> {
    let folder = series.parent().unwrap_or(Path::new(""));
    let file = file.strip_prefix(folder).unwrap_or(file).to_string_lossy().into_owned();
    let time = format!("{time:e}");
    let attributes = [("timestep", time.as_str()), ("group", ""), ("part", "0"), ("file", file.as_str())];
    xml.create_element("DataSet").with_attributes(attributes).write_empty().map(drop)
}
