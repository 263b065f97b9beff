//! Charts of lines, on logarithmic or linear axes.

use super::{COLOURS, Drawn, FONT, Picture};
use plotters::coord::Shift;
use plotters::coord::ranged1d::ValueFormatter;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// The marks at the points of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// No marks: a bare line, in grey.
    Bare,
    /// Circles.
    Circle,
    /// Triangles.
    Triangle,
    /// Squares.
    Square,
    /// Crosses.
    Cross,
}

/// How the points of a line are joined.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// By a full line.
    Full,
    /// By dashes.
    Dashed,
    /// By short dashes.
    Dotted,
}

/// A line of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its name in the legend.
    pub name: String,
    /// Number of its colour: the degree.
    pub colour: usize,
    /// The marks at its points.
    pub marker: Marker,
    /// What joins its points.
    pub stroke: Stroke,
    /// The positions of the points.
    pub points: Vec<(f64, f64)>,
}

/// The scale of an axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// Logarithmic, over whole decades.
    Log,
    /// Linear.
    Linear,
}

/// A picture of lines.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// The title above the picture.
    pub title: String,
    /// The label below the abscissa.
    pub x: String,
    /// The label beside the ordinate.
    pub y: String,
    /// The scales of abscissa and ordinate.
    pub scales: [Scale; 2],
    /// The lines.
    pub lines: Vec<Line>,
}

/// Width and height of a chart, pixels.
const SIZE: (u32, u32) = (900, 620);
/// Height of one of several charts below each other, pixels.
const PANEL: u32 = 330;

/// Charts below each other.
#[derive(Debug, Clone, PartialEq)]
pub struct Panels(pub Vec<Chart>);

impl Picture for Panels {
    fn size(&self) -> (u32, u32) {
        (SIZE.0, if self.0.len() == 1 { SIZE.1 * 2 / 3 } else { PANEL * self.0.len() as u32 })
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn {
        let parts = area.split_evenly((self.0.len(), 1));
        self.0.iter().zip(parts).try_for_each(|(chart, part)| chart.draw(&part))
    }
}

impl Picture for Chart {
    fn size(&self) -> (u32, u32) {
        SIZE
    }

    fn draw<B: DrawingBackend>(&self, area: &DrawingArea<B, Shift>) -> Drawn {
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let all = || self.lines.iter().flat_map(|line| &line.points);
        if all().next().is_none() {
            return Err("nothing was measured: there is nothing to draw".to_owned());
        }
        area.fill(&WHITE).map_err(text)?;
        let mut builder = ChartBuilder::on(area);
        builder.caption(&self.title, (FONT, 20)).margin(12).margin_right(230).x_label_area_size(48);
        let range = |scale: Scale, values: &mut dyn Iterator<Item = f64>| match scale {
            Scale::Log => decades(values),
            Scale::Linear => around(values),
        };
        let x = range(self.scales[0], &mut all().map(|p| p.0));
        let y = range(self.scales[1], &mut all().map(|p| p.1));
        let decade = (self.scales[1] == Scale::Log && y.1 / y.0 < 11.0).then_some(y.0);
        // The search for round numbers in such a range would not end.
        if [x, y].iter().any(|(low, high)| !(high - low).is_finite()) {
            return Err("the numbers are too large for an axis".to_owned());
        }
        builder.y_label_area_size(beside(self.scales[1], y));
        let (x, y) = (x.0..x.1, y.0..y.1);
        match self.scales {
            [Scale::Log, Scale::Log] => {
                self.paint(area, builder.build_cartesian_2d(x.log_scale(), y.log_scale()).map_err(text)?, decade)
            }
            [Scale::Log, Scale::Linear] => {
                self.paint(area, builder.build_cartesian_2d(x.log_scale(), y).map_err(text)?, decade)
            }
            [Scale::Linear, Scale::Log] => {
                self.paint(area, builder.build_cartesian_2d(x, y.log_scale()).map_err(text)?, decade)
            }
            [Scale::Linear, Scale::Linear] => self.paint(area, builder.build_cartesian_2d(x, y).map_err(text)?, decade),
        }
    }
}

impl Chart {
    /// Names what lies in a single decade of the ordinate, from `low`, inside of the chart: it has labels at its ends alone.
    fn name_between<B: DrawingBackend, X, Y>(
        &self,
        area: &DrawingArea<B, Shift>,
        chart: &ChartContext<B, Cartesian2d<X, Y>>,
        low: f64,
    ) -> Result<(), DrawingAreaErrorKind<B::ErrorType>>
    where
        X: Ranged<ValueType = f64>,
        Y: Ranged<ValueType = f64>,
    {
        let style = (FONT, 14).into_text_style(area).color(&RGBColor(110, 110, 110));
        let (corner_x, corner_y) = corner(area);
        let left = chart.plotting_area().get_x_axis_pixel_range().start - corner_x;
        let x = self.lines.iter().flat_map(|line| &line.points).map(|p| p.0).next().unwrap_or(0.0);
        [2.0, 5.0].into_iter().try_for_each(|k| {
            let height = chart.backend_coord(&(x, k * low)).1 - corner_y;
            area.draw(&Text::new(format!("{:.0e}", k * low), (left + 8, height), style.clone()))
        })
    }

    /// Axes, lines and legend.
    fn paint<B: DrawingBackend, X, Y>(
        &self,
        area: &DrawingArea<B, Shift>,
        mut chart: ChartContext<B, Cartesian2d<X, Y>>,
        decade: Option<f64>,
    ) -> Result<(), String>
    where
        X: Ranged<ValueType = f64> + ValueFormatter<f64>,
        Y: Ranged<ValueType = f64> + ValueFormatter<f64>,
    {
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let plane = chart.as_coord_spec();
        let (x, y) = (plane.x_spec().range(), plane.y_spec().range());
        let [x, y] = [(self.scales[0], x), (self.scales[1], y)]
            .map(|(scale, range)| move |value: &f64| label(scale, (range.start, range.end), *value));
        chart
            .configure_mesh()
            .max_light_lines(if self.scales.contains(&Scale::Log) { 10 } else { 1 })
            .bold_line_style(RGBColor(205, 205, 205))
            .light_line_style(RGBColor(240, 240, 240))
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&x)
            .y_label_formatter(&y)
            .label_style((FONT, 15))
            .axis_desc_style((FONT, 17))
            .draw()
            .map_err(text)?;
        if let Some(y) = decade {
            self.name_between(area, &chart, y).map_err(text)?;
        }
        let ((corner_x, corner_y), width) = (corner(area), area.dim_in_pixel().0 as i32);
        for (k, line) in self.lines.iter().enumerate() {
            let colour = COLOURS[line.colour % COLOURS.len()];
            let style = ShapeStyle::from(colour).stroke_width(2);
            let points = line.points.clone();
            match line.stroke {
                // Piece by piece: where a line turns back, one path would have a spike that is no value.
                Stroke::Full => {
                    chart.draw_series(points.windows(2).map(|piece| PathElement::new(piece.to_vec(), style)))
                }
                Stroke::Dashed => chart.draw_series(DashedLineSeries::new(points, 7, 5, style)),
                Stroke::Dotted => chart.draw_series(DashedLineSeries::new(points, 2, 4, style)),
            }
            .map_err(text)?;
            for &point in &line.points {
                let (x, y) = chart.backend_coord(&point);
                mark(area, line.marker, (x - corner_x, y - corner_y), colour).map_err(text)?;
            }
            let at = (width - 213, 60 + 20 * k as i32);
            sample(area, line, at, colour).map_err(text)?;
            let style = (FONT, 14).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(line.name.clone(), (at.0 + SAMPLE + 8, at.1), style)).map_err(text)?;
        }
        Ok(())
    }
}

/// Numbers that differ by less than this share of the largest one are equal: steps between them are near its rounding.
const EQUAL: f64 = 1e-9;

/// A range around numbers, with a margin of a twentieth. It is never empty.
fn around(values: &mut dyn Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    let margin = match () {
        () if high - low > EQUAL * high.abs().max(low.abs()) => 0.05 * (high - low),
        () if high == 0.0 => 1.0,
        () => 0.05 * high.abs(),
    };
    (low - margin, high + margin)
}

/// The label of a number on an axis of this range: with as many digits as tell its steps apart, and without those of rounding.
fn label(scale: Scale, (low, high): (f64, f64), x: f64) -> String {
    if scale == Scale::Log {
        return format!("{x:.0e}");
    }
    let (most, width) = (low.abs().max(high.abs()), high - low);
    if x.abs() < 1e-6 * width {
        return "0".to_owned();
    }
    if (1e-3..1e6).contains(&most) {
        // Steps are a tenth of the range or half of that.
        let digits = (2.5 - width.log10()).floor().clamp(0.0, 12.0) as usize;
        let text = format!("{x:.digits$}");
        return if digits == 0 { text } else { text.trim_end_matches('0').trim_end_matches('.').to_owned() };
    }
    let digits = (2.5 + (most / width).log10()).floor().clamp(1.0, 12.0) as usize;
    let digits = format!("{x:.digits$e}");
    digits.parse::<f64>().map_or(digits, |rounded| format!("{rounded:e}"))
}

/// Room for the labels of an ordinate and for its name, pixels.
fn beside(scale: Scale, (low, high): (f64, f64)) -> u32 {
    // The longest labels are those of numbers between round ones: a third of the range is none.
    let between = (1..3).map(|k| low + f64::from(k) / 3.0 * (high - low));
    let longest = between.map(|x| label(scale, (low, high), x).len()).max().unwrap_or(0);
    (36 + 8 * longest as u32).max(70)
}

/// Half of the length of the line in a legend, pixels.
const SAMPLE: i32 = 14;

/// Line and mark of a legend.
fn sample<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    line: &Line,
    (x, y): (i32, i32),
    colour: RGBColor,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let style = ShapeStyle::from(colour).stroke_width(2);
    let (dash, pause) = match line.stroke {
        Stroke::Full => (2 * SAMPLE, 1),
        Stroke::Dashed => (7, 5),
        Stroke::Dotted => (2, 4),
    };
    for start in (x - SAMPLE..x + SAMPLE).step_by((dash + pause) as usize) {
        area.draw(&PathElement::new(vec![(start, y), ((start + dash).min(x + SAMPLE), y)], style))?;
    }
    mark(area, line.marker, (x, y), colour)
}

/// The upper left corner of an area in its picture.
fn corner<B: DrawingBackend>(area: &DrawingArea<B, Shift>) -> (i32, i32) {
    let (x, y) = area.get_pixel_range();
    (x.start, y.start)
}

/// One point, in pixels.
fn mark<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    marker: Marker,
    at: (i32, i32),
    colour: RGBColor,
) -> Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let full = colour.filled();
    match marker {
        Marker::Bare => Ok(()),
        Marker::Circle => area.draw(&Circle::new(at, 4, full)),
        Marker::Triangle => area.draw(&TriangleMarker::new(at, 6, full)),
        Marker::Square => area.draw(&square(at, full)),
        Marker::Cross => area.draw(&Cross::new(at, 5, ShapeStyle::from(colour).stroke_width(2))),
    }
}

/// A square of 9 x 9 pixels.
fn square(at: (i32, i32), style: ShapeStyle) -> plotters::element::Rectangle<(i32, i32)> {
    plotters::element::Rectangle::new([(at.0 - 4, at.1 - 4), (at.0 + 4, at.1 + 4)], style)
}

/// Whole decades around positive numbers.
fn decades(values: impl Iterator<Item = f64>) -> (f64, f64) {
    let (low, high) = values.fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let (low, high) = (low.log10().floor(), high.log10().ceil());
    (10_f64.powf(low), 10_f64.powf(if high > low { high } else { low + 1.0 }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_range_is_never_of_the_size_of_rounding_and_one_that_overflows_is_an_error() {
        let of = |values: [f64; 2]| around(&mut values.into_iter());
        assert_eq!(of([0.0, 0.0]), (-1.0, 1.0));
        for values in [[1.0, 1.0], [1.0, 1.0 + f64::EPSILON], [-3.0, -3.0 * (1.0 + f64::EPSILON)]] {
            let (low, high) = of(values);
            assert!(high - low > 0.09 * values[0].abs(), "{values:?}: {low}..{high}");
        }
        let points = vec![(0.0, 1e308), (1.0, -1e308)];
        let line = Line { name: String::new(), colour: 0, marker: Marker::Bare, stroke: Stroke::Full, points };
        let scales = [Scale::Linear; 2];
        let chart = Chart { title: String::new(), x: String::new(), y: String::new(), scales, lines: vec![line] };
        let why = super::super::svg(&chart).unwrap_err();
        assert!(why.contains("too large"), "{why}");
    }

    #[test]
    fn labels_of_neighbouring_steps_differ_and_have_no_digits_of_rounding() {
        // The middle of an axis, and its width.
        let large: [(f64, f64); 4] = [(2e5, 3.0), (7e3, 1e-4), (-5e8, 1e3), (1e12, 1e12)];
        for (middle, width) in large.into_iter().chain([(0.0, 1.0), (1.0, 1e-6), (3e-7, 1e-9), (0.0, 9e-15)]) {
            let range = (middle - 0.5 * width, middle + 0.5 * width);
            let step = 10_f64.powf((0.1 * width).log10().floor());
            let first = (range.0 / step).ceil();
            let labels: Vec<String> =
                (0..10).map(|k| label(Scale::Linear, range, (first + f64::from(k)) * step)).collect();
            let distinct: std::collections::BTreeSet<_> = labels.iter().collect();
            assert_eq!(distinct.len(), labels.len(), "{labels:?}");
            let room = beside(Scale::Linear, range) as usize;
            assert!(labels.iter().all(|label| 36 + 8 * label.len() <= room.max(70) + 8), "{labels:?}: {room}");
        }
        let of = |range, x| label(Scale::Linear, range, x);
        assert_eq!([of((-1.1, 1.1), 0.1 + 0.2), of((-1.1, 1.1), 1e-17), of((0.0, 120.0), 60.0)], ["0.3", "0", "60"]);
        assert_eq!([of((0.99, 1.01), 1.0025), of((-2e-9, 2e-9), -1e-9)], ["1.0025", "-1e-9"]);
    }
}
