//! Quantities over the meshes of a series: their errors and, where no exact solution is known, their limit.

use super::case::Series;
use super::measure::Measure;
use super::record::Record;
use super::richardson::{Doubt, Estimate, estimate};
use crate::registry::quantities::Kind;
use crate::scene::Scene;
use serde_json::{Value, json};

/// A quantity over the meshes of a series.
#[derive(Debug, Clone, PartialEq)]
pub struct Trend {
    /// The series.
    pub series: Series,
    /// Refinement and value, from coarse to fine.
    pub values: Vec<(f64, f64)>,
    /// What is known of its limit.
    pub limit: Limit,
}

/// What is known of the limit of a quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Limit {
    /// The quantity is an error itself.
    Zero,
    /// The value of the exact solution.
    Exact(f64),
    /// By Richardson's extrapolation, or why not.
    Extrapolated(Result<Estimate, Doubt>),
}

impl Limit {
    /// The error of a value: relative, or absolute where the limit is 0; none where the limit is not known.
    fn error(&self, value: f64) -> Option<f64> {
        let limit = match self {
            Self::Zero => 0.0,
            Self::Exact(limit) => *limit,
            Self::Extrapolated(estimate) => estimate.ok()?.limit,
        };
        let error = (value - limit).abs();
        Some(if limit == 0.0 { error } else { error / limit.abs() }).filter(|error| error.is_finite())
    }

    /// What is known, in a few words.
    pub fn words(&self) -> String {
        match self {
            Self::Zero => "is an error itself".to_owned(),
            Self::Exact(limit) => format!("exact {}", number_words(*limit)),
            Self::Extrapolated(Err(doubt)) => doubt.to_string(),
            Self::Extrapolated(Ok(Estimate { limit, order: None, .. })) => {
                format!("the same on all meshes, {}", number_words(*limit))
            }
            Self::Extrapolated(Ok(Estimate { limit, order: Some(order), .. })) => {
                format!("order {order:.2}, extrapolated {}", number_words(*limit))
            }
        }
    }
}

impl Trend {
    /// Of quantity `number` of the scene in the records of a series; none without a run that went well.
    fn of(records: &[Record], series: &Series, number: usize, kind: &Kind) -> Option<Self> {
        let own = records.iter().filter(|r| r.case.series == *series && r.is_done());
        let mut own: Vec<&Record> = own.collect();
        own.sort_by(|a, b| a.case.refinement.total_cmp(&b.case.refinement));
        own.dedup_by(|a, b| a.case.refinement == b.case.refinement);
        let values: Vec<(f64, f64)> = own.iter().map(|r| (r.case.refinement, r.quantities[number].value)).collect();
        let limit = match own.last()?.quantities[number].exact {
            _ if kind.is_error => Limit::Zero,
            Some(exact) => Limit::Exact(exact),
            None => {
                let by_size: Vec<(f64, f64)> = values.iter().map(|(refinement, q)| (1.0 / refinement, *q)).collect();
                Limit::Extrapolated(estimate(&by_size, series.degree))
            }
        };
        Some(Self { series: series.clone(), values, limit })
    }

    /// The error of the finest mesh.
    pub fn error(&self) -> Option<f64> {
        self.limit.error(self.values.last()?.1)
    }

    /// The error that an extrapolated limit may have itself: at most that of the finest mesh. None of other limits.
    fn doubt(&self) -> Option<f64> {
        matches!(self.limit, Limit::Extrapolated(Ok(Estimate { order: Some(_), .. }))).then(|| self.error()).flatten()
    }
}

/// The series of records, each once, in their order.
pub fn series_of(records: &[Record]) -> Vec<&Series> {
    let mut all: Vec<&Series> = Vec::new();
    for record in records {
        if !all.contains(&&record.case.series) {
            all.push(&record.case.series);
        }
    }
    all
}

/// Quantity `number` of the scene over the meshes of all series that have a run that went well.
pub fn trends(records: &[Record], scene: &Scene, number: usize) -> Vec<Trend> {
    let kind = scene.quantities[number].what.build();
    series_of(records).into_iter().filter_map(|series| Trend::of(records, series, number, kind)).collect()
}

/// Gives the records of a series the errors of their quantities, as the meshes so far tell them, and the error by the measure.
pub fn rate(records: &mut [Record], series: &Series, scene: &Scene, measure: &Measure) {
    for (number, quantity) in scene.quantities.iter().enumerate() {
        let Some(trend) = Trend::of(records, series, number, quantity.what.build()) else { continue };
        for record in records.iter_mut().filter(|r| r.case.series == *series && r.is_done()) {
            let error = trend.limit.error(record.quantities[number].value);
            if matches!(measure, Measure::Quantity { number: own, .. } if *own == number) {
                record.judge(error, trend.doubt());
            }
            // A value that is nearer to the limit than the finest mesh meets it by chance.
            let known = trend.doubt().is_none_or(|own| error.is_none_or(|error| error >= own));
            record.quantity_errors[number] = error.filter(|_| known);
        }
    }
    for record in records.iter_mut().filter(|r| r.case.series == *series && r.is_done()) {
        match measure {
            Measure::Standard => record.judge(record.errors.map(|e| e.standard), record.floor.map(|floor| floor[0])),
            Measure::L1 => record.judge(record.errors.map(|e| e.standard_l1), record.floor.map(|floor| floor[1])),
            Measure::Quantity { .. } => {}
        }
    }
}

/// All quantities of the scene, for `study.json`.
pub fn json(records: &[Record], scene: &Scene) -> Value {
    let of = |(number, quantity): (usize, &crate::scene::Quantity)| {
        let series = trends(records, scene, number).into_iter().map(|trend| {
            let known = if let Limit::Extrapolated(estimate) = trend.limit { estimate.ok() } else { None };
            json!({
                "setting": trend.series.name(),
                "refinements": trend.values.iter().map(|(refinement, _)| *refinement).collect::<Vec<_>>(),
                "values": trend.values.iter().map(|(_, value)| *value).collect::<Vec<_>>(),
                "order": known.and_then(|estimate| estimate.order),
                "extrapolated": known.map(|estimate| estimate.limit),
                "exact": if let Limit::Exact(exact) = trend.limit { Some(exact) } else { None },
                "error": trend.error(),
                "words": trend.limit.words(),
            })
        });
        let unit = (quantity.what.build().unit)(&quantity.what.values);
        json!({ "name": quantity.name, "unit": unit, "series": series.collect::<Vec<_>>() })
    };
    scene.quantities.iter().enumerate().map(of).collect()
}

/// All quantities of the scene for the terminal, a line a series.
pub fn lines(records: &[Record], scene: &Scene) -> Vec<String> {
    let mut all = Vec::new();
    for (number, quantity) in scene.quantities.iter().enumerate() {
        let unit = (quantity.what.build().unit)(&quantity.what.values);
        all.push(format!("{} {unit}", quantity.name).trim_end().to_owned() + ":");
        all.extend(trends(records, scene, number).iter().map(|trend| {
            let values: Vec<String> = trend.values.iter().map(|(_, value)| number_words(*value)).collect();
            let error = match (trend.limit, trend.error()) {
                (Limit::Zero, _) | (_, None) => String::new(),
                (_, Some(error)) => format!("; error of the finest {error:.1e}"),
            };
            format!("  {:<24} {}: {}{error}", trend.series.name(), values.join(", "), trend.limit.words())
        }));
    }
    all
}

/// All quantities of the scene as a Markdown table; nothing where it names none.
pub fn markdown(records: &[Record], scene: &Scene) -> String {
    let mut text = String::new();
    for (number, quantity) in scene.quantities.iter().enumerate() {
        let unit = (quantity.what.build().unit)(&quantity.what.values);
        let comma = if unit.is_empty() { "" } else { ", " };
        text += &format!(
            "| {}{comma}{unit} | values, from coarse to fine | limit | error of the finest |\n",
            quantity.name
        );
        text += "|---|---|---|---|\n";
        for trend in trends(records, scene, number) {
            let values: Vec<String> = trend.values.iter().map(|(_, value)| number_words(*value)).collect();
            let error = trend.error().map_or(String::new(), |error| match trend.limit {
                Limit::Zero => number_words(error),
                _ => format!("{error:.1e}"),
            });
            text +=
                &format!("| {} | {} | {} | {error} |\n", trend.series.name(), values.join(", "), trend.limit.words());
        }
        text.push('\n');
    }
    text
}

/// A value of a table to six digits; `none` where there is no number.
fn number_words(value: f64) -> String {
    match value.abs() {
        size if size.is_nan() => "none".to_owned(),
        size if (1e-3..1e5).contains(&size) => {
            let digits = 5 - size.log10().floor() as i32;
            format!("{value:.0$}", digits.max(0) as usize)
        }
        _ => format!("{value:.5e}"),
    }
}

#[cfg(test)]
mod tests {
    use super::number_words;

    #[test]
    fn numbers_of_usual_size_stand_without_a_power_of_ten() {
        let found = [0.0023456789, 2.5, 12345.678, -9.2365e9, 1e-4, f64::NAN].map(number_words);
        assert_eq!(found, ["0.00234568", "2.50000", "12345.7", "-9.23650e9", "1.00000e-4", "none"]);
    }
}
