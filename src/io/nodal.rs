//! Numbers at the nodes of a grid of quadrilaterals, as VTU and XDMF files of other programs have them.

use super::grid::{Field, Kind};
use super::import::{self, Kind as Format};
use super::unstructured::{AtNodes, OWN, Source, nodal};
use super::{vtu, xdmf, xml};
use crate::error::{Error, Place, Result};
use crate::mesh::Mesh;
use std::path::Path;

/// A grid with numbers at its nodes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Nodal {
    /// Nodes and cells, without groups of edges; the nodes are all those of the file, in its order.
    pub mesh: Mesh,
    /// What stands at the nodes.
    pub data: Vec<AtNodes>,
}

/// What a file must be, for messages.
pub const REMEDY: &str =
    "give a .vtu, or an .xdmf with its .h5, that has quadrilaterals with four nodes and data at these nodes";

/// Reads a grid of bilinear quadrilaterals with the data at its nodes. A series in time is read at one of its `time`s, in s, or else at the
/// last one.
///
/// # Errors
/// A file that cannot be read, cells of another kind, a time that the file does not have.
pub fn read(path: &Path, time: Option<f64>) -> Result<Nodal> {
    let fault = |what: String| Error::at(Place::file(path), what, REMEDY);
    let source = Source { path };
    match import::kind_of(path)? {
        Format::Vtu => {
            if let Some(time) = time {
                let what = format!("a VTU file has one time only, and that at {time} s is asked for");
                return Err(Error::at(Place::file(path), what, "leave out `fields_time`, or give an XDMF series"));
            }
            let bytes = import::whole(path)?;
            let part = vtu::part(&bytes, &fault).map_err(fault)?;
            let (mesh, mut data) = (nodal(vec![part], &source)?, vtu::at_nodes(&bytes).map_err(fault)?);
            // A file may have points twice in a piece.
            data.retain(|data| mesh.nodes.len().checked_mul(data.components) == Some(data.values.len()));
            Ok(Nodal { mesh, data })
        }
        Format::Xdmf => {
            let bytes = import::whole(path)?;
            let root = xml::parse(&bytes).map_err(fault)?;
            if xdmf::is_own_series(&root) {
                let what = "this is a series of fields of dgmpm, which are no bilinear fields on cells";
                return Err(Error::at(Place::file(path), what, OWN));
            }
            let file = xdmf::File::new(path);
            let mesh = nodal(file.parts(&root)?, &source)?;
            let data = file.at_nodes(&root, mesh.nodes.len(), time)?;
            Ok(Nodal { mesh, data })
        }
        _ => Err(fault("it is no VTU or XDMF file".to_owned())),
    }
}

/// Writes fields at the nodes of a mesh as a VTU file, which [`read`] reads with the same bits.
///
/// # Errors
/// A file that cannot be written.
pub fn write(path: &Path, mesh: &Mesh, fields: &[Field]) -> Result<()> {
    let points: Vec<[f64; 3]> = mesh.nodes.iter().map(|&[x, y]| [x, y, 0.0]).collect();
    vtu::write_nodal(path, &points, &mesh.cells, fields)
}

/// A vector of the plane at each node as a field.
pub fn vector(name: &str, values: &[[f64; 2]]) -> Field {
    Field::new(name, Kind::Vector, values.iter().flat_map(|&[x, y]| [x, y, 0.0]).collect())
}

/// A tensor of the plane at each node as a field, with 1 at the place 33.
pub fn tensor(name: &str, values: &[[f64; 4]]) -> Field {
    let row = |&[a, b, c, d]: &[f64; 4]| [a, b, 0.0, c, d, 0.0, 0.0, 0.0, 1.0];
    Field::new(name, Kind::Tensor, values.iter().flat_map(row).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::rectangle;

    fn file(folder: &Path) -> std::path::PathBuf {
        let mesh = rectangle([1.0, 0.5], [2, 1]).unwrap();
        let path = folder.join("a.vtu");
        let v: Vec<[f64; 2]> = mesh.nodes.iter().map(|&[x, y]| [x / 3.0, -y]).collect();
        let f: Vec<[f64; 4]> = mesh.nodes.iter().map(|&[x, y]| [1.0, x, y / 7.0, 1.0]).collect();
        write(&path, &mesh, &[vector("v", &v), tensor("F", &f)]).unwrap();
        path
    }

    #[test]
    fn what_is_written_comes_back_bit_for_bit_and_what_is_changed_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = file(folder.path());
        let found = read(&path, None).unwrap();
        let mesh = rectangle([1.0, 0.5], [2, 1]).unwrap();
        assert_eq!((&found.mesh.nodes, &found.mesh.cells), (&mesh.nodes, &mesh.cells));
        let [v, f] = &found.data[..] else { panic!("{found:?}") };
        assert_eq!((&v.name[..], v.components, &f.name[..], f.components), ("v", 3, "F", 9));
        let last = mesh.nodes[mesh.nodes.len() - 1];
        assert_eq!(v.values[15..], [last[0] / 3.0, -last[1], 0.0]);
        assert_eq!(f.values[45..], [1.0, last[0], 0.0, last[1] / 7.0, 1.0, 0.0, 0.0, 0.0, 1.0]);
        let text = std::fs::read_to_string(&path).unwrap().replace("RangeMax=\"1\"", "RangeMax=\"2\"");
        std::fs::write(&path, text).unwrap();
        assert!(read(&path, None).unwrap_err().to_string().contains("the file is damaged"));
    }

    #[test]
    fn no_cut_of_a_file_and_no_points_that_stand_twice_make_the_reader_panic() {
        let folder = tempfile::tempdir().unwrap();
        let path = file(folder.path());
        let text = std::fs::read_to_string(&path).unwrap();
        // Without its seal.
        let text = &text[..=text.rfind("</VTKFile>").unwrap() + 9];
        for end in 0..text.len() - 10 {
            std::fs::write(&path, &text[..end]).unwrap();
            if let Ok(found) = read(&path, None) {
                assert!(found.data.iter().all(|data| data.values.len() == data.components * found.mesh.nodes.len()));
            }
        }
        let at = text.find("<Points>").unwrap();
        let end = text.find("</Points>").unwrap() + 9;
        std::fs::write(&path, [&text[..end], &text[at..end], &text[end..]].concat()).unwrap();
        // Twice as many points as there are values.
        assert_eq!(read(&path, None).unwrap().data, []);
    }
}
