//! What the values of a compared key cost and bring, each beside the first of them.

use super::case::Case;
use super::record::Record;

/// One choice of the compared keys beside the first one.
#[derive(Debug, Clone, PartialEq, serde::Serialize)]
pub struct Comparison {
    /// The choice, such as `curl.control=off`.
    pub set: String,
    /// The first choice.
    pub beside: String,
    /// Pairs of runs that differ by the choice alone, and both got to their end.
    pub pairs: usize,
    /// CPU seconds over those of the first choice: the geometric mean of the pairs.
    pub cpu: f64,
    /// Error over that of the first choice, likewise; none where the error of no pair is known.
    pub error: Option<f64>,
}

/// All choices beside the first one; empty of a study that compares no keys.
pub fn compared(records: &[Record]) -> Vec<Comparison> {
    let mut choices: Vec<&Vec<String>> = Vec::new();
    for record in records {
        if !choices.contains(&&record.case.series.sets) {
            choices.push(&record.case.series.sets);
        }
    }
    let Some((&first, others)) = choices.split_first() else { return vec![] };
    others.iter().filter_map(|choice| beside(records, choice, first)).collect()
}

fn beside(records: &[Record], choice: &[String], first: &[String]) -> Option<Comparison> {
    let partner = |record: &Record| {
        let mut case: Case = record.case.clone();
        case.series.sets = first.to_vec();
        records.iter().find(|other| other.case == case && other.is_done())
    };
    let of_choice = records.iter().filter(|r| r.case.series.sets == *choice && r.is_done());
    let pairs: Vec<(&Record, &Record)> = of_choice.filter_map(|r| partner(r).map(|other| (r, other))).collect();
    let errors = pairs.iter().filter_map(|(a, b)| Some(a.error()? / b.error()?)).filter(|x| x.is_finite() && *x > 0.0);
    let cpu = mean(pairs.iter().map(|(a, b)| a.cpu / b.cpu))?;
    Some(Comparison { set: choice.join(" "), beside: first.join(" "), pairs: pairs.len(), cpu, error: mean(errors) })
}

/// The geometric mean; none of nothing.
fn mean(ratios: impl Iterator<Item = f64>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    ratios.for_each(|x| (sum, count) = (sum + x.ln(), count + 1));
    (count > 0).then(|| (sum / f64::from(count)).exp())
}

impl Comparison {
    /// As a line for the user.
    pub fn line(&self) -> String {
        let Self { set, beside, pairs, cpu, error } = self;
        let error = error.map_or(String::new(), |error| format!(" and {error:.3} times the error"));
        let runs = if *pairs == 1 { "1 pair of runs".to_owned() } else { format!("{pairs} pairs of runs") };
        format!("  {set} takes {cpu:.3} times the CPU seconds{error} of {beside} (mean of {runs})")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_of_ratios_is_geometric() {
        // Twice as long once and half as long once is no difference.
        assert_eq!(mean([2.0, 0.5].into_iter()), Some(1.0));
        assert_eq!(mean(std::iter::empty()), None);
    }
}
