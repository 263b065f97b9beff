//! The mesh that a first scene is made for, `dgmpm new`: a mesh file as it is, or a geometry that Gmsh meshes.

use super::draft::{draft, tagged};
use super::notices;
use crate::error::{Error, Place, Result};
use crate::format::count;
use crate::io::{gmsh, read_mesh};
use crate::mesh::{Mesh, links};
use crate::scene::Scene;
use std::path::{Component, Path, PathBuf};

/// A mesh, and where it is or goes.
pub struct First {
    /// The mesh.
    pub mesh: Mesh,
    /// The file that the scene names.
    pub path: PathBuf,
    /// Whether it has to be written there.
    pub is_new: bool,
    /// What is worth knowing of it.
    pub notes: Vec<String>,
}

impl First {
    /// Reads a mesh file, or has Gmsh mesh a geometry (.geo). Edges of the boundary that are in no group get one; such a mesh, and
    /// that of a geometry, is new.
    ///
    /// # Errors
    /// A file that cannot be read; Gmsh where it is not there or fails.
    pub fn read(path: &Path) -> Result<Self> {
        let is_geometry = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("geo"));
        let (mesh, recombined) = match is_geometry {
            true => {
                gmsh::program::first_mesh(path).map_err(|(what, remedy)| Error::at(Place::file(path), what, remedy))?
            }
            false => (read_mesh(path)?, false),
        };
        let (mesh, named) = tagged(mesh).map_err(|why| why.or_at(Place::file(path)))?;
        let mut notes = Vec::new();
        if recombined {
            notes.push(
                "the geometry gives no mesh of quadrilaterals alone: Gmsh has recombined and cut its cells (Mesh.RecombineAll = 1, \
                 Mesh.SubdivisionAlgorithm = 1), which halves their size"
                    .to_owned(),
            );
        }
        if named > 0 {
            let group = mesh.edge_groups.last().map_or("", String::as_str);
            let edges = count(named, "edge");
            notes.push(format!("{edges} of the boundary are in no physical curve: the scene calls them \"{group}\""));
        }
        let is_new = is_geometry || named > 0;
        let to = match (is_geometry, is_new) {
            (true, _) => path.with_extension("msh"),
            (false, true) => path.with_file_name(format!("{}_named.msh", stem(path))),
            (false, false) => path.to_owned(),
        };
        Ok(Self { mesh, path: to, is_new, notes })
    }

    /// The text of a scene for it that stands in the file `scene`, checked, and more that is worth knowing.
    ///
    /// # Errors
    /// A mesh without a boundary.
    pub fn scene(&self, scene: &Path) -> Result<(String, Vec<String>)> {
        let text = draft(&self.mesh, &relative(&self.path, scene))?.text();
        Scene::parse(&text, scene, &[])?.check_mesh(&self.mesh)?;
        Ok((text, notices::of_mesh(&self.mesh, &links(&self.mesh)?)))
    }
}

fn stem(path: &Path) -> String {
    path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
}

/// The path of a file as a scene names it: from the folder of the scene.
fn relative(file: &Path, scene: &Path) -> String {
    let full = |path: &Path| std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let (file, scene) = (full(file), full(scene));
    let folder = scene.parent().unwrap_or(Path::new("/"));
    let [to, from] = [&file, folder].map(|path| path.components().collect::<Vec<Component>>());
    let same = to.iter().zip(&from).take_while(|(a, b)| a == b).count();
    let up = std::iter::repeat_n("..".to_owned(), from.len() - same);
    let down = to[same..].iter().map(|part| part.as_os_str().to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_scene_names_its_mesh_from_its_own_folder() {
        let name = |file: &str, scene: &str| relative(Path::new(file), Path::new(scene));
        assert_eq!(name("a/plate.msh", "a/plate.toml"), "plate.msh");
        assert_eq!(name("plate.msh", "scenes/deep/plate.toml"), "../../plate.msh");
        assert_eq!(name("/m/plate.msh", "/m/s/x.toml"), "../plate.msh");
    }
}
