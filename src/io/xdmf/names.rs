//! Names of groups in an XDMF file: an element `Information` of a grid, with the text that meshio reads as `field_data`.

use quick_xml::events::{BytesCData, Event};

use super::{Written, Xml};
use crate::io::unstructured::{Names, Of};
use crate::io::xml;

/// The name of the element where it also names the file of the lines.
const FACETS: &str = "facets";
/// Its name where it does not.
const NAMES: &str = "names";
/// Names of groups beyond which a file is refused.
const MOST: usize = 10_000;

/// The names that an element has, and the file of the lines that it names.
///
/// # Errors
/// A text that is not the one of meshio.
pub fn read(about: &xml::Element) -> Result<(Names, Option<String>), String> {
    let facets = about.attribute("Value").filter(|_| about.attribute("Name") == Some(FACETS)).map(str::to_owned);
    let mut names = Names::new();
    // Other programs put other texts there.
    let Ok(root) = xml::parse(&about.text) else { return Ok((names, facets)) };
    for map in root.all("map") {
        let number = std::str::from_utf8(&map.text).ok().and_then(|text| text.trim().parse().ok());
        let of = match map.attribute("dim") {
            Some("1") => Of::Edges,
            Some("2") => Of::Cells,
            _ => continue,
        };
        if let (Some(name), Some(number)) = (map.attribute("key"), number) {
            names.insert((of, number), name.to_owned());
        }
        if names.len() > MOST {
            return Err(format!("it has more than {MOST} names of groups"));
        }
    }
    Ok((names, facets))
}

/// The numbers of groups for other programs: their names where these are different whole numbers, as those of a mesh that comes from
/// DOLFINx; otherwise 1 and so on.
pub fn numbers(names: &[String]) -> Vec<i32> {
    let whole: Option<Vec<i32>> =
        names.iter().map(|name| name.parse().ok().filter(|n: &i32| n.to_string() == *name)).collect();
    whole.unwrap_or_else(|| (1..).take(names.len()).collect())
}

/// Writes the names of groups of edges and of cells with their numbers, and the file of the lines.
pub fn write(xml: &mut Xml, groups: [(&[String], &[i32]); 2], facets: Option<&str>) -> Written {
    let mut text = String::from("<main>");
    for (dimension, (names, numbers)) in groups.into_iter().enumerate() {
        for (name, number) in names.iter().zip(numbers) {
            let name = quick_xml::escape::escape(name.as_str());
            text += &format!("<map key=\"{name}\" dim=\"{}\">{number}</map>", dimension + 1);
        }
    }
    text += "</main>";
    let attributes = [("Name", facets.map_or(NAMES, |_| FACETS)), ("Value", facets.unwrap_or_default())];
    let element = xml.create_element("Information").with_attributes(attributes);
    // A text cannot end itself: `]]>` in a name is `]]&gt;`.
    element.write_inner_content(|xml| xml.write_event(Event::CData(BytesCData::new(text)))).map(drop)
}
