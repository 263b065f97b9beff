//! XML of other programs as a tree of elements. No bytes make this part panic, or take memory or time out of proportion to them.

use quick_xml::Reader;
use quick_xml::events::{BytesStart, Event};

/// Elements within each other beyond which a file is refused; a VTU file has 5, an XDMF file 8.
pub const DEPTH: usize = 16;
/// Attributes of an element beyond which a file is refused; VTK writes up to 9.
const ATTRIBUTES: usize = 32;
/// Elements beyond which a file is refused: a thousand times with ten fields and more.
const ELEMENTS: usize = 100_000;

/// An element with all that is in it.
#[derive(Debug, Default)]
pub struct Element {
    /// Its name, with a prefix if it has one.
    pub name: String,
    /// Names and values.
    attributes: Vec<(String, String)>,
    /// The elements in it, in their order.
    pub children: Vec<Element>,
    /// Its own text, that of its children left out.
    pub text: Vec<u8>,
}

impl Element {
    /// The value of an attribute; the first of its name.
    pub fn attribute(&self, name: &str) -> Option<&str> {
        self.attributes.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }

    /// The first child of a name.
    pub fn child(&self, name: &str) -> Option<&Element> {
        self.children.iter().find(|child| child.name == name)
    }

    /// All children of a name.
    pub fn all<'a>(&'a self, name: &'a str) -> impl Iterator<Item = &'a Element> {
        self.children.iter().filter(move |child| child.name == name)
    }

    fn of(start: &BytesStart) -> Result<Self, String> {
        let name = text_of(start.name().as_ref(), "the name of an element")?.to_owned();
        let mut attributes = Vec::new();
        // A check for names that are there twice takes the square of their number.
        for attribute in start.attributes().with_checks(false) {
            let attribute = attribute.map_err(|why| why.to_string())?;
            let key = text_of(attribute.key.as_ref(), "the name of an attribute")?.to_owned();
            attributes.push((key, unescaped(&attribute.value)?));
            if attributes.len() > ATTRIBUTES {
                return Err(format!("an element has more than {ATTRIBUTES} attributes"));
            }
        }
        Ok(Self { name, attributes, ..Self::default() })
    }
}

/// The root element of a document.
///
/// # Errors
/// What is wrong, in words.
pub fn parse(bytes: &[u8]) -> Result<Element, String> {
    let mut reader = Reader::from_reader(bytes);
    let mut count = 0;
    // The root of all, then the elements that are open.
    let mut open = vec![Element::default()];
    loop {
        let event = reader.read_event().map_err(|why| format!("byte {}: {why}", reader.error_position()))?;
        let is_start = matches!(event, Event::Start(_));
        match event {
            Event::Start(start) | Event::Empty(start) => {
                count += 1;
                if count > ELEMENTS {
                    return Err(format!("it has more than {ELEMENTS} elements"));
                }
                if open.len() > DEPTH {
                    return Err(format!("it has more than {DEPTH} elements within each other"));
                }
                open.push(Element::of(&start)?);
                if !is_start {
                    close(&mut open);
                }
            }
            Event::End(_) => close(&mut open),
            Event::Text(text) => last(&mut open).text.extend_from_slice(&text),
            Event::CData(text) => last(&mut open).text.extend_from_slice(&text),
            Event::Eof if open.len() > 1 => return Err(format!("it ends within `{}`", last(&mut open).name)),
            Event::Eof => break,
            _ => {}
        }
    }
    open.pop().and_then(|all| all.children.into_iter().next()).ok_or_else(|| "it has no element".to_owned())
}

fn last(open: &mut [Element]) -> &mut Element {
    // The root of all is never closed.
    let at = open.len() - 1;
    &mut open[at]
}

/// The last open element becomes a child of the one before.
fn close(open: &mut Vec<Element>) {
    if open.len() > 1
        && let Some(element) = open.pop()
    {
        last(open).children.push(element);
    }
}

/// The name of the root element and its attribute `type`, from the first bytes of a document.
pub fn root(head: &[u8]) -> Option<(String, Option<String>)> {
    let mut reader = Reader::from_reader(head);
    loop {
        match reader.read_event().ok()? {
            Event::Start(start) | Event::Empty(start) => {
                let name = String::from_utf8(start.name().as_ref().to_vec()).ok()?;
                return Some((name, attribute(&start, "type").ok()?));
            }
            Event::Eof => return None,
            Event::Text(text) if !text.trim_ascii().is_empty() => return None,
            _ => {}
        }
    }
}

/// An attribute of an element; the first of its name.
///
/// # Errors
/// Too many attributes; a value that is no text.
pub fn attribute(element: &BytesStart, name: &str) -> Result<Option<String>, String> {
    let mut found = None;
    for (k, attribute) in element.attributes().with_checks(false).enumerate() {
        if k >= ATTRIBUTES {
            return Err(format!("an element has more than {ATTRIBUTES} attributes"));
        }
        let attribute = attribute.map_err(|why| why.to_string())?;
        if attribute.key.as_ref() == name.as_bytes() && found.is_none() {
            found = Some(unescaped(&attribute.value).map_err(|why| format!("{name}: {why}"))?);
        }
    }
    Ok(found)
}

fn text_of<'a>(bytes: &'a [u8], what: &str) -> Result<&'a str, String> {
    std::str::from_utf8(bytes).map_err(|_| format!("{what} is not UTF-8 text"))
}

fn unescaped(value: &[u8]) -> Result<String, String> {
    let text = text_of(value, "an attribute")?;
    Ok(quick_xml::escape::unescape(text).map_err(|why| why.to_string())?.into_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_document_becomes_a_tree_and_a_bad_one_a_message() {
        let text = "<?xml version=\"1.0\"?><!DOCTYPE a []><a x=\"1 &lt; 2\">p<b/><b y='3'>q<![CDATA[<r>]]></b>s</a>";
        let root = parse(text.as_bytes()).unwrap();
        assert_eq!((root.name.as_str(), root.attribute("x"), &root.text[..]), ("a", Some("1 < 2"), &b"ps"[..]));
        let all: Vec<&Element> = root.all("b").collect();
        assert_eq!((all.len(), all[1].attribute("y"), &all[1].text[..]), (2, Some("3"), &b"q<r>"[..]));
        for (text, what) in [
            ("", "no element"),
            ("<a><b></a>", "byte"),
            ("<a><b>", "ends within `b`"),
            (&"<a>".repeat(30), "within each other"),
            (&format!("<a>{}</a>", "<b/>".repeat(ELEMENTS)), "more than 100000 elements"),
            (&format!("<a{}/>", " b='1'".repeat(40)), "more than 32 attributes"),
        ] {
            assert!(parse(text.as_bytes()).unwrap_err().contains(what), "{what}");
        }
    }

    #[test]
    fn the_root_is_told_by_the_first_bytes() {
        let of = |text: &str| root(text.as_bytes());
        assert_eq!(of("\u{feff}<?xml?><!-- a -->\n<Xdmf Version='3.0'><Dom").unwrap().0, "Xdmf");
        let vtk = of("<VTKFile type=\"Collection\">").unwrap();
        assert_eq!((vtk.0.as_str(), vtk.1.as_deref()), ("VTKFile", Some("Collection")));
        for text in ["", "a <b>", "$MeshFormat\n", "<<<", "<a"] {
            assert_eq!(of(text), None, "{text}");
        }
    }
}
