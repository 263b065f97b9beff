//! Tables: by their columns.

use super::Info;
use serde_json::json;

/// What a table of a kind begins with.
const KINDS: [(&str, &str); 6] = [
    ("step,t,dt,kinetic_energy", "ledger: energy and momentum over time"),
    ("step,t,rule,cells_before", "changes of the mesh during a run"),
    ("t [s],", "numbers through time of an output"),
    ("t,s,x,y,", "samples along a line"),
    ("method,", "table of a study"),
    ("t,", "table of loads"),
];

/// What a table holds; none where the text is no table of numbers.
pub(super) fn info(text: &str) -> Option<Info> {
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#'));
    let header = lines.next()?;
    let columns: Vec<&str> = header.split(',').map(str::trim).collect();
    let kind = KINDS.iter().find(|(start, _)| header.starts_with(start)).map(|(_, kind)| *kind);
    let rows: Vec<Vec<&str>> = lines.map(|line| line.split(',').collect()).collect();
    let is_table = columns.len() > 1 && !rows.is_empty() && rows.iter().all(|row| row.len() == columns.len());
    let is_number = |text: &&str| text.trim().parse::<f64>().is_ok();
    let has_numbers = rows.iter().any(|row| row.iter().any(is_number));
    if !is_table || !(has_numbers || kind.is_some()) {
        return None;
    }
    let time = columns.iter().position(|name| ["t", "t [s]"].contains(name));
    let times = time.and_then(|k| {
        let of = |row: Option<&Vec<&str>>| row?.get(k)?.trim().parse::<f64>().ok();
        Some(json!([of(rows.first())?, of(rows.last())?]))
    });
    let info = Info::new(kind.unwrap_or("table of numbers")).with("columns", columns).with("rows", rows.len());
    Some(info.maybe("t_from_to_s", times))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_has_a_header_and_rows_of_its_length() {
        let kind = |text: &str| info(text).map(|info| info.kind);
        assert_eq!(kind("t [s],x\n0e0,1e0\n").as_deref(), Some("numbers through time of an output"));
        assert_eq!(kind("# a load\nt,p\n0,1\n1,2\n").as_deref(), Some("table of loads"));
        assert_eq!(kind("a,b\n1,2\n").as_deref(), Some("table of numbers"));
        for no_table in ["", "a,b\n", "words and, more\nwords, again", "a,b\n1\n", "1\n2\n"] {
            assert_eq!(kind(no_table), None, "{no_table:?}");
        }
        let whole = info("t,p\n0,1\n2e-3,2\n").unwrap();
        assert!(whole.facts.contains(&("t_from_to_s".to_owned(), json!([0.0, 2e-3]))), "{whole:?}");
    }
}
