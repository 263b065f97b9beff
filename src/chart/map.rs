//! A map: a field in colours on equal axes, with the lines of the body and a bar that explains the colours.

use super::{Drawn, FONT, Palette, Picture, Raster};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// Pixels left of, above, right of and below the map.
const MARGINS: [u32; 4] = [92, 66, 150, 62];
/// The largest width and height of the map, pixels.
const LARGEST: [f64; 2] = [900.0, 720.0];
/// The smallest height of the bar, pixels.
const BAR: u32 = 170;
/// Distance of the bar from the map, and its width, pixels.
const BAR_PLACE: [i32; 2] = [22, 22];
const DARK: RGBColor = RGBColor(40, 40, 40);

/// What the colours mean.
#[derive(Debug, Clone, PartialEq)]
pub struct Bar {
    /// The colours.
    pub palette: Palette,
    /// The numbers at its ends, in the unit of its labels.
    pub range: [f64; 2],
}

/// A map under construction, and then drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct Map {
    /// The name of the field, with its unit.
    pub title: String,
    /// Time and other circumstances.
    pub about: String,
    /// The labels of both axes.
    pub axes: [String; 2],
    /// What one unit of the axes is, in the units of positions.
    pub unit: f64,
    /// What the colours mean.
    pub bar: Bar,
    /// Lower left and upper right corner of what is shown.
    window: [[f64; 2]; 2],
    /// Pixels of a unit of position.
    scale: f64,
    raster: Raster,
    /// Thin lines, then the outline.
    lines: [Vec<Vec<[f64; 2]>>; 2],
}

impl Map {
    /// An empty map of what lies in a box, with a margin.
    pub fn new(title: String, about: String, bar: Bar, [low, high]: [[f64; 2]; 2]) -> Self {
        let size = [high[0] - low[0], high[1] - low[1]];
        // Enough for bodies of no width, too.
        let margin = 0.04 * size[0].max(size[1]).max(1e-300);
        let window = [low.map(|x| x - margin), high.map(|x| x + margin)];
        let size = size.map(|n| n + 2.0 * margin);
        let scale = (LARGEST[0] / size[0]).min(LARGEST[1] / size[1]);
        let pixels = size.map(|n| (n * scale).ceil() as u32);
        let shift = BAR.saturating_sub(pixels[1]) / 2;
        let raster = Raster::new([MARGINS[0], MARGINS[1] + shift], pixels);
        let axes = ["x [m]", "y [m]"].map(str::to_owned);
        Self { title, about, axes, unit: 1.0, bar, window, scale, raster, lines: [vec![], vec![]] }
    }

    /// The place of a position, in pixels.
    pub fn place(&self, x: [f64; 2]) -> [f64; 2] {
        let [left, top] = self.raster.at().map(f64::from);
        [left + self.scale * (x[0] - self.window[0][0]), top + self.scale * (self.window[1][1] - x[1])]
    }

    /// The coloured pixels, to be filled.
    pub fn raster(&mut self) -> &mut Raster {
        &mut self.raster
    }

    /// A line of the mesh, or of the outline of the body.
    pub fn line(&mut self, positions: &[[f64; 2]], is_outline: bool) {
        let all = positions.iter().map(|x| self.place(*x)).collect();
        self.lines[usize::from(is_outline)].push(all);
    }

    fn bar_height(&self) -> u32 {
        self.raster.size()[1].max(BAR)
    }

    fn axes<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn {
        let ([left, top], [width, height]) = (self.raster.at().map(|n| n as i32), self.raster.size().map(|n| n as i32));
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let frame = Rectangle::new([(left, top), (left + width, top + height)], DARK.stroke_width(1));
        area.draw(&frame).map_err(text)?;
        let small = (FONT, 16).into_text_style(area).color(&DARK);
        for axis in 0..2 {
            let [low, high] = [0, 1].map(|end| self.window[end][axis] / self.unit);
            let room = [width / 90, height / 36][axis].clamp(2, 8) as usize;
            for (value, label) in ticks([low, high], room) {
                let place = self.place([0, 1].map(|k| if k == axis { value * self.unit } else { 0.0 }));
                let (at, out) = match axis {
                    0 => ((place[0].round() as i32, top + height), (0, 6)),
                    _ => ((left, place[1].round() as i32), (-6, 0)),
                };
                let tick = PathElement::new(vec![at, (at.0 + out.0, at.1 + out.1)], DARK.stroke_width(1));
                area.draw(&tick).map_err(text)?;
                let (pos, off) = match axis {
                    0 => (Pos::new(HPos::Center, VPos::Top), (0, 9)),
                    _ => (Pos::new(HPos::Right, VPos::Center), (-10, 0)),
                };
                area.draw(&Text::new(label, (at.0 + off.0, at.1 + off.1), small.clone().pos(pos))).map_err(text)?;
            }
        }
        let [x, y] = &self.axes;
        let below = small.clone().pos(Pos::new(HPos::Center, VPos::Bottom));
        area.draw(&Text::new(x.clone(), (left + width / 2, top + height + 54), below)).map_err(text)?;
        let beside = small.transform(FontTransform::Rotate270).pos(Pos::new(HPos::Center, VPos::Top));
        area.draw(&Text::new(y.clone(), (12, top + height / 2), beside)).map_err(text)
    }

    fn bar<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn {
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let left = (self.raster.at()[0] + self.raster.size()[0]) as i32 + BAR_PLACE[0];
        let (top, height) = (MARGINS[1] as i32, self.bar_height() as i32);
        let right = left + BAR_PLACE[1];
        for row in 0..height {
            let [r, g, b] = self.bar.palette.colour(1.0 - (f64::from(row) + 0.5) / f64::from(height));
            let strip = Rectangle::new([(left, top + row), (right, top + row + 1)], RGBColor(r, g, b).filled());
            area.draw(&strip).map_err(text)?;
        }
        area.draw(&Rectangle::new([(left, top), (right, top + height)], DARK.stroke_width(1))).map_err(text)?;
        let style = (FONT, 16).into_text_style(area).color(&DARK).pos(Pos::new(HPos::Left, VPos::Center));
        let [low, high] = self.bar.range;
        for (value, label) in ticks([low, high], (height / 36).clamp(4, 8) as usize) {
            let y = top + height - (f64::from(height) * (value - low) / (high - low)).round() as i32;
            area.draw(&PathElement::new(vec![(right, y), (right + 6, y)], DARK.stroke_width(1))).map_err(text)?;
            area.draw(&Text::new(label, (right + 10, y), style.clone())).map_err(text)?;
        }
        Ok(())
    }
}

impl Picture for Map {
    fn size(&self) -> (u32, u32) {
        let [left, top, right, bottom] = MARGINS;
        (left + self.raster.size()[0].max(360) + right, top + self.bar_height() + bottom)
    }

    fn under(&self) -> Option<&Raster> {
        Some(&self.raster)
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn {
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let styles = [ShapeStyle::from(BLACK.mix(0.22)).stroke_width(1), DARK.stroke_width(1)];
        for (lines, style) in self.lines.iter().zip(styles) {
            for line in lines {
                let points: Vec<(i32, i32)> = line.iter().map(|x| (x[0].round() as i32, x[1].round() as i32)).collect();
                area.draw(&PathElement::new(points, style)).map_err(text)?;
            }
        }
        self.axes(area)?;
        self.bar(area)?;
        let left = self.raster.at()[0] as i32;
        let style = |size: i32| (FONT, size).into_text_style(area).color(&DARK).pos(Pos::new(HPos::Left, VPos::Top));
        area.draw(&Text::new(self.title.clone(), (left, 10), style(21))).map_err(text)?;
        area.draw(&Text::new(self.about.clone(), (left, 37), style(16))).map_err(text)
    }
}

/// About so many round numbers in a range, with their labels.
pub fn ticks([low, high]: [f64; 2], count: usize) -> Vec<(f64, String)> {
    let rough = (high - low) / count as f64;
    if !(rough > 0.0 && rough.is_finite()) {
        return vec![];
    }
    let decade = 10_f64.powf(rough.log10().floor());
    let nearest = [(1.5, 1.0), (3.5, 2.0), (7.5, 5.0)].into_iter().find(|(end, _)| rough < end * decade);
    let step = nearest.map_or(10.0, |(_, step)| step) * decade;
    let digits = (-(step.log10() + 1e-9).floor()).max(0.0) as usize;
    let label = |value: f64| match digits <= 6 && low.abs().max(high.abs()) < 1e6 {
        true => format!("{:.digits$}", value + 0.0),
        false => format!("{value:.1e}"),
    };
    let (first, last) = ((low / step - 1e-9).ceil() as i64, (high / step + 1e-9).floor() as i64);
    (first..=last).map(|k| k as f64 * step).map(|value| (value, label(value))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_inside_of_the_range() {
        let labels = |range, count| ticks(range, count).into_iter().map(|(_, label)| label).collect::<Vec<_>>();
        assert_eq!(labels([0.0, 1.0], 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
        assert_eq!(labels([-0.3, 0.9], 3), ["0.0", "0.5"]);
        assert_eq!(labels([812.0, 1290.0], 5), ["900", "1000", "1100", "1200"]);
        assert!(ticks([1.0, 1.0], 5).is_empty() && ticks([f64::NAN, 1.0], 5).is_empty());
    }

    #[test]
    fn axes_are_equal_and_a_box_of_no_width_is_shown() {
        for high in [[3.0, 1.0], [0.1, 4.0], [0.0, 2.0]] {
            let bar = Bar { palette: Palette::Rising, range: [0.0, 1.0] };
            let map = Map::new(String::new(), String::new(), bar, [[0.0, 0.0], high]);
            let [a, b] = [map.place([0.0, 0.0]), map.place([1e-2, 1e-2])];
            assert!(((b[0] - a[0]) - (a[1] - b[1])).abs() < 1e-9 && b[0] > a[0]);
            let [width, height] = map.raster.size();
            assert!(
                width > 0
                    && height > 0
                    && f64::from(width) <= LARGEST[0] + 1.0
                    && f64::from(height) <= LARGEST[1] + 1.0
            );
        }
    }
}
