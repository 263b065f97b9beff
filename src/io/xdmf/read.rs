//! Grids of an XDMF file of meshio, DOLFINx or this program: numbers in HDF5 files beside it, or as text within it.
//!
//! A series in time stands for its first grid. No file makes this part panic, or take memory or time out of proportion to its bytes;
//! HDF5 files of other programs are read only where the user trusts them.

use std::cell::RefCell;
use std::collections::HashMap;
use std::path::{Component, Path};
use std::rc::Rc;

use super::{names, series::SERIES};
use crate::error::{Error, Place, Result};
use crate::io::hdf5::{Reader, Values};
use crate::io::unstructured::{Cells, Data, Part, Shape, of_mixed, of_xdmf};
use crate::io::xml::Element;

/// What a file must be, for messages.
pub const REMEDY: &str = "give an XDMF file with a mesh of quadrilaterals, its numbers in an HDF5 file beside it, as meshio and DOLFINx write it";

/// An XDMF file with the HDF5 files beside it that have been opened.
pub struct File<'a> {
    pub(super) path: &'a Path,
    readers: RefCell<HashMap<String, Rc<Reader>>>,
}

impl<'a> File<'a> {
    /// The file at this path, of which nothing is read yet.
    pub fn new(path: &'a Path) -> Self {
        Self { path, readers: RefCell::default() }
    }

    fn error(&self, what: impl Into<String>) -> Error {
        Error::at(Place::file(self.path), what, REMEDY)
    }

    /// All grids, by the root element of the document.
    ///
    /// # Errors
    /// What is wrong with the grids or with the HDF5 files beside it.
    pub fn parts<'b>(&'b self, root: &'b Element) -> Result<Vec<Part<'b>>> {
        let domain = root.child("Domain").ok_or_else(|| self.error("it has no `Domain`"))?;
        if domain.all("Grid").any(|grid| grid.attribute("Name") == Some(SERIES)) {
            let remedy = "give mesh.xdmf, which `dgmpm export` writes beside it";
            return Err(Error::at(
                Place::file(self.path),
                "this is a series of fields, whose cells have no nodes in common",
                remedy,
            ));
        }
        let mut grids = Vec::new();
        domain.all("Grid").for_each(|grid| collect(grid, &mut grids));
        grids.into_iter().filter(|grid| grid.child("Topology").is_some()).map(|grid| self.part(grid)).collect()
    }

    fn part<'b>(&'b self, grid: &'b Element) -> Result<Part<'b>> {
        let mut part = Part { name: grid.attribute("Name").unwrap_or_default().to_owned(), ..Part::default() };
        if let Some(geometry) = grid.child("Geometry") {
            part.points = Some(self.points(geometry)?);
        }
        if let Some(topology) = grid.child("Topology") {
            part.cells = self.cells(topology)?;
        }
        for data in grid.all("Attribute").filter(|data| data.attribute("Center") == Some("Cell")) {
            let Some(item) = data.child("DataItem") else { continue };
            let name = data.attribute("Name").unwrap_or_default().to_owned();
            let kind = item.attribute("NumberType").or_else(|| item.attribute("DataType"));
            // DOLFINx does not say the type of mesh tags; a grid with nothing else is one.
            let whole = kind.map_or(part.name == name, |kind| ["Int", "UInt", "Char", "UChar"].contains(&kind));
            part.data.push(Data { name, whole, values: Box::new(move || self.numbers(item)) });
        }
        if let Some(about) = grid.child("Information") {
            (part.names, part.facets) = names::read(about).map_err(|why| self.error(why))?;
        }
        Ok(part)
    }

    fn points(&self, geometry: &Element) -> Result<Vec<[f64; 3]>> {
        let kind = geometry.attribute("GeometryType").or_else(|| geometry.attribute("Type")).unwrap_or("XYZ");
        let numbers = |geometry: &Element| match geometry.child("DataItem") {
            Some(item) => self.numbers(item),
            None => Err(self.error("its geometry has no `DataItem`")),
        };
        let whole = |count: usize, size: usize| match count % size {
            0 => Ok(()),
            _ => {
                Err(self.error(format!("its geometry has {count} numbers, which are no points of {size} coordinates")))
            }
        };
        let values = numbers(geometry)?;
        match kind.to_ascii_uppercase().as_str() {
            "XY" => {
                whole(values.len(), 2).map(|()| values.as_chunks::<2>().0.iter().map(|&[x, y]| [x, y, 0.0]).collect())
            }
            "XYZ" => whole(values.len(), 3).map(|()| values.as_chunks::<3>().0.to_vec()),
            _ => Err(self.error(format!("its geometry is of the type `{kind}`; XY and XYZ can be read"))),
        }
    }

    fn cells(&self, topology: &Element) -> Result<Cells> {
        let kind = topology.attribute("TopologyType").or_else(|| topology.attribute("Type")).unwrap_or_default();
        let Some(item) = topology.child("DataItem") else { return Err(self.error("its topology has no `DataItem`")) };
        if kind.eq_ignore_ascii_case("Mixed") {
            return self.mixed(&self.nodes(item)?);
        }
        let Some((shape, size)) = of_xdmf(kind) else {
            return Err(self.error(format!("its topology is of the type `{kind}`, which is not known")));
        };
        let told = topology.attribute("NodesPerElement").and_then(|text| text.trim().parse().ok());
        let usual = if shape == Shape::Line { 2 } else { 1 };
        let size: usize = size.or(told).unwrap_or(usual).max(1);
        let (nodes, mut cells) = (self.nodes(item)?, Cells::default());
        if !nodes.len().is_multiple_of(size) {
            let what = format!("its topology has {} numbers, which are no cells of {size} nodes", nodes.len());
            return Err(self.error(what));
        }
        nodes.chunks_exact(size).for_each(|nodes| cells.push(shape, nodes, false));
        Ok(cells)
    }

    /// Cells each of which has its kind before its nodes.
    fn mixed(&self, all: &[u64]) -> Result<Cells> {
        let (mut cells, mut at) = (Cells::default(), 0);
        while at < all.len() {
            let unknown =
                || self.error(format!("cell {} (from 0) is of the kind {}, which is not known", cells.count, all[at]));
            let (shape, size) = of_mixed(all[at]).ok_or_else(unknown)?;
            let cut = || self.error(format!("its topology ends within cell {} (from 0)", cells.count));
            let (size, start) = match size {
                Some(size) => (size, at + 1),
                None => (all.get(at + 1).and_then(|&size| usize::try_from(size).ok()).ok_or_else(cut)?, at + 2),
            };
            let nodes = start.checked_add(size).and_then(|end| all.get(start..end)).ok_or_else(cut)?;
            at = start + size;
            cells.push(shape, nodes, false);
        }
        Ok(cells)
    }

    fn nodes(&self, item: &Element) -> Result<Vec<u64>> {
        let node = |x: f64| (x >= 0.0 && x.fract() == 0.0 && x < 9e15).then_some(x as u64);
        let nodes: Option<Vec<u64>> = self.numbers(item)?.into_iter().map(node).collect();
        nodes.ok_or_else(|| self.error("its topology has what is no number of a point"))
    }

    /// The numbers of an array.
    pub(super) fn numbers(&self, item: &Element) -> Result<Vec<f64>> {
        let text = std::str::from_utf8(&item.text).map_err(|_| self.error("an array is not UTF-8 text"))?;
        let kind = item.attribute("ItemType").unwrap_or("Uniform");
        if kind != "Uniform" || item.attribute("Reference").is_some() || !item.children.is_empty() {
            return Err(self.error("an array is made from other arrays, which is not done here"));
        }
        match item.attribute("Format").unwrap_or("XML") {
            "XML" => {
                let number = |word: &str| {
                    let short: String = word.chars().take(20).collect();
                    word.parse().map_err(|_| self.error(format!("`{short}` is not a number")))
                };
                text.split_ascii_whitespace().map(number).collect()
            }
            "HDF" => self.stored(text.trim()),
            other => Err(self.error(format!("its numbers are stored as `{other}`; HDF and XML can be read"))),
        }
    }

    /// The numbers of an array of an HDF5 file beside this one, by `file.h5:/path`.
    fn stored(&self, place: &str) -> Result<Vec<f64>> {
        let Some((name, within)) = place.rsplit_once(':') else {
            let short: String = place.chars().take(60).collect();
            return Err(self.error(format!("`{short}` is no place in an HDF5 file, such as `mesh.h5:/data0`")));
        };
        let values = self.reader(name)?.get_within(within)?.1;
        match values {
            Values::F64(values) => Ok(values),
            Values::I64(values) => Ok(values.into_iter().map(|x| x as f64).collect()),
            Values::U64(values) => Ok(values.into_iter().map(|x| x as f64).collect()),
            Values::Text(_) => Err(self.error(format!("`{place}` holds texts, not numbers"))),
        }
    }

    /// The HDF5 file of a name, opened once.
    fn reader(&self, name: &str) -> Result<Rc<Reader>> {
        if let Some(known) = self.readers.borrow().get(name) {
            return Ok(Rc::clone(known));
        }
        let path = beside(self.path, name).ok_or_else(|| {
            let what = format!("its numbers are in `{name}`, which is not in its folder; other files are not followed");
            Error::at(Place::file(self.path), what, "put both files into one folder")
        })?;
        let reader = Rc::new(Reader::open(&path, "give both files, the .xdmf and the .h5, as they were written")?);
        self.readers.borrow_mut().insert(name.to_owned(), Rc::clone(&reader));
        Ok(reader)
    }
}

/// The path of a file by its name in the folder of another; none where the name leads to another folder.
pub fn beside(path: &Path, name: &str) -> Option<std::path::PathBuf> {
    let mut parts = Path::new(name).components();
    let plain = matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None));
    plain.then(|| path.with_file_name(name))
}

/// The grids with cells, in their order; of a collection in time only the first.
fn collect<'a>(grid: &'a Element, all: &mut Vec<&'a Element>) {
    let kind = grid.attribute("GridType").or_else(|| grid.attribute("CollectionType")).unwrap_or("Uniform");
    if !["Collection", "Tree"].contains(&kind) {
        all.push(grid);
    } else if grid.attribute("CollectionType") == Some("Temporal") {
        grid.all("Grid").take(1).for_each(|grid| collect(grid, all));
    } else {
        grid.all("Grid").for_each(|grid| collect(grid, all));
    }
}
