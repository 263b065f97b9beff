//! The program `gmsh`, where a geometry is to be meshed in mid-run.

use crate::mesh::Mesh;
use std::path::{Path, PathBuf};
use std::process::Command;

/// What is wrong, and what would be right.
pub type Fault = (String, &'static str);

const REMEDY: &str = "give a .geo file that Gmsh meshes with quadrilaterals and named groups";

fn fault(what: impl ToString) -> Fault {
    (what.to_string(), REMEDY)
}

/// Whether there is a `gmsh` on the path.
pub fn is_installed() -> bool {
    Command::new("gmsh").arg("--version").output().is_ok()
}

/// Meshes a geometry; `size` gives the size of the cells (m) at X, on the cells of `now`.
///
/// # Errors
/// What Gmsh says, or that it is not there.
pub fn mesh(geometry: &Path, size: Option<&dyn Fn([f64; 2]) -> f64>, now: &Mesh) -> Result<Mesh, Fault> {
    let geometry = geometry.canonicalize().map_err(|why| fault(format!("{}: {why}", geometry.display())))?;
    let folder = std::env::temp_dir().join(format!("dgmpm-gmsh-{}", std::process::id()));
    std::fs::create_dir_all(&folder).map_err(|why| fault(format!("{}: {why}", folder.display())))?;
    let made = in_folder(&folder, &geometry, size, now);
    // What Gmsh left has no further use; a folder that stays does no harm.
    let _ = std::fs::remove_dir_all(&folder);
    made
}

fn in_folder(
    folder: &Path,
    geometry: &Path,
    size: Option<&dyn Fn([f64; 2]) -> f64>,
    now: &Mesh,
) -> Result<Mesh, Fault> {
    let (script, out) = (folder.join("regrid.geo"), folder.join("regrid.msh"));
    let mut text = format!("Merge \"{}\";\n", geometry.display());
    if let Some(size) = size {
        text += &size_field_script(&folder.join("size.pos"), size, now)?;
    }
    std::fs::write(&script, text).map_err(fault)?;
    let run = Command::new("gmsh").args(["-2", "-v", "1", "-format", "msh41", "-o"]).arg(&out).arg(&script).output();
    let run = run.map_err(|why| {
        let remedy =
            "install Gmsh (https://gmsh.info, or `pip install gmsh`) so that `gmsh` is on the path, or give `mesh`";
        (format!("cannot run `gmsh`: {why}"), remedy)
    })?;
    if !run.status.success() {
        let said = String::from_utf8_lossy(&run.stderr);
        return Err(fault(format!("gmsh failed ({}): {}", run.status, said.lines().next().unwrap_or_default())));
    }
    crate::io::read_mesh(&out).map_err(fault)
}

/// Writes the size field; the lines of a script that take it as the size of the cells.
fn size_field_script(field: &PathBuf, size: &dyn Fn([f64; 2]) -> f64, now: &Mesh) -> Result<String, Fault> {
    std::fs::write(field, size_field(size, now)).map_err(fault)?;
    Ok(format!(
        "Merge \"{}\";\nField[1] = PostView;\nField[1].ViewIndex = 0;\nBackground Field = 1;\n\
         Mesh.MeshSizeExtendFromBoundary = 0;\nMesh.MeshSizeFromPoints = 0;\n",
        field.display()
    ))
}

/// The size at the nodes of a mesh as a view of Gmsh: two triangles a cell.
fn size_field(size: &dyn Fn([f64; 2]) -> f64, mesh: &Mesh) -> String {
    let mut text = "View \"size\" {\n".to_owned();
    for cell in 0..mesh.cells.len() {
        let x = mesh.corners(cell);
        for [a, b, c] in [[0, 1, 2], [0, 2, 3]] {
            let [p, q, r] = [x[a], x[b], x[c]];
            let [s, t, u] = [p, q, r].map(size);
            text += &format!("ST({},{},0,{},{},0,{},{},0){{{s},{t},{u}}};\n", p[0], p[1], q[0], q[1], r[0], r[1]);
        }
    }
    text + "};\n"
}
