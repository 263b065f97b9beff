//! Pictures as SVG and as PNG: charts of lines, and maps.

mod colour;
mod lines;
mod map;
mod raster;

pub use colour::Palette;
pub use lines::{Chart, Line, Marker, Panels, Scale, Stroke};
pub use map::{Bar, Map, ticks};
pub use raster::{Corner, Raster};

use crate::error::{Error, Result};
use crate::io::pending;
use base64::Engine;
use plotters::coord::Shift;
use plotters::prelude::*;
use std::path::Path;
use std::sync::Once;

/// The font of all text.
const FONT: &str = "sans-serif";
/// Colours by degree, from 0. Colour-blind readers can tell them apart (Okabe, Ito).
const COLOURS: [RGBColor; 7] = [
    RGBColor(120, 120, 120),
    RGBColor(230, 159, 0),
    RGBColor(0, 114, 178),
    RGBColor(0, 158, 115),
    RGBColor(213, 94, 0),
    RGBColor(204, 121, 167),
    RGBColor(86, 180, 233),
];

/// The format of a picture.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// Lines and text.
    Svg,
    /// Pixels.
    Png,
}

impl Format {
    /// The format that the ending of a path gives.
    ///
    /// # Errors
    /// Another ending.
    pub fn of(path: &Path) -> Result<Self> {
        match path.extension().and_then(|ending| ending.to_str()) {
            Some("svg") => Ok(Self::Svg),
            Some("png") => Ok(Self::Png),
            _ => Err(Error::input(
                format!("the format of the picture {} is not known", path.display()),
                "give a name that ends in .svg or .png",
            )),
        }
    }
}

/// A picture, drawn by any backend.
pub trait Picture {
    /// Width and height, pixels.
    fn size(&self) -> (u32, u32);

    /// Draws it on a white area of its size, and does not end the picture: it may be a part of a larger one.
    ///
    /// # Errors
    /// There is nothing to draw, or the backend fails.
    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn;

    /// Coloured pixels that are under what is drawn.
    fn under(&self) -> Option<&Raster> {
        None
    }
}

/// Why something could not be drawn.
pub type Drawn = std::result::Result<(), String>;

/// Draws a picture into `path`. The ending of the path (`svg`, `png`) gives the format.
///
/// # Errors
/// Another ending, nothing to draw, or a file that cannot be written.
pub fn save<P: Picture>(picture: &P, path: &Path) -> Result<()> {
    let format = Format::of(path)?;
    fonts();
    let failed = |why: String| Error::output(path, why);
    let bytes = if format == Format::Svg { svg(picture) } else { png(picture) }.map_err(failed)?;
    pending::write_bytes(path, &bytes)
}

fn svg<P: Picture>(picture: &P) -> std::result::Result<Vec<u8>, String> {
    let mut text = String::new();
    whole(picture, SVGBackend::with_string(&mut text, picture.size()))?;
    if let Some(under) = picture.under() {
        let ([x, y], [width, height]) = (under.at(), under.size());
        let pixels =
            encoded(under.pixels(), under.resolution(), png::ColorType::Rgba).map_err(|why| why.to_string())?;
        let data = base64::engine::general_purpose::STANDARD.encode(pixels);
        let image = format!(
            "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" href=\"data:image/png;base64,{data}\"/>\n"
        );
        // Behind the first element, `<svg ..>`.
        let place = text.find('>').map_or(text.len(), |at| at + 1);
        text.insert_str(place, &image);
    }
    Ok(text.into_bytes())
}

fn png<P: Picture>(picture: &P) -> std::result::Result<Vec<u8>, String> {
    let (width, height) = picture.size();
    let mut pixels = vec![255; 3 * width as usize * height as usize];
    if let Some(under) = picture.under() {
        under.blend(&mut pixels, width as usize);
    }
    whole(picture, BitMapBackend::with_buffer(&mut pixels, (width, height)))?;
    encoded(&pixels, [width, height], png::ColorType::Rgb).map_err(|why| why.to_string())
}

/// Draws a picture and ends it. The end comes once, behind all parts: it closes the root of an SVG.
fn whole<P: Picture, B: DrawingBackend>(picture: &P, backend: B) -> Drawn {
    let area = backend.into_drawing_area();
    picture.draw(&area)?;
    area.present().map_err(|why| why.to_string())
}

/// The font comes with the program, because a machine without a desktop has no font.
fn fonts() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // The only possible error is a file that is no font. The test that draws with this font excludes it.
        let _ = plotters::style::register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

fn encoded(
    pixels: &[u8],
    [width, height]: [u32; 2],
    colour: png::ColorType,
) -> std::result::Result<Vec<u8>, png::EncodingError> {
    let mut out = Vec::new();
    let mut encoder = png::Encoder::new(&mut out, width, height);
    encoder.set_color(colour);
    let mut writer = encoder.write_header()?;
    writer.write_image_data(pixels)?;
    writer.finish()?;
    Ok(out)
}

#[cfg(test)]
mod tests {
    use super::*;
    use quick_xml::events::Event;

    /// Elements of an SVG. Its only root is `<svg>`, and nothing is behind it.
    fn elements<P: Picture>(picture: &P) -> usize {
        fonts();
        let text = String::from_utf8(svg(picture).unwrap()).unwrap();
        let mut reader = quick_xml::Reader::from_str(&text);
        let (mut depth, mut roots, mut count) = (0, 0, 0);
        loop {
            // The reader itself refuses an end without its start.
            match reader.read_event().unwrap() {
                Event::Start(element) => {
                    roots += usize::from(depth == 0 && element.name().as_ref() == b"svg");
                    assert!(depth > 0 || roots == 1, "a second root");
                    (depth, count) = (depth + 1, count + 1);
                }
                Event::Empty(_) => {
                    assert!(depth > 0, "an element outside of the root");
                    count += 1;
                }
                Event::End(_) => depth -= 1,
                Event::Eof => break,
                Event::Text(text) => assert!(depth > 0 || text.iter().all(u8::is_ascii_whitespace), "text outside"),
                _ => assert!(depth > 0, "something outside of the root"),
            }
        }
        assert_eq!((depth, roots), (0, 1));
        count
    }

    fn chart(scale: Scale) -> Chart {
        let line = |stroke, marker| Line {
            name: "a < b & \"c\"".to_owned(),
            colour: 2,
            marker,
            stroke,
            points: vec![(1.0, 1.0), (2.0, 3.0), (1.5, 2.0)],
        };
        let lines = vec![line(Stroke::Full, Marker::Circle), line(Stroke::Dashed, Marker::Bare)];
        Chart { title: "t".to_owned(), x: "x".to_owned(), y: "y".to_owned(), scales: [scale; 2], lines }
    }

    #[test]
    fn each_svg_is_xml_with_one_root_and_all_panels_in_it() {
        for scale in [Scale::Linear, Scale::Log] {
            let one = elements(&chart(scale));
            for count in 1..=3 {
                let all = elements(&Panels(vec![chart(scale); count]));
                // Panels are lower than a chart alone, and have fewer lines of the grid; none is missing as a whole.
                assert!(all > count * one / 3, "{count} panels: {all} elements, one chart: {one}");
            }
        }
        let bar = Bar { palette: Palette::Rising, range: [0.0, 1.0] };
        let mut map = Map::new("m".to_owned(), String::new(), bar, [[0.0; 2], [1.0; 2]]);
        map.line(&[[0.0; 2], [1.0; 2]], true);
        assert!(elements(&map) > 1);
    }
}
