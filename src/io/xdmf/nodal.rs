//! Numbers at the nodes of an XDMF file, at one time of a series.

use super::read::File;
use super::series::SERIES;
use crate::error::{Error, Place, Result};
use crate::io::unstructured::AtNodes;
use crate::io::xml::Element;

/// Whether a document is a series of fields that this program has written.
pub fn is_own_series(root: &Element) -> bool {
    root.child("Domain").is_some_and(|domain| domain.all("Grid").any(|grid| grid.attribute("Name") == Some(SERIES)))
}

/// The grids of a series that are no series themselves, each with its time in s.
type Times<'a> = Vec<(f64, &'a Element)>;

impl File<'_> {
    /// Numbers at the `count` nodes of the mesh; of each series in time those at `time`, in s, or else at its last time. The first of a
    /// name counts.
    ///
    /// # Errors
    /// A time that no series has; numbers that cannot be read.
    pub fn at_nodes(&self, root: &Element, count: usize, time: Option<f64>) -> Result<Vec<AtNodes>> {
        let (mut grids, mut series) = (Vec::new(), Vec::new());
        for domain in root.all("Domain") {
            domain.all("Grid").for_each(|grid| split(grid, &mut grids, &mut series));
        }
        let mut found = false;
        for steps in &series {
            let wanted = match time {
                None => steps.last(),
                Some(time) => steps.iter().find(|(own, _)| (own - time).abs() <= 1e-9 * time.abs()),
            };
            found |= wanted.is_some();
            grids.extend(wanted.map(|(_, grid)| *grid));
        }
        if let (Some(time), false) = (time, found) {
            return Err(self.no_such_time(time, &series));
        }
        let mut data: Vec<AtNodes> = Vec::new();
        for attribute in grids.into_iter().flat_map(|grid| grid.all("Attribute")) {
            let name = attribute.attribute("Name").unwrap_or_default();
            let Some(item) = attribute.child("DataItem") else { continue };
            if attribute.attribute("Center") != Some("Node") || data.iter().any(|known| known.name == name) {
                continue;
            }
            let values = self.numbers(item)?;
            if count > 0 && values.len().is_multiple_of(count) {
                data.push(AtNodes { name: name.to_owned(), components: values.len() / count, values });
            }
        }
        Ok(data)
    }

    fn no_such_time(&self, time: f64, series: &[Times]) -> Error {
        let times = series.iter().flatten().map(|(time, _)| *time);
        let [low, high] = [f64::min, f64::max].map(|pick| times.clone().reduce(pick).unwrap_or(f64::NAN));
        let nearest = times.clone().min_by(|a, b| (a - time).abs().total_cmp(&(b - time).abs()));
        let (what, remedy) = match nearest {
            None => ("it has no series in time".to_owned(), "leave out `fields_time`".to_owned()),
            Some(nearest) => (
                format!("it has no fields at {time} s"),
                format!(
                    "it has {} times from {low} s to {high} s; the nearest is fields_time = {nearest:?}",
                    times.count()
                ),
            ),
        };
        Error::at(Place::file(self.path), what, remedy)
    }
}

/// Sorts grids into those of no series and the steps of each series.
fn split<'a>(grid: &'a Element, alone: &mut Vec<&'a Element>, series: &mut Vec<Times<'a>>) {
    let kind = grid.attribute("GridType").or_else(|| grid.attribute("CollectionType")).unwrap_or("Uniform");
    if !["Collection", "Tree"].contains(&kind) {
        alone.push(grid);
    } else if grid.attribute("CollectionType") == Some("Temporal") {
        let time = |step: &Element| step.child("Time")?.attribute("Value")?.trim().parse().ok();
        series.push(grid.all("Grid").map(|step| (time(step).unwrap_or(f64::NAN), step)).collect());
    } else {
        grid.all("Grid").for_each(|grid| split(grid, alone, series));
    }
}
