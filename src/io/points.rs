//! Positions of points for a cloud that ignores the grid, and fields at them: VTU (as written by `export` or meshio) or CSV.

use std::cmp::Ordering;
use std::path::Path;

use super::grid::{Field, Kind};
use super::seal::{self, Seal};
use super::{regular, vtu};
use crate::error::{Error, Place, Result};

/// What a file of points must be, for messages.
const REMEDY: &str = "give a VTU file with its points in m, or rows x, y in m";

/// Columns beyond which rows are refused: the parts of a tensor are looked for by name among all of them.
const COLUMNS: usize = 1000;

/// Largest |z| that counts as 0, relative to the largest coordinate: it allows for rounding in a rotated plane.
const FLAT: f64 = 1e-10;

/// Points with their fields.
pub type Found = (Vec<[f64; 2]>, Vec<Field>);

/// Reads positions X in m: of a VTU file by its ending, else rows x, y with or without a row of names.
///
/// # Errors
/// A file that cannot be read or holds no points; a row that is no pair of numbers, with its line.
pub fn read(path: &Path) -> Result<Vec<[f64; 2]>> {
    Ok(read_with_fields(path)?.0)
}

/// Reads positions as [`read`] does, and all fields. In a VTU file these are the fields with 1, 3 or 9 components. In rows
/// they are the named columns other than x, y (or other than the first two, if no column is named x or y):
/// `name_1, name_2` is a vector, `name_11, name_12, name_21, name_22` a tensor in the plane.
///
/// # Errors
/// As for [`read`]; a row with fewer numbers than names.
pub fn read_with_fields(path: &Path) -> Result<Found> {
    let found = if path.extension().is_some_and(|ending| ending == "vtu") { vtu(path)? } else { rows(path)? };
    let fault = |what: String| Err(Error::at(Place::file(path), what, REMEDY));
    match found.0.iter().position(|x| x.iter().any(|x| !x.is_finite())) {
        Some(k) => fault(format!("point {} is not finite", k + 1)),
        None if found.0.is_empty() => fault("there is no point in it".to_owned()),
        None => Ok(found),
    }
}

fn vtu(path: &Path) -> Result<Found> {
    let fault = |why: String| Error::at(Place::file(path), format!("cannot read the points: {why}"), REMEDY);
    let bytes = regular::bytes(path, u64::MAX).map_err(fault)?;
    if seal::check_text(&bytes) == Seal::Broken {
        let what = "the file is damaged: its bytes are not those that were written";
        return Err(Error::at(
            Place::file(path),
            what,
            "export it again; if you have changed it, remove its last line",
        ));
    }
    let (points, fields) = vtu::points(&bytes).map_err(fault)?;
    let size = points.iter().flatten().fold(0.0, |size: f64, x| size.max(x.abs()));
    // NaN is an error too.
    if let Some(k) = points.iter().position(|x| x[2].is_nan() || x[2].abs() > FLAT * size) {
        return Err(fault(format!("point {} has z = {}, and the body lies in the plane z = 0", k + 1, points[k][2])));
    }
    Ok((points.into_iter().map(|[x, y, _]| [x, y]).collect(), fields))
}

fn rows(path: &Path) -> Result<Found> {
    let text = regular::text(path, u64::MAX)
        .map_err(|why| Error::at(Place::file(path), format!("cannot read the points: {why}"), REMEDY))?;
    of_rows(&text, path)
}

/// Points and fields of rows; `path` stands in messages.
///
/// # Errors
/// As for [`read_with_fields`].
pub fn of_rows(text: &str, path: &Path) -> Result<Found> {
    let (mut names, mut numbers, mut count) = (Vec::new(), Vec::new(), None);
    for (line, text) in text.lines().enumerate().filter(|(_, text)| !text.trim().is_empty()) {
        let fault = |(what, remedy): Fault| Error::at(Place::line(path, line + 1, 1), what, remedy);
        let words = words(text).map_err(fault)?;
        if count.is_none() && words.iter().all(|word| is_name(word)) {
            names = words.iter().map(|word| word.trim_matches(['"', '\'']).to_owned()).collect();
        } else {
            let row = numbers_of(&words, &names, count.filter(|_| names.is_empty())).map_err(fault)?;
            numbers.extend(row);
        }
        if words.len() > COLUMNS {
            let what = format!("the row has {} entries, and {COLUMNS} are the most that are read", words.len());
            return Err(fault((what, "give x, y and the fields that are needed")));
        }
        if words.len() < 2 {
            return Err(fault(("this is not a point".to_owned(), "give x, y in m")));
        }
        count = Some(words.len());
    }
    let count = count.unwrap_or(2);
    let place = place_of(&names).map_err(|(what, remedy)| Error::at(Place::file(path), what, remedy))?;
    let column = |k: usize| -> Vec<f64> { numbers.iter().skip(k).step_by(count).copied().collect() };
    let points = numbers.chunks_exact(count).map(|row| place.map(|k| row[k])).collect();
    let others = names.into_iter().enumerate().filter(|(k, _)| !place.contains(k));
    Ok((points, fields_of(others.map(|(k, name)| (name, column(k))).collect())))
}

/// The fault of a row, and how to correct it.
type Fault = (String, &'static str);

/// The entries of a row, between commas or blanks.
fn words(row: &str) -> std::result::Result<Vec<&str>, Fault> {
    if row.contains(';') {
        let remedy = "separate numbers by commas or blanks, with a point before the decimals";
        return Err(("`;` is not known as a separator".to_owned(), remedy));
    }
    // `# x y`, as NumPy writes names.
    let row = row.trim().trim_start_matches('#').trim_start();
    if !row.contains(',') {
        return Ok(row.split_whitespace().collect());
    }
    let all: Vec<&str> = row.strip_suffix(',').unwrap_or(row).split(',').map(str::trim).collect();
    match all.iter().position(|word| word.is_empty()) {
        Some(k) => Err((format!("entry {} is empty", k + 1), "give a number in each column")),
        None => Ok(all),
    }
}

/// Whether a word of the first row is a name: it is not a number, and not a misspelt number.
fn is_name(word: &str) -> bool {
    let first = word.trim_start_matches(['"', '\'']).chars().next();
    word.parse::<f64>().is_err() && first.is_some_and(|first| first.is_alphabetic() || first == '_')
}

/// The numbers of a row: as many as there are names, or as the row before has.
fn numbers_of(words: &[&str], names: &[String], before: Option<usize>) -> std::result::Result<Vec<f64>, Fault> {
    let mut numbers = Vec::with_capacity(words.len());
    for word in words {
        let number = word.parse::<f64>();
        numbers.push(number.map_err(|_| (format!("this is not a point: `{word}` is not a number"), "give x, y in m"))?);
    }
    let (wanted, whose) = match before {
        _ if !names.is_empty() => (names.len(), "names"),
        Some(count) => (count, "in the rows before"),
        None => return Ok(numbers),
    };
    match numbers.len().cmp(&wanted) {
        Ordering::Less => Err((format!("there are fewer numbers than {whose}"), "give a number under each name")),
        Ordering::Greater => Err((format!("there are more numbers than {whose}"), "give a name above each number")),
        Ordering::Equal => Ok(numbers),
    }
}

/// The columns of x and y: by their names (also those of ParaView, with units behind them), otherwise the first two columns.
///
/// # Errors
/// A unit that is not m; names of which only one is a coordinate, or of which two are the same one.
fn place_of(names: &[String]) -> std::result::Result<[usize; 2], Fault> {
    let mut found = [None; 2];
    for (column, name) in names.iter().enumerate() {
        let (name, unit) = split_unit(name);
        let axis = AXES_NAMES.iter().position(|known| known.iter().any(|known| name.eq_ignore_ascii_case(known)));
        let Some(axis) = axis else { continue };
        if let Some(unit) = unit.filter(|unit| *unit != "m") {
            return Err((format!("the unit of `{name}` is {unit}"), "give coordinates in m"));
        }
        if found[axis].replace(column).is_some() {
            return Err((format!("there are two columns `{name}`"), "name one column x and one y"));
        }
    }
    match found {
        [Some(x), Some(y)] => Ok([x, y]),
        [None, None] => Ok([0, 1]),
        [x, _] => {
            let (there, missing) = if x.is_some() { ("x", "y") } else { ("y", "x") };
            Err((format!("a column is named {there}, and none {missing}"), "name one column x and one y"))
        }
    }
}

/// Names of x and of y.
const AXES_NAMES: [[&str; 2]; 2] = [["x", "Points:0"], ["y", "Points:1"]];

/// A name and the unit behind it, as in `x [m]` or `x (m)`.
fn split_unit(name: &str) -> (&str, Option<&str>) {
    let unit = |open, close| name.strip_suffix(close).and_then(|rest: &str| rest.split_once(open));
    match unit('[', ']').or_else(|| unit('(', ')')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (name.trim(), None),
    }
}

/// Columns with names as fields.
fn fields_of(mut columns: Vec<(String, Vec<f64>)>) -> Vec<Field> {
    let mut fields = Vec::new();
    while let Some((name, values)) = columns.first().cloned() {
        let stem = name.rsplit_once('_').map_or("", |(stem, _)| stem).to_owned();
        let mut take = |suffixes: &[&str]| -> Option<Vec<Vec<f64>>> {
            let find = |suffix: &&str| columns.iter().position(|(name, _)| *name == format!("{stem}_{suffix}"));
            let at: Vec<usize> = suffixes.iter().map(find).collect::<Option<_>>()?;
            let found = at.iter().map(|&k| columns[k].1.clone()).collect();
            columns.retain(|(name, _)| !suffixes.iter().any(|suffix| *name == format!("{stem}_{suffix}")));
            Some(found)
        };
        let zip = |parts: &[Vec<f64>], of: &dyn Fn(usize) -> Vec<f64>| (0..parts[0].len()).flat_map(of).collect();
        if let Some(t) = take(&["11", "12", "21", "22"]) {
            let row = |p: usize| vec![t[0][p], t[1][p], 0.0, t[2][p], t[3][p], 0.0, 0.0, 0.0, 1.0];
            fields.push(Field::new(stem, Kind::Tensor, zip(&t, &row)));
        } else if let Some(v) = take(&["1", "2"]) {
            fields.push(Field::new(stem, Kind::Vector, zip(&v, &|p| vec![v[0][p], v[1][p], 0.0])));
        } else {
            columns.remove(0);
            fields.push(Field::new(name, Kind::Scalar, values));
        }
    }
    fields
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::grid::PointCloud;
    use crate::io::vtu::write_points;

    #[test]
    fn points_of_an_exported_vtu_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.vtu");
        let points = vec![[0.1, 0.2, 0.0], [1.0 / 3.0, 2.0, 0.0], [-5e-300, 7.0, 0.0]];
        write_points(&path, &PointCloud { points: points.clone(), ..PointCloud::default() }).unwrap();
        assert_eq!(read(&path).unwrap(), points.iter().map(|x| [x[0], x[1]]).collect::<Vec<_>>());
    }

    #[test]
    fn rows_may_have_names_and_a_bad_row_is_named() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        std::fs::write(&path, "x,y\n0.5, 1e-3\n\n2 3\n").unwrap();
        assert_eq!(read(&path).unwrap(), [[0.5, 1e-3], [2.0, 3.0]]);
        std::fs::write(&path, "0,0\n1;2\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("points.csv:2:1"));
        std::fs::write(&path, "0,inf\n").unwrap();
        assert!(read(&path).unwrap_err().to_string().contains("point 1 is not finite"));
    }

    #[test]
    fn no_first_row_is_lost_or_taken_for_names() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.csv");
        let read_text = |text: &str| {
            std::fs::write(&path, text).unwrap();
            read(&path).map_err(|why| why.to_string())
        };
        let (a, b) = ([0.25, 0.5], [1.0, 2.0]);
        // A mark, no mark; names, no names; what NumPy and ParaView write; blanks, tabs, a comma at the end.
        for text in [
            "0.25,0.5\n1,2\n",
            "\u{feff}0.25,0.5\n1,2\n",
            "\u{feff}x,y\r\n0.25,0.5\r\n1,2\r\n",
            "\n# x y\n0.25 0.5\n1\t2\n",
            "\"id\",\"X\",\"Y\"\n7,0.25,0.5\n8,1,2\n",
            "\"u\",\"Points:0\",\"Points:1\",\"Points:2\"\n7,0.25,0.5,0\n7,1,2,0\n",
            "X [m],Y [m]\n0.25, 0.5,\n1, 2,\n",
            "y,x\n0.5,0.25\n2,1\n",
            "Y [m],X (m)\n0.5,0.25\n2,1\n",
            "a,y,b,x\n7,0.5,8,0.25\n7,2,8,1\n",
            "0.25 0.5 3\n1 2 4\n",
        ] {
            assert_eq!(read_text(text), Ok(vec![a, b]), "{text:?}");
        }
        for (text, what) in [
            ("y,z\n1,2\n", "a column is named y, and none x"),
            ("x,y [mm]\n1,2\n", "the unit of `y` is mm"),
            ("x,y,X\n1,2,3\n", "two columns `X`"),
        ] {
            let why = read_text(text).unwrap_err();
            assert!(why.contains("points.csv: ") && why.contains(what), "{text:?}: {why}");
        }
        for (text, line, what) in [
            ("0.25;0.5\n1,2\n", 1, "`;` is not known as a separator"),
            ("x;y\n1;2\n", 1, "`;` is not known as a separator"),
            ("0,25;0,5\n", 1, "`;` is not known as a separator"),
            ("0.2z5,0.5\n1,2\n", 1, "`0.2z5` is not a number"),
            ("0.2z5,0.z5\n1,2\n", 1, "`0.2z5` is not a number"),
            ("-,0.5\n1,2\n", 1, "`-` is not a number"),
            ("x,0.5\n1,2\n", 1, "`x` is not a number"),
            ("points\n1,2\n", 1, "this is not a point"),
            ("0.25\n1,2\n", 1, "this is not a point"),
            ("x,y\nx,y\n1,2\n", 2, "`x` is not a number"),
            ("x,y,a\n1,2,3\n1,,3\n", 3, "entry 2 is empty"),
            ("x,y\n1,2,3\n", 2, "more numbers than names"),
            ("1,2\n1,2,3\n", 2, "more numbers than in the rows before"),
            ("1,2,3\n1,2\n", 2, "fewer numbers than in the rows before"),
            ("1,2\n1,2 m\n", 2, "`2 m` is not a number"),
        ] {
            let why = read_text(text).unwrap_err();
            assert!(why.contains(&format!("points.csv:{line}:1: ")) && why.contains(what), "{text:?}: {why}");
        }
    }

    #[test]
    fn fields_come_back_from_vtu_and_from_named_columns() {
        let folder = tempfile::tempdir().unwrap();
        let (vtu, csv) = (folder.path().join("points.vtu"), folder.path().join("points.csv"));
        let fields = vec![
            Field::new("deformation", Kind::Tensor, vec![1.1, 0.2, 0.0, 0.3, 0.9, 0.0, 0.0, 0.0, 1.0]),
            Field::new("velocity", Kind::Vector, vec![1.0 / 3.0, -2e5, 0.0]),
            Field::new("damage", Kind::Scalar, vec![0.125]),
        ];
        write_points(
            &vtu,
            &PointCloud { points: vec![[0.5, 0.25, 0.0]], fields: fields.clone(), about: "a -- b".to_owned() },
        )
        .unwrap();
        assert_eq!(read_with_fields(&vtu).unwrap(), (vec![[0.5, 0.25]], fields.clone()));
        let names = "x,y,deformation_11,velocity_1,deformation_12,deformation_21,deformation_22,velocity_2,damage";
        std::fs::write(&csv, format!("{names}\n0.5,0.25,1.1,{},0.2,0.3,0.9,-2e5,0.125\n", 1.0 / 3.0)).unwrap();
        assert_eq!(read_with_fields(&csv).unwrap(), (vec![[0.5, 0.25]], fields));
        std::fs::write(&csv, "x,y,velocity_1\n0.5,0.25\n").unwrap();
        assert!(read(&csv).unwrap_err().to_string().contains("points.csv:2:1: there are fewer numbers than names"));
    }

    #[test]
    fn a_vtu_that_is_none_gives_one_message() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.vtu");
        for text in ["", "<VTKFile>", "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\"></VTKFile>", "\u{0}\u{1}"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(read(&path).unwrap_err().exit_code(), 2, "{text}");
        }
    }
}
