//! `dgmpm stability`: how perturbations of a state grow.

mod asked;
mod body;
mod files;
mod material;
mod scheme;

use super::print::answer;
use super::threads::start_threads;
use crate::error::Result;
use crate::stability::{Plan, lines, rows, values};

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    body: body::Body,
    #[command(flatten)]
    material: material::Material,
    #[command(flatten)]
    scheme: scheme::Scheme,
    #[command(flatten)]
    asked: asked::Asked,
    #[command(flatten)]
    files: files::Files,
    /// Threads [default: all processors]
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    args.threads.map_or(Ok(()), start_threads)?;
    let questions = args.asked.questions()?;
    args.files.check()?;
    let found = rows(&args.plan()?, questions, args.files.plot.is_some())?;
    lines(&found).iter().for_each(answer);
    args.files.write(&found)
}

impl Args {
    fn plan(&self) -> Result<Plan> {
        // The four numbers of a deformation are one value.
        let deformation = self.material.deformation.iter().map(|f| ("deformation".to_owned(), vec![f.clone()]));
        let mut lists: Vec<(String, Vec<String>)> = deformation.collect();
        let named = self.material.lists().into_iter().chain(self.scheme.lists());
        let given = named.filter_map(|(key, list)| Some(Ok((key, list.as_deref()?))));
        for list in given.chain(self.scheme.over()) {
            let (key, list) = list?;
            lists.push((key.trim().to_owned(), values(list)?));
        }
        let (domain, pattern) = (self.body.domain()?, self.material.pattern()?);
        Ok(Plan { domain, sets: self.body.sets.clone(), lists, pattern, semi_discrete: self.asked.semi_discrete })
    }
}
