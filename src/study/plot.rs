//! Work-precision plots, in logarithms, one line a series: as SVG and as PNG.

use super::case::Series;
use super::measure::Measure;
use super::record::Record;
use super::trend::series_of;
use crate::chart::{Chart, Line, Scale, save};
use crate::error::{Error, Result};
use crate::registry::methods::Build;
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

/// Draws error over `axis` into `path`, as [`crate::chart::save`].
///
/// # Errors
/// As for [`crate::chart::save`].
pub fn plot(records: &[Record], axis: Axis, title: &str, measure: &Measure, path: &Path) -> Result<()> {
    let lines = lines(records, axis);
    if lines.is_empty() {
        return Err(Error::output(path, "no run went well: there is nothing to draw"));
    }
    let (x, y) = (axis.name().to_owned(), measure.label());
    save(&Chart { title: title.to_owned(), x, y, scales: [Scale::Log; 2], lines }, path)
}

/// A line for each series that has a point, in the order of the records.
fn lines(records: &[Record], axis: Axis) -> Vec<Line> {
    let all = series_of(records);
    // Lines of one degree and method would look alike where a study varies something else.
    let varied = all.iter().any(|series| series.layout.is_some() || !series.sets.is_empty());
    let line = |(k, series): (usize, &Series)| {
        let Build { marker, stroke, .. } = *series.method.build();
        let colour = if varied { k } else { series.degree };
        Line { name: series.name(), colour, marker, stroke, points: points(records, series, axis) }
    };
    all.into_iter().enumerate().map(line).filter(|line| !line.points.is_empty()).collect()
}

/// Records of a series that can stand in a plot, from coarse to fine.
fn points(records: &[Record], series: &Series, axis: Axis) -> Vec<(f64, f64)> {
    let mut of: Vec<&Record> = records.iter().filter(|r| r.case.series == *series).collect();
    of.sort_by(|a, b| a.case.refinement.total_cmp(&b.case.refinement));
    let point = |r: &Record| Some((axis.of(r), r.error().filter(|e| e.is_finite() && *e > 0.0)?));
    of.into_iter().filter_map(point).collect()
}
