//! The program `gmsh`, where a geometry is to be meshed in mid-run.

use crate::io::regular;
use crate::io::seal::{self, Seal};
use crate::mesh::Mesh;
use std::path::Path;
use std::process::Command;

/// What is wrong, and what would be right.
pub type Fault = (String, &'static str);

const REMEDY: &str = "give a .geo file that is there, and that Gmsh meshes with quadrilaterals and named groups";

fn fault(what: impl ToString) -> Fault {
    (what.to_string(), REMEDY)
}

/// Whether there is a `gmsh` on the path.
pub fn is_installed() -> bool {
    Command::new("gmsh").arg("--version").output().is_ok()
}

/// Meshes a geometry; `size` gives the size of the cells (m) at X, on the cells of `now`.
///
/// A geometry is a program: Gmsh runs what it says, with the rights of the user. Its name goes to Gmsh as one argument, and never
/// into a script or to a shell.
///
/// # Errors
/// What Gmsh says, or that it is not there; a geometry that is damaged.
pub fn mesh(geometry: &Path, size: Option<&dyn Fn([f64; 2]) -> f64>, now: &Mesh) -> Result<Mesh, Fault> {
    let geometry = geometry.canonicalize().map_err(|why| fault(format!("{}: {why}", geometry.display())))?;
    look(&geometry)?;
    // A folder that only this user can look into, and whose name nobody can know before.
    let folder = tempfile::Builder::new().prefix("dgmpm-gmsh-").tempdir().map_err(fault)?;
    in_folder(folder.path(), &geometry, size, now)
}

/// Meshes a geometry as it says; where that gives other cells than quadrilaterals, once more with Gmsh's options that leave no others.
/// Also whether these options were needed.
///
/// # Errors
/// As for [`mesh`].
pub fn first_mesh(geometry: &Path) -> Result<(Mesh, bool), Fault> {
    let geometry = geometry.canonicalize().map_err(|why| fault(format!("{}: {why}", geometry.display())))?;
    look(&geometry)?;
    let folder = tempfile::Builder::new().prefix("dgmpm-gmsh-").tempdir().map_err(fault)?;
    let run = |more: &[&str]| {
        let out = folder.path().join("first.msh");
        let mut gmsh = command(folder.path(), &geometry, &out);
        gmsh.args(more);
        let said = run(gmsh)?;
        read(&out, &geometry, &said)
    };
    match run(&[]) {
        Ok(mesh) => Ok((mesh, false)),
        // What the file itself gives is what its message is about.
        Err(why) => run(&QUADRILATERALS).map(|mesh| (mesh, true)).map_err(|_| why),
    }
}

/// Options by which Gmsh makes quadrilaterals of whatever it meshes, and cuts the triangles that are left into three.
const QUADRILATERALS: [&str; 6] =
    ["-setnumber", "Mesh.RecombineAll", "1", "-setnumber", "Mesh.SubdivisionAlgorithm", "1"];

/// Whether a geometry is a text file, and as it was written.
///
/// # Errors
/// Why it is not.
pub fn look(geometry: &Path) -> Result<(), Fault> {
    let text = regular::text(geometry, LARGEST).map_err(|why| fault(format!("{}: {why}", geometry.display())))?;
    match seal::check_text(text.as_bytes()) {
        Seal::Broken => {
            let what = format!("{} is damaged: its bytes are not those that were written", geometry.display());
            Err((what, "if you have changed it, remove its last line, which has the hash"))
        }
        Seal::Whole | Seal::None => Ok(()),
    }
}

/// Bytes of the largest geometry.
const LARGEST: u64 = 1 << 30;

fn in_folder(
    folder: &Path,
    geometry: &Path,
    size: Option<&dyn Fn([f64; 2]) -> f64>,
    now: &Mesh,
) -> Result<Mesh, Fault> {
    let out = folder.join("regrid.msh");
    let mut gmsh = command(folder, geometry, &out);
    if let Some(size) = size {
        write_size_field(folder, size, now)?;
        gmsh.arg(SCRIPT);
    }
    let said = run(gmsh)?;
    read(&out, geometry, &said)
}

/// The mesh that Gmsh has made of a geometry. Gmsh ends with success where it has found errors, which are in `said`.
fn read(out: &Path, geometry: &Path, said: &str) -> Result<Mesh, Fault> {
    crate::io::read_mesh(out).map_err(|why| match said {
        // The file of the mesh is gone when somebody reads the message.
        "" => fault(why.to_string().replace(&*out.to_string_lossy(), &format!("the mesh of {}", geometry.display()))),
        said => fault(format!("gmsh made no mesh of {}: {said}", geometry.display())),
    })
}

/// Gmsh, from a geometry to a mesh of its surfaces.
fn command(folder: &Path, geometry: &Path, out: &Path) -> Command {
    let mut gmsh = Command::new("gmsh");
    gmsh.current_dir(folder).args(["-2", "-v", "1", "-format", "msh41", "-o"]).arg(out).arg(geometry);
    gmsh
}

/// Runs Gmsh to its end; its first word on an error, empty where it has found none.
fn run(mut gmsh: Command) -> Result<String, Fault> {
    let run = gmsh.output().map_err(|why| {
        let remedy =
            "install Gmsh (https://gmsh.info, or `pip install gmsh`) so that `gmsh` is on the path, or give a mesh";
        (format!("cannot run `gmsh`: {why}"), remedy)
    })?;
    let said = String::from_utf8_lossy(&run.stderr);
    let error = said.lines().find(|line| line.contains("rror"));
    if run.status.success() {
        return Ok(error.map_or(String::new(), |line| line.trim().to_owned()));
    }
    let line = error.or(said.lines().next()).unwrap_or_default();
    Err(fault(format!("gmsh failed ({}): {line}", run.status)))
}

/// The script that takes the size field as the size of the cells.
const SCRIPT: &str = "size.geo";

/// Writes the size field, and the script for it.
fn write_size_field(folder: &Path, size: &dyn Fn([f64; 2]) -> f64, now: &Mesh) -> Result<(), Fault> {
    let script = "Merge \"size.pos\";\nField[1] = PostView;\nField[1].ViewIndex = 0;\nBackground Field = 1;\n\
                  Mesh.MeshSizeExtendFromBoundary = 0;\nMesh.MeshSizeFromPoints = 0;\n";
    std::fs::write(folder.join("size.pos"), size_field(size, now)).map_err(fault)?;
    std::fs::write(folder.join(SCRIPT), script).map_err(fault)
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
