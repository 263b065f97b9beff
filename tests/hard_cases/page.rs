//! docs/hard_cases.md.

use super::{Outcome, Verdict};
use std::fmt::Write;
use std::path::Path;

/// What stands above the tables.
const HEAD: &str = include_str!("head.md");

/// Writes the page.
pub fn write(outcomes: &[Outcome]) {
    let mut page = HEAD.to_owned();
    missed(&mut page, outcomes);
    let mut group = "";
    for Outcome { case, verdicts, seconds } in outcomes {
        if case.group != group {
            group = case.group;
            writeln!(page, "\n## {group}\n").unwrap();
            page.push_str("| case | setting | criterion and result | seconds |\n|---|---|---|---|\n");
        }
        let settings: Vec<_> = std::iter::once(format!("`{}.toml`", case.scene))
            .chain(case.sets.iter().map(|set| format!("`{}`", set.replace('|', "\\|"))))
            .collect();
        let lines: Vec<_> = verdicts.iter().map(|(verdict, _)| line(verdict)).collect();
        writeln!(page, "| {} | {} | {} | {seconds:.1} |", case.name, settings.join("<br>"), lines.join("<br>"))
            .unwrap();
    }
    richardson(&mut page, outcomes);
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("docs/hard_cases.md");
    std::fs::write(path, page).unwrap();
}

fn line(Verdict { criterion, figure, met }: &Verdict) -> String {
    format!("{}{criterion}: {figure}", if *met { "" } else { "**not met:** " })
}

/// The list of what is not met.
fn missed(page: &mut String, outcomes: &[Outcome]) {
    let of = |outcome: &Outcome| {
        let verdicts = outcome.verdicts.iter().filter(|(verdict, _)| !verdict.met);
        verdicts
            .map(|(Verdict { criterion, figure, .. }, _)| format!("- {}: {criterion}: {figure}\n", outcome.case.name))
            .collect()
    };
    let lines: Vec<String> = outcomes.iter().flat_map(|outcome| -> Vec<String> { of(outcome) }).collect();
    let checks: usize = outcomes.iter().map(|outcome| outcome.verdicts.len()).sum();
    let seconds: f64 = outcomes.iter().map(|outcome| outcome.seconds).sum();
    writeln!(
        page,
        "\n## What is not met\n\nOf {checks} criteria in {1} cases {0} are not met. All cases together take {seconds:.0} s of one core.\n\n{2}",
        lines.len(),
        outcomes.len(),
        lines.concat().trim_end()
    )
    .unwrap();
}

/// The final length of the copper bar without limiter by Richardson's extrapolation over cells that are halved twice.
fn richardson(page: &mut String, outcomes: &[Outcome]) {
    let length = |name: &str| -> Option<f64> {
        let outcome = outcomes.iter().find(|outcome| outcome.case.name == name)?;
        let (verdict, _) = outcome.verdicts.iter().find(|(verdict, _)| verdict.criterion.contains("length"))?;
        verdict.figure.split(' ').next()?.parse().ok()
    };
    let bar = "Taylor bar, copper, without limiter";
    let names = [format!("{bar}, 10 x 1 cells"), bar.to_owned(), format!("{bar}, 40 x 4 cells")];
    let [Some(coarse), Some(middle), Some(fine)] = names.map(|name| length(&name)) else { return };
    let ratio = (coarse - middle) / (middle - fine);
    let text = if ratio > 1.0 {
        let change = (middle - fine) / (ratio - 1.0);
        format!(
            "the observed order is {:.2}, the extrapolated length {:.2} mm: {:.2} mm ({:.1} %) below that of 40 x 4 cells",
            ratio.log2(),
            1e3 * (fine - change),
            1e3 * change,
            100.0 * change / fine
        )
    } else {
        "it does not converge on these meshes".to_owned()
    };
    let [a, b, c] = [coarse, middle, fine].map(|length| 1e3 * length);
    writeln!(
        page,
        "\n**Final length of the copper bar**, without limiter: {a:.2}, {b:.2}, {c:.2} mm with 10, 20 and 40 cells along it; {text}."
    )
    .unwrap();
}
