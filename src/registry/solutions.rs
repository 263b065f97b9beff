//! The exact solutions, `[exact] kind = ..`.

use super::{ANY, BELOW_1, Chosen, Entry, FINITE, Fault, POSITIVE, Parameter, Table, Values, quoted};
use crate::exact::{Exact, J2Impact, LinearBar, Manufactured, Riemann, SimpleWave, Vortex, WallImpact};
use crate::step::Law;
use std::sync::Arc;

/// Makes a solution from its parameters and the laws, as many as it takes; none: there is no solution.
pub type Make = fn(&Values, &[Law]) -> Option<Arc<dyn Exact>>;

/// What there is to know of an exact solution.
pub struct Solution {
    /// The names of the laws that it holds for; empty: all without a memory.
    pub laws: &'static [&'static str],
    /// How many materials it takes at most.
    pub materials: usize,
    /// How it is made.
    pub make: Make,
}

impl Solution {
    const fn of(make: Make) -> Self {
        Self { laws: &[], materials: 1, make }
    }
}

const CENTRE: Parameter = Parameter::number("centre", "middle of the wave at t = 0", "m", FINITE, 0.75);
const WIDTH: Parameter =
    Parameter::number("width", "width w: the wave is exp(-((x - centre) / w)^2)", "m", POSITIVE, 0.12);
const SPEED: Parameter = Parameter::number("speed", "speed against the wall", "m/s", POSITIVE, 200.0);

/// Every solution.
pub static SOLUTIONS: Table<Solution> = Table::new(&[
    Entry {
        name: "simple-wave",
        about: "a wave of finite strain that travels in one direction until it breaks",
        parameters: &[Parameter::number("amplitude", "largest compression", "", BELOW_1, 0.1), CENTRE, WIDTH],
        check: ANY,
        build: Solution::of(|of, laws| {
            let [amplitude, centre, width] = ["amplitude", "centre", "width"].map(|name| of.number(name));
            Some(Arc::new(SimpleWave::new(laws[0].clone(), amplitude, centre, width)))
        }),
    },
    Entry {
        name: "wall-impact",
        about: "impact of a body on a wall in uniaxial strain: one shock",
        parameters: &[SPEED],
        check: ANY,
        build: Solution::of(|of, laws| Some(Arc::new(WallImpact::new(&laws[0], of.number("speed"))))),
    },
    Entry {
        name: "j2-impact",
        about: "impact of a J2 body on a wall in uniaxial strain: an elastic precursor and a slower shock",
        parameters: &[SPEED],
        check: ANY,
        build: Solution {
            laws: &["j2"],
            ..Solution::of(|of, laws| Some(Arc::new(J2Impact::new(&laws[0], of.number("speed"))?)))
        },
    },
    Entry {
        name: "linear-bar",
        about: "a bar at rest that is released from a strain, with the waves that its ends reflect",
        parameters: &[
            Parameter::number("length", "length of the bar", "m", POSITIVE, 3.0),
            Parameter::number("amplitude", "largest compression", "", BELOW_1, 1e-3),
            CENTRE,
            WIDTH,
        ],
        check: ANY,
        build: Solution {
            laws: &["linear-elastic"],
            ..Solution::of(|of, laws| {
                let (length, amplitude) = (of.number("length"), of.number("amplitude"));
                Some(Arc::new(LinearBar::new(&laws[0], length, amplitude, of.number("centre"), of.number("width"))))
            })
        },
    },
    Entry {
        name: "manufactured",
        about: "a smooth motion, periodic in both directions; a body force keeps it up",
        parameters: &[
            Parameter::number("amplitude", "largest strain", "", BELOW_1, 0.05),
            Parameter::number("length", "length of a period", "m", POSITIVE, 1.0),
        ],
        check: ANY,
        build: Solution::of(|of, laws| {
            Some(Arc::new(Manufactured::new(laws[0].clone(), of.number("amplitude"), of.number("length"))))
        }),
    },
    Entry {
        name: "vortex",
        about: "an annulus of pure rotation, at any size of rotation; a body force keeps it up",
        parameters: &[
            Parameter::number("centre_x", "x of its centre", "m", FINITE, 1.5),
            Parameter::number("centre_y", "y of its centre", "m", FINITE, 1.5),
            Parameter::number("radius", "mean radius", "m", POSITIVE, 1.0),
            Parameter::number("amplitude", "largest rotation", "rad", FINITE, 1.0),
            Parameter::number("period", "time of a motion there and back", "s", POSITIVE, 1.0),
        ],
        check: ANY,
        build: Solution::of(|of, laws| {
            let [x, y, radius, amplitude, period] =
                ["centre_x", "centre_y", "radius", "amplitude", "period"].map(|name| of.number(name));
            Some(Arc::new(Vortex::new(laws[0].clone(), [x, y], radius, amplitude, period)))
        }),
    },
    Entry {
        name: "riemann",
        about: "the waves from a jump; of one material, or of two: the first [[material]] is on the left",
        parameters: &[
            Parameter::number("interface", "x of the jump", "m", FINITE, 1.5),
            Parameter::number("left_stretch", "F11 on the left", "", POSITIVE, 1.0),
            Parameter::number("left_velocity", "v1 on the left", "m/s", FINITE, 0.0),
            Parameter::number("right_stretch", "F11 on the right", "", POSITIVE, 1.0),
            Parameter::number("right_velocity", "v1 on the right", "m/s", FINITE, 0.0),
        ],
        check: ANY,
        build: Solution {
            materials: 2,
            ..Solution::of(|of, laws| {
                let state = |stretch: &str, velocity: &str| [of.number(stretch), of.number(velocity)];
                let states = [state("left_stretch", "left_velocity"), state("right_stretch", "right_velocity")];
                Some(Arc::new(Riemann::new(laws, states, of.number("interface"))?))
            })
        },
    },
]);

/// Whether a solution holds for these laws (name and law of each `[[material]]`) and until the end of the run, s.
///
/// # Errors
/// What does not fit, at its key in the scene.
pub fn check(solution: &Chosen<Solution>, laws: &[(&str, Law)], end: f64) -> Result<(), Fault> {
    let (name, Solution { laws: wanted, materials, make }) = (solution.name(), solution.build());
    let wrong = |what: String, remedy: String| Err(Fault::new("exact.kind", what, remedy));
    if laws.len() > *materials {
        let what = format!("the scene has {} materials, \"{name}\" takes {materials}", laws.len());
        return wrong(what, "leave out a [[material]], or [exact]".to_owned());
    }
    let holds = |law: &str, has_memory: bool| wanted.contains(&law) || wanted.is_empty() && !has_memory;
    if let Some((law, _)) = laws.iter().find(|(name, law)| !holds(name, law.has_memory())) {
        let what = format!("\"{name}\" is no solution for the law \"{law}\"");
        let of_law: Vec<&str> =
            SOLUTIONS.iter().filter(|entry| entry.build.laws.contains(law)).map(|entry| entry.name).collect();
        return match of_law[..] {
            _ if !wanted.is_empty() => wrong(what, format!("give the material law = {}", quoted(wanted))),
            [] => wrong(what, "give a law without internal variables".to_owned()),
            _ => wrong(what, format!("for law = \"{law}\" there is {}", quoted(&of_law))),
        };
    }
    let laws: Vec<Law> = laws.iter().map(|(_, law)| law.clone()).collect();
    let Some(solution) = make(&solution.values, &laws) else {
        let what = format!("\"{name}\" has no solution: the impact would press a material to nothing");
        return wrong(what, "lower the difference of the velocities".to_owned());
    };
    if end >= solution.until() {
        let what = format!("\"{name}\" is a solution until {:.6e} s only: then it breaks", solution.until());
        return Err(Fault::new("time.end", what, "end the run before"));
    }
    Ok(())
}
