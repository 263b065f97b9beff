//! Charts of lines, as SVG and as PNG.

mod lines;

pub use lines::{Chart, Line, Marker, Scale, Stroke};

use crate::error::{Error, Result};
use crate::io::pending::Pending;
use plotters::prelude::*;
use std::path::Path;
use std::sync::Once;

/// Width and height of a picture, pixels.
const SIZE: (u32, u32) = (900, 620);
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

/// Draws a picture into `path`. The ending of the path (`svg`, `png`) gives the format.
///
/// # Errors
/// Another ending, nothing to draw, or a file that cannot be written.
pub fn save(chart: &Chart, path: &Path) -> Result<()> {
    let format = Format::of(path)?;
    fonts();
    let pending = Pending::new(path)?;
    let failed = |why: String| Error::output(path, why);
    if format == Format::Svg {
        let mut text = String::new();
        chart.draw(SVGBackend::with_string(&mut text, SIZE).into_drawing_area()).map_err(failed)?;
        std::fs::write(pending.path(), text).map_err(|why| Error::output(path, why))?;
    } else {
        // The bitmap backend takes the format from the ending of the name, and a pending file has no such ending.
        let mut pixels = vec![255; 3 * SIZE.0 as usize * SIZE.1 as usize];
        let area = BitMapBackend::with_buffer(&mut pixels, SIZE).into_drawing_area();
        chart.draw(area).map_err(failed)?;
        let file = std::fs::File::create(pending.path()).map_err(|why| Error::output(path, why))?;
        write_png(file, &pixels).map_err(|why| Error::output(path, why))?;
    }
    pending.commit()
}

/// The font comes with the program, because a machine without a desktop has no font.
fn fonts() {
    static ONCE: Once = Once::new();
    ONCE.call_once(|| {
        // The only possible error is a file that is no font. The test that draws with this font excludes it.
        let _ = plotters::style::register_font(FONT, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT);
    });
}

fn write_png(file: std::fs::File, pixels: &[u8]) -> std::result::Result<(), png::EncodingError> {
    let mut encoder = png::Encoder::new(std::io::BufWriter::new(file), SIZE.0, SIZE.1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.write_header()?.write_image_data(pixels)
}
