//! What holds for every entry of every table, so that a new one is tested by its line.

use super::values::tests::ASKED;
use super::*;
use crate::quantity::Seen;
use std::collections::BTreeSet;

/// The name, line and parameters of an entry.
type Line = (&'static str, &'static str, &'static [Parameter]);

/// Every table of the registry.
fn all() -> Vec<(&'static str, Vec<Line>)> {
    fn of<B>(entries: &'static Table<B>) -> Vec<Line> {
        entries.iter().map(|entry| (entry.name, entry.about, entry.parameters)).collect()
    }
    vec![
        ("laws", of(&LAWS)),
        ("conditions", of(&CONDITIONS)),
        ("sources", of(&SOURCES)),
        ("fluxes", of(&FLUXES)),
        ("solutions", of(&SOLUTIONS)),
        ("outputs", of(&OUTPUTS)),
        ("grids", of(&GRIDS)),
        ("layouts", of(&LAYOUTS)),
        ("controls", of(&CONTROLS)),
        ("methods", of(&METHODS)),
        ("quantities", of(&QUANTITIES)),
    ]
}

/// Lines stand in lists and sentences: no capital first but in a name, no full stop.
fn is_a_line(text: &str) -> bool {
    !text.is_empty() && text.len() < 140 && !text.contains('\n') && !text.ends_with('.')
}

#[test]
fn names_are_unique_and_everything_has_its_line() {
    for (table, entries) in all() {
        let names: BTreeSet<&str> = entries.iter().map(|(name, ..)| *name).collect();
        assert_eq!(names.len(), entries.len(), "{table}");
        for (name, about, parameters) in entries {
            assert!(is_a_line(about), "{table} {name}: {about}");
            let keys: BTreeSet<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            assert_eq!(keys.len(), parameters.len(), "{table} {name}");
            for parameter in parameters {
                assert!(is_a_line(parameter.about), "{table} {name} {}: {}", parameter.name, parameter.about);
            }
        }
    }
}

#[test]
fn defaults_are_in_their_ranges() {
    let good = |parameter: &Parameter| match (parameter.form, parameter.default.value(2)) {
        (Form::Number(check), Some(Value::Number(value))) => (check.holds)(value),
        (Form::Integer(from, to), Some(Value::Integer(value))) => (from..=to).contains(&value),
        (Form::Expressions(count), Some(Value::Expressions(all))) => all.len() == count,
        (Form::Name(names, _), Some(Value::Text(name))) => names().contains(&&name[..]),
        (Form::Names(names), Some(Value::Texts(all))) => all.iter().all(|name| names().contains(&&name[..])),
        (Form::Boolean, Some(Value::Boolean(_))) | (Form::Expression, Some(Value::Expression(_))) | (_, None) => true,
        _ => false,
    };
    for (table, entries) in all() {
        for (name, _, parameters) in entries {
            parameters.iter().for_each(|parameter| assert!(good(parameter), "{table} {name} {}", parameter.name));
        }
    }
}

/// A unit square of 2 x 2 cells whose velocity rises along x.
fn free_square() -> crate::scene::Scene {
    let sides = ["left", "right", "bottom", "top"].map(|g| format!("[[boundary]]\ngroup = \"{g}\"\nkind = \"free\"\n"));
    let text = format!(
        "[mesh]\nrectangle = {{ size = [1.0, 1.0], cells = [2, 2] }}\n[[material]]\nlaw = \"neo-hookean\"\nyoung = 1.0\n\
         poisson = 0.3\ndensity = 1.0\n{}[initial]\nvelocity = [\"0.1*x\", \"0\"]\n[scheme]\nmethod = \"rk-dgfem\"\ndegree = 1\n[time]\nend = 1.0\n",
        sides.concat()
    );
    crate::scene::Scene::parse(&text, std::path::Path::new("square.toml"), &[]).unwrap()
}

/// Builds an entry from an example, and tells which values it asked for that it has no parameter for.
fn strange<B>(entry: &'static Entry<B>, build: impl Fn(&B, &Values)) -> Vec<String> {
    let values = example(entry.parameters);
    (entry.check)(&values).unwrap();
    ASKED.take();
    build(&entry.build, &values);
    let known: Vec<&str> = entry.parameters.iter().map(|parameter| parameter.name).collect();
    ASKED.take().into_iter().filter(|name| !known.contains(&&name[..])).collect()
}

#[test]
fn builders_ask_for_the_parameters_of_their_entry_and_for_no_others() {
    let none = Vec::<String>::new();
    for entry in &LAWS {
        let law = (entry.build)(&example(entry.parameters));
        assert!(law.density() > 0.0 && law.speeds([1.0, 0.0, 0.0, 1.0], [1.0, 0.0]).iter().all(|c| *c > 0.0));
        assert_eq!(strange(entry, |build, of| assert!(build(of).density() > 0.0)), none, "{}", entry.name);
    }
    for entry in &CONDITIONS {
        assert_eq!(strange(entry, |build, of| drop((build.make)(of))), none, "{}", entry.name);
        let is_known = |key: &str| entry.parameters.iter().any(|parameter| parameter.name == key);
        assert!(
            entry.build.joined.or(entry.build.between.as_ref().and_then(|between| between.other)).is_none_or(is_known),
            "{}",
            entry.name
        );
    }
    for entry in &SOURCES {
        assert_eq!(strange(entry, |build, of| drop(build(of, None))), none, "{}", entry.name);
    }
    for entry in &SOLUTIONS {
        let name = entry.build.laws.first().unwrap_or(&"neo-hookean");
        let law = LAWS.find(name).unwrap();
        let laws = vec![(law.build)(&example(law.parameters)); entry.build.materials];
        let none_is_nan = |build: &solutions::Solution, of: &Values| {
            let solution = (build.make)(of, &laws);
            if let Some(solution) = solution {
                assert!(solution.deformation([0.3, 0.2], 1e-3).iter().all(|f| f.is_finite()), "{}", entry.name);
            }
        };
        assert_eq!(strange(entry, none_is_nan), none, "{}", entry.name);
    }
    let problem = crate::problem::Problem::new(&free_square()).unwrap();
    for entry in &QUANTITIES {
        let build = |build: &quantities::Kind, of: &Values| {
            let crate::problem::Problem { body, scheme, state, .. } = &problem;
            let seen = Seen::new(&body.mesh, scheme, state, &body.material);
            let quantity = (build.make)(of, &quantities::Start { seen: &seen, exact: None }).unwrap();
            // A velocity that rises along a line has no front.
            let is_front = entry.name == "front-width" || entry.name == "overshoot";
            assert!(is_front || quantity.is_metered() || quantity.of(&seen).is_finite(), "{}", entry.name);
            let _ = ((build.unit)(of), (build.displacement)(of), (build.check)(of, &body.mesh).is_ok());
        };
        // Fields are those of all laws, which are made to be asked for theirs.
        let of_a_law = |name: &String| LAWS.iter().any(|law| law.parameters.iter().any(|own| own.name == name));
        let strange: Vec<String> = strange(entry, build).into_iter().filter(|name| !of_a_law(name)).collect();
        assert_eq!(strange, none, "{}", entry.name);
    }
    for entry in &LAYOUTS {
        let build = |build: &layouts::Layout, of: &Values| match build.points {
            layouts::Points::Cells(points) => assert_eq!(points(of)(3, 0).len(), 9),
            layouts::Points::Body(points) => {
                let mesh = crate::mesh::rectangle([1.0, 1.0], [2, 2]).unwrap();
                assert!(!points(of, &mesh, &[true; 4], 3).is_empty());
            }
            layouts::Points::File => assert!(of.has("path")),
        };
        assert_eq!(strange(entry, build), none, "{}", entry.name);
    }
}

#[test]
fn what_stands_in_the_registry_and_where_it_is_written_has_one_name() {
    for entry in &METHODS {
        assert_eq!((entry.name, entry.build.method.build().method), (entry.build.method.name(), entry.build.method));
    }
    assert_eq!(METHODS.len(), Method::NAMES.len());
    let looks = METHODS.iter().map(|entry| format!("{:?} {:?}", entry.build.marker, entry.build.stroke));
    assert_eq!(looks.collect::<BTreeSet<_>>().len(), METHODS.len(), "lines of two methods look alike in plots");
    for default in [2, 3].map(layouts::default_name).into_iter().chain([layouts::WITH_MEMORY]) {
        assert!(LAYOUTS.find(default).is_some(), "{default}");
    }
    assert!(FLUXES.find(fluxes::DEFAULT).is_some() && CONTROLS.find(controls::DEFAULT).is_some());
    for entry in &GRIDS {
        assert_eq!(entry.parameters[0].name, entry.name, "the first key chooses the grid");
    }
}
