//! Where the mesh comes from, and what names its groups.

use super::reader::Reader;
use super::tables;
use crate::error::Result;
use crate::registry::Values;
use serde::Serialize;
use std::path::PathBuf;

/// Where the mesh comes from.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Mesh {
    /// A file, as written in the scene ([`super::Scene::mesh_path`] resolves it).
    File(PathBuf),
    /// [0, size_1] x [0, size_2] with groups left, right, bottom, top and body.
    Rectangle {
        /// Edge lengths, in m.
        size: [f64; 2],
        /// Cells per direction.
        cells: [usize; 2],
    },
}

/// The keys of `[mesh]` that only VTU and XDMF files need.
pub(super) const KEYS: [&str; 3] = ["groups", "facets", "names"];

/// What names the groups of a mesh from a VTU or XDMF file; empty, where the scene does not say it.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct MeshGroups {
    /// The data at the cells that have the numbers of groups.
    pub data: Option<String>,
    /// The file of the lines, as written in the scene.
    pub facets: Option<PathBuf>,
    /// Names for numbers.
    pub names: Vec<GroupName>,
}

/// The name of a group by its number.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct GroupName {
    /// Whether it is a group of cells, and not of edges.
    pub is_of_cells: bool,
    /// The number in the file.
    pub number: usize,
    /// The name in the scene.
    pub name: String,
}

/// What `[mesh]` says.
///
/// # Errors
/// Keys that do not go together.
pub(super) fn mesh(table: &mut Reader) -> Result<(Mesh, MeshGroups)> {
    let values = table.values(tables::MESH)?;
    table.finish()?;
    let groups = groups(table, &values)?;
    let mesh = match (values.maybe_text("file"), values.table("rectangle")) {
        (Some(file), None) => Mesh::File(PathBuf::from(file)),
        (None, Some(rectangle)) => {
            let (size, cells) = crate::registry::grids::rectangle(rectangle);
            Mesh::Rectangle { size, cells }
        }
        (Some(_), Some(_)) => {
            return Err(table.wrong("rectangle", "[mesh] has both `file` and `rectangle`", "keep one of them"));
        }
        (None, None) => return Err(table.missing("file", "or rectangle = { size = [3.0, 3.0], cells = [30, 30] }")),
    };
    Ok((mesh, groups))
}

/// What `[mesh]` says of groups.
///
/// # Errors
/// A name without a number, or with two; keys of a file where there is none.
fn groups(table: &Reader, values: &Values) -> Result<MeshGroups> {
    if let Some(key) = KEYS.into_iter().find(|key| table.has(key) && !table.has("file")) {
        return Err(table.wrong(key, format!("`{key}` is for a mesh from a file"), "leave it out, or give `file`"));
    }
    let mut names = Vec::new();
    for entry in values.tables("names") {
        let (cells, edges) = (entry.maybe_integer("cells"), entry.maybe_integer("edges"));
        let (is_of_cells, number) = match (cells, edges) {
            (Some(cells), None) => (true, cells),
            (None, Some(edges)) => (false, edges),
            _ => {
                let what = format!(
                    "the name \"{}\" needs the number of a group of cells, or of one of edges",
                    entry.text("name")
                );
                return Err(table.wrong(
                    "names",
                    what,
                    "such as names = [{ cells = 1, name = \"steel\" }, { edges = 2, name = \"left\" }]",
                ));
            }
        };
        names.push(GroupName { is_of_cells, number, name: entry.text("name").to_owned() });
    }
    let facets = values.maybe_text("facets").map(PathBuf::from);
    Ok(MeshGroups { data: values.maybe_text("groups").map(str::to_owned), facets, names })
}
