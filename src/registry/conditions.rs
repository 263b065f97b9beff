//! The conditions on groups of boundary edges, `[[boundary]] kind = ..`.

use super::{ANY, Entry, FINITE, Fault, Form, NOT_NEGATIVE, POSITIVE, Parameter, Preset, Table, Values};
use crate::boundary::{
    Absorbing, Boundary, Data, Foundation, Free, Obstacle, Pressure, Shape, Traction, Unilateral, Velocity, Wall,
};
use crate::contact::{Cohesive, Interaction, Paired, Sliding};
use crate::expression::Expression;
use std::sync::Arc;

/// Makes what acts between faces.
pub type MakeInteraction = fn(&Values) -> Arc<dyn Interaction>;

/// What there is to know of a condition.
pub struct Condition {
    /// Makes it from its parameters.
    pub make: fn(&Values) -> Arc<dyn Boundary>,
    /// The parameter that names the group at which the body goes on: the faces of both are inner faces then.
    pub joined: Option<&'static str>,
    /// What acts between faces.
    pub between: Option<Between>,
    /// Whether it presses where bodies touch, which strains cells unevenly: material points stand on the Gauss nodes then, unless the scene
    /// says where.
    pub presses: bool,
}

/// What acts between the faces of a group and those of another one, or of the group itself.
pub struct Between {
    /// Makes it.
    pub make: MakeInteraction,
    /// The parameter that names the other group.
    pub other: Option<&'static str>,
}

impl Condition {
    /// A condition that knows of its own faces only.
    pub const fn of(make: fn(&Values) -> Arc<dyn Boundary>) -> Self {
        Self { make, joined: None, between: None, presses: false }
    }

    /// An obstacle, or a wall that the body leaves and reaches.
    const fn obstacle(make: fn(&Values) -> Arc<dyn Boundary>) -> Self {
        Self { presses: true, ..Self::of(make) }
    }

    /// What acts between faces.
    const fn between(make: fn(&Values) -> Arc<dyn Boundary>, between: Between) -> Self {
        Self { make, joined: None, presses: between.other.is_some(), between: Some(between) }
    }
}

const SPEED: Parameter =
    Parameter::new("speed", "the speed of the wall", "m/s", Form::Expression, Preset::Constant(&[0.0]));

const FRICTION: Parameter = Parameter::number("friction", "Coulomb's coefficient", "", NOT_NEGATIVE, 0.0);

const VELOCITY: Parameter = Parameter::new(
    "velocity",
    "its velocity, which depends on t alone; it does not turn",
    "m/s",
    Form::Expressions(2),
    Preset::Constant(&[0.0, 0.0]),
);

/// Of a table of loads.
const TABLE: Preset = Preset::Absent("none: `value` has it");

/// Whether expressions are the number 0.
fn are_zero(all: &[Expression]) -> bool {
    all.iter().all(|one| one.constant() == Some(0.0))
}

/// The speed of a wall; none of one at rest.
fn speed(of: &Values) -> Option<Data> {
    (!are_zero(of.expressions("speed"))).then(|| of.data("speed"))
}

fn obstacle(of: &Values, shape: Shape) -> Arc<dyn Boundary> {
    let velocity = (!are_zero(of.expressions("velocity"))).then(|| of.pair("velocity"));
    Arc::new(Obstacle { shape, velocity, friction: of.number("friction") })
}

fn moves_as_a_whole(of: &Values) -> Result<(), Fault> {
    match of.expressions("velocity").iter().position(Expression::depends_on_place) {
        None => Ok(()),
        Some(k) => {
            let remedy = "an obstacle is rigid and does not turn: give expressions of t alone";
            Err(Fault::new(format!("velocity.{k}"), "the velocity of the obstacle depends on x or y", remedy))
        }
    }
}

fn polygon(corners: &[[f64; 2]]) -> Result<(), Fault> {
    let next = |k: usize| corners[(k + 1) % corners.len()];
    if let Some(k) = (0..corners.len()).find(|&k| corners[k] == next(k)) {
        return Err(Fault::new(format!("corners.{k}"), "two corners in a row are the same", "remove one"));
    }
    if let Some([i, j]) = Shape::crossing(corners) {
        let what = format!("the edges behind corner {i} and corner {j} cross or touch");
        return Err(Fault::new(format!("corners.{j}"), what, "give the corners in their order along the edge"));
    }
    match Shape::twice_area(corners) == 0.0 {
        true => Err(Fault::new("corners", "the polygon has no area", "give corners that are not on a line")),
        false => Ok(()),
    }
}

/// Every condition. What is said of an expression that is not finite begins with the line that describes its parameter.
pub static CONDITIONS: Table<Condition> = Table::new(&[
    Entry {
        name: "wall",
        about: "rigid wall without friction, bilateral: it never opens; `speed` moves it along the outward normal",
        parameters: &[SPEED],
        check: ANY,
        build: Condition::of(|of| Arc::new(Wall { speed: speed(of) })),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "unilateral",
        about: "rigid wall that the body may leave and reach, with gap and friction; `speed` moves it along the outward normal",
        parameters: &[Parameter::number("gap", "the gap at the start", "m", NOT_NEGATIVE, 0.0), SPEED, FRICTION],
        check: ANY,
        build: Condition::obstacle(|of| {
            let (gap, friction) = ([of.number("gap")], of.number("friction"));
            Arc::new(Unilateral { gap, speed: speed(of), friction })
        }),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "half-plane",
        about: "rigid half-plane in the way of the group, in the current configuration, with friction; it may move",
        parameters: &[
            Parameter::required("point", "a point of its edge at the start", "m", Form::Vector(FINITE)),
            Parameter::required("normal", "the direction out of it, of any length above 0", "", Form::Vector(FINITE)),
            VELOCITY,
            FRICTION,
        ],
        check: |of| match of.vector("normal") == [0.0; 2] {
            true => Err(Fault::new("normal", "the normal has no direction", "give for instance [0, 1]")),
            false => moves_as_a_whole(of),
        },
        build: Condition::obstacle(|of| {
            let (point, n) = (of.vector("point"), of.vector("normal"));
            let length = n[0].hypot(n[1]);
            obstacle(of, Shape::HalfPlane { point, normal: n.map(|n| n / length) })
        }),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "disc",
        about: "rigid disc in the way of the group, in the current configuration, with friction; it may move",
        parameters: &[
            Parameter::required("centre", "its centre at the start", "m", Form::Vector(FINITE)),
            Parameter::required("radius", "its radius", "m", Form::Number(POSITIVE)),
            VELOCITY,
            FRICTION,
        ],
        check: moves_as_a_whole,
        build: Condition::obstacle(|of| {
            obstacle(of, Shape::Disc { centre: of.vector("centre"), radius: of.number("radius") })
        }),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "polygon",
        about: "rigid polygon in the way of the group, in the current configuration, with friction; it may move",
        parameters: &[
            Parameter::required("corners", "its corners at the start, either way around", "m", Form::Points(3)),
            VELOCITY,
            FRICTION,
        ],
        check: |of| {
            polygon(of.points("corners"))?;
            moves_as_a_whole(of)
        },
        build: Condition::obstacle(|of| obstacle(of, Shape::Polygon { corners: of.points("corners").to_vec() })),
    },
    Entry {
        name: "symmetry",
        about: "line of symmetry: a wall at rest",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Wall { speed: None })),
    },
    Entry { name: "free", about: "no traction", parameters: &[], check: ANY, build: Condition::of(|_| Arc::new(Free)) },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "clamped",
        about: "no velocity",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Velocity { value: [Arc::new(|_, _| 0.0), Arc::new(|_, _| 0.0)] })),
    },
    Entry {
        name: "velocity",
        about: "prescribed velocity",
        parameters: &[
            Parameter::new(
                "value",
                "the velocity of the boundary",
                "m/s",
                Form::Expressions(2),
                Preset::Unless("file"),
            ),
            Parameter::new("file", "the velocity over time", "m/s", Form::LoadTable(2), TABLE),
        ],
        check: ANY,
        build: Condition::of(|of| Arc::new(Velocity { value: of.loads("value", "file") })),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "traction",
        about: "prescribed traction P N, per area of the initial configuration",
        parameters: &[
            Parameter::new("value", "the traction on the boundary", "Pa", Form::Expressions(2), Preset::Unless("file")),
            Parameter::new("file", "the traction over time", "Pa", Form::LoadTable(2), TABLE),
        ],
        check: ANY,
        build: Condition::of(|of| Arc::new(Traction { value: of.loads("value", "file") })),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "pressure",
        about: "pressure along the current normal: P N = -p cof(F) N",
        parameters: &[
            Parameter::new("value", "the pressure on the boundary", "Pa", Form::Expression, Preset::Unless("file")),
            Parameter::new("file", "the pressure over time", "Pa", Form::LoadTable(1), TABLE),
        ],
        check: ANY,
        build: Condition::of(|of| {
            let [value] = of.loads("value", "file");
            Arc::new(Pressure { value })
        }),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "foundation",
        about: "springs and dampers along the initial normal and tangent: P N = -k u - c v",
        parameters: &[
            Parameter::required(
                "stiffness",
                "k along the normal and along the tangent, per area of the initial configuration",
                "Pa/m",
                Form::Vector(NOT_NEGATIVE),
            ),
            Parameter::new(
                "damping",
                "c along the normal and along the tangent, per area of the initial configuration",
                "Pa s/m",
                Form::Vector(NOT_NEGATIVE),
                Preset::Absent("none"),
            ),
        ],
        check: |of| {
            let acts = ["stiffness", "damping"].iter().any(|key| of.has(key) && of.vector(key) != [0.0; 2]);
            let what = "the foundation has neither a spring nor a damper";
            if acts { Ok(()) } else { Err(Fault::new("stiffness", what, "give one of them, or kind = \"free\"")) }
        },
        build: Condition::of(|of| {
            let damping = if of.has("damping") { of.vector("damping") } else { [0.0; 2] };
            Arc::new(Foundation { stiffness: of.vector("stiffness"), damping })
        }),
    },
    #[cfg(feature = "effect-conditions")]
    Entry {
        name: "absorbing",
        about: "nothing comes in, and plane waves go out",
        parameters: &[],
        check: ANY,
        build: Condition::of(|_| Arc::new(Absorbing)),
    },
    Entry {
        name: "periodic",
        about: "the body continues at another group, which is this one moved",
        parameters: &[Parameter::required(
            "partner",
            "the group at the other side of the body, such as \"right\"; it needs no [[boundary]] of its own",
            "",
            Form::Text,
        )],
        check: ANY,
        // The faces are inner faces: nothing asks for their condition.
        build: Condition { joined: Some("partner"), ..Condition::of(|_| Arc::new(Free)) },
    },
    #[cfg(feature = "effect-contact")]
    Entry {
        name: "contact",
        about: "contact with the faces of another group, or of its own: they press on each other where they touch, and part freely",
        parameters: &[
            Parameter {
                name: "partner",
                about: "the group of the other body, such as \"right\"; it needs no [[boundary]] of its own",
                unit: "",
                form: Form::Text,
                default: Preset::Absent("the group itself: the two sides of a crack, a body that folds"),
            },
            Parameter::new(
                "friction",
                "the coefficient of Coulomb friction",
                "",
                Form::Number(NOT_NEGATIVE),
                Preset::Number(0.0),
            ),
        ],
        check: ANY,
        build: Condition::between(
            |of| Arc::new(Paired(sliding(of))),
            Between { make: sliding, other: Some("partner") },
        ),
    },
    #[cfg(feature = "effect-contact")]
    Entry {
        name: "cohesive",
        about: "a cut inside of the body that takes energy to open: a bilinear law of traction and opening",
        parameters: &[
            Parameter::required("strength", "the largest traction", "Pa", Form::Number(POSITIVE)),
            Parameter::required(
                "energy",
                "the energy that takes to break it, per area",
                "J/m^2",
                Form::Number(POSITIVE),
            ),
            Parameter {
                name: "stiffness",
                about: "traction over opening before damage",
                unit: "Pa/m",
                form: Form::Number(POSITIVE),
                default: Preset::Absent("50 strength^2/energy: damage begins at 1 % of the opening where it is broken"),
            },
        ],
        check: |of| {
            let [strength, energy] = ["strength", "energy"].map(|name| of.number(name));
            match of.maybe("stiffness") {
                Some(stiffness) if 2.0 * energy * stiffness <= strength * strength => Err(Fault::new(
                    "stiffness",
                    format!(
                        "a stiffness of {stiffness} Pa/m lets it store more than its energy before the strength is reached"
                    ),
                    format!("give more than strength^2/(2 energy) = {} Pa/m", strength * strength / (2.0 * energy)),
                )),
                _ => Ok(()),
            }
        },
        build: Condition::between(|of| Arc::new(Paired(cohesive(of))), Between { make: cohesive, other: None }),
    },
]);

fn sliding(of: &Values) -> Arc<dyn Interaction> {
    Arc::new(Sliding { friction: of.number("friction") })
}

fn cohesive(of: &Values) -> Arc<dyn Interaction> {
    let [strength, energy] = ["strength", "energy"].map(|name| of.number(name));
    let stiffness = of.maybe("stiffness").unwrap_or(50.0 * strength * strength / energy);
    Arc::new(Cohesive { strength, energy, stiffness })
}
