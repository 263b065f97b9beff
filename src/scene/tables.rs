//! The keys of the tables of a scene. What a `kind`, `law`, `layout` or `control` adds to them stands in the
//! [`crate::registry`], with its entry.

use super::Histories;
use super::fields;
use crate::registry::quantities::Statistic;
use crate::registry::{
    AT_LEAST_1, Check, FINITE, FLUXES, Form, METHODS, NOT_NEGATIVE, POSITIVE, Parameter, Policy, Preset, SHARE, Sweeps,
    controls, fluxes,
};
use crate::registry::{
    CONDITIONS, CONTROLS, LAWS, LAYOUTS, LIMITERS, OUTPUTS, QUANTITIES, SOLUTIONS, SOURCES, grids, limiters,
};

pub(super) const fn key(
    name: &'static str,
    about: &'static str,
    unit: &'static str,
    form: Form,
    default: Preset,
) -> Parameter {
    Parameter { name, about, unit, form, default }
}

const fn needed(name: &'static str, about: &'static str, unit: &'static str, form: Form) -> Parameter {
    Parameter::required(name, about, unit, form)
}

fn of<T>(names: &[(&'static str, T)]) -> Vec<&'static str> {
    names.iter().map(|(name, _)| *name).collect()
}

/// The keys above all tables.
pub(super) const TOP: &[Parameter] =
    &[key("title", "what the scene shows, for people", "", Form::Text, Preset::Absent("the name of the file"))];

pub(super) const MESH: &[Parameter] = &[
    key(
        "file",
        "a mesh: of Gmsh, a .vtu or .xdmf file of another program, or the .h5 file of `dgmpm mesh`",
        "",
        Form::Text,
        Preset::Absent("none: `rectangle` says what the mesh is"),
    ),
    key(
        "rectangle",
        "a mesh without a file, with the groups left, right, bottom, top and body",
        "",
        Form::Table(grids::RECTANGLE),
        Preset::Absent("none: `file` says what the mesh is"),
    ),
    key(
        "groups",
        "of a .vtu or .xdmf file: the data at its cells that have the numbers of groups, or \"none\"",
        "",
        Form::Text,
        Preset::Absent("`gmsh:physical`, `cell_tags`, `facet_tags` and such, or the only whole numbers"),
    ),
    key(
        "facets",
        "the .vtu or .xdmf file of the lines with the numbers of groups of edges",
        "",
        Form::Text,
        Preset::Absent("the file of the mesh"),
    ),
    key(
        "names",
        "names for the numbers of groups",
        "",
        Form::Tables(GROUP_NAMES),
        Preset::Absent("those that the file has, otherwise the numbers"),
    ),
];

const GROUP_NAMES: &[Parameter] = &[
    key(
        "cells",
        "the number of a group of cells",
        "",
        Form::Integer(0, usize::MAX),
        Preset::Absent("none: `edges` has a number"),
    ),
    key(
        "edges",
        "the number of a group of edges",
        "",
        Form::Integer(0, usize::MAX),
        Preset::Absent("none: `cells` has a number"),
    ),
    needed("name", "its name in the scene", "", Form::Text),
];

pub(super) const HISTORIES: Parameter = key(
    "histories",
    "where laws with internal variables keep these and P; at the points their flow makes energy (for studies)",
    "",
    Form::Name(|| of(Histories::NAMES), &[]),
    Preset::Absent("`\"nodes\"`"),
);

pub(super) const PER_DIRECTION: Parameter = key(
    "per_direction",
    "points per cell and direction; of a layout through the whole body in the mean",
    "",
    Form::Integer(1, 30),
    Preset::Absent("degree + 1; of poisson-disk and rotated degree + 2; of random and cluster degree + 3"),
);

pub(super) const LAYOUT: Parameter = key(
    "layout",
    "where the points stand",
    "",
    Form::Name(|| LAYOUTS.names(), &[]),
    Preset::Absent(
        "`\"paper\"`; from degree 3 on `\"midpoints\"`; for laws with internal variables, and in scenes with contact, obstacles or unilateral walls, `\"gauss\"`",
    ),
);

pub(super) const LIMITS: [Parameter; 2] = [
    key(
        "face_lebesgue",
        "largest face Lebesgue constant of the points of a cell; where it is given it holds for lattices too",
        "",
        Form::Number(AT_LEAST_1),
        Preset::Absent("10, 10, 30, 60, 150, 500, 1650 for degree 0 to 6"),
    ),
    key(
        "condition",
        "largest condition number of the fit; where it is given it holds for lattices too",
        "",
        Form::Number(AT_LEAST_1),
        Preset::Absent("1e5"),
    ),
];
pub(super) const CLOUD: &[Parameter] = &[LAYOUT, PER_DIRECTION, HISTORIES, LIMITS[0], LIMITS[1]];

/// What a material may have of its own: no file.
fn own_layouts() -> Vec<&'static str> {
    LAYOUTS.iter().filter(|entry| !entry.build.is_file()).map(|entry| entry.name).collect()
}

pub(super) const LAW: Parameter = needed("law", "the law", "", Form::Name(|| LAWS.names(), &[]));
pub(super) const OWN_LAYOUT: Parameter = key(
    "layout",
    "as in [cloud], with its keys, for the points of this group",
    "",
    Form::Name(own_layouts, &[]),
    Preset::Absent("that of [cloud]"),
);
pub(super) const MATERIAL: &[Parameter] = &[
    key("group", "the group of cells", "", Form::Text, Preset::Absent("all cells, of a single [[material]]")),
    LAW,
    key(
        "histories",
        "as in [cloud], for the points of this group",
        "",
        Form::Name(|| of(Histories::NAMES), &[]),
        Preset::Absent("that of [cloud]"),
    ),
    OWN_LAYOUT,
    Parameter {
        default: Preset::Absent("that of [cloud], or more where `layout` is given and needs more points"),
        ..PER_DIRECTION
    },
];

pub(super) const VELOCITY: Parameter =
    key("velocity", "v1, v2; expressions of x, y", "m/s", Form::Expressions(2), Preset::Constant(&[0.0, 0.0]));
pub(super) const DEFORMATION: Parameter = key(
    "deformation",
    "F11, F12, F21, F22; expressions of x, y",
    "",
    Form::Expressions(4),
    Preset::Constant(&[1.0, 0.0, 0.0, 1.0]),
);
pub(super) const SNAPSHOT: Parameter = key(
    "snapshot",
    "a snapshot that the run starts from, such as \"snapshots/000123.h5\"; without any other key",
    "",
    Form::Text,
    Preset::Absent("none"),
);
pub(super) const FROM: Parameter = key(
    "from",
    "the state comes from the fields of the cloud file; without any other key",
    "",
    Form::Name(|| vec!["cloud"], &[]),
    Preset::Absent("none"),
);
pub(super) const INITIAL: &[Parameter] = &[
    VELOCITY,
    DEFORMATION,
    SNAPSHOT,
    FROM,
    fields::FILE,
    fields::VELOCITY,
    fields::DISPLACEMENT,
    fields::DEFORMATION,
    fields::TIME,
];

pub(super) const EXACT: &[Parameter] = &[needed("kind", "the solution", "", Form::Name(|| SOLUTIONS.names(), &[]))];

pub(super) const BOUNDARY: &[Parameter] = &[
    needed("group", "the group of edges in the mesh, such as \"left\"", "", Form::Text),
    needed("kind", "the condition", "", Form::Name(|| CONDITIONS.names(), &[])),
];

pub(super) const SOURCE: &[Parameter] = &[
    key("group", "the group of cells that it acts on", "", Form::Text, Preset::Absent("all cells")),
    needed("kind", "the source", "", Form::Name(|| SOURCES.names(), &[])),
];

/// The share of the measured limit that a step is, where the scene says nothing of it.
pub(super) const SAFETY: f64 = 0.9;

const DEGREE: Form = Form::Integer(0, 6);

pub(super) const SCHEME: &[Parameter] = &[
    needed("method", "the method", "", Form::Name(|| METHODS.names(), &[])),
    needed("degree", "degree N of the polynomials in space", "", DEGREE),
    key("time_degree", "degree N_T in time", "", DEGREE, Preset::Absent("`degree`")),
    key("flux", "the flux on inner faces", "", Form::Name(|| FLUXES.names(), &[]), Preset::Absent(fluxes::DEFAULTS)),
    key(
        "cfl",
        "size of the time step: dt = cfl h / ((2N+1) c); a step beyond the stability limit is an error",
        "",
        Form::Number(POSITIVE),
        Preset::Absent("none: `safety` says what the step is"),
    ),
    key(
        "safety",
        "size of the time step as a share of the measured stability limit, in place of `cfl`; above 1 is an error",
        "",
        Form::Number(POSITIVE),
        Preset::Absent("0.9"),
    ),
    key(
        "sweeps",
        "sweeps of the predictor: the ladder evaluates the law less often, with the same limits and orders, and needs time_degree = degree",
        "",
        Form::Name(|| of(Sweeps::NAMES), &[]),
        Preset::Absent("`\"ladder\"`; with another time_degree `\"paper\"`"),
    ),
    key(
        "angular_momentum",
        "whether each body keeps its angular momentum to rounding: after each step it turns as little as that takes; not with a [[source]], and not at degree 0",
        "",
        Form::Boolean,
        Preset::Boolean(false),
    ),
    key(
        "springs",
        "whether springs in the faces pull back what jumps of the traction have moved them by: elastic bodies that vibrate or carry loads for long keep more of their energy, for 10 % more time; flux `dual`, see docs/method.md",
        "",
        Form::Boolean,
        Preset::Boolean(false),
    ),
];

pub(super) const CURL: &[Parameter] =
    &[key("control", "the control", "", Form::Name(|| CONTROLS.names(), &["auto"]), Preset::Name(controls::DEFAULT))];

pub(super) const LIMITER: &[Parameter] =
    &[key("kind", "the limiter", "", Form::Name(|| LIMITERS.names(), &[]), Preset::Name(limiters::DEFAULT))];

pub(super) const TIME: &[Parameter] = &[
    key("start", "time of the initial state", "s", Form::Number(FINITE), Preset::Number(0.0)),
    needed("end", "the end time", "s", Form::Number(POSITIVE)),
];

/// Shares of energy made out of nothing at which a run stops and warns.
pub(super) const WATCHED: [f64; 2] = [0.1, 1e-3];

pub(super) const WATCH: &[Parameter] = &[
    key(
        "energy",
        "share of energy made out of nothing at which the run stops",
        "",
        Form::Or("off", &Form::Number(POSITIVE)),
        Preset::Absent("0.1"),
    ),
    key("warn", "share at which the program warns", "", Form::Number(POSITIVE), Preset::Absent("1e-3")),
];

/// 0 is the initial state.
const MOMENT: Check = NOT_NEGATIVE;

/// When something is done.
pub(super) const WHEN: &[Parameter] = &[
    key("at", "at these times", "s", Form::Numbers(MOMENT), Preset::Absent("none")),
    key("every", "at the start and then every so many seconds", "s", Form::Number(POSITIVE), Preset::Absent("none")),
    key(
        "every_steps",
        "at the start and then every so many steps",
        "",
        Form::Integer(1, usize::MAX),
        Preset::Absent("none"),
    ),
];

pub(super) const EXACT_TIMES: Parameter = key(
    "exact_times",
    "whether steps are shortened to end at the times of `at` or `every`",
    "",
    Form::Boolean,
    Preset::Boolean(false),
);

pub(super) const OUTPUT: &[Parameter] = &[needed("kind", "what is recorded", "", Form::Name(|| OUTPUTS.names(), &[]))];

/// When a quantity is taken; the first is the default.
pub(super) const OVER: [&str; 2] = ["end", "run"];

pub(super) const QUANTITY: &[Parameter] = &[
    needed("name", "its name in results, unique: letters, digits, `_`, `-` and `.`", "", Form::Text),
    needed("kind", "the quantity", "", Form::Name(|| QUANTITIES.names(), &[])),
    key(
        "over",
        "taken at the end of the run, or over all its steps",
        "",
        Form::Name(|| OVER.to_vec(), &[]),
        Preset::Name(OVER[0]),
    ),
    key(
        "time",
        "taken at this time, on a straight line between the steps before and after it; in place of `over`",
        "s",
        Form::Number(MOMENT),
        Preset::Absent("the end of the run"),
    ),
    key(
        "statistic",
        "with `over = \"run\"`: what is taken of the values of all steps",
        "",
        Form::Name(|| of(Statistic::NAMES), &[]),
        Preset::Absent("`\"max\"`"),
    ),
];

pub(super) const CHECKPOINT: &[Parameter] = &[
    key(
        "every_minutes",
        "minutes between two checkpoints",
        "min",
        Form::Number(POSITIVE),
        Preset::Absent("10, where `every_steps` is absent"),
    ),
    key("every_steps", "steps between two checkpoints", "", Form::Integer(1, usize::MAX), Preset::Absent("none")),
];

pub(super) const CRITERIA: &[Parameter] = &[
    key(
        "certificate",
        "the largest face Lebesgue constant of a cell is above this",
        "",
        Form::Number(POSITIVE),
        Preset::Absent("none"),
    ),
    key(
        "distortion",
        "the smallest scaled Jacobian in the current configuration is below this",
        "",
        Form::Number(SHARE),
        Preset::Absent("none"),
    ),
    key(
        "front",
        "velocity varies within a cell by more than this share of its range over the body",
        "",
        Form::Number(SHARE),
        Preset::Absent("none"),
    ),
];

pub(super) const REGRID: [Parameter; 2] = [
    key(
        "when",
        "at those times only if one of these conditions holds; without times it is tested every 10 steps",
        "",
        Form::Table(CRITERIA),
        Preset::Absent("always"),
    ),
    key("points", "what happens to the points", "", Form::Name(|| of(Policy::NAMES), &[]), Preset::Name("keep")),
];
