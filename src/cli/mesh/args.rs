//! Arguments of `dgmpm mesh`.

use super::groups::Groups;
use super::to::To;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
#[command(args_conflicts_with_subcommands = true, arg_required_else_help = true)]
pub struct Args {
    #[command(subcommand)]
    pub action: Option<Action>,
    /// Gmsh file (MSH 2.2 or 4.1), .vtu or .xdmf file of another program, or a mesh.h5
    pub file: Option<PathBuf>,
    #[command(flatten)]
    pub groups: Groups,
    #[command(flatten)]
    pub to: To,
}

/// What is done besides an import.
#[derive(Debug, clap::Subcommand)]
pub enum Action {
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
        /// Gmsh, .vtu or .xdmf file, or a mesh.h5
        file: PathBuf,
        #[command(flatten)]
        groups: Groups,
    },
}
