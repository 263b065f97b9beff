//! The limiters of cells at shocks, and the rescue of lost cells, `[limiter] kind = ..`.

use super::{ANY, Check, Entry, Form, NOT_NEGATIVE, Parameter, Preset, Table, Values};
use crate::limiter::{CellLimiter, Limiter, MomentLimiter, Sensor, VertexLimiter};
use crate::step::Correction;
use std::sync::Arc;

/// Makes a limiter from its parameters, for a degree in space.
pub type Make = fn(&Values, usize) -> Arc<dyn Correction>;

/// What there is to know of a limiter.
pub struct Kind {
    /// Makes it; none: no limiter.
    pub make: Option<Make>,
    /// The flux of a scene that names none, where no law has internal variables or a
    /// Poisson's ratio above .45 (there it makes energy). A limiter needs one that damps all jumps of F: with `dual` the
    /// stress behind the shock of the paper's impact is wrong by .8 % (S2, 200 m/s) to 10 % (S1, 2000 m/s), with `rusanov` by .04 %.
    pub flux: Option<&'static str>,
}

/// The limiter of a scene that names none.
pub const DEFAULT: &str = "off";

const THRESHOLD: Parameter = Parameter::new(
    "threshold",
    "cells are limited whose jump at a face is above .6 times this times (h/L)^((N+2)/4) of the range of the solution; 0: all cells",
    "",
    Form::Number(NOT_NEGATIVE),
    Preset::Number(1.0),
);

/// Whether lost cells are stepped again with degree 0.
const fn rescue(default: bool) -> Parameter {
    Parameter::new(
        "rescue",
        "whether cells that a step loses, or whose J falls below .8 of that of their mean F, are stepped again with degree 0",
        "",
        Form::Boolean,
        Preset::Boolean(default),
    )
}

/// Every limiter.
pub static LIMITERS: Table<Kind> = Table::new(&[
    Entry {
        name: "off",
        about: "no limiter",
        parameters: &[rescue(false)],
        check: ANY,
        build: Kind { make: None, flux: None },
    },
    Entry {
        name: "moment",
        about: "cuts modes in characteristic variables to the differences of the next lower modes, from the highest down",
        parameters: &[
            Parameter::new(
                "beta",
                "how much steeper than its neighbours a cell may be",
                "",
                Form::Number(Check { range: "from 1 to 2", holds: |x| (1.0..=2.0).contains(&x) }),
                Preset::Number(2.0),
            ),
            THRESHOLD,
            rescue(true),
        ],
        check: ANY,
        build: Kind {
            make: Some(|of, degree| limiter(of, degree, MomentLimiter { beta: of.number("beta") })),
            flux: Some("rusanov"),
        },
    },
    Entry {
        name: "vertex",
        about: "keeps the linear part of each derivative in the range of the cells around each corner; component by component",
        parameters: &[THRESHOLD, rescue(true)],
        check: ANY,
        build: Kind { make: Some(|of, degree| limiter(of, degree, VertexLimiter)), flux: Some("rusanov") },
    },
]);

fn limiter(of: &Values, degree: usize, kind: impl CellLimiter) -> Arc<dyn Correction> {
    Arc::new(Limiter::new(degree, Sensor { threshold: of.number("threshold") }, kind))
}
