//! `dgmpm seed`: material points into the cells of a mesh.

use super::args::SceneArgs;
use super::keep::keep_from;
use super::print::say;
use crate::cloud::Cloud;
use crate::error::Result;
use crate::format::count;
use crate::io::cloud_file;
use crate::problem::Files;
use std::collections::BTreeMap;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    /// Mesh file in place of the scene's
    #[arg(long, value_name = "FILE")]
    mesh: Option<PathBuf>,
    /// Where to write
    #[arg(long, value_name = "FILE", default_value = "cloud.h5")]
    out: PathBuf,
    /// Replace the file
    #[arg(long)]
    force: bool,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let scene = args.scene.load()?;
    let files = Files { mesh: args.mesh.clone(), cloud: None };
    keep_from(&args.out, args.force, &files.inputs(&scene))?;
    let mesh = files.mesh(&scene)?;
    let cloud = scene.build_cloud(&mesh)?;
    cloud_file::write_cloud(&args.out, &cloud, &mesh)?;
    report(&cloud);
    say(format!("written to {}", args.out.display()));
    Ok(())
}

/// Prints how many points the cells have.
pub fn report(cloud: &Cloud) {
    let mut classes = BTreeMap::new();
    cloud.first.windows(2).for_each(|w| *classes.entry(w[1] - w[0]).or_insert(0_usize) += 1);
    for (points, cells) in classes {
        say(format!("{} with {}", count(cells, "cell"), count(points, "point")));
    }
}
