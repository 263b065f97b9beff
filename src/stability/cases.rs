//! The cases of a command: every combination of the lists that are given.

use super::problem::{Domain, Pattern, Setup};
use crate::error::{Error, Result};

/// The layout of a method that has no points.
pub(super) const NO_LAYOUT: &str = "-";

/// What a command asks for; a list that is empty leaves the scene as it is.
#[derive(Debug, Clone)]
pub struct Plan {
    /// The body.
    pub domain: Domain,
    /// `--set` for all cases.
    pub sets: Vec<String>,
    /// Keys and their values: each list multiplies the cases.
    pub lists: Vec<(String, Vec<String>)>,
    /// Where the stiffer cells are, if there are two materials; none: as a checkerboard.
    pub pattern: Option<Pattern>,
    /// Whether the limit dt -> 0 is looked at.
    pub semi_discrete: bool,
}

/// A setup, and the values that the lists of [`Plan`] have in it.
#[derive(Debug, Clone)]
pub struct Case {
    /// The setup.
    pub setup: Setup,
    /// Key and value of each list.
    pub labels: Vec<(String, String)>,
}

impl Plan {
    /// All cases, the last list running fastest. A layout is left out where the method has no points, and of the cases that
    /// are the same then only the first one stays.
    ///
    /// # Errors
    /// A value of a key that is no number where one is needed; keys that do not go together.
    pub fn cases(&self) -> Result<Vec<Case>> {
        self.check()?;
        let setup = Setup {
            domain: self.domain.clone(),
            sets: self.sets.clone(),
            contrast: 1.0,
            pattern: self.pattern.unwrap_or(Pattern::Checkerboard),
            courant: None,
            semi_discrete: self.semi_discrete,
        };
        let mut cases = vec![Case { setup, labels: vec![] }];
        for (key, values) in self.lists.iter().filter(|(_, values)| !values.is_empty()) {
            let mut more = Vec::new();
            for case in &cases {
                for value in values {
                    let mut case = case.clone();
                    case.apply(key, value)?;
                    case.labels.push((key.clone(), value.clone()));
                    more.push(case);
                }
            }
            cases = more;
        }
        if self.has("layout") {
            cases.iter_mut().try_for_each(Case::without_idle_layout)?;
            let all = std::mem::take(&mut cases);
            for case in all {
                if cases.iter().all(|other| other.labels != case.labels) {
                    cases.push(case);
                }
            }
        }
        Ok(cases)
    }

    fn has(&self, key: &str) -> bool {
        self.lists.iter().any(|(known, values)| known == key && !values.is_empty())
    }

    /// Refuses what would have no effect.
    fn check(&self) -> Result<()> {
        let steps = ["dt", "safety"].into_iter().find(|key| self.semi_discrete && self.has(key));
        if let Some(key) = steps {
            return Err(no_step(&format!("--{key}")));
        }
        if self.pattern.is_some() && !self.has("contrast") {
            let what = "--pattern says where the stiffer material is, and there is one material";
            return Err(Error::input(what, "give its --contrast, or leave out --pattern"));
        }
        if matches!(self.domain, Domain::Scene(_)) && self.has("contrast") {
            let what = "a contrast makes two materials of a patch or a --body, and a scene has its own";
            return Err(Error::input(what, "leave out contrast, and give the [[material]] of the scene"));
        }
        Ok(())
    }
}

/// The error of a question about a step in the limit dt -> 0.
pub(super) fn no_step(option: &str) -> Error {
    let what = format!("{option} asks about a step, and --semi-discrete is the limit dt -> 0, which has none");
    Error::input(what, format!("leave out --semi-discrete, or {option}"))
}

impl Case {
    /// The number of a label.
    pub fn number(&self, label: usize) -> Option<f64> {
        self.labels[label].1.parse().ok()
    }

    /// Without the layout of a method that has no points.
    fn without_idle_layout(&mut self) -> Result<()> {
        if self.setup.has_points()? {
            return Ok(());
        }
        self.setup.sets.retain(|set| !set.starts_with("cloud.layout="));
        self.labels.iter_mut().filter(|(key, _)| key == "layout").for_each(|(_, value)| *value = NO_LAYOUT.to_owned());
        Ok(())
    }

    /// Gives a key a value: a short name, or the path of a key of the scene.
    fn apply(&mut self, key: &str, value: &str) -> Result<()> {
        let setup = &mut self.setup;
        // TOML has no number that begins with a point.
        let value = &if value.starts_with('.') { format!("0{value}") } else { value.replacen("-.", "-0.", 1) };
        let path = |path: &str| format!("{path}={value}");
        match key {
            "method" | "flux" | "safety" => setup.sets.push(path(&format!("scheme.{key}"))),
            "degree" => {
                setup.sets.extend([path("scheme.degree"), path("scheme.time_degree")]);
            }
            "layout" => setup.sets.push(path("cloud.layout")),
            "curl" => setup.sets.push(path("curl.control")),
            "alpha" => setup.sets.push(path("curl.alpha")),
            "law" | "young" | "poisson" | "density" => {
                let materials = if let Domain::Scene(scene) = &setup.domain { scene.materials.len() } else { 1 };
                setup.sets.extend((0..materials).map(|k| format!("material.{k}.{key}={value}")));
            }
            "dt" => setup.courant = Some(number(key, value)?),
            "contrast" => setup.contrast = number(key, value)?,
            "deformation" => set_deformation(setup, &value.split(',').map(str::to_owned).collect::<Vec<_>>())?,
            // A state under one or two equal stretches.
            "f11" => set_deformation(setup, &[value, "0", "0", "1"].map(str::to_owned))?,
            "stretch" => set_deformation(setup, &[value, "0", "0", value].map(str::to_owned))?,
            "shear" => set_deformation(setup, &["1", value, "0", "1"].map(str::to_owned))?,
            other if other.contains('.') => setup.sets.push(path(other)),
            _ => {
                let known = "method, degree, layout, flux, curl, alpha, law, young, poisson, density, safety, dt, contrast, \
                     f11, stretch, shear";
                let remedy = format!("there are {known}, and keys of the scene such as scheme.time_degree");
                return Err(Error::input(format!("--over has the key `{key}`"), remedy));
            }
        }
        Ok(())
    }
}

/// The last list of a plan that has at least two values, all numbers: what a plot stands over; its place in the labels.
///
/// # Errors
/// There is none.
pub fn axis(cases: &[Case]) -> Result<usize> {
    let count = cases.first().map_or(0, |case| case.labels.len());
    let stands = |k: &usize| varies(cases, *k) && cases.iter().all(|case| case.number(*k).is_some());
    (0..count).rev().find(stands).ok_or_else(|| {
        let remedy =
            "give a list of at least two numbers: --over poisson=.3,.45, --dt 0.02:0.2:10, --safety or --degree";
        Error::input("there is nothing to plot over", remedy)
    })
}

/// Whether a label has several values.
pub fn varies(cases: &[Case], label: usize) -> bool {
    cases.iter().any(|case| case.labels[label] != cases[0].labels[label])
}

/// The values of a list `a,b,c`, in which `a:b:n` stands for n numbers from a to b.
///
/// # Errors
/// A range that is none.
pub fn values(text: &str) -> Result<Vec<String>> {
    let mut out = Vec::new();
    for part in text.split(',').map(str::trim) {
        if !part.contains(':') {
            out.push(part.to_owned());
            continue;
        }
        let parts: Vec<&str> = part.split(':').collect();
        let [from, to, count] = if let [from, to, count] = parts[..] { [from, to, count] } else { [""; 3] };
        let numbers = from.parse::<f64>().ok().zip(to.parse::<f64>().ok()).zip(count.parse::<usize>().ok());
        let Some(((from, to), count)) = numbers.filter(|(_, count)| (2..=1000).contains(count)) else {
            let remedy = "write from:to:count, such as 0.1:1.2:12, with a count from 2 to 1000";
            return Err(Error::input(format!("`{part}` is no range"), remedy));
        };
        let at = |k: usize| from + (to - from) * k as f64 / (count - 1) as f64;
        // The rounding of the last digits would not be read.
        out.extend((0..count).map(|k| format!("{:.12e}", at(k)).parse::<f64>().unwrap_or(at(k)).to_string()));
    }
    Ok(out)
}

/// A positive number.
fn number(key: &str, value: &str) -> Result<f64> {
    match value.parse::<f64>() {
        Ok(x) if x.is_finite() && x > 0.0 => Ok(x),
        _ => Err(Error::input(format!("{key} is `{value}`"), "give a number above 0")),
    }
}

/// The uniform deformation F11, F12, F21, F22 of a setup.
fn set_deformation(setup: &mut Setup, f: &[String]) -> Result<()> {
    let remedy = "give F11,F12,F21,F22 with F11 F22 - F12 F21 > 0, such as 0.9,0,0,0.9";
    let numbers: Vec<f64> = f.iter().filter_map(|x| x.trim().parse().ok()).collect();
    let [a, b, c, d] = numbers[..] else {
        return Err(Error::input(format!("the deformation is `{}`", f.join(",")), remedy));
    };
    // NaN is not above 0 either.
    if !(a * d - b * c > 0.0 && numbers.iter().all(|x| x.is_finite())) {
        return Err(Error::input(format!("the deformation {} has J = {}", f.join(","), a * d - b * c), remedy));
    }
    setup.sets.push(format!("initial.deformation=[{a:?}, {b:?}, {c:?}, {d:?}]"));
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_values_and_ranges() {
        assert_eq!(values("lcf, off").unwrap(), ["lcf", "off"]);
        assert_eq!(values("0.1:0.4:4,.7").unwrap(), ["0.1", "0.2", "0.3", "0.4", ".7"]);
        assert!(values("1:2:1").is_err() && values("a:2:3").is_err() && values("1:2").is_err());
    }

    #[test]
    fn lists_multiply_and_the_last_one_of_numbers_is_the_axis_of_a_plot() {
        let lists = [("curl", "off,lcf"), ("poisson", ".3,.45"), ("flux", "rusanov,acoustic")];
        let lists = lists.map(|(key, list)| (key.to_owned(), values(list).unwrap())).to_vec();
        let mut plan = Plan { domain: Domain::Patch, sets: vec![], lists, pattern: None, semi_discrete: true };
        let cases = plan.cases().unwrap();
        assert_eq!((cases.len(), axis(&cases).unwrap()), (8, 1));
        assert_eq!(cases[1].setup.sets, ["curl.control=off", "material.0.poisson=0.3", "scheme.flux=acoustic"]);
        plan.lists.remove(1);
        assert!(axis(&plan.cases().unwrap()).is_err());
        plan.lists[0].0 = "nothing".to_owned();
        assert!(plan.cases().is_err());
    }
}
