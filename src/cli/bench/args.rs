//! Arguments of `dgmpm bench`.

use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// ader-dgmpm, ader-dgfem or rk-dgfem
    #[arg(long, value_name = "NAME", default_value = "ader-dgmpm")]
    pub method: String,
    /// Degree N = N_T
    #[arg(long, value_name = "N", default_value_t = 2)]
    pub degree: usize,
    /// Square cells per direction
    #[arg(long, value_name = "NX,NY", value_delimiter = ',', default_value = "32,32")]
    pub cells: Vec<usize>,
    /// Mesh file of a rectangle in place of --cells (with --all: measured beside squares)
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Layout of the points of ADER-DGMPM: paper, midpoints, gauss, jitter [default: that of the degree]
    #[arg(long, value_name = "NAME")]
    pub layout: Option<String>,
    /// Law, with the constants of the paper's steel
    #[arg(long, value_name = "NAME", default_value = "neo-hookean")]
    pub law: String,
    /// Instruction set: avx512, avx2 or portable [default: the widest of this processor]
    #[arg(long, value_name = "NAME")]
    pub kernel: Option<String>,
    /// Threads
    #[arg(long, value_name = "N", default_value_t = 1)]
    pub threads: usize,
    /// Steps to time [default: until the wave has run its way]
    #[arg(long, value_name = "N", conflicts_with = "seconds")]
    pub steps: Option<usize>,
    /// Seconds to step
    #[arg(long, value_name = "S", allow_negative_numbers = true)]
    pub seconds: Option<f64>,
    /// A further key of the scene, as often as needed: curl.control=off, scheme.flux=acoustic-curl
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// Print one line: method degree dofs steps cpu DoF-updates/s/core=.. L2err=..
    #[arg(long)]
    pub oneline: bool,
    /// Measure everything into this folder (table, pictures, CSV): some minutes, see `make bench`
    #[arg(long, value_name = "DIR", conflicts_with_all = ["oneline", "steps", "seconds", "sets"])]
    pub all: Option<PathBuf>,
}
