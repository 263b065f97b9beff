//! What errors are taken against: the exact solution of the scene, or a finer run of a higher degree.

use super::case::{Case, Series, run, why};
use super::measure::Measure;
use super::richardson::order;
use crate::accuracy::{Errors, compare, errors};
use crate::cloud::Locator;
use crate::error::{Error, Result};
use crate::exact::Exact;
use crate::observe::Solution;
use crate::problem::Problem;
use crate::registry::Method;
use crate::run::Stop;
use crate::scene::Scene;
use crate::state::State;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

/// A solution that errors are taken against.
pub enum Reference {
    /// The exact one.
    Exact(Arc<dyn Exact>),
    /// A finer run.
    Run(Box<Finer>),
    /// None: only the quantities of the scene have errors.
    Nothing,
}

/// A finer run, and what is known of its own error.
pub struct Finer {
    built: Problem,
    state: State,
    case: Case,
    /// Its estimated errors, standard and in L1; none where it has no two coarser meshes to compare with.
    errors: Option<[f64; 2]>,
}

impl Finer {
    fn run(scene: &Scene, case: Case, interrupt: &AtomicBool) -> Result<Self> {
        let built = case.build(scene)?;
        let lost = |what: String| Error::input(what, "give another --reference DEGREE,REFINEMENT");
        match run(&built, interrupt) {
            Ok((state, ..)) => Ok(Self { built, state, case, errors: None }),
            Err(Stop::Unstable(loss)) if let Some(culprit) = built.culprit(&loss) => {
                let remedy = "give an expression that is finite at all places and times of the run";
                Err(scene.error(&culprit.key, format!("in the reference run: {}", culprit.what), remedy))
            }
            Err(stop @ (Stop::Unstable(_) | Stop::EnergyMade(_))) => {
                Err(lost(format!("the reference run lost stability: {}", why(&stop))))
            }
            Err(Stop::Output(why)) => Err(why),
            Err(Stop::Interrupted) => Err(Error::Interrupted("in the reference run of a study".into())),
        }
    }

    /// The errors of another solution of the scene, by quadrature in the cells of this one, which are the smaller.
    fn errors(&self, built: &Problem, state: &State) -> Errors {
        let own = Solution::of_state(&self.built.scheme, &self.state, &self.built.body.material);
        let other = Solution::of_state(&built.scheme, state, &built.body.material);
        let locator = Locator::new(&built.body.mesh);
        let order = own.basis.len() + 2;
        compare(&self.built.body.mesh, order, &|cell| own.law(cell), &|cell, xi, x| {
            let expected = own.at(cell, xi);
            // A point of the body that another mesh of it lacks would show as an error that is not a number.
            let nothing = ([f64::NAN; 4], [f64::NAN; 2], expected.history.clone());
            let found = locator.find(x).map_or(nothing, |(cell, xi)| {
                let point = other.at(cell, xi);
                (point.deformation, point.velocity, point.history)
            });
            [found, (expected.deformation, expected.velocity, expected.history)]
        })
    }
}

impl Reference {
    /// The exact solution of the scene, or else RK-DGFEM of this degree and refinement (which does not grow at high
    /// degrees, as ADER does), with an estimate of its own error: by the rate at which runs on meshes with about 2 and 4
    /// times its h come near it, or, where there are no two such meshes, by the distances to one and two degrees less.
    ///
    /// # Errors
    /// A reference that cannot run.
    pub fn new(scene: &Scene, degree: usize, refinement: f64, interrupt: &AtomicBool) -> Result<Self> {
        if let Some(exact) = scene.build_exact() {
            return Ok(Self::Exact(exact));
        }
        let case = |degree: usize, refinement: f64| {
            let series =
                Series { method: Method::RkDgfem, degree, time_degree: degree, layout: None, sets: Vec::new() };
            Case { series, refinement }
        };
        let mut finer = Finer::run(scene, case(degree, refinement), interrupt)?;
        let distance = |other: Case| -> Result<(f64, [f64; 2])> {
            let coarse = Finer::run(scene, other, interrupt)?;
            let cells = |built: &Problem| built.body.mesh.cells.len() as f64;
            let h = (cells(&finer.built) / cells(&coarse.built)).sqrt();
            let errors = finer.errors(&coarse.built, &coarse.state);
            Ok((h, [errors.standard, errors.standard_l1]))
        };
        let half = distance(case(degree, coarser(scene, refinement, 0.5)))?;
        let quarter = distance(case(degree, coarser(scene, refinement, 0.25)))?;
        finer.errors = if half.0 > 1.2 && quarter.0 > 1.2 * half.0 {
            Some([0, 1].map(|k| extrapolated((half.0, half.1[k]), (quarter.0, quarter.1[k]), degree)))
        } else if degree > 0 {
            let less = |by: usize| distance(case(degree - by, refinement)).map(|(_, distance)| distance);
            let one = less(1)?;
            let two = if degree > 1 { less(2)? } else { one };
            Some([0, 1].map(|k| by_degrees(one[k], two[k])))
        } else {
            None
        };
        Ok(Self::Run(Box::new(finer)))
    }

    /// The errors of a state; none without a reference.
    pub fn errors(&self, built: &Problem, state: &State) -> Option<Errors> {
        let Problem { body, scheme, .. } = built;
        match self {
            Self::Exact(exact) => Some(errors(exact.as_ref(), &body.mesh, scheme, state, &body.material)),
            Self::Run(finer) => Some(finer.errors(built, state)),
            Self::Nothing => None,
        }
    }

    /// The estimated errors of the reference itself, standard and in L1: 0 of an exact solution, none where they are not known.
    pub fn own_errors(&self) -> Option<[f64; 2]> {
        match self {
            Self::Exact(_) => Some([0.0; 2]),
            Self::Run(finer) => finer.errors,
            Self::Nothing => None,
        }
    }

    /// That by a measure; by the standard one for quantities.
    pub fn error(&self, measure: &Measure) -> Option<f64> {
        self.own_errors().map(|[standard, l1]| if *measure == Measure::L1 { l1 } else { standard })
    }

    /// What it is, in words.
    pub fn words(&self, measure: &Measure) -> String {
        match self {
            Self::Nothing => "nothing, as none was asked for".to_owned(),
            Self::Exact(_) => "the exact solution".to_owned(),
            Self::Run(finer) => {
                let own = match self.error(measure) {
                    Some(error) => format!("its own error is about {error:.1e}"),
                    None => "its own error is not known: the mesh has no coarser ones to compare with".to_owned(),
                };
                format!("{} on {} cells; {own}", finer.case.series.name(), finer.built.body.mesh.cells.len())
            }
        }
    }
}

/// The refinement of a coarser mesh: whole where the mesh is a file.
fn coarser(scene: &Scene, refinement: f64, share: f64) -> f64 {
    if scene.mesh_path().is_some() { (refinement * share).floor().max(1.0) } else { refinement * share }
}

/// The error e of a solution from the distances d_i = e (h_i^p - 1) of two coarser ones with h_i times its h; the rate p,
/// between that of a shock and N + 1, follows from their ratio.
fn extrapolated(half: (f64, f64), quarter: (f64, f64), degree: usize) -> f64 {
    half.1 / (half.0.powf(order(half, quarter, [0.25, degree as f64 + 1.0])) - 1.0)
}

/// The error e of a solution from the distances to those of one and two degrees less, if errors fall by one factor r a degree: these are
/// e (1/r - 1) and e (1/r^2 - 1). Where it is not seen to fall by half, the first distance stands for it.
fn by_degrees(one: f64, two: f64) -> f64 {
    let r = one / (two - one);
    if (0.0..0.5).contains(&r) { one * r / (1.0 - r) } else { one }
}

#[cfg(test)]
mod tests {
    use super::{by_degrees, extrapolated};

    #[test]
    fn the_error_of_the_reference_follows_from_two_smaller_degrees_where_it_falls() {
        for r in [0.01, 0.1, 0.4] {
            let error = 1e-5;
            let found = by_degrees(error * (1.0 / r - 1.0), error * (1.0 / (r * r) - 1.0));
            // Exact data: rounding.
            assert!((found / error - 1.0).abs() < 1e-12, "{r}: {found:e}");
        }
        // A shock; degree 1, which has one degree below it; a degree that is farther away by chance.
        for two in [1.8e-3, 1e-3, 0.5e-3] {
            assert_eq!(by_degrees(1e-3, two), 1e-3);
        }
    }

    #[test]
    fn the_error_of_the_reference_follows_from_two_coarser_runs() {
        for (degree, p) in [(1, 2.0), (3, 3.7), (4, 0.5)] {
            let error = 1e-4;
            let at = |h: f64| (h, error * (f64::powf(h, p) - 1.0));
            for (half, quarter) in [(2.0, 4.0), (1.5, 3.0)] {
                let found = extrapolated(at(half), at(quarter), degree);
                // Exact data: rounding of a bisection.
                assert!((found / error - 1.0).abs() < 1e-9, "{degree} {p}: {found:e}");
            }
        }
    }
}
