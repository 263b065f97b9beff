//! The exact solutions that scenes can name, `[exact] kind = ..`, with their parameters and defaults.

use super::Scene;
use super::reader::{Check, FINITE, POSITIVE, Reader};
use crate::error::Result;
use crate::exact::{Exact as Solution, LinearBar, Manufactured, SimpleWave, Vortex, WallImpact};
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

/// Parameters by name and the law to a solution.
type Build = fn(&dyn Fn(&str) -> f64, Law) -> Arc<dyn Solution>;

/// A solution and its parameters.
#[derive(Debug)]
pub struct Entry {
    /// Its name in scenes.
    pub name: &'static str,
    /// Key, default and range of its parameters.
    parameters: &'static [(&'static str, f64, Check)],
    /// Whether it holds for a linear law only.
    linear: bool,
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
        build: |of, law| Arc::new(SimpleWave::new(law, of("amplitude"), of("centre"), of("width"))),
    },
    Entry {
        name: "wall-impact",
        parameters: &[("speed", 200.0, POSITIVE)],
        linear: false,
        build: |of, law| Arc::new(WallImpact::new(&law, of("speed"))),
    },
    Entry {
        name: "linear-bar",
        parameters: &[("length", 3.0, POSITIVE), ("amplitude", 1e-3, BELOW_1), CENTRE, WIDTH],
        linear: true,
        build: |of, law| Arc::new(LinearBar::new(&law, of("length"), of("amplitude"), of("centre"), of("width"))),
    },
    Entry {
        name: "manufactured",
        parameters: &[("amplitude", 0.05, BELOW_1), ("length", 1.0, POSITIVE)],
        linear: false,
        build: |of, law| Arc::new(Manufactured::new(law, of("amplitude"), of("length"))),
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
        build: |of, law| {
            let centre = [of("centre_x"), of("centre_y")];
            Arc::new(Vortex::new(law, centre, of("radius"), of("amplitude"), of("period")))
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
    /// Whether the exact solution fits law and end time.
    pub(super) fn check_exact(&self) -> Result<()> {
        let Some((entry, solution)) = self.entry().zip(self.build_exact()) else { return Ok(()) };
        if self.materials.len() > 1 {
            let remedy = "an exact solution is that of one material: leave one [[material]]";
            return Err(self.error("exact.kind", "the scene has several materials", remedy));
        }
        if entry.linear && self.materials[0].law != "linear-elastic" {
            let what = format!("\"{}\" holds for a linear law only", entry.name);
            return Err(self.error("exact.kind", what, "give the material law = \"linear-elastic\""));
        }
        if self.end >= solution.until() {
            let what =
                format!("\"{}\" is a solution until {:.6e} s only: then it breaks", entry.name, solution.until());
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
        let (exact, law) = (self.exact.as_ref()?, self.build_laws().into_iter().next()?);
        let parameter = |name: &str| exact.parameters.get(name).copied().unwrap_or(f64::NAN);
        Some((self.entry()?.build)(&parameter, law))
    }
}
