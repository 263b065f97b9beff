//! The numbers of a case.

use super::angles::{self, At};
use super::assemble::{Assembler, Differences, Operator};
use super::cases::no_step;
use super::energy::Energy;
use super::norms;
use super::operator::Rate;
use super::{Problem, Setup};
use crate::error::{Error, Result};
use crate::format::count;
use crate::scene::Scene;

/// A step is stable if its spectral radius is at most 1 and this, by degree: twice what ADER of degree 4, 5, 6 grows by at
/// any step ([`crate::step::cfl::growth`]); RK of these degrees with the projection of F grows by up to 5e-6 far below its limit.
const TOLERANCE: [f64; 7] = [1e-6, 1e-6, 1e-6, 1e-6, 8e-6, 6e-5, 1.6e-4];
/// Tangents of an unloaded law have eigenvalues 0 to the rounding of their differences, over rho0 c_p^2.
const DEFINITE: f64 = 1e-9;
/// A step so much below the known limit shows the growth of the state alone.
const SMALL: f64 = 0.05;
/// dt c/h from which the search begins where no limit is known.
const UNKNOWN_LIMIT: f64 = 0.1;
/// The limit is found to this part.
const RESOLUTION: f64 = 1e-3;
/// Most unknowns of a body: the matrix is full, and its eigenvalues take minutes.
const MOST_UNKNOWNS: usize = 4000;

/// What is asked.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Questions {
    /// Bloch angles a direction.
    pub angles: usize,
    /// Whether the largest stable step is looked for.
    pub limit: bool,
    /// Whether the growth of the largest number over some steps is computed.
    pub norms: bool,
}

/// The settings of a case, by their names in scenes.
#[derive(Debug, Clone, PartialEq)]
pub struct Names {
    /// Method.
    pub method: String,
    /// N.
    pub degree: usize,
    /// Layout of the points, where the method has points.
    pub layout: Option<String>,
    /// Flux.
    pub flux: String,
    /// Control of the curl.
    pub curl: String,
}

impl Names {
    fn of(scene: &Scene) -> Self {
        Self {
            method: scene.scheme.method.name().to_owned(),
            degree: scene.scheme.degree,
            layout: scene.scheme.method.has_points().then(|| scene.materials[0].cloud.layout.name().to_owned()),
            flux: scene.scheme.flux.name().to_owned(),
            curl: scene.curl.name().to_owned(),
        }
    }
}

/// The largest stable step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Limit {
    /// dt c/h, 0 where none is found.
    pub courant: f64,
    /// Whether the state grows at steps however small, by what counts as growth at `courant`: no larger step grows more than twice
    /// as fast.
    pub grows: bool,
}

/// What was found.
#[derive(Debug, Clone, PartialEq)]
pub struct Measured {
    /// The settings.
    pub names: Names,
    /// Cells of the body; of a patch those of its unit.
    pub cells: usize,
    /// Rows of the matrix.
    pub unknowns: usize,
    /// dt c/h with the largest speed c of the state; none in the limit dt -> 0.
    pub courant: Option<f64>,
    /// Largest growth rate, c_p/h with c_p of the unloaded law: ln(spectral radius) / dt, or the largest real part.
    pub growth: f64,
    /// Spectral radius of a step.
    pub radius: Option<f64>,
    /// The angles of the largest growth of a patch.
    pub theta: Option<[f64; 2]>,
    /// The largest stable dt c/h.
    pub limit: Option<Limit>,
    /// The most that energy can gain, c_p/h, see [`super::Energy`].
    pub energy: f64,
    /// Whether the energy product is definite or at least not negative.
    pub definite: bool,
    /// Growth of the largest number over 1, 10 and 100 steps.
    pub norms: Option<[f64; 3]>,
    /// What entries of the matrix are off by, c_p/h.
    pub noise: f64,
}

/// Builds and measures a case.
///
/// # Errors
/// Bad input; a body that is too large; a question about a step in the limit dt -> 0.
pub fn measure(setup: &Setup, questions: Questions) -> Result<Measured> {
    match setup.semi_discrete {
        true if setup.courant.is_some() => return Err(no_step("--dt")),
        true if questions.limit => return Err(no_step("--limit")),
        _ => {}
    }
    let problem = setup.build()?;
    let cells = problem.columns();
    let of_cell = |cell: &usize| problem.at_nodes() + problem.own_creep(*cell).count();
    let unknowns: usize = cells.iter().map(of_cell).sum();
    if unknowns > MOST_UNKNOWNS {
        let mean = unknowns.div_ceil(cells.len());
        let what = format!(
            "{} of {mean} unknowns; at most {} at this degree",
            count(cells.len(), "cell"),
            MOST_UNKNOWNS / mean
        );
        return Err(Error::input(
            what,
            "give a coarser or shorter body (eigenvalues of a full matrix), or a lower degree",
        ));
    }
    let operator = if setup.semi_discrete { Operator::SemiDiscrete } else { Operator::Step(problem.courant) };
    let how = Assembler::new(&problem).best(operator)?;
    let rate = Rate::new(&problem, &how, operator)?;
    let At { growth, theta } = angles::worst(&rate, questions.angles)?;
    let limit = match questions.limit {
        true => Some(Search::new(&problem, how, questions.angles)?.find(theta)?),
        false => None,
    };
    let energy = Energy::new(&problem)?;
    let mut around = angles::grid(questions.angles);
    around.push(theta);
    let (gain, definite) = (energy.largest(&rate, &around)?, energy.lowest > -DEFINITE);
    let norms = if questions.norms { norms::norms(&rate, questions.angles)? } else { None };
    // Rates in c_p/h of the unloaded law, steps in c/h of the state.
    let unit = problem.c / problem.reference;
    let courant = rate.courant;
    let radius = courant.map(|dt| (growth * dt).exp());
    let theta = rate.periodic.then_some(theta);
    let names = Names::of(&problem.scene);
    Ok(Measured {
        names,
        cells: cells.len(),
        unknowns,
        courant,
        growth: growth * unit,
        radius,
        theta,
        limit,
        energy: gain * unit,
        definite,
        norms,
        noise: how.noise * unit,
    })
}

/// The search for the largest stable step.
struct Search<'a> {
    problem: &'a Problem,
    how: Differences,
    angles: usize,
    /// The growth at a small step, which is that of the state, c/h.
    slow: f64,
}

impl<'a> Search<'a> {
    fn new(problem: &'a Problem, how: Differences, angles: usize) -> Result<Self> {
        let known = if problem.known_limit > 0.0 { problem.known_limit } else { UNKNOWN_LIMIT };
        let rate = Rate::new(problem, &how, Operator::Step(SMALL * known))?;
        let slow = angles::worst(&rate, angles)?.growth.max(0.0);
        Ok(Self { problem, how, angles, slow })
    }

    /// The largest step that does not grow, or where the state grows at any step, that does not grow more than twice as fast.
    fn find(&self, hint: [f64; 2]) -> Result<Limit> {
        let courant = self.largest(hint)?;
        Ok(Limit { courant, grows: self.slow > self.tolerance(courant) })
    }

    /// dt c/h, 0 where a twentieth of the known limit is unstable, too.
    fn largest(&self, hint: [f64; 2]) -> Result<f64> {
        let mut hint = Some(hint);
        let known = if self.problem.known_limit > 0.0 { self.problem.known_limit } else { UNKNOWN_LIMIT };
        let (mut stable, mut unstable) = (0.0, 0.0);
        // Outwards from the known limit.
        let mut at = known;
        while stable == 0.0 || unstable == 0.0 {
            if self.is_stable(at, &mut hint)? {
                stable = at;
                at *= 1.1;
            } else {
                unstable = at;
                at *= if at > 0.8 * known { 0.9 } else { 0.5 };
            }
            if unstable > 0.0 && unstable < SMALL * known || stable > 20.0 * known {
                return Ok(stable);
            }
        }
        loop {
            while unstable / stable > 1.0 + RESOLUTION {
                let middle = (stable * unstable).sqrt();
                if self.is_stable(middle, &mut hint)? { stable = middle } else { unstable = middle }
            }
            // The angles of the grid are stable; those between may be worse.
            let rate = Rate::new(self.problem, &self.how, Operator::Step(stable))?;
            let worst = angles::worst(&rate, self.angles)?;
            if worst.growth <= self.bound(stable) {
                return Ok(stable);
            }
            hint = Some(worst.theta);
            (stable, unstable) = (0.99 * stable, stable);
            while !self.is_stable(stable, &mut hint)? {
                (stable, unstable) = (0.99 * stable, stable);
                if stable < SMALL * known {
                    return Ok(0.0);
                }
            }
        }
    }

    /// The growth that counts as stable, c/h.
    fn bound(&self, courant: f64) -> f64 {
        self.tolerance(courant) + 2.0 * self.slow
    }

    /// The growth that counts as none, c/h.
    fn tolerance(&self, courant: f64) -> f64 {
        TOLERANCE[self.problem.scheme.operators.degree.min(6)].ln_1p() / courant
    }

    fn is_stable(&self, courant: f64, hint: &mut Option<[f64; 2]>) -> Result<bool> {
        let rate = Rate::new(self.problem, &self.how, Operator::Step(courant));
        // Beyond the limit numbers may leave what can be represented.
        let Ok(rate) = rate else { return Ok(false) };
        let found = angles::above(&rate, self.angles, self.bound(courant), *hint)?;
        *hint = found.or(*hint);
        Ok(found.is_none())
    }
}
