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

    /// Draws it on a white area of its size.
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
    picture.draw(&SVGBackend::with_string(&mut text, picture.size()).into_drawing_area())?;
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
    picture.draw(&BitMapBackend::with_buffer(&mut pixels, (width, height)).into_drawing_area())?;
    encoded(&pixels, [width, height], png::ColorType::Rgb).map_err(|why| why.to_string())
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
