//! The exact solutions that scenes can name, `[exact] kind = ..`, with their parameters and defaults.

use super::Scene;
use super::reader::{Check, FINITE, POSITIVE, Reader};
use crate::error::Result;
use crate::exact::{Exact as Solution, J2Impact, LinearBar, Manufactured, Riemann, SimpleWave, Vortex, WallImpact};
use crate::material::Law;
use std::collections::BTreeMap;
use std::sync::Arc;

/// The exact solution of a scene.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Exact {
    /// Its name, one of [`SOLUTIONS`].
    pub kind: String,
    /// Its parameters, all of them.
    pub parameters: BTreeMap<String, f64>,
    /// Whether it gives the initial state: where the scene has no `[initial]`.
    pub initial: bool,
}

/// Parameters by name and the laws, as many as the entry takes, to a solution; None: there is none.
type Build = fn(&dyn Fn(&str) -> f64, &[Law]) -> Option<Arc<dyn Solution>>;

/// A solution and its parameters.
#[derive(Debug)]
pub struct Entry {
    /// Its name in scenes.
    pub name: &'static str,
    /// Key, default and range of its parameters.
    parameters: &'static [(&'static str, f64, Check)],
    /// Whether it holds for a linear law only.
    linear: bool,
    /// Whether it holds for laws with plastic strain, and no others.
    plastic: bool,
    /// How many materials it takes at most.
    materials: usize,
    build: Build,
}

const BELOW_1: Check = Check { range: "below 1", holds: |a| a < 1.0 };
const CENTRE: (&str, f64, Check) = ("centre", 0.75, FINITE);
const WIDTH: (&str, f64, Check) = ("width", 0.12, POSITIVE);

/// Every solution; lengths in m, speeds in m/s, times in s.
pub const SOLUTIONS: &[Entry] = &[
    Entry {
        name: "simple-wave",
        parameters: &[("amplitude", 0.1, BELOW_1), CENTRE, WIDTH],
        linear: false,
        plastic: false,
        materials: 1,
        build: |of, laws| Some(Arc::new(SimpleWave::new(laws[0].clone(), of("amplitude"), of("centre"), of("width")))),
    },
    Entry {
        name: "wall-impact",
        parameters: &[("speed", 200.0, POSITIVE)],
        linear: false,
        plastic: false,
        materials: 1,
        build: |of, laws| Some(Arc::new(WallImpact::new(&laws[0], of("speed")))),
    },
    Entry {
        name: "j2-impact",
        parameters: &[("speed", 200.0, POSITIVE)],
        linear: false,
        plastic: true,
        materials: 1,
        build: |of, laws| Some(Arc::new(J2Impact::new(&laws[0], of("speed"))?)),
    },
    Entry {
        name: "linear-bar",
        parameters: &[("length", 3.0, POSITIVE), ("amplitude", 1e-3, BELOW_1), CENTRE, WIDTH],
        linear: true,
        plastic: false,
        materials: 1,
        build: |of, laws| {
            let (length, amplitude) = (of("length"), of("amplitude"));
            Some(Arc::new(LinearBar::new(&laws[0], length, amplitude, of("centre"), of("width"))))
        },
    },
    Entry {
        name: "manufactured",
        parameters: &[("amplitude", 0.05, BELOW_1), ("length", 1.0, POSITIVE)],
        linear: false,
        plastic: false,
        materials: 1,
        build: |of, laws| Some(Arc::new(Manufactured::new(laws[0].clone(), of("amplitude"), of("length")))),
    },
    Entry {
        name: "vortex",
        parameters: &[
            ("centre_x", 1.5, FINITE),
            ("centre_y", 1.5, FINITE),
            ("radius", 1.0, POSITIVE),
            ("amplitude", 1.0, FINITE),
            ("period", 1.0, POSITIVE),
        ],
        linear: false,
        plastic: false,
        materials: 1,
        build: |of, laws| {
            let centre = [of("centre_x"), of("centre_y")];
            Some(Arc::new(Vortex::new(laws[0].clone(), centre, of("radius"), of("amplitude"), of("period"))))
        },
    },
    Entry {
        name: "riemann",
        parameters: &[
            ("interface", 1.5, FINITE),
            ("left_stretch", 1.0, POSITIVE),
            ("left_velocity", 0.0, FINITE),
            ("right_stretch", 1.0, POSITIVE),
            ("right_velocity", 0.0, FINITE),
        ],
        linear: false,
        plastic: false,
        materials: 2,
        build: |of, laws| {
            let states = [[of("left_stretch"), of("left_velocity")], [of("right_stretch"), of("right_velocity")]];
            Some(Arc::new(Riemann::new(laws, states, of("interface"))?))
        },
    },
];

/// Reads `[exact]`; `initial` says whether the solution gives the initial state.
pub(super) fn exact(table: Option<&mut Reader>, initial: bool) -> Result<Option<Exact>> {
    let Some(table) = table else { return Ok(None) };
    let names: Vec<(&str, usize)> = SOLUTIONS.iter().enumerate().map(|(i, entry)| (entry.name, i)).collect();
    let all: Vec<String> = names.iter().map(|(name, _)| format!("\"{name}\"")).collect();
    let kind = table.choice("kind", &names, &[])?;
    let entry = &SOLUTIONS[kind.ok_or_else(|| table.missing("kind", &format!("there are {}", all.join(", "))))?];
    let mut parameters = BTreeMap::new();
    for &(name, default, check) in entry.parameters {
        parameters.insert(name.to_owned(), table.number(name, check)?.unwrap_or(default));
    }
    table.of_kind(entry.name);
    table.finish()?;
    Ok(Some(Exact { kind: entry.name.to_owned(), parameters, initial }))
}

impl Scene {
    /// Whether the exact solution fits materials and end time.
    pub(super) fn check_exact(&self) -> Result<()> {
        let Some(entry) = self.entry() else { return Ok(()) };
        let (count, name) = (self.materials.len(), entry.name);
        if count > entry.materials {
            let what = format!("the scene has {count} materials, \"{name}\" takes {}", entry.materials);
            return Err(self.error("exact.kind", what, "leave out a [[material]], or [exact]"));
        }
        if entry.linear && self.materials.iter().any(|material| material.law != "linear-elastic") {
            let what = format!("\"{name}\" holds for a linear law only");
            return Err(self.error("exact.kind", what, "give the material law = \"linear-elastic\""));
        }
        if let Some(law) = self.laws().iter().position(|law| law.internal().is_empty() == entry.plastic) {
            let law = &self.materials[law].law;
            let what = format!("\"{name}\" is no solution for the law \"{law}\"");
            let remedy = if entry.plastic {
                "give the material law = \"j2\""
            } else {
                "for law = \"j2\" there is \"j2-impact\""
            };
            return Err(self.error("exact.kind", what, remedy));
        }
        let Some(solution) = self.build_exact() else {
            let what = format!("\"{name}\" has no solution: the impact would press a material to nothing");
            return Err(self.error("exact.kind", what, "lower the difference of the velocities"));
        };
        if self.end >= solution.until() {
            let what = format!("\"{name}\" is a solution until {:.6e} s only: then it breaks", solution.until());
            return Err(self.error("time.end", what, "end the run before"));
        }
        Ok(())
    }

    fn entry(&self) -> Option<&'static Entry> {
        let exact = self.exact.as_ref()?;
        SOLUTIONS.iter().find(|entry| entry.name == exact.kind)
    }

    /// The exact solution that the scene names.
    pub fn build_exact(&self) -> Option<Arc<dyn Solution>> {
        let (exact, laws) = (self.exact.as_ref()?, self.laws());
        let parameter = |name: &str| exact.parameters.get(name).copied().unwrap_or(f64::NAN);
        // A scene has at least one material, and every law of the list is built.
        if laws.is_empty() { None } else { (self.entry()?.build)(&parameter, &laws) }
    }
}
