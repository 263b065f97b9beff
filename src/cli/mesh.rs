//! `dgmpm mesh`: import, make, inspect.

use super::args::keep;
use super::print::{note, row, say, table};
use crate::error::{Error, Result};
use crate::io::{gmsh, mesh_file, read_mesh};
use crate::mesh::parts::EdgeCount;
use crate::mesh::{Link, Mesh, links, quality::Quality, rectangle};
use crate::problem::notices;
use std::path::{Path, PathBuf};

/// Arguments.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    action: Option<Action>,
    /// Gmsh file (MSH 2.2 or 4.1), or a mesh.h5
    file: Option<PathBuf>,
    #[command(flatten)]
    to: To,
}

#[derive(Debug, clap::Args)]
struct To {
    /// Where to write: .h5, or .msh for Gmsh [default: the input's name with .h5, or rectangle.h5]
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
    /// Replace the file
    #[arg(long)]
    force: bool,
}

#[derive(Debug, clap::Subcommand)]
enum Action {
    /// Make [0, W] x [0, H] with groups left, right, bottom, top and body
    Rectangle {
        /// Edge lengths W,H in m
        #[arg(long, value_name = "W,H", value_delimiter = ',', allow_hyphen_values = true, required = true)]
        size: Vec<f64>,
        /// Cells per direction NX,NY
        #[arg(long, value_name = "NX,NY", value_delimiter = ',', required = true)]
        cells: Vec<usize>,
        #[command(flatten)]
        to: To,
    },
    /// Print counts, groups, sizes and quality
    Info {
        /// Gmsh file or mesh.h5
        file: PathBuf,
    },
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    match (&args.action, &args.file) {
        (Some(Action::Info { file }), _) => {
            let (mesh, links) = load(file)?;
            info(&mesh, &links);
            Ok(())
        }
        (Some(Action::Rectangle { size, cells, to }), _) => {
            let pair = |what| Error::input(format!("{what} wants two numbers"), "for example --size 3,3 --cells 30,30");
            let size = size[..].try_into().map_err(|_| pair("--size"))?;
            let cells = cells[..].try_into().map_err(|_| pair("--cells"))?;
            let mesh = rectangle(size, cells)?;
            let links = links(&mesh)?;
            write(&mesh, &links, to, Path::new("rectangle.h5"))
        }
        (None, Some(file)) => {
            let (mesh, links) = load(file)?;
            write(&mesh, &links, &args.to, &file.with_extension("h5"))
        }
        (None, None) => Err(Error::input("no mesh is named", "give a Gmsh file, or `rectangle`, or `info FILE`")),
    }
}

/// A mesh whose boundary is wholly tagged, with what lies behind its faces.
fn load(file: &Path) -> Result<(Mesh, Vec<[Link; 4]>)> {
    let mesh = read_mesh(file)?;
    let links = links(&mesh)?;
    Ok((mesh, links))
}

fn write(mesh: &Mesh, links: &[[Link; 4]], to: &To, default: &Path) -> Result<()> {
    let out = to.out.as_deref().unwrap_or(default);
    keep(out, to.force)?;
    if out.extension().is_some_and(|ending| ending == "msh") {
        gmsh::write(mesh, out)?;
    } else {
        mesh_file::write_mesh(out, mesh)?;
    }
    info(mesh, links);
    say(format!("written to {}", out.display()));
    Ok(())
}

fn info(mesh: &Mesh, links: &[[Link; 4]]) {
    let (quality, counts) = (Quality::of(mesh), mesh.edge_counts());
    let (jacobian, worst) = quality.scaled_jacobian;
    let mut rows = vec![
        row("nodes", mesh.nodes.len().to_string()),
        row("cells", mesh.cells.len().to_string()),
        row("boundary edges", counts.iter().map(|count| count.boundary).sum::<usize>().to_string()),
        row("area", format!("{:.6e} m^2", quality.area)),
        row("h_e", format!("{:.4e} .. {:.4e} m", quality.smallest_h_e.0, quality.largest_h_e.0)),
        row("smallest h_e in", format!("cell {}", mesh.number(quality.smallest_h_e.1))),
        row("smallest scaled Jacobian", format!("{jacobian:.4} in cell {}", mesh.number(worst))),
        row("mean scaled Jacobian", format!("{:.4}", quality.mean_scaled_jacobian)),
        row("largest aspect", format!("{:.3} in cell {}", quality.aspect.0, mesh.number(quality.aspect.1))),
    ];
    for (group, name) in mesh.groups.iter().enumerate() {
        let count = mesh.cell_group.iter().filter(|&&g| g == group).count();
        rows.push(row(format!("cells of `{name}`"), count.to_string()));
    }
    for (name, EdgeCount { inner, boundary }) in mesh.edge_groups.iter().zip(counts) {
        let text = match (inner, boundary) {
            (0, _) => boundary.to_string(),
            (_, 0) => format!("{inner}, all inside of the body"),
            _ => format!("{}, {inner} of them inside of the body", inner + boundary),
        };
        rows.push(row(format!("edges of `{name}`"), text));
    }
    table(&rows);
    notices::of_mesh(mesh, links).iter().for_each(note);
}
