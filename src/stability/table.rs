//! Results as rows of a table and as CSV.

use super::cases::Case;
use super::measure::Measured;
use std::f64::consts::PI;

/// A case with what was found, or why nothing was.
#[derive(Debug, Clone)]
pub struct Row {
    /// The case.
    pub case: Case,
    /// The numbers.
    pub found: Measured,
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
        if !["method", "degree", "layout", "flux", "curl"].contains(&&key[..]) {
            out.push((key.clone(), Box::new(move |row: &Row| row.case.labels[k].1.clone())));
        }
    }
    let mut number = |head: &str, of: fn(&Measured) -> Option<f64>| {
        if rows.iter().any(|row| of(&row.found).is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| of(&row.found).map_or("-".into(), short))));
        }
    };
    number("dt c/h", |found| found.courant);
    number("radius - 1", |found| found.radius.map(|radius| radius - 1.0));
    number("growth h/c_p", |found| Some(found.growth));
    number("limit dt c/h", |found| found.limit);
    number("angle x", |found| Some(found.theta?[0] * 180.0 / PI));
    number("angle y", |found| Some(found.theta?[1] * 180.0 / PI));
    number("energy h/c_p", |found| Some(found.energy));
    for (k, head) in ["|S|", "|S^10|", "|S^100|"].into_iter().enumerate() {
        if rows.iter().any(|row| row.found.norms.is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| row.found.norms.map_or("-".into(), |n| short(n[k])))));
        }
    }
    let mut number = |head: &str, of: fn(&Measured) -> Option<f64>| {
        if rows.iter().any(|row| of(&row.found).is_some()) {
            out.push((head.to_owned(), Box::new(move |row: &Row| of(&row.found).map_or("-".into(), short))));
        }
    };
    number("noise h/c_p", |found| Some(found.noise));
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
    out.iter().map(|line| line.trim_end().to_owned()).collect()
}
