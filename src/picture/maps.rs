//! Maps of the fields of snapshots, on the deformed body or on the initial one.

use super::field::Shade;
use super::unit::{label, prefixed, short};
use crate::chart::{Bar, Corner, Map, save};
use crate::error::{Error, Result};
use crate::mesh::faces::neighbours;
use crate::mesh::{FACE_CORNERS, Mesh, map};
use crate::observe::{Point, Solution};
use crate::problem::series::{Series, Shown};
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// Cells up to which a map shows their edges.
const CELLS: usize = 4000;
/// Parts of a cell in each direction: at most so many for each degree above 0, and over all cells about so many parts.
const PARTS: usize = 4;
const ALL_PARTS: f64 = 2e5;

/// Which snapshots are drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum When {
    /// The last one.
    End,
    /// That after this step.
    Step(usize),
    /// That nearest to this time, s.
    Time(f64),
    /// All.
    All,
}

/// What maps are drawn of.
pub struct Maps {
    series: Series,
    shades: Vec<Shade>,
    is_initial: bool,
    is_single: bool,
    range: Option<[f64; 2]>,
    far: Option<String>,
}

/// The numbers of a field at the corners of the parts of all cells, and where these are.
struct Sheet {
    /// Parts of a cell in each direction.
    parts: usize,
    /// Corners by cell.
    at: Vec<Vec<[f64; 2]>>,
    /// By field, by cell.
    values: Vec<Vec<Vec<f64>>>,
}

/// What all pictures have in common: the box, and the range of each field.
struct Frame {
    window: [[f64; 2]; 2],
    ranges: Vec<[f64; 2]>,
}

const EMPTY: [f64; 2] = [f64::INFINITY, f64::NEG_INFINITY];

fn with([low, high]: [f64; 2], x: f64) -> [f64; 2] {
    [low.min(x), high.max(x)]
}

impl Maps {
    /// The maps of a run: of these fields, or of those of a first look where none is named. `range`: the ends of the colours, in the
    /// unit of the field.
    ///
    /// # Errors
    /// A folder without a run or without a snapshot after that step; a time that is not finite; a field that there is not.
    pub fn new(folder: &Folder, names: &[String], when: When, range: Option<[f64; 2]>) -> Result<Self> {
        let mut series = Series::of(folder)?.not_empty()?;
        let shades = if names.is_empty() { Shade::usual(&series.laws) } else { Shade::named(names, &series.laws)? };
        let mut far = None;
        let chosen = match when {
            When::All => None,
            When::End => Some(series.files.len() - 1),
            When::Step(step) => Some(place_of(&series, step)?),
            When::Time(time) if !time.is_finite() => {
                return Err(Error::input("--time is not a finite number", "give seconds, such as --time 1e-3"));
            }
            When::Time(time) => {
                let times = series.times()?;
                let (nearest, is_far) = nearest(&times, time);
                far = is_far.then(|| far_from(time, series.files[nearest].0, times[nearest]));
                Some(nearest)
            }
        };
        if let Some(chosen) = chosen {
            series.files = vec![series.files.swap_remove(chosen)];
        }
        Ok(Self { series, shades, is_initial: false, is_single: when == When::End, range, far })
    }

    /// A note where the snapshot nearest to a time is far from it.
    pub fn far(&self) -> Option<&str> {
        self.far.as_deref()
    }

    /// On the initial body.
    #[must_use]
    pub fn initial(self, is_initial: bool) -> Self {
        Self { is_initial, ..self }
    }

    /// Draws them into a folder, in the format of this ending. Answers the files. Pictures of several times have the same box and the
    /// same colours.
    ///
    /// # Errors
    /// A snapshot that cannot be read, a file that cannot be written.
    pub fn draw(&self, folder: &Path, ending: &str) -> Result<Vec<PathBuf>> {
        let mut frame =
            Frame { window: [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], ranges: vec![EMPTY; self.shades.len()] };
        self.series.each(|shown| {
            frame.take(&self.sheet(&shown));
            Ok(())
        })?;
        if let Some(range) = self.range {
            frame.ranges.fill(range);
        }
        let mut files = Vec::new();
        self.series.each(|shown| {
            let sheet = self.sheet(&shown);
            for (k, shade) in self.shades.iter().enumerate() {
                let when = if self.is_single { String::new() } else { format!("_{:06}", shown.step) };
                let path = folder.join(format!("{}{when}.{ending}", shade.name));
                save(&self.map(&shown, &sheet, (k, shade), &frame), &path)?;
                files.push(path);
            }
            Ok(())
        })?;
        Ok(files)
    }

    /// Where points of a cell are shown.
    fn position(&self, mesh: &Mesh, cell: usize, xi: [f64; 2], point: &Point) -> [f64; 2] {
        let x = map::position(&mesh.map(cell), xi);
        if self.is_initial { x } else { [x[0] + point.displacement[0], x[1] + point.displacement[1]] }
    }

    fn sheet(&self, Shown { body, solution, .. }: &Shown) -> Sheet {
        let cells = body.mesh.cells.len();
        let most = (ALL_PARTS / cells as f64).sqrt() as usize;
        let parts = most.clamp(1, PARTS * (solution.basis.len() - 1).max(1));
        let xi: Vec<[f64; 2]> = (0..=parts)
            .flat_map(|i| (0..=parts).map(move |j| [i, j]))
            .map(|at| at.map(|k| k as f64 / parts as f64))
            .collect();
        let weights: Vec<Vec<f64>> = xi.iter().map(|&xi| solution.basis.values_2d(xi)).collect();
        let mut sheet =
            Sheet { parts, at: Vec::with_capacity(cells), values: vec![Vec::with_capacity(cells); self.shades.len()] };
        for cell in 0..cells {
            let points: Vec<Point> = xi.iter().zip(&weights).map(|(&xi, w)| solution.combine(cell, xi, w)).collect();
            let places = xi.iter().zip(&points).map(|(&xi, point)| self.position(&body.mesh, cell, xi, point));
            sheet.at.push(places.collect());
            for (values, shade) in sheet.values.iter_mut().zip(&self.shades) {
                values.push(points.iter().map(|point| shade.value(solution.law(cell), point)).collect());
            }
        }
        sheet
    }

    fn map(&self, shown: &Shown, sheet: &Sheet, (k, shade): (usize, &Shade), frame: &Frame) -> Map {
        let range = shade.palette.range(frame.ranges[k]);
        let (unit, size) = prefixed(shade.unit, range[0].abs().max(range[1].abs()));
        let (time_unit, time) = prefixed("s", shown.time);
        let is_deformed = !self.is_initial && shown.solution.has_displacement();
        let shape = if is_deformed { "deformed body" } else { "initial body" };
        let about = format!("t = {} {time_unit}, step {}, {shape}", short(shown.time / time), shown.step);
        let bar = Bar { palette: shade.palette, range: range.map(|x| x / size) };
        let mut map = Map::new(label(&shade.title, &unit), about, bar, frame.window);
        let largest = frame.window.as_flattened().iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let (unit, size) = prefixed("m", largest);
        (map.axes, map.unit) = ([format!("x [{unit}]"), format!("y [{unit}]")], size);
        sheet.fill(&mut map, k, (shade, range));
        self.lines(&mut map, shown);
        map
    }

    /// The edges of the cells, where these are not too many, and the outline.
    fn lines(&self, map: &mut Map, Shown { body, solution, .. }: &Shown) {
        let mesh = &body.mesh;
        for (cell, across) in neighbours(mesh).into_iter().enumerate() {
            for (face, beyond) in across.into_iter().enumerate() {
                let is_outline = beyond.is_none();
                // Each inner edge once.
                if is_outline || (mesh.cells.len() <= CELLS && beyond.is_some_and(|other| other > cell)) {
                    map.line(&self.edge(mesh, solution, cell, face), is_outline);
                }
            }
        }
    }

    fn edge(&self, mesh: &Mesh, solution: &Solution, cell: usize, face: usize) -> Vec<[f64; 2]> {
        let [a, b] = FACE_CORNERS[face].map(|corner| map::CORNER_XI[corner]);
        let is_straight = self.is_initial && mesh.map(cell).bulge.is_none();
        let pieces = if is_straight { 1 } else { 2 * (solution.basis.len() - 1).max(1) };
        let along = (0..=pieces).map(|k| k as f64 / pieces as f64);
        let xi = along.map(|s| [0, 1].map(|k| a[k] + s * (b[k] - a[k])));
        xi.map(|xi| self.position(mesh, cell, xi, &solution.at(cell, xi))).collect()
    }
}

/// The place of the time nearest to `time` among rising ones, and whether it is off by more than half of the distance to its neighbours.
fn nearest(times: &[f64], time: f64) -> (usize, bool) {
    let off = |k: usize| (times[k] - time).abs();
    let nearest = (0..times.len()).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0);
    let around = &times[nearest.saturating_sub(1)..(nearest + 2).min(times.len())];
    let spacing = around.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max);
    // A time in the middle of two is not far from either of them, whatever its rounding.
    (nearest, off(nearest) > 0.5 * spacing + 1e-9 * times[nearest].abs())
}

fn far_from(time: f64, step: usize, shown: f64) -> String {
    let [(unit, size), (shown_unit, shown_size)] = [time, shown].map(|t| prefixed("s", t.abs()));
    let [time, shown] = [short(time / size), short(shown / shown_size)];
    format!(
        "no snapshot is near t = {time} {unit}: the nearest one is shown, after step {step}, t = {shown} {shown_unit}"
    )
}

/// The place of the snapshot after a step.
fn place_of(series: &Series, step: usize) -> Result<usize> {
    let known: Vec<String> = series.files.iter().map(|(step, _)| step.to_string()).collect();
    series.files.iter().position(|(known, _)| *known == step).ok_or_else(|| {
        Error::input(
            format!("there is no snapshot after step {step}"),
            format!("there are those after {}", known.join(", ")),
        )
    })
}

impl Frame {
    fn take(&mut self, sheet: &Sheet) {
        let [low, high] = &mut self.window;
        for x in sheet.at.iter().flatten() {
            (0..2).for_each(|axis| [low[axis], high[axis]] = with([low[axis], high[axis]], x[axis]));
        }
        for (range, values) in self.ranges.iter_mut().zip(&sheet.values) {
            *range = values.iter().flatten().filter(|x| x.is_finite()).fold(*range, |range, x| with(range, *x));
        }
    }
}

impl Sheet {
    /// Colours the parts of all cells by a field, two triangles each.
    fn fill(&self, map: &mut Map, field: usize, (shade, range): (&Shade, [f64; 2])) {
        let side = self.parts + 1;
        for (at, values) in self.at.iter().zip(&self.values[field]) {
            let corners: Vec<Corner> =
                at.iter().zip(values).map(|(x, value)| Corner { at: map.place(*x), value: *value }).collect();
            for (i, j) in (0..self.parts).flat_map(|i| (0..self.parts).map(move |j| (i, j))) {
                let [a, b] = [corners[i * side + j], corners[(i + 1) * side + j]];
                let [c, d] = [corners[(i + 1) * side + j + 1], corners[i * side + j + 1]];
                map.raster().fill([a, b, c], shade.palette, range);
                map.raster().fill([a, c, d], shade.palette, range);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_time_outside_of_the_run_is_far_from_its_nearest_snapshot_and_one_inside_is_not() {
        let times = [0.0, 1.0, 2.0, 4.0];
        let at = |time| nearest(&times, time);
        assert_eq!([0.5, 1.4, 3.0, 3.1, 4.0].map(at), [(0, false), (1, false), (2, false), (3, false), (3, false)]);
        assert_eq!([-0.4, -0.6, 4.9, 5.1].map(at), [(0, false), (0, true), (3, false), (3, true)]);
        assert_eq!([nearest(&[2.0], 2.0), nearest(&[2.0], 2.1)], [(0, false), (0, true)]);
        let said = far_from(-1.0, 120, 2.5e-3);
        assert!(said.contains("t = -1 s") && said.contains("after step 120, t = 2.5 ms"), "{said}");
    }
}
