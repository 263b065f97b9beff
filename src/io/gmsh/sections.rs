//! The frame of an MSH file: its header, its sections, the names of physical groups.

use super::error::Error;
use super::source::Source;
use super::{Raw, v22, v41};

/// The versions that are read.
#[derive(Clone, Copy, PartialEq)]
enum Version {
    V22,
    V41,
}

/// All sections that are read; others are skipped.
pub fn read(bytes: &[u8]) -> Result<Raw, Error> {
    let mut source = Source::new(bytes);
    let version = header(&mut source)?;
    let mut raw = Raw { entities: version == Version::V41, ..Raw::default() };
    let mut entities = None;
    let (mut nodes, mut elements) = (false, false);
    while !source.at_end() {
        let name = section(&mut source)?;
        match (name.as_str(), version) {
            ("PhysicalNames", _) => names(&mut source, &mut raw)?,
            ("Entities", _) if elements => return Err(source.wrong("`$Entities` before `$Elements`")),
            ("Entities", Version::V41) => {
                v41::entities(&mut source, &mut raw, entities.get_or_insert_default())?;
            }
            ("PartitionedEntities", Version::V41) => {
                v41::partitioned_entities(&mut source, &mut raw, entities.get_or_insert_default())?;
            }
            ("Nodes", Version::V22) => v22::nodes(&mut source, &mut raw, false)?,
            ("ParametricNodes", Version::V22) => v22::nodes(&mut source, &mut raw, true)?,
            ("Nodes", Version::V41) => v41::nodes(&mut source, &mut raw)?,
            ("Elements", Version::V22) => v22::elements(&mut source, &mut raw)?,
            ("Elements", Version::V41) => v41::elements(&mut source, &mut raw, &entities.take().unwrap_or_default())?,
            _ => {
                source.skip_section(&name)?;
                continue;
            }
        }
        nodes |= name == "Nodes" || name == "ParametricNodes";
        elements |= name == "Elements";
        end(&mut source, &name)?;
    }
    match (nodes, elements) {
        (false, _) => Err(Error::Missing("Nodes")),
        (_, false) => Err(Error::Missing("Elements")),
        _ => Ok(raw),
    }
}

/// `$MeshFormat`, version, 0 for text or 1 for binary, size of a double; in a binary file the int 1.
fn header(source: &mut Source) -> Result<Version, Error> {
    loop {
        match source.word() {
            b"$MeshFormat" => break,
            b"$Comments" => source.skip_section("Comments")?,
            b"$NOD" | b"$PARA" | b"$ELM" => return Err(Error::Version("1.0".to_owned())),
            _ => return Err(Error::NotMsh),
        }
    }
    let version = String::from_utf8_lossy(source.word()).into_owned();
    let known = match version.as_str() {
        "2.2" => Version::V22,
        "4.1" => Version::V41,
        _ if version.parse::<f64>().is_ok() => return Err(Error::Version(version)),
        _ => return Err(source.wrong("a version of the format (2.2 or 4.1)")),
    };
    let binary = match source.number("0 (text) or 1 (binary)")? {
        0 => false,
        1 => true,
        _ => return Err(source.wrong("0 (text) or 1 (binary)")),
    };
    let size: u32 = source.number("the size of numbers in bytes")?;
    source.line();
    if binary {
        if size != 8 {
            return Err(Error::Binary("written with numbers that are not 8 bytes long"));
        }
        source.binary = true;
        match source.int("the number 1")? {
            1 => {}
            0x0100_0000 => return Err(Error::Binary("from a big-endian machine")),
            _ => return Err(source.wrong("the number 1")),
        }
    }
    end(source, "MeshFormat")?;
    Ok(known)
}

/// The name of the section that begins here; the source is then at the line below.
fn section(source: &mut Source) -> Result<String, Error> {
    match source.word() {
        [b'$', name @ ..] if !name.is_empty() && !name.starts_with(b"End") => {
            let name = String::from_utf8_lossy(name).into_owned();
            // The line's end belongs to the name: in a binary file numbers follow at once.
            if source.line().is_empty() {
                return Ok(name);
            }
            // Only in case of an error: to find its line, all lines before it are counted.
            Err(source.wrong(format!("the end of the line after `${name}`")))
        }
        _ => Err(source.wrong("a section such as `$Nodes`")),
    }
}

fn end(source: &mut Source, name: &str) -> Result<(), Error> {
    let expected = format!("$End{name}");
    if source.word() == expected.as_bytes() { Ok(()) } else { Err(source.wrong(format!("`{expected}`"))) }
}

/// Lines `dimension tag "name"`, text in every file. Gmsh does not escape quotes, so a name goes to the last one.
fn names(source: &mut Source, raw: &mut Raw) -> Result<(), Error> {
    let count: u64 = source.number("the number of physical names")?;
    source.line();
    for _ in 0..count {
        let dimension: i32 = source.number("the dimension of a physical group")?;
        if !(0..=3).contains(&dimension) {
            return Err(source.wrong("a dimension from 0 to 3"));
        }
        let tag = source.number("the tag of a physical group")?;
        let line = source.line();
        let [b'"', name @ .., b'"'] = line else {
            return Err(source.wrong("a name in quotes"));
        };
        if !name.is_empty() {
            raw.names.insert((dimension, tag), String::from_utf8_lossy(name).into_owned());
        }
        raw.surfaces |= dimension == 2;
    }
    Ok(())
}
