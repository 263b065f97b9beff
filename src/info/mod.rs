//! `dgmpm info`: what a file of the pipeline holds.
//!
//! The first bytes of a file say what it is, whatever its name; only scenes and geometries, which begin in any way, go by their ending.

mod scene;
mod store;
mod table;
mod xml;

mod run;

use crate::error::{Error, Place, Result};
use crate::file;
use crate::format::{Row, row};
use crate::io::{hash, hdf5, read_mesh};
use crate::mesh::Mesh;
use crate::mesh::quality::Quality;
use serde_json::{Map, Value, json};
use std::io::Read;
use std::path::Path;

/// What a file or a folder holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Info {
    /// What it is, in words.
    pub kind: String,
    /// What is known of it: names in small letters with `_`, and values.
    pub facts: Vec<(String, Value)>,
}

/// The largest text that is looked at whole, bytes.
const LARGEST: u64 = 1 << 30;
/// Bytes that say what a file is.
const HEAD: u64 = 4096;

/// What can be read, for messages.
pub const READ: &str = "the files that can be read are: meshes of Gmsh (.msh), geometries (.geo), scenes (.toml), the .h5 files of dgmpm (mesh, \
                        cloud, operators, snapshot, checkpoint, export), tables (.csv), summary.json, meshes and exports of VTK, meshio and DOLFINx (.vtu, .pvd, .xdmf, .vtkhdf), and the \
                        folder of a run or of a study";

impl Info {
    /// With no facts yet.
    fn new(kind: impl Into<String>) -> Self {
        Self { kind: kind.into(), facts: Vec::new() }
    }

    /// With one more fact.
    fn with(mut self, name: &str, value: impl Into<Value>) -> Self {
        self.facts.push((name.to_owned(), value.into()));
        self
    }

    /// With one more fact, where it is known.
    fn maybe(self, name: &str, value: Option<impl Into<Value>>) -> Self {
        match value {
            Some(value) => self.with(name, value),
            None => self,
        }
    }

    /// Looks at a file or a folder.
    ///
    /// # Errors
    /// What cannot be read, or is none of the files of the program: a message that names those that are.
    pub fn of(path: &Path) -> Result<Self> {
        if path.is_dir() {
            return run::folder(path);
        }
        let fail = |why: String| Error::at(Place::file(path), format!("cannot be read: {why}"), READ);
        let about = file::about(path).map_err(fail)?;
        let mut head = Vec::new();
        let read = std::fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
        read.map_err(|why| fail(why.to_string()))?;
        let info = Self::by_content(path, &head)?.ok_or_else(|| {
            let what = if head.is_empty() { "the file is empty" } else { "this is no file of dgmpm or Gmsh" };
            Error::at(Place::file(path), what, READ)
        })?;
        Ok(info.with("bytes", about.len()))
    }

    fn by_content(path: &Path, head: &[u8]) -> Result<Option<Self>> {
        if hdf5::begins_as_hdf5(path) {
            return store::info(path).map(Some);
        }
        let ending = path.extension().map(|ending| ending.to_ascii_lowercase()).unwrap_or_default();
        if head.starts_with(b"$MeshFormat") {
            return of_mesh(path, head).map(Some);
        }
        if head.trim_ascii_start().starts_with(b"<") {
            return xml::info(path);
        }
        if ending == "toml" {
            return scene::info(path).map(Some);
        }
        let text = || {
            file::text(path, LARGEST)
                .map_err(|why| Error::at(Place::file(path), format!("cannot be read: {why}"), READ))
        };
        // Bytes that are no text are none of what follows.
        if std::str::from_utf8(head).is_err_and(|why| why.error_len().is_some()) {
            return Ok(None);
        }
        Ok(match () {
            () if ending == "geo" => {
                Some(Self::new("Gmsh geometry").with("next", "dgmpm new makes mesh and scene of it"))
            }
            () if head.trim_ascii_start().starts_with(b"{") => run::summary(&text()?),
            () => table::info(&text()?),
        })
    }

    /// As a table of two columns: names in words, values with their units.
    pub fn rows(&self) -> Vec<Row> {
        let head = row("kind", &self.kind);
        let all = self.facts.iter().flat_map(|(name, value)| {
            let label = name.replace('_', " ");
            match value {
                Value::Object(parts) => {
                    parts.iter().map(|(part, value)| row(format!("{label} `{part}`"), words(value))).collect()
                }
                value => vec![row(label, words(value))],
            }
        });
        std::iter::once(head).chain(all).collect()
    }

    /// As one object of JSON.
    pub fn json(&self) -> Value {
        let mut all = Map::from_iter([("kind".to_owned(), json!(self.kind))]);
        all.extend(self.facts.iter().cloned());
        Value::Object(all)
    }
}

/// A value in words.
fn words(value: &Value) -> String {
    match value {
        Value::String(text) => text.clone(),
        Value::Null => "none".to_owned(),
        Value::Bool(is) => if *is { "yes" } else { "no" }.to_owned(),
        Value::Array(all) if all.is_empty() => "none".to_owned(),
        Value::Array(all) => all.iter().map(words).collect::<Vec<_>>().join(", "),
        Value::Number(number) => match number.as_f64().filter(|_| number.is_f64()) {
            Some(x) if x != 0.0 && !(1e-3..1e6).contains(&x.abs()) => format!("{x:e}"),
            _ => number.to_string(),
        },
        Value::Object(parts) => {
            parts.iter().map(|(name, value)| format!("{name}: {}", words(value))).collect::<Vec<_>>().join(", ")
        }
    }
}

/// A mesh file of Gmsh.
fn of_mesh(path: &Path, head: &[u8]) -> Result<Info> {
    let version = head.split(|&byte| byte == b'\n').nth(1).unwrap_or_default();
    let version = String::from_utf8_lossy(version).into_owned();
    let mut words = version.split_whitespace();
    let (number, is_binary) = (words.next().unwrap_or("unknown").to_owned(), words.next() == Some("1"));
    let mesh = read_mesh(path)?;
    let info = Info::new("Gmsh mesh").with("version", number).with("binary", is_binary);
    Ok(mesh_facts(info, &mesh))
}

impl Info {
    /// Counts, sizes, quality and groups of a mesh.
    pub fn of_mesh(kind: &str, mesh: &Mesh) -> Self {
        mesh_facts(Self::new(kind), mesh)
    }
}

fn mesh_facts(info: Info, mesh: &Mesh) -> Info {
    let (quality, counts) = (Quality::of(mesh), mesh.edge_counts());
    let [low, high] = mesh.extent();
    let cells = |group: usize| mesh.cell_group.iter().filter(|&&g| g == group).count();
    let groups: Map<String, Value> =
        mesh.groups.iter().enumerate().map(|(group, name)| (name.clone(), json!(cells(group)))).collect();
    let edges = |k: usize| json!({ "boundary": counts[k].boundary, "inner": counts[k].inner });
    let edge_groups: Map<String, Value> =
        mesh.edge_groups.iter().enumerate().map(|(k, name)| (name.clone(), edges(k))).collect();
    info.with("nodes", mesh.nodes.len())
        .with("cells", mesh.cells.len())
        .with("x_from_to_m", json!([low[0], high[0]]))
        .with("y_from_to_m", json!([low[1], high[1]]))
        .with("area_m2", quality.area)
        .with("smallest_h_m", quality.smallest_h_e.0)
        .with("largest_h_m", quality.largest_h_e.0)
        .with("smallest_scaled_jacobian", quality.scaled_jacobian.0)
        .with("largest_aspect", quality.aspect.0)
        .with("cells_of", groups)
        .with("edges_of", edge_groups)
        .with("fingerprint", hash::of_places(mesh))
}
