//! Positions of points for a cloud that ignores the grid, and fields at them: VTU (as written by `export` or meshio) or CSV.

use std::path::Path;

use vtkio::model::{Attribute, DataSet, Vtk};

use super::grid::{Field, Kind};
use crate::error::{Error, Place, Result};

/// What a file of points has to be.
const REMEDY: &str = "give a VTU file with its points in m, or rows x, y in m";

/// Points with their fields.
type Found = (Vec<[f64; 2]>, Vec<Field>);

/// Reads positions X in m: of a VTU file by its ending, else rows x, y with or without a row of names.
///
/// # Errors
/// A file that cannot be read or holds no points; a row that is no pair of numbers, with its line.
pub fn read(path: &Path) -> Result<Vec<[f64; 2]>> {
    Ok(read_with_fields(path)?.0)
}

/// Reads positions as [`read`] does, and all fields: of a VTU file those with 1, 3 or 9 components; of rows the columns
/// behind x, y by their names, where `name_1, name_2` are a vector and `name_11, name_12, name_21, name_22` a tensor in the
/// plane.
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
    let file = Vtk::import(path).map_err(|why| fault(why.to_string()))?;
    let DataSet::UnstructuredGrid { pieces, .. } = file.data else {
        return Err(fault("it is not an unstructured grid".to_owned()));
    };
    let (mut points, mut fields): Found = (Vec::new(), Vec::new());
    for piece in pieces {
        let piece = piece.into_loaded_piece_data(None).map_err(|why| fault(why.to_string()))?;
        let numbers = piece.points.cast_into::<f64>().ok_or_else(|| fault("its points are no numbers".to_owned()))?;
        points.extend(numbers.chunks_exact(3).map(|x| [x[0], x[1]]));
        for attribute in piece.data.point {
            let Attribute::DataArray(array) = attribute else { continue };
            let count = numbers.len() / 3;
            let kind = [Kind::Scalar, Kind::Vector, Kind::Tensor];
            let kind = kind.into_iter().find(|kind| array.data.len() == count * kind.components());
            let (Some(kind), Some(values)) = (kind, array.data.cast_into::<f64>()) else { continue };
            match fields.iter_mut().find(|field| field.name == array.name) {
                Some(field) => field.values.extend(values),
                None => fields.push(Field::new(array.name, kind, values)),
            }
        }
    }
    // A field that not every piece has is none.
    fields.retain(|field| field.values.len() == points.len() * field.kind.components());
    Ok((points, fields))
}

fn rows(path: &Path) -> Result<Found> {
    let text = std::fs::read_to_string(path)
        .map_err(|why| Error::at(Place::file(path), format!("cannot read the points: {why}"), REMEDY))?;
    let (mut names, mut points, mut columns) = (Vec::new(), Vec::new(), Vec::new());
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let words = || line.split([',', ' ', '\t']).filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words().map_while(|word| word.parse().ok()).collect();
        let fault = |what: &str, remedy: &str| Err(Error::at(Place::line(path, number + 1, 1), what, remedy));
        match numbers[..] {
            [x, y, ..] if numbers.len() >= names.len() => {
                points.push([x, y]);
                columns.resize(names.len().saturating_sub(2), Vec::new());
                columns.iter_mut().zip(&numbers[2..]).for_each(|(column, number)| column.push(*number));
            }
            [_, _, ..] => return fault("there are fewer numbers than names", "give a number under each name"),
            _ if number == 0 => names = words().map(str::to_owned).collect(),
            _ => return fault("this is not a point", "give x, y in m"),
        }
    }
    let columns = names.into_iter().skip(2).zip(columns).collect();
    Ok((points, fields_of(columns)))
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
        write_points(&path, &PointCloud { points: points.clone(), fields: vec![] }).unwrap();
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
    fn fields_come_back_from_vtu_and_from_named_columns() {
        let folder = tempfile::tempdir().unwrap();
        let (vtu, csv) = (folder.path().join("points.vtu"), folder.path().join("points.csv"));
        let fields = vec![
            Field::new("deformation", Kind::Tensor, vec![1.1, 0.2, 0.0, 0.3, 0.9, 0.0, 0.0, 0.0, 1.0]),
            Field::new("velocity", Kind::Vector, vec![1.0 / 3.0, -2e5, 0.0]),
            Field::new("plastic_strain", Kind::Scalar, vec![0.125]),
        ];
        write_points(&vtu, &PointCloud { points: vec![[0.5, 0.25, 0.0]], fields: fields.clone() }).unwrap();
        assert_eq!(read_with_fields(&vtu).unwrap(), (vec![[0.5, 0.25]], fields.clone()));
        let names =
            "x,y,deformation_11,velocity_1,deformation_12,deformation_21,deformation_22,velocity_2,plastic_strain";
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
