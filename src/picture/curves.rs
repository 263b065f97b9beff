//! Curves of the tables of a run: energy and momentum over time, numbers through time, samples along lines.

use super::unit::{label, prefixed, scaled, short};
use crate::chart::{Chart, Line, Marker, Panels, Scale, Stroke, save};
use crate::error::{Error, Place, Result};
use crate::file;
use crate::run::Folder;
use std::path::{Path, PathBuf};

/// Bytes of the largest table.
const LARGEST: u64 = 1 << 30;
/// Curves in a panel; more would not be told apart, and have further panels.
const MOST: usize = 7;
/// The largest number that is drawn, and what is drawn for larger ones: the range of an axis and its margins must be finite.
const HIGHEST: f64 = 1e300;
/// Points of a curve: more would fall on the same pixels.
const POINTS: usize = 3000;

/// A panel of the ledger: title, unit, columns with their names in the legend.
type Part = (&'static str, &'static str, &'static [(&'static str, &'static str)]);

/// The panels of the ledger.
const LEDGER: [Part; 4] = [
    (
        "Energy of the body",
        "J/m",
        &[
            ("kinetic_energy", "kinetic"),
            ("strain_energy", "strain"),
            ("face_energy", "in springs of faces"),
            ("total_energy", "total"),
            ("material_dissipation", "dissipated by the law"),
            ("boundary_work", "work of boundaries"),
            ("source_work", "work of sources"),
        ],
    ),
    (
        "Energy that the method takes",
        "J/m",
        &[
            ("flux_dissipation", "between cells"),
            ("boundary_dissipation", "at boundaries"),
            ("curl_dissipation", "control of the curl"),
            ("correction_dissipation", "corrections"),
            ("regrid_dissipation", "changes of mesh"),
        ],
    ),
    ("Momentum", "kg/s", &[("momentum_1", "along x"), ("momentum_2", "along y")]),
    ("Smallest J = det F", "", &[("min_j", "smallest J")]),
];

/// A table of numbers.
struct Table {
    columns: Vec<String>,
    rows: Vec<Vec<f64>>,
}

/// The points of a curve.
type Points = Vec<(f64, f64)>;

/// A curve with its name.
type Named = (String, Points);

/// A curve before it has a place: its name, its unit, its points.
type Curve = (String, String, Points);

/// Draws the tables of a run into a folder, in the format of this ending. Answers the files.
///
/// # Errors
/// A table that cannot be read, a file that cannot be written.
pub fn curves(run: &Folder, folder: &Path, ending: &str) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    let mut draw = |name: &str, charts: Vec<Chart>| {
        let path = folder.join(format!("{name}.{ending}"));
        if !charts.is_empty() {
            save(&Panels(charts), &path)?;
            files.push(path);
        }
        Ok::<(), Error>(())
    };
    if run.ledger().is_file() {
        draw("energy", ledger(&Table::read(&run.ledger())?))?;
    }
    for path in tables(&run.root.join("tracks")) {
        let name = stem(&path);
        draw(&format!("track_{name}"), track(&name, &Table::read(&path)?))?;
    }
    for path in tables(&run.root.join("lines")) {
        let name = stem(&path);
        draw(&format!("line_{name}"), samples(&name, &Table::read(&path)?))?;
    }
    Ok(files)
}

/// The tables in a folder, sorted.
fn tables(folder: &Path) -> Vec<PathBuf> {
    let all = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let mut tables: Vec<PathBuf> = all.filter(|path| path.extension().is_some_and(|ending| ending == "csv")).collect();
    tables.sort();
    tables
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

impl Table {
    fn read(path: &Path) -> Result<Self> {
        let fail = |what: String| Error::at(Place::file(path), what, "run the scene again with --force");
        let text = file::text(path, LARGEST).map_err(|why| fail(format!("cannot be read: {why}")))?;
        let mut lines = text.lines();
        let columns: Vec<String> = lines.next().unwrap_or_default().split(',').map(str::to_owned).collect();
        let mut rows = Vec::new();
        for (number, line) in lines.enumerate() {
            let row: std::result::Result<Vec<f64>, _> = line.split(',').map(str::parse).collect();
            match row {
                Ok(row) if row.len() == columns.len() => rows.push(row),
                _ => return Err(fail(format!("line {} is no row of {} numbers", number + 2, columns.len()))),
            }
        }
        Ok(Self { columns, rows })
    }

    fn place(&self, column: &str) -> Option<usize> {
        self.columns.iter().position(|name| name == column)
    }

    /// The points of a column over another one, without gaps, cut to [`HIGHEST`], and thinned to what a picture shows.
    fn points(&self, x: usize, y: usize) -> Points {
        // What is nearer to 0 than the inverse of the largest number has too few digits for an axis.
        let cut = |value: f64| if value.abs() < HIGHEST.recip() { 0.0 } else { value.clamp(-HIGHEST, HIGHEST) };
        let points = self.rows.iter().map(|row| (row[x], row[y])).filter(|(x, y)| x.is_finite() && y.is_finite());
        let all: Vec<(f64, f64)> = points.map(|(x, y)| (cut(x), cut(y))).collect();
        let step = all.len().div_ceil(POINTS).max(1);
        let last = all.len().saturating_sub(1);
        all.into_iter().enumerate().filter(|(k, _)| k % step == 0 || *k == last).map(|(_, point)| point).collect()
    }
}

/// The panels of curves that share a unit; none where there is nothing to show.
fn split(title: &str, x: (&str, &str), unit: &str, curves: Vec<Named>) -> Vec<Chart> {
    let parts = apart(curves.into_iter().filter(|(_, points)| points.len() > 1).collect());
    let count = parts.len();
    let title = |k: usize| if count > 1 { format!("{title} ({} of {count})", k + 1) } else { title.to_owned() };
    parts.iter().enumerate().map(|(k, curves)| panel(&title(k), x, unit, curves)).collect()
}

/// Curves in parts of at most [`MOST`], in their order. Components of one quantity that follow each other stay together, unless these
/// alone are more.
fn apart(curves: Vec<Named>) -> Vec<Vec<Named>> {
    let mut parts: Vec<Vec<Named>> = Vec::new();
    for quantity in curves.chunk_by(|a, b| field_of(&a.0) == field_of(&b.0)) {
        for some in quantity.chunks(MOST) {
            match parts.last_mut() {
                Some(part) if part.len() + some.len() <= MOST => part.extend_from_slice(some),
                _ => parts.push(some.to_vec()),
            }
        }
    }
    parts
}

/// A panel of curves that share a unit.
fn panel(title: &str, x: (&str, &str), unit: &str, curves: &[Named]) -> Chart {
    let largest = |of: fn(&(f64, f64)) -> f64| {
        curves.iter().flat_map(|(_, points)| points).map(of).fold(0.0, |most: f64, x| most.max(x.abs()))
    };
    let ((x_unit, x_size), (y_unit, y_size)) = (scaled(x.1, largest(|p| p.0)), scaled(unit, largest(|p| p.1)));
    let line = |(k, (name, points)): (usize, &Named)| Line {
        name: name.clone(),
        colour: [2, 4, 3, 5, 1, 6, 0][k % MOST],
        marker: Marker::Bare,
        stroke: [Stroke::Full, Stroke::Dashed][k / 4 % 2],
        points: points.iter().map(|(x, y)| (x / x_size, y / y_size)).collect(),
    };
    let lines: Vec<Line> = curves.iter().enumerate().map(line).collect();
    let (x, y) = (label(x.0, &x_unit), if y_unit.is_empty() { String::new() } else { format!("[{y_unit}]") });
    Chart { title: title.to_owned(), x, y, scales: [Scale::Linear; 2], lines }
}

fn ledger(table: &Table) -> Vec<Chart> {
    let Some(t) = table.place("t") else { return vec![] };
    let of = |(title, unit, columns): &Part| {
        let curve = |(column, name): &(&str, &str)| Some(((*name).to_owned(), table.points(t, table.place(column)?)));
        let curves: Vec<_> = columns.iter().filter_map(curve).collect();
        // What is 0 all the time says nothing.
        let speaks = |(_, points): &Named| points.iter().any(|(_, y)| *y != 0.0);
        split(title, ("t", "s"), unit, curves.into_iter().filter(speaks).collect())
    };
    LEDGER.iter().flat_map(of).collect()
}

/// `name [unit]` of a column.
fn parts(column: &str) -> (String, String) {
    match column.split_once(" [") {
        Some((name, unit)) => (name.to_owned(), unit.trim_end_matches(']').to_owned()),
        None => (column.to_owned(), String::new()),
    }
}

/// Panels of what belongs together, in the order of their first curves.
fn panels(name: &str, x: (&str, &str), curves: Vec<Curve>, key: impl Fn(&Curve) -> String) -> Vec<Chart> {
    let mut groups: Vec<(String, Vec<Curve>)> = Vec::new();
    for curve in curves {
        let key = key(&curve);
        match groups.iter_mut().find(|(known, _)| *known == key) {
            Some((_, group)) => group.push(curve),
            None => groups.push((key, vec![curve])),
        }
    }
    let of = |(_, group): (String, Vec<Curve>)| {
        let unit = group.first().map_or_else(String::new, |curve| curve.1.clone());
        // A field where all curves are its components.
        let mut fields = group.iter().map(|curve| field_of(&curve.0));
        let first = fields.next().unwrap_or_default().to_owned();
        let title = match fields.all(|field| field == first) && group.iter().any(|curve| curve.0 != name) {
            true => format!("{name}: {}", first.replace('_', " ")),
            false => name.to_owned(),
        };
        split(&title, x, &unit, group.into_iter().map(|(name, _, points)| (name, points)).collect())
    };
    groups.into_iter().flat_map(of).collect()
}

/// Numbers through time: a panel for each unit.
fn track(name: &str, table: &Table) -> Vec<Chart> {
    let Some(t) = table.place("t [s]") else { return vec![] };
    let curve = |(k, column): (usize, &String)| {
        let (name, unit) = parts(column);
        (name, unit, table.points(t, k))
    };
    let curves = table.columns.iter().enumerate().filter(|(k, _)| *k != t).map(curve).collect();
    panels(name, ("t", "s"), curves, |curve| curve.1.clone())
}

/// Samples along a line, at the last time: a panel for each field.
fn samples(name: &str, table: &Table) -> Vec<Chart> {
    let (Some(t), Some(s)) = (table.place("t"), table.place("s")) else { return vec![] };
    let Some(last) = table.rows.last().map(|row| row[t]) else { return vec![] };
    let rows = table.rows.iter().filter(|row| row[t] == last).cloned().collect();
    let at_end = Table { columns: table.columns.clone(), rows };
    let (unit, size) = prefixed("s", last);
    let is_field = |column: &&(usize, &String)| !["t", "s", "x", "y"].contains(&&column.1[..]);
    let all: Vec<(usize, &String)> = table.columns.iter().enumerate().collect();
    let curve = |(k, column): &(usize, &String)| ((*column).clone(), unit_of(column).to_owned(), at_end.points(s, *k));
    let curves = all.iter().filter(is_field).map(curve).collect();
    let name = format!("{name}, t = {} {unit}", short(last / size));
    panels(&name, ("s", "m"), curves, |curve| field_of(&curve.0).replace('_', " "))
}

/// The field of a component such as `cauchy_stress_11`.
fn field_of(column: &str) -> &str {
    let plain = column.trim_end_matches(|c: char| c.is_ascii_digit());
    plain.strip_suffix('_').filter(|_| plain != column).unwrap_or(column)
}

/// The unit of a column, which tables of lines do not have.
fn unit_of(column: &str) -> &'static str {
    let field = crate::observe::Field::OF_ALL.into_iter().find(|field| field.name() == field_of(column));
    field.map_or("", crate::quantity::Component::unit)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn columns_have_their_fields_and_units() {
        assert_eq!(
            [field_of("cauchy_stress_11"), field_of("von_mises"), field_of("plastic_strain")],
            ["cauchy_stress", "von_mises", "plastic_strain"]
        );
        assert_eq!([unit_of("cauchy_stress_11"), unit_of("velocity_1"), unit_of("jacobian")], ["Pa", "m/s", ""]);
        assert_eq!(parts("left_force_1 [N/m]"), ("left_force_1".to_owned(), "N/m".to_owned()));
    }

    #[test]
    fn numbers_of_one_unit_share_a_panel() {
        let columns = ["t [s]", "a [N]", "b [m]", "c [N]", "none [Pa]"].map(str::to_owned).to_vec();
        let rows = vec![vec![0.0, 1.0, 2.0, 3.0, f64::NAN], vec![1e-3, 2.0, 3.0, 4.0, f64::NAN]];
        let charts = track("x", &Table { columns, rows });
        let names: Vec<Vec<&str>> =
            charts.iter().map(|chart| chart.lines.iter().map(|line| line.name.as_str()).collect()).collect();
        assert_eq!(names, [vec!["a", "c"], vec!["b"]]);
        assert_eq!(charts[0].x, "t [ms]");
    }

    #[test]
    fn each_of_many_curves_is_drawn_once_and_components_of_a_quantity_share_a_panel() {
        // 12 forces of 2 components, one more than a panel has at an odd place, and a quantity of more components than a panel has.
        let forces =
            (0..12).flat_map(|k| [1, 2].map(|axis| format!("body{}_force_{axis}", ["a", "b"][k % 2].repeat(k + 1))));
        let names: Vec<String> = forces.chain((0..MOST + 2).map(|k| format!("many_{k}"))).collect();
        let columns: Vec<String> =
            std::iter::once("t [s]".to_owned()).chain(names.iter().map(|n| format!("{n} [N/m]"))).collect();
        let rows = vec![vec![0.0; columns.len()], vec![1.0; columns.len()]];
        let charts = track("x", &Table { columns, rows });
        let of = |chart: &Chart| chart.lines.iter().map(|line| line.name.clone()).collect::<Vec<_>>();
        assert_eq!(charts.iter().flat_map(of).collect::<Vec<_>>(), names);
        assert!(charts.iter().all(|chart| (1..=MOST).contains(&chart.lines.len())));
        for name in names.iter().filter(|name| name.ends_with("force_1")) {
            let chart = charts.iter().find(|chart| of(chart).contains(name)).unwrap();
            assert!(of(chart).contains(&name.replace("force_1", "force_2")), "{name}");
        }
        let titles: std::collections::BTreeSet<_> = charts.iter().map(|chart| &chart.title).collect();
        assert_eq!(titles.len(), charts.len(), "{titles:?}");
    }

    #[test]
    fn numbers_whose_range_overflows_are_cut_and_the_picture_ends() {
        let rows = vec![vec![0.0, 1e308, 2.0], vec![1.0, -1e308, 3.0], vec![2.0, 1.0, -1e308], vec![3.0, 2.0, 4.0]];
        let charts = track("x", &Table { columns: ["t [s]", "a [N]", "b [m]"].map(str::to_owned).to_vec(), rows });
        let lengths: Vec<usize> = charts.iter().map(|chart| chart.lines[0].points.len()).collect();
        assert_eq!(lengths, [4, 4]);
        let folder = tempfile::tempdir().unwrap();
        save(&Panels(charts), &folder.path().join("x.svg")).unwrap();
    }
}
