//! Meshes from files of any kind that is read. What a file is, its first bytes tell, and not its name alone.

use super::seal::{self, Seal};
use super::unstructured::{Part, Source, Tags, assemble};
use super::{gmsh, mesh_file, regular, store, vtu, xdmf, xml};
use crate::error::{Error, Place, Result};
use crate::file::memory;
use crate::mesh::Mesh;
use std::io::Read;
use std::path::{Path, PathBuf};

/// The files that can be read as meshes, for messages.
pub const FORMATS: &str = "give a .msh of Gmsh (4.1 or 2.2; a .geo must be meshed first: `gmsh -2 case.geo`), a .vtu, an .xdmf with its .h5, or \
                           the .h5 of `dgmpm mesh`";

/// What a VTU file must be, for messages.
const VTU: &str =
    "give an unstructured grid of quadrilaterals, as text, base64 or appended, not compressed or by zlib or LZMA";

/// Bytes at the start of a file by which its kind is told.
const HEAD: u64 = 4096;

/// What a file is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Store,
    Gmsh,
    Vtu,
    Xdmf,
}

/// Reads a mesh of any kind.
///
/// # Errors
/// Bad input, with its place.
pub fn read_mesh(path: &Path) -> Result<Mesh> {
    read_tagged(path, &Tags::default())
}

/// Reads a mesh of any kind; `tags` say what names its groups in a VTU or XDMF file.
///
/// # Errors
/// Bad input, with its place; tags for a file that has names of groups itself.
pub fn read_tagged(path: &Path, tags: &Tags) -> Result<Mesh> {
    let kind = kind_of(path)?;
    if let Some(xdmf) = numbers_of(path, kind) {
        return read_tagged(&xdmf, tags);
    }
    if matches!(kind, Kind::Store | Kind::Gmsh) && *tags != Tags::default() {
        let what = "the groups of this file have their names in it";
        return Err(Error::at(
            Place::file(path),
            what,
            "leave out groups, facets and names: they are for VTU and XDMF files",
        ));
    }
    match kind {
        Kind::Store => mesh_file::read_mesh(path),
        Kind::Gmsh => Ok(gmsh::parse(&bytes(path)?).map_err(|why| why.in_file(path))?.with_common_axes()),
        Kind::Vtu | Kind::Xdmf => grids(path, kind, |parts| read_beside(path, parts, tags)),
    }
}

/// Whether the groups of a mesh have their names in its file, so that it takes no [`Tags`].
///
/// # Errors
/// A file that is not there, or of no format that is known.
pub fn has_own_names(path: &Path) -> Result<bool> {
    let kind = kind_of(path)?;
    Ok(matches!(kind, Kind::Store | Kind::Gmsh) && numbers_of(path, kind).is_none())
}

/// Reads the mesh of the bytes of a VTU or XDMF file, as if they were a file of this path. No bytes make it panic, or allocate out of
/// proportion to them.
///
/// # Errors
/// Bad input, with its place.
pub fn parse(bytes: &[u8], path: &Path, tags: &Tags) -> Result<Mesh> {
    let kind = told_by(&bytes[..bytes.len().min(HEAD as usize)]);
    let kind = kind.filter(|kind| matches!(kind, Kind::Vtu | Kind::Xdmf)).ok_or_else(|| unknown(path, bytes))?;
    grids_of(bytes, path, kind, |parts| read_beside(path, parts, tags))
}

/// The mesh of the grids of a file, and of those of the file of the lines.
fn read_beside(path: &Path, parts: Vec<Part>, tags: &Tags) -> Result<Mesh> {
    let source = Source { path };
    let own = parts.iter().find_map(|part| part.facets.as_deref()).and_then(|name| xdmf::beside(path, name));
    let Some(facets) = tags.facets.clone().or(own) else { return assemble(parts, vec![], tags, &source) };
    if !facets.exists() {
        let what = format!("the file {} with the groups of its edges is not there", facets.display());
        return Err(source.error(what, "put it there, or name it: `facets` in [mesh] of the scene, or --facets"));
    }
    let kind = kind_of(&facets)?;
    if !matches!(kind, Kind::Vtu | Kind::Xdmf) {
        let remedy = "give the .xdmf or .vtu file that has lines with the numbers of their groups";
        return Err(Error::at(Place::file(&facets), "the groups of edges are not read from such a file", remedy));
    }
    grids(&facets, kind, |lines| assemble(parts, lines, tags, &source))
}

/// The XDMF file whose numbers an HDF5 file has: one beside it, where the file is no store of this program.
fn numbers_of(path: &Path, kind: Kind) -> Option<PathBuf> {
    let xdmf = path.with_extension("xdmf");
    let is_foreign = kind == Kind::Store && path.is_file() && !store::is_store(path);
    (is_foreign && kind_of(&xdmf).ok() == Some(Kind::Xdmf)).then_some(xdmf)
}

/// Hands on the grids of a file.
fn grids<T>(path: &Path, kind: Kind, then: impl FnOnce(Vec<Part>) -> Result<T>) -> Result<T> {
    grids_of(&bytes(path)?, path, kind, then)
}

fn grids_of<T>(bytes: &[u8], path: &Path, kind: Kind, then: impl FnOnce(Vec<Part>) -> Result<T>) -> Result<T> {
    check_seal(bytes, path)?;
    if kind == Kind::Vtu {
        let fault = |why: String| Error::at(Place::file(path), format!("cannot read the mesh: {why}"), VTU);
        return then(vec![vtu::part(bytes, &fault).map_err(fault)?]);
    }
    let fault = |why: String| Error::at(Place::file(path), format!("cannot read the mesh: {why}"), xdmf::REMEDY);
    let (file, root) = (xdmf::File::new(path), xml::parse(bytes).map_err(fault)?);
    let parts = file.parts(&root)?;
    then(parts)
}

/// Refuses a text of this program that was changed.
fn check_seal(bytes: &[u8], path: &Path) -> Result<()> {
    match seal::check_text(bytes) {
        Seal::Broken => {
            let what = "the file is damaged: its bytes are not those that were written";
            Err(Error::at(Place::file(path), what, "export it again; if you have changed it, remove its last line"))
        }
        _ => Ok(()),
    }
}

/// All bytes of a VTU or XDMF file that is whole.
///
/// # Errors
/// A file that cannot be read or was changed.
pub(super) fn whole(path: &Path) -> Result<Vec<u8>> {
    let bytes = bytes(path)?;
    check_seal(&bytes, path)?;
    Ok(bytes)
}

/// All bytes of a file that fits into memory.
fn bytes(path: &Path) -> Result<Vec<u8>> {
    let most = memory::available() as u64;
    regular::bytes(path, most)
        .map_err(|why| Error::at(Place::file(path), format!("the mesh cannot be read: {why}"), FORMATS))
}

/// What a file is.
pub(super) fn kind_of(path: &Path) -> Result<Kind> {
    let fault = |why: String| Error::at(Place::file(path), format!("the mesh cannot be read: {why}"), FORMATS);
    regular::about(path).map_err(fault)?;
    let mut head = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(HEAD).read_to_end(&mut head));
    read.map_err(|why| fault(why.to_string()))?;
    check_no_series(path, &head)?;
    if store::is_meant_as_store(path) {
        return Ok(Kind::Store);
    }
    told_by(&head).ok_or_else(|| unknown(path, &head))
}

/// Refuses series for ParaView, which are no meshes, with what takes their place.
fn check_no_series(path: &Path, head: &[u8]) -> Result<()> {
    let is_list =
        xml::root(head).is_some_and(|(name, kind)| name == "VTKFile" && kind.as_deref() == Some("Collection"));
    let is_vtkhdf = path.extension().is_some_and(|ending| ending == "vtkhdf");
    let what = match () {
        () if is_list => "this is a .pvd file: a list of the .vtu files of a series, and no mesh",
        () if is_vtkhdf => "this is a VTKHDF file, which is not read as a mesh",
        () => return Ok(()),
    };
    let of_run = "of a run of dgmpm give its mesh.h5, or a grid_<step>.vtu of `dgmpm export`";
    let own = if is_list { "give one of the .vtu files that it names" } else { "save it as .vtu" };
    Err(Error::at(Place::file(path), what, format!("{own}; {of_run}. Else {FORMATS}")))
}

/// What a file is by its first bytes.
fn told_by(head: &[u8]) -> Option<Kind> {
    if head.trim_ascii_start().starts_with(b"$") {
        return Some(Kind::Gmsh);
    }
    match xml::root(head)?.0.as_str() {
        "VTKFile" => Some(Kind::Vtu),
        "Xdmf" => Some(Kind::Xdmf),
        _ => None,
    }
}

/// The message about a file that is none of those that are read.
fn unknown(path: &Path, head: &[u8]) -> Error {
    let text = head.trim_ascii_start();
    let what = match () {
        () if head.is_empty() => "the file is empty".to_owned(),
        () if text.starts_with(b"# vtk DataFile") => "this is a VTK file of the legacy format".to_owned(),
        () => match xml::root(head) {
            Some((name, _)) => format!("this is an XML file with the root `{name}`, and no mesh"),
            None => "this is no mesh of a format that is known".to_owned(),
        },
    };
    Error::at(Place::file(path), what, FORMATS)
}
