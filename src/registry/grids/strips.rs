//! The mesh of the scene with finer strips.

use super::lines::grid_of_lines;
use super::{FACTOR, Present, Rule, Values, fronts};
use crate::error::Result;
use crate::mesh::Mesh;
use crate::registry::{Fault, Form, NOT_NEGATIVE, Parameter, Preset, SHARE};
use crate::regrid::TensorGrid;

/// The share of the range of velocity that makes a front, where none is given: at a shock, which takes one to three cells,
/// it is .3 to .6; in the fan from a free corner .05 to .1 on 30 cells.
pub const FRONT: f64 = 0.2;

/// The word that stands for the cells of a front.
const AT_FRONT: &str = "front";

const AXES: [&str; 2] = ["x", "y"];

/// The keys of a strip.
pub(super) const STRIP: &[Parameter] = &[
    Parameter::required("axis", "which lines become finer: those of x or of y", "", Form::Name(|| AXES.to_vec(), &[])),
    Parameter::required(
        "around",
        "where: at all cells with a front of velocity, or at a position that depends on t",
        "m",
        Form::Or(AT_FRONT, &Form::Expression),
    ),
    Parameter::new(
        "share",
        "with around = \"front\": a front varies by more than this share of the range of velocity",
        "",
        Form::Number(SHARE),
        Preset::Absent("0.2"),
    ),
    Parameter::required("behind", "how far it reaches below", "m", Form::Number(NOT_NEGATIVE)),
    Parameter::required("ahead", "how far it reaches above", "m", Form::Number(NOT_NEGATIVE)),
    Parameter::new("factor", "parts that each interval is cut into", "", FACTOR, Preset::Integer(2)),
];

/// Only a front has a share.
pub(super) fn fit(of: &Values) -> std::result::Result<(), Fault> {
    let is_wrong = |strip: &Values| strip.has("share") && strip.text("around") != AT_FRONT;
    match of.tables("strips").iter().position(is_wrong) {
        None => Ok(()),
        Some(k) => Err(Fault::new(
            format!("strips.{k}.share"),
            "`share` says what a front is, and the strip is at a position",
            "remove it, or give around = \"front\"",
        )),
    }
}

pub(super) fn make(of: &Values, rule: &dyn Rule, _: usize, present: &Present) -> Result<Mesh> {
    let wrong =
        |what| rule.wrong("strips", what, "strips need a mesh of the scene that is a grid of lines, of one group");
    let base = rule.base()?;
    let lines = with_strips(&base, of.tables("strips"), present).map_err(wrong)?;
    rule.has_room("strips", (lines[0].len() - 1).saturating_mul(lines[1].len() - 1))?;
    grid_of_lines(&base, lines).map_err(wrong)
}

/// The lines of the scene's own mesh with finer strips. Its lines stay, so that most cells are those of the last grid.
fn with_strips(base: &Mesh, strips: &[Values], present: &Present) -> std::result::Result<[Vec<f64>; 2], String> {
    let mut lines = TensorGrid::of(base).ok_or("the mesh of the scene is not a grid of lines")?.lines;
    for strip in strips {
        let axis = usize::from(strip.text("axis") == AXES[1]);
        let (low, high) = match strip.expression("around") {
            Some(at) => {
                let at = at.eval([0.0; 2], present.view.state.time);
                (at, at)
            }
            None => {
                let cells = fronts(present, strip.maybe("share").unwrap_or(FRONT));
                let at = cells.iter().flat_map(|&cell| present.view.mesh.corners(cell).map(|x| x[axis]));
                at.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)))
            }
        };
        let within = [low - strip.number("behind"), high + strip.number("ahead")];
        lines[axis] = finer(&lines[axis], within, strip.integer("factor"));
    }
    Ok(lines)
}

/// Lines with intervals that meet the open interval `within` cut into `factor` equal ones.
fn finer(lines: &[f64], within: [f64; 2], factor: usize) -> Vec<f64> {
    let mut out = vec![lines[0]];
    for pair in lines.windows(2) {
        let (a, b) = (pair[0], pair[1]);
        // A strip that ends on a line does not reach beyond it: rounding is no reason to cut.
        let slack = 1e-9 * (b - a);
        if a < within[1] - slack && b > within[0] + slack {
            out.extend((1..factor).map(|k| a + (b - a) * (k as f64 / factor as f64)));
        }
        out.push(b);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_cut_the_intervals_that_they_meet_and_no_others() {
        let lines = [0.0, 1.0, 2.0, 3.0];
        assert_eq!(finer(&lines, [1.0, 2.0], 2), [0.0, 1.0, 1.5, 2.0, 3.0]);
        assert_eq!(finer(&lines, [0.5, 1.5], 4), [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 3.0]);
        assert_eq!(finer(&lines, [-3.0, -1.0], 2), lines);
        // No front was found.
        assert_eq!(finer(&lines, [f64::INFINITY, f64::NEG_INFINITY], 2), lines);
    }
}
