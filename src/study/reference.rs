//! What errors are taken against: the exact solution of the scene, or a finer run of a higher degree.

use super::case::{Built, Case, Series};
use crate::cloud::Locator;
use crate::error::{Error, Result};
use crate::exact::{Errors, Exact, compare, errors};
use crate::observe::Solution;
use crate::run::Stop;
use crate::scene::{Method, Scene};
use crate::state::State;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A solution that errors are taken against.
pub enum Reference {
    /// The exact one.
    Exact(Arc<dyn Exact>),
    /// A finer run.
    Run(Box<Finer>),
}

/// A finer run, and what is known of its own error.
pub struct Finer {
    built: Built,
    state: State,
    case: Case,
    /// Its estimated standard error; none where it has no two coarser meshes to compare with.
    error: Option<f64>,
}

impl Finer {
    fn run(scene: &Scene, case: Case, interrupt: &AtomicBool) -> Result<Self> {
        let built = case.build(scene)?;
        let lost = |what: String| Error::input(what, "give another --reference DEGREE,REFINEMENT");
        match built.run(interrupt) {
            Ok((state, _)) => Ok(Self { built, state, case, error: None }),
            Err(Stop::Unstable(loss)) => Err(lost(format!("the reference run lost stability: {}", loss.kind))),
            Err(Stop::Output(why)) => Err(why),
            Err(Stop::Interrupted) => Err(Error::Interrupted("in the reference run of a study".into())),
        }
    }

    /// The errors of another solution of the scene, by quadrature in the cells of this one, which are the smaller.
    fn errors(&self, built: &Built, state: &State) -> Errors {
        let own = Solution::of_state(&self.built.scheme, &self.state, &self.built.material);
        let other = Solution::of_state(&built.scheme, state, &built.material);
        let locator = Locator::new(&built.mesh);
        let order = own.basis.len() + 2;
        compare(&self.built.mesh, order, &|cell| own.law(cell), &|cell, xi, x| {
            let expected = own.at(cell, xi);
            // A point of the body that another mesh of it lacks would show as an error that is not a number.
            let nothing = ([f64::NAN; 4], [f64::NAN; 2]);
            let found = locator.find(x).map_or(nothing, |(cell, xi)| {
                let point = other.at(cell, xi);
                (point.deformation, point.velocity)
            });
            [found, (expected.deformation, expected.velocity)]
        })
    }
}

impl Reference {
    /// The exact solution of the scene, or else RK-DGFEM of this degree and refinement (which does not grow at high
    /// degrees, as ADER does), with an estimate of its own error from runs on meshes with 2 and 4 times its h.
    ///
    /// # Errors
    /// A reference that cannot run.
    pub fn new(scene: &Scene, degree: usize, refinement: f64, interrupt: &AtomicBool) -> Result<Self> {
        if let Some(exact) = scene.build_exact() {
            return Ok(Self::Exact(exact));
        }
        let series = Series { method: Method::RkDgfem, degree, layout: None };
        let mut finer = Finer::run(scene, Case { series: series.clone(), refinement }, interrupt)?;
        let distance = |share: f64| -> Result<Option<f64>> {
            let case = Case { series: series.clone(), refinement: refinement * share };
            let coarse = Finer::run(scene, case, interrupt)?;
            let same = coarse.built.mesh.cells.len() >= finer.built.mesh.cells.len();
            Ok((!same).then(|| finer.errors(&coarse.built, &coarse.state).standard))
        };
        if let (Some(half), Some(quarter)) = (distance(0.5)?, distance(0.25)?) {
            // Differences to the reference: (2^p - 1) and (4^p - 1) of its error at rate p; their ratio is 2^p + 1.
            let rate = (quarter / half - 1.0).max(0.0).log2().clamp(0.25, degree as f64 + 1.0);
            finer.error = Some(half / (rate.exp2() - 1.0));
        }
        Ok(Self::Run(Box::new(finer)))
    }

    /// The errors of a state.
    pub fn errors(&self, built: &Built, state: &State) -> Errors {
        match self {
            Self::Exact(exact) => errors(exact.as_ref(), &built.mesh, &built.scheme, state, &built.material),
            Self::Run(finer) => finer.errors(built, state),
        }
    }

    /// The estimated standard error of the reference itself: 0 of an exact solution, none where it is not known.
    pub fn error(&self) -> Option<f64> {
        match self {
            Self::Exact(_) => Some(0.0),
            Self::Run(finer) => finer.error,
        }
    }

    /// What it is, in words.
    pub fn words(&self) -> String {
        match self {
            Self::Exact(_) => "the exact solution".to_owned(),
            Self::Run(finer) => {
                let own = match finer.error {
                    Some(error) => format!("its own error is about {error:.1e}"),
                    None => "its own error is not known: the mesh has no coarser ones to compare with".to_owned(),
                };
                format!("{} on {} cells; {own}", finer.case.series.name(), finer.built.mesh.cells.len())
            }
        }
    }
}
