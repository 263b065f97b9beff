//! One setting of a scene: built and run.

use crate::error::Result;
use crate::observe::Observer;
use crate::problem::{Problem, Setup};
use crate::quantity::Measured;
use crate::registry::Method;
use crate::run::{Report, Run, Stop};
use crate::scene::{self, Scene, Step};
use crate::state::State;
use std::sync::atomic::AtomicBool;

/// Share of the stability limit in place of a scene's `cfl`: that number means another share for every degree.
const SAFETY: f64 = 0.9;

/// The settings that one line of a plot joins.
#[derive(Debug, Clone, PartialEq)]
pub struct Series {
    /// The method.
    pub method: Method,
    /// N.
    pub degree: usize,
    /// N_T.
    pub time_degree: usize,
    /// Where the points of ADER-DGMPM stand; none: as the scene says.
    pub layout: Option<String>,
    /// What is set otherwise than in the scene, `key=value` each, where the study compares values of keys.
    pub sets: Vec<String>,
}

impl Series {
    /// As in tables: `ader-dgmpm S2`, with T where N_T is another, and with layout and keys where the study varies them.
    pub fn name(&self) -> String {
        let time = if self.time_degree == self.degree { String::new() } else { format!("T{}", self.time_degree) };
        let layout = self.layout.as_ref().map_or(String::new(), |layout| format!(" {layout}"));
        let sets: String = self.sets.iter().map(|set| format!(" {set}")).collect();
        format!("{} S{}{time}{layout}{sets}", self.method.name(), self.degree)
    }
}

/// A series on one mesh.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    /// The series.
    pub series: Series,
    /// Cells per direction over those of the scene.
    pub refinement: f64,
}

impl Case {
    /// Cells per direction of a rectangle; at least one.
    pub fn rectangle(&self, cells: [usize; 2]) -> [usize; 2] {
        cells.map(|n| ((n as f64 * self.refinement).round() as usize).max(1))
    }

    /// Parts per direction that cells of a mesh file are cut into.
    fn parts(&self) -> usize {
        (self.refinement.round() as usize).max(1)
    }

    /// The `--set` that make this case of the scene.
    pub fn sets(&self, scene: &Scene) -> Vec<String> {
        let Series { method, degree, time_degree, layout, sets: compared } = &self.series;
        let mut sets = vec![
            format!("scheme.method={}", method.name()),
            format!("scheme.degree={degree}"),
            format!("scheme.time_degree={time_degree}"),
        ];
        sets.extend(layout.as_ref().map(|layout| format!("cloud.layout={layout}")));
        if let scene::Mesh::Rectangle { cells, .. } = scene.mesh {
            let [nx, ny] = self.rectangle(cells);
            sets.push(format!("mesh.rectangle.cells=[{nx}, {ny}]"));
        }
        if matches!(scene.scheme.step, Step::Cfl(_)) {
            sets.push(format!("scheme.safety={SAFETY}"));
        }
        sets.extend(compared.iter().cloned());
        sets
    }

    /// Number of cells, of which the mesh of the scene has `of_scene`.
    pub(super) fn cells(&self, scene: &Scene, of_scene: usize) -> usize {
        match scene.mesh {
            // Saturating: a search for a mesh may ask for sizes that no machine holds.
            scene::Mesh::Rectangle { cells, .. } => self.rectangle(cells).into_iter().fold(1, usize::saturating_mul),
            scene::Mesh::File(_) => of_scene.saturating_mul(self.parts()).saturating_mul(self.parts()),
        }
    }

    /// min_e h_e of its mesh, m, where that of the scene has `of_scene`.
    pub(super) fn h(&self, scene: &Scene, of_scene: f64) -> f64 {
        match scene.mesh {
            scene::Mesh::Rectangle { size, cells } => {
                let cells = self.rectangle(cells);
                let [dx, dy] = [0, 1].map(|axis| size[axis] / cells[axis] as f64);
                2.0 * dx * dy / (dx + dy)
            }
            scene::Mesh::File(_) => of_scene / self.parts() as f64,
        }
    }

    /// The problem of this case.
    ///
    /// # Errors
    /// Bad input, as for a run of the scene.
    pub fn build(&self, scene: &Scene) -> Result<Problem> {
        let mut scene = scene.with(&self.sets(scene))?;
        // Outputs would ask for time, files and the displacement; the quantities of the scene stay.
        scene.outputs.clear();
        let mut mesh = scene.build_mesh()?;
        if let scene::Mesh::File(_) = scene.mesh {
            mesh = mesh.refined(self.parts());
        }
        Setup::of(&scene).mesh(mesh).build()
    }
}

/// Runs a problem to the end without outputs, from a copy of its state, and takes the quantities of its scene. What they cost is
/// not in the seconds of the report; that the displacement is integrated, where they need it, is.
///
/// # Errors
/// See [`Stop`].
pub fn run(problem: &Problem, interrupt: &AtomicBool) -> std::result::Result<(State, Report, Vec<Measured>), Stop> {
    let (mut state, mut report) = (problem.state.clone(), Report::default());
    let (mesh, scheme, settings) = (&problem.body.mesh, &problem.scheme, problem.settings);
    let mut gauge = problem.gauge()?;
    let observers = gauge.iter_mut().map(|gauge| Box::new(gauge) as Box<dyn Observer + '_>).collect();
    Run { mesh, scheme, settings, observers, interrupt }.advance(&mut state, &mut report)?;
    report.finish(scheme, &state);
    let [cpu, wall] = gauge.as_ref().map_or([0.0; 2], |gauge| gauge.cost);
    (report.cpu, report.wall) = ((report.cpu - cpu).max(0.0), (report.wall - wall).max(0.0));
    Ok((state, report, gauge.map(|gauge| gauge.measured()).unwrap_or_default()))
}

/// Why a run lost stability, in a few words.
pub fn why(stop: &Stop) -> String {
    match stop {
        Stop::Unstable(lost) => lost.loss.kind.to_string(),
        Stop::EnergyMade(made) => format!("it made {:.0} % of its energy out of nothing", 100.0 * made.0.share),
        Stop::Interrupted | Stop::Output(_) => "it was stopped".to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_what_is_not_the_default() {
        let series = Series { method: Method::AderDgmpm, degree: 3, time_degree: 3, layout: None, sets: Vec::new() };
        assert_eq!(series.name(), "ader-dgmpm S3");
        let series = Series { time_degree: 1, layout: Some("jitter".into()), ..series };
        assert_eq!(series.name(), "ader-dgmpm S3T1 jitter");
        let series = Series { layout: None, sets: vec!["curl.control=lcf".into()], ..series };
        assert_eq!(series.name(), "ader-dgmpm S3T1 curl.control=lcf");
    }

    #[test]
    fn a_case_of_a_scene_is_made_by_its_overrides() {
        let text = "[mesh]\nrectangle = { size = [3.0, 0.1], cells = [30, 1] }\n[[material]]\nlaw = \"linear-elastic\"\n\
             young = 1.0\npoisson = 0.3\ndensity = 1.0\n[scheme]\nmethod = \"rk-dgfem\"\ndegree = 1\ncfl = 0.4\n[time]\nend = 1.0\n";
        let walls =
            ["left", "right", "bottom", "top"].map(|g| format!("[[boundary]]\ngroup = \"{g}\"\nkind = \"wall\"\n"));
        let text = format!("{text}{}", walls.join(""));
        let scene = Scene::parse(&text, std::path::Path::new("x.toml"), &[]).unwrap();
        let series = Series {
            method: Method::AderDgmpm,
            degree: 3,
            time_degree: 1,
            layout: Some("gauss".into()),
            sets: Vec::new(),
        };
        let case = Case { series, refinement: 0.5 };
        // At least one cell in each direction.
        assert_eq!((case.rectangle([30, 1]), case.cells(&scene, 30)), ([15, 1], 15));
        let scene = scene.with(&case.sets(&scene)).unwrap();
        assert_eq!((scene.scheme.method, scene.scheme.degree, scene.scheme.time_degree), (Method::AderDgmpm, 3, 1));
        // The same share of every method's limit.
        assert_eq!(scene.scheme.step, Step::Safety(SAFETY));
    }
}
