//! VTKHDF: a whole time series in one HDF5 file, for VTK from 9.3 and ParaView from 5.12 on (Debian 12 has ParaView 5.11).
//!
//! The format 2.0 of VTK for an unstructured grid in time: the arrays of all times stand behind each other, and the group `Steps`
//! says where those of each time begin. What does not change (the grid between two regrids, certificates of cells) is stored once.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use hdf5_metno as h5;
use hdf5_metno::types::FixedAscii;
use hdf5_metno::{H5Type, Hyperslab};
use ndarray::{ArrayView1, ArrayView2};

use super::grid::{Field, HighOrderGrid, PointCloud, check_fields};
use super::hdf5::{self, CHUNK_BYTES, DEFLATE_LEVEL};
use super::pending::Pending;
use super::provenance::Provenance;
use super::seal;
use super::vtu::{VERTEX, kind_of_grid};
use crate::error::{Error, Result};

/// The version of the format.
const VERSION: [i64; 2] = [2, 0];

/// A series that is being written; its file appears at [`Series::finish`].
pub struct Series {
    path: PathBuf,
    pending: Pending,
    root: h5::Group,
    file: h5::File,
    /// The arrays that grow from time to time, by their names.
    arrays: BTreeMap<String, Growing>,
    /// What stands last in an array: its hash, and where it begins.
    last: BTreeMap<String, (blake3::Hash, usize)>,
    parts: usize,
    times: Vec<f64>,
    /// Where each time begins, by the name of the array in `Steps`.
    begins: BTreeMap<String, Vec<i64>>,
}

/// Points, and cells of one kind that own as many of them each, one behind the other.
struct Shape<'a> {
    points: &'a [[f64; 3]],
    nodes: usize,
    kind: u8,
}

/// An array that grows by rows.
struct Growing {
    dataset: h5::Dataset,
    rows: usize,
    /// Numbers of a row; 0 where the array has one dimension.
    width: usize,
}

impl Series {
    /// Starts a series.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn create(path: &Path) -> Result<Self> {
        let pending = Pending::new(path)?;
        let begin = || -> h5::Result<(h5::File, h5::Group)> {
            let file = hdf5::open_new(pending.path())?;
            let root = file.create_group("VTKHDF")?;
            root.new_attr::<i64>().shape(VERSION.len()).create("Version")?.write_raw(&VERSION)?;
            // VTK reads a text of ASCII with just these bytes.
            let kind =
                FixedAscii::<16>::from_ascii("UnstructuredGrid").map_err(|e| h5::Error::from(&*e.to_string()))?;
            root.new_attr::<FixedAscii<16>>().create("Type")?.write_scalar(&kind)?;
            Ok((file, root))
        };
        let (file, root) = begin().map_err(|e| Error::output(path, hdf5::reason(&e)))?;
        let (arrays, last, begins) = Default::default();
        Ok(Self { path: path.to_owned(), pending, root, file, arrays, last, parts: 0, times: Vec::new(), begins })
    }

    /// Says where the states come from and where points are, as attributes of the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn label(&self, from: &Provenance, positions: &str) -> Result<()> {
        from.label(&self.file, positions).map_err(|e| self.failed(&e))
    }

    /// Adds a grid with its fields at a time, s.
    ///
    /// # Errors
    /// Fields that do not fit the grid, or differ from those of the time before; a file that cannot be written.
    pub fn push_grid(&mut self, time: f64, grid: &HighOrderGrid) -> Result<()> {
        grid.check()?;
        let shape = Shape { points: &grid.points, nodes: grid.nodes_per_cell(), kind: kind_of_grid(grid.degree) };
        self.push(time, &shape, &grid.point_fields, &grid.cell_fields)
    }

    /// Adds points with their fields at a time, s.
    ///
    /// # Errors
    /// As [`Series::push_grid`].
    pub fn push_points(&mut self, time: f64, cloud: &PointCloud) -> Result<()> {
        cloud.check()?;
        self.push(time, &Shape { points: &cloud.points, nodes: 1, kind: VERTEX }, &cloud.fields, &[])
    }

    fn push(&mut self, time: f64, shape: &Shape, point_fields: &[Field], cell_fields: &[Field]) -> Result<()> {
        let cells = shape.points.len() / shape.nodes;
        check_fields(point_fields, shape.points.len())?;
        check_fields(cell_fields, cells)?;
        self.put_shape(shape, cells).map_err(|e| self.failed(&e))?;
        for (section, fields) in [("PointData", point_fields), ("CellData", cell_fields)] {
            for field in fields {
                let width = if field.kind.components() == 1 { 0 } else { field.kind.components() };
                let at = self.put(&format!("{section}/{}", field.name), width, &field.values);
                let at = at.map_err(|e| self.failed(&e))?;
                self.begins_at(&format!("{section}Offsets/{}", field.name), at);
            }
        }
        self.times.push(time);
        // A field that is not there at all times would have fewer beginnings than there are times.
        match self.begins.iter().find(|(_, begins)| begins.len() != self.times.len()) {
            Some((name, _)) => {
                let name = name.rsplit('/').next().unwrap_or(name);
                let what = format!("the field `{name}` is not there at all times, which a VTKHDF file cannot express");
                Err(Error::input(what, "export this run by --format vtu, or run it again with this field at all times"))
            }
            None => Ok(()),
        }
    }

    /// The points and cells of a time: those of the time before where they are the same.
    fn put_shape(&mut self, shape: &Shape, cells: usize) -> h5::Result<()> {
        let points = shape.points.as_flattened();
        let is_same = self.last.get("Points").is_some_and(|(hash, _)| *hash == hash_of(points));
        if !is_same {
            self.put("Points", 3, points)?;
            let whole = |numbers: &mut dyn Iterator<Item = usize>| numbers.map(|k| k as i64).collect::<Vec<_>>();
            // Each part has its own, although those of equal grids are equal: a part is read by one number of its cells.
            for (name, values) in [
                ("NumberOfPoints", vec![shape.points.len() as i64]),
                ("NumberOfCells", vec![cells as i64]),
                ("NumberOfConnectivityIds", vec![shape.points.len() as i64]),
                ("Connectivity", whole(&mut (0..shape.points.len()))),
                ("Offsets", whole(&mut (0..=cells).map(|cell| cell * shape.nodes))),
            ] {
                self.append(name, 0, &values)?;
            }
            self.append("Types", 0, &vec![shape.kind; cells])?;
            self.parts += 1;
        }
        let rows = |name: &str| self.arrays.get(name).map_or(0, |array| array.rows);
        let first_point = rows("Points") - shape.points.len();
        let begins = [
            ("PartOffsets", self.parts - 1),
            ("NumberOfParts", 1),
            ("PointOffsets", first_point),
            ("CellOffsets", rows("Types") - cells),
            ("ConnectivityIdOffsets", rows("Connectivity") - shape.points.len()),
        ];
        begins.into_iter().for_each(|(name, at)| self.begins_at(name, at));
        Ok(())
    }

    fn begins_at(&mut self, name: &str, at: usize) {
        self.begins.entry(name.to_owned()).or_default().push(at as i64);
    }

    /// Appends values, unless they stand last in their array; returns the row where they begin.
    fn put(&mut self, name: &str, width: usize, values: &[f64]) -> h5::Result<usize> {
        let hash = hash_of(values);
        if let Some((_, at)) = self.last.get(name).filter(|(last, _)| *last == hash) {
            return Ok(*at);
        }
        let at = self.append(name, width, values)?;
        self.last.insert(name.to_owned(), (hash, at));
        Ok(at)
    }

    /// Appends values to an array; returns the row where they begin.
    fn append<T: H5Type>(&mut self, name: &str, width: usize, values: &[T]) -> h5::Result<usize> {
        if !self.arrays.contains_key(name) {
            self.arrays.insert(name.to_owned(), Growing::new::<T>(&self.root, name, width)?);
        }
        self.arrays.get_mut(name).map_or(Ok(0), |array| array.append(values))
    }

    fn failed(&self, error: &h5::Error) -> Error {
        Error::output(&self.path, hdf5::reason(error))
    }

    /// Finishes the file and gives it its name.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn finish(self) -> Result<()> {
        let Self { path, pending, root, file, arrays, times, begins, .. } = self;
        let end = || -> h5::Result<()> {
            drop(arrays);
            let steps = root.create_group("Steps")?;
            steps.new_attr::<i64>().create("NSteps")?.write_scalar(&(times.len() as i64))?;
            hdf5::put(&steps, "Values", &[times.len()], &times)?;
            for (name, begins) in &begins {
                // Those of cells and of the connectivity have a column for each kind of topology, of which an unstructured grid has one.
                let of_topology = ["CellOffsets", "ConnectivityIdOffsets"].contains(&&name[..]);
                let shape = if of_topology { vec![begins.len(), 1] } else { vec![begins.len()] };
                hdf5::put(&steps, name, &shape, begins)?;
            }
            drop((steps, root));
            file.flush().and_then(|()| file.close())
        };
        end().map_err(|e| Error::output(&path, hdf5::reason(&e)))?;
        seal::put(pending.path()).map_err(|e| Error::output(&path, e))?;
        pending.commit()
    }
}

impl Growing {
    fn new<T: H5Type>(root: &h5::Group, name: &str, width: usize) -> h5::Result<Self> {
        let rows = (CHUNK_BYTES / (width.max(1) * size_of::<T>())).max(1);
        let mut builder = root.new_dataset::<T>().obj_track_times(false).create_intermediate_group(true);
        builder = if width == 0 { builder.chunk(rows) } else { builder.chunk((rows, width)) };
        if h5::filters::deflate_available() {
            builder = builder.shuffle().deflate(DEFLATE_LEVEL);
        }
        let dataset = match width {
            0 => builder.shape(0..).create(name)?,
            width => builder.shape((0.., width)).create(name)?,
        };
        Ok(Self { dataset, rows: 0, width })
    }

    fn append<T: H5Type>(&mut self, values: &[T]) -> h5::Result<usize> {
        let from = self.rows;
        self.rows += values.len() / self.width.max(1);
        if self.width == 0 {
            self.dataset.resize(self.rows)?;
            self.dataset.write_slice(ArrayView1::from(values), Hyperslab::from(from..self.rows))?;
        } else {
            self.dataset.resize((self.rows, self.width))?;
            let shape = (self.rows - from, self.width);
            let rows = ArrayView2::from_shape(shape, values).map_err(|e| h5::Error::from(&*e.to_string()))?;
            self.dataset.write_slice(rows, Hyperslab::from((from..self.rows, 0..self.width)))?;
        }
        Ok(from)
    }
}

fn hash_of(values: &[f64]) -> blake3::Hash {
    let mut hasher = blake3::Hasher::new();
    for x in values {
        hasher.update(&x.to_le_bytes());
    }
    hasher.finalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::grid::Kind;

    #[test]
    fn a_field_that_is_not_there_at_all_times_is_bad_input_with_what_takes_its_place() {
        let folder = tempfile::tempdir().unwrap();
        let cloud = |names: &[&str]| PointCloud {
            points: vec![[0.0; 3]],
            fields: names.iter().map(|name| Field::new(*name, Kind::Scalar, vec![1.0])).collect(),
            about: String::new(),
        };
        for (first, second) in [(&["a", "b"][..], &["a"][..]), (&["a"], &["a", "b"])] {
            let mut series = Series::create(&folder.path().join("points.vtkhdf")).unwrap();
            series.push_points(0.0, &cloud(first)).unwrap();
            let why = series.push_points(1.0, &cloud(second)).unwrap_err();
            assert!(
                why.exit_code() == 2 && why.to_string().contains("the field `b` is not there at all times"),
                "{why}"
            );
            assert!(why.to_string().contains("--format vtu"), "{why}");
        }
    }
}
