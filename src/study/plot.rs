//! Work-precision plots, in logarithms, one line a series: as SVG and as PNG.

use super::case::Series;
use super::record::Record;
use crate::chart::{COLOURS, FONT, Picture, SIZE, decades, save, square};
use crate::error::Result;
use crate::scene::Method;
use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};
use std::path::Path;

/// The abscissa.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Axis {
    /// CPU seconds.
    Seconds,
    /// Grid unknowns.
    Dofs,
}

impl Axis {
    fn of(self, record: &Record) -> f64 {
        match self {
            Self::Seconds => record.cpu.max(1e-6),
            Self::Dofs => record.dofs as f64,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Seconds => "CPU seconds",
            Self::Dofs => "degrees of freedom",
        }
    }
}

/// Error over `axis`, a line a series.
struct WorkPrecision<'a> {
    records: &'a [Record],
    axis: Axis,
    title: &'a str,
}

impl Picture for WorkPrecision<'_> {
    fn draw<B: DrawingBackend>(&self, area: DrawingArea<B, Shift>) -> std::result::Result<(), String> {
        draw(area, self.records, self.axis, self.title)
    }
}

/// Draws error over `axis` into `path`, as [`crate::chart::save`].
///
/// # Errors
/// As for [`crate::chart::save`].
pub fn plot(records: &[Record], axis: Axis, title: &str, path: &Path) -> Result<()> {
    save(&WorkPrecision { records, axis, title }, path)
}

/// Records of a series that can stand in a plot, from coarse to fine.
fn points(records: &[Record], series: &Series, axis: Axis) -> Vec<(f64, f64)> {
    let mut of: Vec<&Record> = records.iter().filter(|r| r.case.series == *series).collect();
    of.sort_by(|a, b| a.case.refinement.total_cmp(&b.case.refinement));
    let point = |r: &Record| Some((axis.of(r), r.error().filter(|e| e.is_finite() && *e > 0.0)?));
    of.into_iter().filter_map(point).collect()
}

fn draw<B: DrawingBackend>(
    area: DrawingArea<B, Shift>,
    records: &[Record],
    axis: Axis,
    title: &str,
) -> std::result::Result<(), String> {
    let text = |why: DrawingAreaErrorKind<B::ErrorType>| why.to_string();
    let mut lines: Vec<(&Series, Vec<(f64, f64)>)> = Vec::new();
    for record in records {
        if lines.iter().all(|(series, _)| **series != record.case.series) {
            lines.push((&record.case.series, points(records, &record.case.series, axis)));
        }
    }
    lines.retain(|(_, points)| !points.is_empty());
    if lines.is_empty() {
        return Err("no run went well: there is nothing to draw".to_owned());
    }
    let all = || lines.iter().flat_map(|(_, points)| points);
    let (x, y) = (decades(all().map(|p| p.0)), decades(all().map(|p| p.1)));
    area.fill(&WHITE).map_err(text)?;
    let mut chart = ChartBuilder::on(&area)
        .caption(title, (FONT, 20))
        .margin(12)
        .margin_right(210)
        .x_label_area_size(48)
        .y_label_area_size(70)
        .build_cartesian_2d((x.0..x.1).log_scale(), (y.0..y.1).log_scale())
        .map_err(text)?;
    chart
        .configure_mesh()
        .bold_line_style(RGBColor(205, 205, 205))
        .light_line_style(RGBColor(240, 240, 240))
        .x_desc(axis.name())
        .y_desc("relative error (standard measure)")
        .x_label_formatter(&|x| format!("{x:.0e}"))
        .y_label_formatter(&|y| format!("{y:.0e}"))
        .label_style((FONT, 15))
        .axis_desc_style((FONT, 17))
        .draw()
        .map_err(text)?;
    // A single decade has labels at its ends alone: name what lies between, inside of the chart.
    if y.1 / y.0 < 11.0 {
        let style = (FONT, 14).into_text_style(&area).color(&RGBColor(110, 110, 110));
        let between = [2.0, 5.0].map(|k| Text::new(format!("{:.0e}", k * y.0), (x.0 * 1.03, k * y.0), style.clone()));
        chart.draw_series(between).map_err(text)?;
    }
    for (k, (series, points)) in lines.iter().enumerate() {
        let colour = COLOURS[series.degree.min(COLOURS.len() - 1)];
        let plain = ShapeStyle::from(colour).stroke_width(2);
        match series.method {
            Method::AderDgmpm => chart.draw_series(LineSeries::new(points.clone(), plain)),
            Method::AderDgfem => chart.draw_series(DashedLineSeries::new(points.clone(), 7, 5, plain)),
            Method::RkDgfem => chart.draw_series(DashedLineSeries::new(points.clone(), 2, 4, plain)),
        }
        .map_err(text)?;
        let (full, points) = (colour.filled(), points.iter().copied());
        // A square for material points, a triangle for ADER-DGFEM, a circle for RK-DGFEM; as in the legend.
        match series.method {
            Method::AderDgmpm => chart.draw_series(points.map(|at| EmptyElement::at(at) + square((0, 0), full))),
            Method::AderDgfem => chart.draw_series(points.map(|at| TriangleMarker::new(at, 6, full))),
            Method::RkDgfem => chart.draw_series(points.map(|at| Circle::new(at, 4, full))),
        }
        .map_err(text)?;
        legend(&area, k, series, colour).map_err(text)?;
    }
    area.present().map_err(text)
}

/// Line k of the legend, right of the chart.
fn legend<B: DrawingBackend>(
    area: &DrawingArea<B, Shift>,
    k: usize,
    series: &Series,
    colour: RGBColor,
) -> std::result::Result<(), DrawingAreaErrorKind<B::ErrorType>> {
    let (x, y) = (SIZE.0 as i32 - 205, 60 + 22 * k as i32);
    let at = (x + 12, y);
    let full = colour.filled();
    match series.method {
        Method::AderDgmpm => area.draw(&square(at, full))?,
        Method::AderDgfem => area.draw(&TriangleMarker::new(at, 6, full))?,
        Method::RkDgfem => area.draw(&Circle::new(at, 4, full))?,
    }
    let style = (FONT, 15).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Center));
    area.draw(&Text::new(series.name(), (x + 26, y), style))
}
