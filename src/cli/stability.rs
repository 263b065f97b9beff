//! `dgmpm stability`: how perturbations of a state grow.

use super::print::say;
use crate::chart;
use crate::error::{Error, Result};
use crate::io::pending::write_text;
use crate::scene::Scene;
use crate::stability::{self, Domain, Pattern, Plan, Questions, Row, csv, lines, measure, values};
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Scene of a small body [default: a patch of squares without end, by Bloch angles]
    scene: Option<PathBuf>,
    /// Override a key of the scene, as often as needed
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
    /// A body of so many unit squares in place of a patch
    #[arg(long, value_name = "NX,NY", value_delimiter = ',', conflicts_with = "scene")]
    body: Vec<usize>,
    /// Conditions of its sides: one kind, or left,right,bottom,top
    #[arg(long, value_name = "KIND,..", value_delimiter = ',', default_value = "free", requires = "body")]
    boundary: Vec<String>,
    /// The state F0 [default: the initial one of the scene, else 1,0,0,1]
    #[arg(long, value_name = "F11,F12,F21,F22", allow_hyphen_values = true)]
    deformation: Option<String>,
    /// Constitutive law [default: neo-hookean]
    #[arg(long, value_name = "NAME")]
    law: Option<String>,
    /// Young's modulus [default: 1]
    #[arg(long, value_name = "E")]
    young: Option<String>,
    /// Poisson's ratio [default: 0.3]
    #[arg(long, value_name = "NU")]
    poisson: Option<String>,
    /// Density [default: 1]
    #[arg(long, value_name = "RHO")]
    density: Option<String>,
    /// Two materials: ratio of their Young's moduli
    #[arg(long, value_name = "RATIO", conflicts_with = "scene")]
    contrast: Option<String>,
    /// Where the stiffer one is: checkerboard, or halves
    #[arg(long, value_name = "NAME", default_value = "checkerboard")]
    pattern: String,
    /// Methods [default: that of the scene; rk-dgfem without one]
    #[arg(long, value_name = "NAME,..")]
    method: Option<String>,
    /// Degrees N = N_T
    #[arg(long, value_name = "N,..")]
    degree: Option<String>,
    /// Layouts of the points of ADER-DGMPM
    #[arg(long, value_name = "NAME,..")]
    layout: Option<String>,
    /// Fluxes
    #[arg(long, value_name = "NAME,..")]
    flux: Option<String>,
    /// Controls of the curl
    #[arg(long, value_name = "NAME,..")]
    curl: Option<String>,
    /// Shares of the stability limit
    #[arg(long, value_name = "C,..", conflicts_with = "dt")]
    safety: Option<String>,
    /// Steps, as dt c / h
    #[arg(long, value_name = "C,..")]
    dt: Option<String>,
    /// Values of a further key: poisson=.3,.45,.4999, f11=.7,.9,1, curl.alpha=1,3
    #[arg(long, value_name = "KEY=V,..")]
    over: Vec<String>,
    /// The limit dt -> 0 in place of a step
    #[arg(long)]
    semi_discrete: bool,
    /// Look for the largest stable step, too
    #[arg(long)]
    limit: bool,
    /// Growth of the largest number over 1, 10 and 100 steps, too
    #[arg(long)]
    norms: bool,
    /// Bloch angles a direction
    #[arg(long, value_name = "N", default_value_t = 12)]
    angles: usize,
    /// Write all numbers into a CSV file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Plot growth over the last list of numbers (svg or png)
    #[arg(long, value_name = "FILE")]
    plot: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    force: bool,
    /// Threads [default: all processors]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    args.threads.map_or(Ok(()), super::threads::start_threads)?;
    if args.angles < 2 {
        return Err(Error::input(format!("--angles is {}", args.angles), "give a number from 2"));
    }
    let questions = Questions { angles: args.angles, limit: args.limit, norms: args.norms };
    for path in [&args.csv, &args.plot].into_iter().flatten() {
        if path.exists() && !args.force {
            return Err(Error::input(
                format!("{} exists", path.display()),
                "give --force to replace it, or another name",
            ));
        }
    }
    let cases = args.plan()?.cases()?;
    if args.plot.is_some() {
        stability::axis(&cases)?;
    }
    let mut rows = Vec::new();
    for case in cases {
        let found = measure(&case.setup, questions)?;
        rows.push(Row { case, found });
    }
    lines(&rows).iter().for_each(say);
    args.csv.as_ref().map_or(Ok(()), |path| write_text(path, &csv(&rows)))?;
    args.plot.as_ref().map_or(Ok(()), |path| chart::save(&stability::chart(&rows)?, path))?;
    Ok(())
}

impl Args {
    fn plan(&self) -> Result<Plan> {
        let mut lists = Vec::new();
        if let Some(f) = &self.deformation {
            lists.push(("deformation".to_owned(), vec![f.clone()]));
        }
        let named = [
            ("law", &self.law),
            ("young", &self.young),
            ("poisson", &self.poisson),
            ("density", &self.density),
            ("contrast", &self.contrast),
            ("method", &self.method),
            ("degree", &self.degree),
            ("layout", &self.layout),
            ("flux", &self.flux),
            ("curl", &self.curl),
            ("safety", &self.safety),
            ("dt", &self.dt),
        ];
        for (key, text) in named {
            if let Some(text) = text {
                lists.push((key.to_owned(), values(text)?));
            }
        }
        for text in &self.over {
            let remedy = "write --over poisson=.3,.45,.4999";
            let (key, list) =
                text.split_once('=').ok_or_else(|| Error::input(format!("--over is `{text}`"), remedy))?;
            lists.push((key.trim().to_owned(), stability::values(list)?));
        }
        let pattern = match &self.pattern[..] {
            "checkerboard" => Pattern::Checkerboard,
            "halves" => Pattern::Halves,
            other => {
                let what = format!("there is no pattern `{other}`");
                return Err(Error::input(what, "give checkerboard or halves"));
            }
        };
        let (sets, semi_discrete) = (self.sets.clone(), self.semi_discrete);
        Ok(Plan { domain: self.domain()?, sets, lists, contrast: 1.0, pattern, courant: None, semi_discrete })
    }

    fn domain(&self) -> Result<Domain> {
        if let Some(path) = &self.scene {
            return Ok(Domain::Scene(Box::new(Scene::load(path, &self.sets)?)));
        }
        let kinds = match &self.boundary[..] {
            [one] => [one, one, one, one].map(String::clone),
            [a, b, c, d] => [a, b, c, d].map(String::clone),
            _ => return Err(Error::input("--boundary is no list", "give one kind, or left,right,bottom,top")),
        };
        match self.body[..] {
            [] => Ok(Domain::Patch),
            [nx, ny] if nx > 0 && ny > 0 => Ok(Domain::Body([nx, ny], kinds)),
            _ => Err(Error::input("--body is not NX,NY", "give two numbers from 1, such as 12,1")),
        }
    }
}
