//! Positions of points for a cloud that ignores the grid: VTU (as written by `export` or meshio) or CSV.

use std::path::Path;

use vtkio::model::{DataSet, Vtk};

use crate::error::{Error, Place, Result};

/// What a file of points has to be.
const REMEDY: &str = "give a VTU file with its points in m, or rows x, y in m";

/// Reads positions X in m: of a VTU file by its ending, else rows x, y with or without a row of names.
///
/// # Errors
/// A file that cannot be read or holds no points; a row that is no pair of numbers, with its line.
pub fn read(path: &Path) -> Result<Vec<[f64; 2]>> {
    let points = if path.extension().is_some_and(|ending| ending == "vtu") { vtu(path)? } else { rows(path)? };
    match points.iter().position(|x| x.iter().any(|x| !x.is_finite())) {
        Some(k) => Err(Error::at(Place::file(path), format!("point {} is not finite", k + 1), REMEDY)),
        None if points.is_empty() => Err(Error::at(Place::file(path), "there is no point in it", REMEDY)),
        None => Ok(points),
    }
}

fn vtu(path: &Path) -> Result<Vec<[f64; 2]>> {
    let fault = |why: String| Error::at(Place::file(path), format!("cannot read the points: {why}"), REMEDY);
    let file = Vtk::import(path).map_err(|why| fault(why.to_string()))?;
    let DataSet::UnstructuredGrid { pieces, .. } = file.data else {
        return Err(fault("it is not an unstructured grid".to_owned()));
    };
    let mut points = Vec::new();
    for piece in pieces {
        let piece = piece.into_loaded_piece_data(None).map_err(|why| fault(why.to_string()))?;
        let numbers = piece.points.cast_into::<f64>().ok_or_else(|| fault("its points are no numbers".to_owned()))?;
        points.extend(numbers.chunks_exact(3).map(|x| [x[0], x[1]]));
    }
    Ok(points)
}

fn rows(path: &Path) -> Result<Vec<[f64; 2]>> {
    let text = std::fs::read_to_string(path)
        .map_err(|why| Error::at(Place::file(path), format!("cannot read the points: {why}"), REMEDY))?;
    let mut points = Vec::new();
    for (number, line) in text.lines().enumerate().filter(|(_, line)| !line.trim().is_empty()) {
        let words = line.split([',', ' ', '\t']).filter(|word| !word.is_empty());
        let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
        match numbers[..] {
            [x, y, ..] => points.push([x, y]),
            _ if number == 0 => {} // names of the columns
            _ => return Err(Error::at(Place::line(path, number + 1, 1), "this is not a point", "give x, y in m")),
        }
    }
    Ok(points)
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
    fn a_vtu_that_is_none_gives_one_message() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("points.vtu");
        for text in ["", "<VTKFile>", "<?xml version=\"1.0\"?><VTKFile type=\"PolyData\"></VTKFile>", "\u{0}\u{1}"] {
            std::fs::write(&path, text).unwrap();
            assert_eq!(read(&path).unwrap_err().exit_code(), 2, "{text}");
        }
    }
}
