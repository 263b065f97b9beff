//! Pictures of a campaign, in logarithms: rates over size, and the roofline.

use crate::study::plot::{COLOURS, FONT, Picture, SIZE, decades, square};
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

/// How the points of a line look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Marker {
    /// None: a bare line, in grey.
    Bare,
    /// Circles: RK-DGFEM.
    Circle,
    /// Triangles: ADER-DGFEM.
    Triangle,
    /// Squares: ADER-DGMPM.
    Square,
    /// Crosses: ADER-DGMPM on an arbitrary cloud.
    Cross,
}

/// A line of a picture.
#[derive(Debug, Clone, PartialEq)]
pub struct Line {
    /// Its name in the legend.
    pub name: String,
    /// Number of its colour: the degree.
    pub colour: usize,
    /// Its points.
    pub marker: Marker,
    /// Where they are.
    pub points: Vec<(f64, f64)>,
}

/// A picture with logarithmic axes.
#[derive(Debug, Clone, PartialEq)]
pub struct Chart {
    /// Above it.
    pub title: String,
    /// Below the abscissa.
    pub x: String,
    /// Beside the ordinate.
    pub y: String,
    /// The lines.
    pub lines: Vec<Line>,
}

impl Picture for Chart {
    fn draw<B: DrawingBackend>(&self, area: DrawingArea<B, Shift>) -> Result<(), String> {
        let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
        let all = || self.lines.iter().flat_map(|line| &line.points);
        if all().next().is_none() {
            return Err("nothing was measured: there is nothing to draw".to_owned());
        }
        let (x, y) = (decades(all().map(|p| p.0)), decades(all().map(|p| p.1)));
        area.fill(&WHITE).map_err(text)?;
        let mut chart = ChartBuilder::on(&area)
            .caption(&self.title, (FONT, 20))
            .margin(12)
            .margin_right(230)
            .x_label_area_size(48)
            .y_label_area_size(70)
            .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())
            .map_err(text)?;
        chart
            .configure_mesh()
            .bold_line_style(RGBColor(205, 205, 205))
            .light_line_style(RGBColor(240, 240, 240))
            .x_desc(&self.x)
            .y_desc(&self.y)
            .x_label_formatter(&|x| format!("{x:.0e}"))
            .y_label_formatter(&|y| format!("{y:.0e}"))
            .label_style((FONT, 15))
            .axis_desc_style((FONT, 17))
            .draw()
            .map_err(text)?;
        for (k, line) in self.lines.iter().enumerate() {
            let colour = COLOURS[line.colour % COLOURS.len()];
            let style = ShapeStyle::from(colour).stroke_width(2);
            chart.draw_series(LineSeries::new(line.points.clone(), style)).map_err(text)?;
            for &point in &line.points {
                mark(&area, line.marker, chart.backend_coord(&point), colour).map_err(text)?;
            }
            let at = (SIZE.0 as i32 - 213, 60 + 20 * k as i32);
            mark(&area, line.marker, at, colour).map_err(text)?;
            let style = (FONT, 14).into_text_style(&area).pos(Pos::new(HPos::Left, VPos::Center));
            area.draw(&Text::new(line.name.clone(), (at.0 + 14, at.1), style)).map_err(text)?;
        }
        area.present().map_err(text)
    }
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
