//! The cheapest settings: the Pareto front of error and seconds, and the answer in words.

use super::case::Series;
use super::record::Record;

/// Indices of the records that no other beats in both error and CPU seconds, by falling error. An error that is only known to be below a
/// number counts as that number.
pub fn front(records: &[Record]) -> Vec<usize> {
    let mut order: Vec<(usize, f64)> =
        records.iter().enumerate().filter_map(|(k, r)| Some((k, r.bound().filter(|e| e.is_finite())?))).collect();
    order.sort_by(|a, b| records[a.0].cpu.total_cmp(&records[b.0].cpu).then(a.1.total_cmp(&b.1)));
    let mut best = f64::INFINITY;
    order.retain(|&(_, error)| {
        let better = error < best;
        best = best.min(error);
        better
    });
    order.into_iter().map(|(k, _)| k).collect()
}

/// The cheapest record for an error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// The error asked for.
    pub error: f64,
    /// Index of the record.
    pub record: usize,
}

/// The cheapest record for each power of ten between the largest and the smallest error of the front; where these are
/// less than two powers apart, as at a shock, for 1, 2, 3 and 5 times each power; where no such number lies between them, for the errors
/// of the front themselves.
pub fn answers(records: &[Record]) -> Vec<Answer> {
    let front = front(records);
    let errors: Vec<f64> = front.iter().filter_map(|&k| records[k].bound()).collect();
    let (Some(&largest), Some(&smallest)) = (errors.first(), errors.last()) else { return vec![] };
    let steps: &[f64] = if largest / smallest < 100.0 { &[5.0, 3.0, 2.0, 1.0] } else { &[1.0] };
    let powers = (smallest.log10().floor() as i32..=largest.log10().floor() as i32).rev();
    let targets = powers.flat_map(|power| steps.iter().map(move |step| step * 10_f64.powi(power)));
    let cheapest = |error: f64| {
        // The front goes from cheap to dear.
        let record = *front.iter().find(|&&k| records[k].bound().is_some_and(|e| e <= error))?;
        (error < largest).then_some(Answer { error, record })
    };
    let found: Vec<Answer> = targets.filter_map(cheapest).collect();
    if !found.is_empty() {
        return found;
    }
    front.iter().filter_map(|&record| Some(Answer { error: records[record].bound()?, record })).collect()
}

/// CPU seconds of a series for an error, by a straight line in logarithms between the two records around it; none where
/// it was not reached. An error above that of the coarsest mesh costs what that mesh costs.
pub fn cost(records: &[Record], series: &Series, error: f64) -> Option<f64> {
    let mut points: Vec<(f64, f64)> =
        records.iter().filter(|r| r.case.series == *series).filter_map(|r| Some((r.bound()?, r.cpu))).collect();
    points.sort_by(|a, b| b.0.total_cmp(&a.0));
    let first = *points.first()?;
    if first.0 <= error {
        return Some(first.1);
    }
    let pair = points.windows(2).find(|pair| pair[1].0 <= error)?;
    let share = (pair[0].0 / error).ln() / (pair[0].0 / pair[1].0).ln();
    Some((pair[0].1.ln() + share * (pair[1].1 / pair[0].1).ln()).exp())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::case::Case;

    fn record(degree: usize, refinement: f64, cpu: f64, error: f64) -> Record {
        let series = Series {
            method: crate::registry::Method::RkDgfem,
            degree,
            time_degree: degree,
            layout: None,
            sets: Vec::new(),
        };
        Record { cpu, error: Some(error), ..Record::failed(Case { series, refinement }, "done".into()) }
    }

    fn records() -> Vec<Record> {
        vec![
            record(1, 1.0, 1.0, 2e-1),
            record(1, 2.0, 8.0, 5e-2),
            record(3, 1.0, 4.0, 2e-2),
            record(3, 2.0, 32.0, 2e-3),
            Record::failed(Case { series: record(2, 1.0, 0.0, 0.0).case.series, refinement: 1.0 }, "unstable".into()),
        ]
    }

    #[test]
    fn no_record_of_the_front_is_beaten_and_every_other_is() {
        assert_eq!(front(&records()), [0, 2, 3]);
        assert_eq!(front(&[]), [] as [usize; 0]);
    }

    #[test]
    fn answers_name_the_cheapest_record_that_has_the_error() {
        let answers = answers(&records());
        let found: Vec<(f64, usize)> = answers.iter().map(|a| ((1e9 * a.error).round() / 1e9, a.record)).collect();
        assert_eq!(found, [(0.1, 2), (0.01, 3)]);
    }

    #[test]
    fn errors_that_lie_close_together_are_told_apart() {
        let shock = [record(1, 1.0, 1.0, 9e-2), record(2, 1.0, 2.0, 4e-2), record(2, 2.0, 3.0, 2.5e-2)];
        let found: Vec<(f64, usize)> = answers(&shock).iter().map(|a| (a.error, a.record)).collect();
        assert_eq!(found, [(0.05, 1), (0.03, 2)]);
    }

    #[test]
    fn where_no_round_error_lies_between_those_of_the_front_they_are_the_answers() {
        let one = [record(1, 1.0, 1.0, 3.2e-2)];
        assert_eq!(answers(&one), [Answer { error: 3.2e-2, record: 0 }]);
        let two = [record(1, 1.0, 1.0, 9e-2), record(2, 1.0, 2.0, 7e-2)];
        let found: Vec<(f64, usize)> = answers(&two).iter().map(|a| (a.error, a.record)).collect();
        assert_eq!(found, [(9e-2, 0), (7e-2, 1)]);
        assert_eq!(answers(&[]), []);
    }

    #[test]
    fn an_error_below_that_of_the_reference_counts_as_its_bound() {
        let mut all = records();
        // 1e-9 away from a reference that is 5e-4 off.
        all[3].judge(Some(1e-9), Some(5e-4));
        assert_eq!((all[3].error(), all[3].bound().unwrap()), (None, 5e-4 + 1e-9));
        // Rounded up: 5.0e-4 would not be true.
        assert_eq!(all[3].error_words(), "< 5.1e-4");
        assert_eq!(front(&all), [0, 2, 3]);
        assert!(answers(&all).iter().all(|answer| answer.error > 5e-4));
        // As far away as the reference is off: an error.
        all[3].judge(Some(5e-4), Some(5e-4));
        assert_eq!((all[3].error(), all[3].below), (Some(5e-4), None));
    }

    #[test]
    fn costs_lie_on_a_line_in_logarithms() {
        let all = records();
        // Half-way between 2e-2 and 2e-3 in logarithms: sqrt(4 x 32).
        let half_way = cost(&all, &all[2].case.series, 2e-2 / 10_f64.sqrt()).unwrap();
        assert!((half_way / 128_f64.sqrt() - 1.0).abs() < 1e-12, "{half_way}");
        assert_eq!(cost(&all, &all[0].case.series, 1e-3), None);
        assert_eq!(cost(&all, &all[0].case.series, 0.5), Some(1.0));
    }
}
