//! Results as rows of a table, as CSV and as a chart.

use super::cases::{self, Case, NO_LAYOUT, Plan};
use super::measure::{Limit, Measured, Questions, measure};
use crate::chart::{Chart, Line, Marker, Scale, Stroke};
use crate::error::Result;
use std::f64::consts::PI;

/// The keys that have a column of their own in any case.
const OWN: [&str; 5] = ["method", "degree", "layout", "flux", "curl"];
/// Numbers whose largest is so many times the smallest stand on a logarithmic axis.
const WIDE: f64 = 100.0;

/// A case with what was found, or why nothing was.
#[derive(Debug, Clone)]
pub struct Row {
    /// The case.
    pub case: Case,
    /// The numbers.
    pub found: Measured,
}

/// Measures all cases of a plan. `plotted`: there is a list of numbers that a plot stands over.
///
/// # Errors
/// Bad input; nothing to plot over, which is found before the work begins.
pub fn rows(plan: &Plan, questions: Questions, plotted: bool) -> Result<Vec<Row>> {
    let cases = plan.cases()?;
    if plotted {
        cases::axis(&cases)?;
    }
    cases.into_iter().map(|case| Ok(Row { found: measure(&case.setup, questions)?, case })).collect()
}

/// A column: its head, and its text in a row.
type Column = (String, Box<dyn Fn(&Row) -> String>);

/// A number of the table: 0 where it is below what the matrix is exact to.
fn short(x: f64) -> String {
    match x {
        _ if x == 0.0 => "0".into(),
        _ if x.abs() >= 0.01 && x.abs() < 1000.0 => format!("{x:.4}"),
        _ => format!("{x:.1e}"),
    }
}

fn columns(rows: &[Row]) -> Vec<Column> {
    let mut out: Vec<Column> = Vec::new();
    let Some(first) = rows.first() else { return out };
    let mut text = |head: &str, of: fn(&Row) -> Option<String>| {
        if rows.iter().any(|row| of(row).is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| of(row).unwrap_or_else(|| "-".to_owned()))));
        }
    };
    text("method", |row| Some(row.found.names.method.clone()));
    text("N", |row| Some(row.found.names.degree.to_string()));
    text("layout", |row| row.found.names.layout.clone());
    text("flux", |row| Some(row.found.names.flux.clone()));
    text("curl", |row| Some(row.found.names.curl.clone()));
    text("cells", |row| Some(row.found.cells.to_string()));
    for (k, (key, _)) in first.case.labels.iter().enumerate() {
        if !OWN.contains(&&key[..]) {
            out.push((key.clone(), Box::new(move |row: &Row| row.case.labels[k].1.clone())));
        }
    }
    let number = |out: &mut Vec<Column>, head: &str, of: fn(&Measured) -> Option<f64>| {
        if rows.iter().any(|row| of(&row.found).is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| of(&row.found).map_or("-".into(), short))));
        }
    };
    number(&mut out, "dt c/h", |found| found.courant);
    number(&mut out, "radius - 1", |found| found.radius.map(|radius| radius - 1.0));
    number(&mut out, "growth h/c_p", |found| Some(found.growth));
    if rows.iter().any(|row| row.found.limit.is_some()) {
        let text = |limit: Limit| short(limit.courant) + if limit.grows { "+" } else { "" };
        out.push(("limit dt c/h".to_owned(), Box::new(move |row: &Row| row.found.limit.map_or("-".into(), text))));
    }
    number(&mut out, "angle x", |found| Some(found.theta?[0] * 180.0 / PI));
    number(&mut out, "angle y", |found| Some(found.theta?[1] * 180.0 / PI));
    let energy = |row: &Row| short(row.found.energy) + if row.found.definite { "" } else { "*" };
    out.push(("energy h/c_p".to_owned(), Box::new(energy)));
    for (k, head) in ["|S|", "|S^10|", "|S^100|"].into_iter().enumerate() {
        if rows.iter().any(|row| row.found.norms.is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| row.found.norms.map_or("-".into(), |n| short(n[k])))));
        }
    }
    number(&mut out, "noise h/c_p", |found| Some(found.noise));
    out
}

/// The table, a line a case, below a head.
pub fn lines(rows: &[Row]) -> Vec<String> {
    let columns = columns(rows);
    let mut out = vec![String::new(); rows.len() + 1];
    for (head, text) in &columns {
        let cells: Vec<String> = std::iter::once(head.clone()).chain(rows.iter().map(text)).collect();
        let width = cells.iter().map(|cell| cell.chars().count()).max().unwrap_or(0);
        out.iter_mut().zip(cells).for_each(|(line, cell)| *line += &format!("{cell:<width$}  "));
    }
    let mut out: Vec<String> = out.iter().map(|line| line.trim_end().to_owned()).collect();
    if rows.iter().any(|row| !row.found.definite) {
        out.push("* the energy of this state is indefinite: a gain alone is no fault".to_owned());
    }
    if rows.iter().any(|row| row.found.limit.is_some_and(|limit| limit.grows)) {
        out.push("+ the state grows at any step; up to this step not more than twice as fast".to_owned());
    }
    out
}

/// All numbers with all digits, angles in degrees; rates in c_p/h, steps in c/h.
pub fn csv(rows: &[Row]) -> String {
    let keys = rows.first().map_or(&[][..], |row| &row.case.labels);
    let own: Vec<usize> = (0..keys.len()).filter(|&k| !OWN.contains(&&keys[k].0[..])).collect();
    let mut text = "method,degree,layout,flux,curl,cells,unknowns".to_owned();
    own.iter().for_each(|&k| text += &format!(",{}", keys[k].0));
    text += ",step,spectral_radius,growth,limit,angle_1,angle_2,energy_growth,energy_definite,max_norm_1,max_norm_10,\
             max_norm_100,noise\n";
    for Row { case, found } in rows {
        let names = &found.names;
        let layout = names.layout.as_deref().unwrap_or_default();
        text += &format!("{},{},{layout},{},{}", names.method, names.degree, names.flux, names.curl);
        text += &format!(",{},{}", found.cells, found.unknowns);
        // F0 has commas of its own.
        own.iter().for_each(|&k| text += &format!(",\"{}\"", case.labels[k].1));
        let angles = found.theta.map(|theta| theta.map(|angle| angle * 180.0 / PI));
        let norm = |k: usize| found.norms.map(|norms| norms[k]);
        let numbers = [
            found.courant,
            found.radius,
            Some(found.growth),
            found.limit.map(|limit| limit.courant),
            angles.map(|a| a[0]),
            angles.map(|a| a[1]),
            Some(found.energy),
            Some(f64::from(u8::from(found.definite))),
            norm(0),
            norm(1),
            norm(2),
            Some(found.noise),
        ];
        numbers.iter().for_each(|x| text += &x.map_or(",".to_owned(), |x| format!(",{x:?}")));
        text.push('\n');
    }
    text
}

/// Growth over the last list of numbers, a line for each combination of the others.
///
/// # Errors
/// No list of at least two numbers.
pub fn chart(rows: &[Row]) -> Result<Chart> {
    let cases: Vec<Case> = rows.iter().map(|row| row.case.clone()).collect();
    let axis = cases::axis(&cases)?;
    let others: Vec<usize> = (0..cases[0].labels.len()).filter(|k| *k != axis && cases::varies(&cases, *k)).collect();
    let mut lines: Vec<Line> = Vec::new();
    for row in rows {
        let values = others.iter().map(|&k| &row.case.labels[k].1).filter(|value| *value != NO_LAYOUT);
        let name: Vec<String> = values.cloned().collect();
        let name = if name.is_empty() { row.found.names.method.clone() } else { name.join(" ") };
        let point = (row.case.number(axis).unwrap_or(f64::NAN), row.found.growth);
        match lines.iter_mut().find(|line| line.name == name) {
            Some(line) => line.points.push(point),
            None => lines.push(Line {
                name,
                colour: lines.len() + 1,
                marker: Marker::Circle,
                stroke: Stroke::Full,
                points: vec![point],
            }),
        }
    }
    let all = || cases.iter().filter_map(|case| case.number(axis));
    let (low, high) = all().fold((f64::INFINITY, 0.0_f64), |(low, high), x| (low.min(x), high.max(x)));
    let x = if low > 0.0 && high > WIDE * low { Scale::Log } else { Scale::Linear };
    Ok(Chart {
        title: "Growth of perturbations".to_owned(),
        x: rows[0].case.labels[axis].0.replace("dt", "dt c/h"),
        y: "growth h/c_p".to_owned(),
        scales: [x, Scale::Linear],
        lines,
    })
}
