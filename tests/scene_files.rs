//! The scene files of the project, and bad scenes with the place and words of their messages.

use std::path::Path;

use dgmpm::parts::scene::{Mesh, Scene};
use proptest::prelude::*;

/// A good scene; the rows of the tables replace one piece of it.
const GOOD: &str = r#"title = "good"
[mesh]
rectangle = { size = [3.0, 1.0], cells = [30, 10] }
[cloud]
layout = "paper"
[[material]]
group = "body"
law = "neo-hookean"
young = 2e11
poisson = 0.3
density = 7800.0
[initial]
velocity = ["-200", "0"]
[[boundary]]
group = "left"
kind = "wall"
[[boundary]]
group = "right"
kind = "free"
[[boundary]]
group = "bottom"
kind = "symmetry"
[[boundary]]
group = "top"
kind = "traction"
value = ["0", "1e6*t"]
[[source]]
kind = "body-force"
value = ["0", "-10*x"]
[curl]
control = "lcf"
[scheme]
method = "ader-dgmpm"
degree = 2
cfl = 0.4
[time]
end = 1e-3
[[output]]
kind = "fields"
at = [5e-4, 1e-3]
[[output]]
kind = "line"
name = "bottom"
from = [0.0, 0.0]
to = [3.0, 0.0]
samples = 300
every = 1e-4
fields = ["velocity"]
"#;

/// What replaces what, then line, column and words of the message.
type Row = (&'static str, &'static str, usize, usize, &'static [&'static str]);

const BAD: &[Row] = &[
    // syntax
    ("degree = 2", "degree = = 2", 34, 10, &["not TOML"]),
    ("degree = 2", "degree = 2\ndegree = 3", 35, 1, &["not TOML", "duplicate key"]),
    // unknown and missing keys
    ("title =", "titel =", 1, 1, &["unknown key `titel`", "did you mean `title`?", "mesh, cloud, material"]),
    (
        "cfl =",
        "clf =",
        35,
        1,
        &["unknown key `clf` in [scheme]", "did you mean `cfl`", "method, degree, time_degree, flux"],
    ),
    ("method =", "metod =", 33, 1, &["unknown key `metod`", "did you mean `method`", "time_degree"]),
    ("method = \"ader-dgmpm\"\n", "", 32, 1, &["[scheme] needs the key `method`", "ader-dgfem"]),
    ("[time]\nend = 1e-3\n", "", 1, 1, &["needs the key `time`", "end"]),
    ("end = 1e-3", "", 36, 1, &["[time] needs the key `end`"]),
    ("[time]", "[tine]", 36, 2, &["unknown key `tine`", "did you mean `time`"]),
    ("[[boundary]]\ngroup = \"left\"", "[boundary]\ngroup = \"left\"", 17, 3, &["not TOML"]),
    ("[[source]]", "[source]", 27, 1, &["`source` is a table", "[[source]]"]),
    ("cells = [30, 10]", "cels = [30, 10]", 3, 34, &["unknown key `cels` in [mesh.rectangle]", "cells"]),
    ("young = 2e11\n", "", 6, 1, &["[[material]] needs the key `young`", "Pa"]),
    ("young =", "yuong =", 9, 1, &["unknown key `yuong`", "did you mean `young`"]),
    (
        "kind = \"free\"",
        "kind = \"free\"\nvalue = [0, 0]",
        20,
        1,
        &["unknown key `value`", "of kind \"free\"", "group, kind"],
    ),
    ("value = [\"0\", \"1e6*t\"]\n", "", 23, 1, &["needs the key `value`", "Pa"]),
    ("[time]", "impedance = \"exact\"\n[time]", 36, 1, &["`impedance` is not built yet"]),
    ("[time]", "[checkpoint]\nevery_step = 3\n[time]", 37, 1, &["did you mean `every_steps`"]),
    ("[time]", "[limiter]\nkind = \"momnt\"\n[time]", 37, 8, &["momnt", "did you mean", "moment"]),
    ("[time]", "[limiter]\nkind = \"moment\"\nbeta = 3\n[time]", 38, 8, &["`beta` is 3", "from 1 to 2"]),
    ("[time]", "[limiter]\nkind = \"vertex\"\nbeta = 2\n[time]", 38, 1, &["unknown key `beta`", "threshold"]),
    ("[time]", "[limiter]\nkind = \"off\"\nrescue = 1\n[time]", 38, 10, &["`rescue` is 1", "true or false"]),
    ("[time]", "springs = 1\n[time]", 36, 11, &["`springs` is 1", "true or false"]),
    ("[time]", "springs = \"yes\"\n[time]", 36, 11, &["`springs` is the text \"yes\"", "true or false"]),
    (
        "[time]",
        "springs = true\nflux = \"acoustic\"\n[time]",
        36,
        11,
        &["need the flux `dual`, and here it is `acoustic`", "give flux = \"dual\", or remove this key"],
    ),
    // types
    ("degree = 2", "degree = \"two\"", 34, 10, &["`degree` is the text \"two\"", "whole number from 0 to 6"]),
    ("degree = 2", "degree = 2.5", 34, 10, &["`degree` is 2.5", "whole number"]),
    ("young = 2e11", "young = \"2e11\"", 9, 9, &["`young` is the text \"2e11\"", "a number, greater than 0"]),
    ("young = 2e11", "young = nan", 9, 9, &["`young` is NaN", "a number"]),
    ("title = \"good\"", "title = 5", 1, 9, &["`title` is 5", "text"]),
    ("[30, 10]", "[30, 10, 2]", 3, 42, &["`cells` must have 2 entries, not 3"]),
    ("[30, 10]", "[30, 1.5]", 3, 47, &["entry 1 of `cells` is 1.5", "whole"]),
    ("[\"-200\", \"0\"]", "\"-200\"", 13, 12, &["a list of 2 expressions"]),
    ("[\"-200\", \"0\"]", "[\"-200\", true]", 13, 21, &["must be an expression", "true"]),
    ("[5e-4, 1e-3]", "5e-4", 40, 6, &["list of numbers"]),
    // ranges
    ("density = 7800.0", "density = -1", 11, 11, &["`density` is -1", "greater than 0"]),
    ("poisson = 0.3", "poisson = 0.5", 10, 11, &["`poisson` is 0.5", "less than 0.5"]),
    ("degree = 2", "degree = 7", 34, 10, &["0 to 6"]),
    // laws with memory
    ("neo-hookean", "j2", 6, 1, &["needs the key `yield_stress`", "greater than 0 Pa"]),
    ("\"neo-hookean\"", "\"j2\"\nyield_stress = 4e8", 6, 1, &["needs the key `hardening`", "not negative Pa"]),
    ("\"neo-hookean\"", "\"j2\"\nyield_stress = 0\nhardening = 0", 9, 16, &["`yield_stress` is 0", "greater than 0"]),
    ("\"neo-hookean\"", "\"j2\"\nyield_stress = 4e8\nhardening = -1", 10, 13, &["`hardening` is -1", "not negative"]),
    ("young = 2e11", "young = 2e11\nyield_stress = 4e8", 10, 1, &["unknown key `yield_stress`"]),
    (
        "[\"velocity\"]",
        "[\"velocity\", \"plastic_strain\"]",
        48,
        23,
        &["no material of the scene has \"plastic_strain\"", "j2"],
    ),
    (
        "[curl]",
        "[exact]\nkind = \"j2-impact\"\n[curl]",
        31,
        8,
        &["\"j2-impact\" is no solution for the law \"neo-hookean\"", "j2"],
    ),
    ("cfl = 0.4", "cfl = 0", 35, 7, &["`cfl` is 0", "greater than 0"]),
    ("end = 1e-3", "end = -1e-3", 37, 7, &["`end` is -0.001"]),
    ("[5e-4, 1e-3]", "[-1e-9]", 40, 7, &["entry 0 of `at` is -0.000000001", "not negative"]),
    ("every = 1e-4", "every = 0", 47, 9, &["`every` is 0", "greater than 0"]),
    ("samples = 300", "samples = 1", 46, 11, &["`samples` is 1", "from 2"]),
    ("to = [3.0, 0.0]", "to = [0.0, 0.0]", 45, 6, &["no length"]),
    ("velocity = [\"-200\", \"0\"]", "deformation = [1, 1, 1, 1]", 13, 15, &["determinant J = 0"]),
    // names
    (
        "\"ader-dgmpm\"",
        "\"ader-dgmp\"",
        33,
        10,
        &["unknown `method` \"ader-dgmp\"", "did you mean `ader-dgmpm`", "\"rk-dgfem\""],
    ),
    ("\"neo-hookean\"", "\"neohook\"", 8, 7, &["unknown `law` \"neohook\"", "\"neo-hookean\""]),
    ("\"paper\"", "\"papers\"", 5, 10, &["did you mean `paper`", "\"jitter\""]),
    ("\"wall\"", "\"contct\"", 16, 8, &["did you mean `contact`", "\"absorbing\""]),
    ("\"wall\"", "\"wal\"", 16, 8, &["did you mean `wall`", "\"clamped\""]),
    ("\"lcf\"", "\"auto\"", 31, 11, &["not built yet"]),
    ("[\"velocity\"]", "[\"velocty\"]", 48, 11, &["did you mean `velocity`", "\"von_mises\""]),
    ("[\"velocity\"]", "[\"velocity\", \"velocity\"]", 48, 23, &["there twice"]),
    ("name = \"bottom\"", "name = \"../x\"", 43, 8, &["name of a file"]),
    ("name = \"bottom\"\n", "", 41, 1, &["needs the key `name`", "lines/<name>.csv"]),
    // both or none, duplicates
    ("cfl = 0.4", "cfl = 0.4\nsafety = 0.9", 36, 10, &["both `cfl` and `safety`"]),
    ("every = 1e-4", "every = 1e-4\nevery_steps = 3", 48, 15, &["both `every` and `every_steps`"]),
    ("every = 1e-4\n", "", 41, 1, &["needs the key `at`", "every_steps"]),
    ("[cloud]", "file = \"a.msh\"\n[cloud]", 3, 13, &["both `file` and `rectangle`"]),
    ("group = \"right\"", "group = \"left\"", 18, 9, &["two [[boundary]] on the group \"left\""]),
    ("kind = \"line\"\n", "kind = \"fields\"\n", 44, 1, &["unknown key `from`"]),
    // keys that would have no effect
    (
        "every = 1e-4",
        "every_steps = 3\nexact_times = true",
        48,
        15,
        &["`exact_times` shortens steps", "give `at` or `every`"],
    ),
    (
        "[[output]]\nkind = \"line\"",
        "[[output]]\nkind = \"ledger\"\nexact_times = true\n[[output]]\nkind = \"line\"",
        43,
        15,
        &["`exact_times` shortens steps", "of kind \"ledger\" gives none"],
    ),
    (
        "every = 1e-4",
        "every = 1e-300",
        47,
        9,
        &["`every` is 1e-300 s, which is more than 1e9 times", "every_steps = 1"],
    ),
    ("\"paper\"", "\"rotated\"\nspacing = 0.1\nper_direction = 3", 7, 17, &["the `spacing` 0.1 m already", "remove"]),
    (
        "[time]\nend = 1e-3",
        "[time]\nstart = 1e-4\nend = 1e-3\n[[regrid]]\nrefine = 2\nat = [2e-4, 0.0]",
        41,
        13,
        &["0 s lies before the start of the run, 1e-4 s", "[time] start"],
    ),
    (
        "\"-200\", \"0\"]",
        "\"-200\", \"0\"]\nfrom = \"cloud\"",
        13,
        12,
        &["[initial] has both `from` and `velocity`", "keep one"],
    ),
    (
        "[time]",
        "[watch]\nenergy = \"of\"\n[time]",
        37,
        10,
        &["`energy` is the text \"of\"", "greater than 0, or \"off\""],
    ),
    ("[time]", "[watch]\nenergy = 0\n[time]", 37, 10, &["`energy` is 0", "greater than 0, or \"off\""]),
    (
        "degree = 2",
        "degree = 1.0",
        34,
        10,
        &["`degree` is 1.0, which has a decimal point", "without a point, such as 1"],
    ),
    (
        "[curl]",
        "[exact]\nkind = \"plastic-impact\"\n[curl]",
        31,
        8,
        &["unknown `kind` \"plastic-impact\"", "`plastic-impact` is called `j2-impact` now"],
    ),
    // groups of the rectangle
    (
        "group = \"top\"",
        "group = \"tpo\"",
        24,
        9,
        &["the mesh has no group \"tpo\"", "did you mean `top`", "left, right, bottom, top"],
    ),
    ("group = \"body\"", "group = \"steel\"", 7, 9, &["no group \"steel\"", "body"]),
    (
        "[[boundary]]\ngroup = \"right\"\nkind = \"free\"\n",
        "",
        14,
        1,
        &["the group right of the mesh has no [[boundary]]", "free"],
    ),
    // expressions
    ("\"1e6*t\"", "\"1e6*z\"", 26, 20, &["unknown name `z`", "x, y (m, at t = 0), t (s)"]),
    ("\"1e6*t\"", "\"1e6*sn(t)\"", 26, 20, &["did you mean `sin`", "atan2"]),
    ("\"1e6*t\"", "\"1e6 t\"", 26, 20, &["unexpected `t`", "2*x"]),
    ("\"-200\"", "\"-200*t\"", 13, 13, &["`velocity` depends on t"]),
    ("kind = \"body-force\"", "kind = \"gravity\"", 29, 15, &["gravity is constant"]),
];

fn parse(text: &str) -> dgmpm::parts::error::Result<Scene> {
    Scene::parse(text, Path::new("case.toml"), &[])
}

#[test]
fn bad_scenes_say_what_where_and_what_exists() {
    parse(GOOD).unwrap();
    let mut failed = Vec::new();
    for (old, new, line, column, words) in BAD {
        assert!(GOOD.contains(old), "the table is wrong: {old}");
        let message = match parse(&GOOD.replacen(old, new, 1)) {
            Ok(_) => "no error".to_owned(),
            Err(error) => error.to_string(),
        };
        let place = format!("case.toml:{line}:{column}: ");
        if !message.starts_with(&place) || words.iter().any(|word| !message.contains(word)) {
            failed.push(format!("{old} -> {new}\n  wanted {place}{words:?}\n  found  {message}"));
        }
    }
    assert!(failed.is_empty(), "{}", failed.join("\n"));
}

#[test]
fn outputs_after_the_end_are_warnings_since_set_shortens_runs() {
    let warnings = |sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        Scene::parse(GOOD, Path::new("case.toml"), &sets).unwrap().warnings()
    };
    assert!(warnings(&[]).is_empty() && warnings(&["output.0.at=[0.0]"]).is_empty());
    let [at, every] = &warnings(&["time.end=6e-5"])[..] else { panic!("two warnings") };
    let words = "case.toml:40:6: `at` of output \"fields\": 2 of 2 times lie after the end of the run, 6e-5 s";
    assert!(at.starts_with(words), "{at}");
    assert!(every.starts_with("case.toml:47:9: `every` of output \"bottom\": longer than the run, 6e-5 s"), "{every}");
    assert!(warnings(&["output.0.at=[1]"])[0].starts_with("--set output.0.at=[1]: `at`"));
}

#[test]
fn keys_without_effect_are_warnings_since_set_changes_the_method() {
    let find = |more: &str, sets: &[&str]| {
        let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
        let text = GOOD.replace("layout = \"paper\"", &format!("layout = \"paper\"\n{more}"));
        Scene::parse(&text, Path::new("case.toml"), &sets).unwrap().warnings()
    };
    let rk = "scheme.method=rk-dgfem";
    let j2 = "material.0={law=\"j2\",young=2e11,poisson=0.3,density=7800,yield_stress=4e8,hardening=0}";
    let row: &[(&str, &[&str], &str, &str)] = &[
        ("", &[rk, "scheme.sweeps=paper"], "--set scheme.sweeps=paper: `sweeps`", "rk-dgfem has no predictor"),
        ("per_direction = 3", &[rk], "case.toml:6:17: `per_direction`", "rk-dgfem computes on the Gauss nodes"),
        ("face_lebesgue = 9", &[rk], "case.toml:6:17: `face_lebesgue`", "no cell computes at its material points"),
        ("condition = 9", &[rk], "case.toml:6:13: `condition`", "no cell computes at its material points"),
        ("", &[rk, "cloud.layout=jitter"], "--set cloud.layout=jitter: `layout`", "only for exports"),
        ("histories = \"points\"", &[rk, j2], "case.toml:6:13: `histories`", "rk-dgfem keeps internal variables"),
        ("histories = \"points\"", &[j2, "cloud.layout=gauss"], "case.toml:6:13: `histories`", "are the Gauss nodes"),
        ("histories = \"points\"", &[], "case.toml:6:13: `histories`", "no law of the scene has internal variables"),
        ("", &["material.0.layout=gauss"], "case.toml:5:10: `layout`", "each [[material]] that it may concern"),
        ("", &["scheme.degree=0", "scheme.time_degree=0"], "case.toml:31:1: `curl`", "degree 0 have no curl"),
        ("", &["regrid=[{at=[2e-3],refine=2}]"], "--set regrid=", "1 of 1 times lie after the end of the run"),
    ];
    for (more, sets, place, why) in row {
        let found = find(more, sets);
        assert!(
            found.len() == 1 && found[0].starts_with(place) && found[0].contains(why),
            "{more} {sets:?}: {found:?}"
        );
        assert!(find("", &[rk]).is_empty(), "the good scene has no such key");
    }
}

#[test]
fn two_materials() {
    let second = "[[material]]\ngroup = \"body\"\nlaw = \"neo-hookean\"\nyoung = 1\npoisson = 0\ndensity = 1\n";
    let text = format!("{GOOD}{second}");
    let message = parse(&text).unwrap_err().to_string();
    assert!(message.starts_with("case.toml:50:9: two [[material]] on the group \"body\""), "{message}");
    let message = parse(&text.replacen("group = \"body\"\n", "", 1)).unwrap_err().to_string();
    assert!(message.starts_with("case.toml:6:1: [[material]] needs the key `group`"), "{message}");
}

fn scene_files() -> Vec<std::path::PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    let mut files: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    files.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    files.sort();
    files
}

#[test]
fn every_scene_of_the_project_is_good_and_survives_a_round_trip() {
    let files = scene_files();
    assert!(files.len() >= 4);
    for path in files {
        let scene = Scene::load(&path, &[]).unwrap_or_else(|error| panic!("{error}"));
        if let Mesh::File(mesh) = &scene.mesh {
            assert_eq!(mesh.file_stem().unwrap(), path.file_stem().unwrap());
        }
        assert_eq!(scene.to_toml(), std::fs::read_to_string(&path).unwrap());
        let changed = Scene::load(&path, &["scheme.safety=0.5".to_owned(), "title=changed".to_owned()]).unwrap();
        let again = Scene::parse(&changed.to_toml(), &path, &[]).unwrap();
        assert_eq!(serde_json::to_value(&changed).unwrap(), serde_json::to_value(&again).unwrap());
        assert_eq!(again.title, "changed");
    }
}

#[test]
fn files_that_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let message = Scene::load(&folder.path().join("none.toml"), &[]).unwrap_err().to_string();
    assert!(message.contains("none.toml: cannot read the scene"), "{message}");
    let path = folder.path().join("bytes.toml");
    std::fs::write(&path, b"a = 1\nb = \xff").unwrap();
    let message = Scene::load(&path, &[]).unwrap_err().to_string();
    assert!(message.contains("bytes.toml:2:5: this is not UTF-8"), "{message}");
}

/// A piece of the good scene replaced by another piece, or by anything.
fn mangled() -> impl Strategy<Value = String> {
    (0..GOOD.len(), 0..40usize, "\\PC{0,12}|[\\[\\]{}=\".,0-9a-z\n]{0,12}").prop_map(|(start, length, new)| {
        let end = (start + length).min(GOOD.len());
        format!("{}{new}{}", &GOOD[..start], &GOOD[end..])
    })
}

proptest! {
    #[test]
    fn no_bytes_make_load_panic(bytes in proptest::collection::vec(any::<u8>(), 0..200)) {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.toml");
        std::fs::write(&path, bytes).unwrap();
        let _ = Scene::load(&path, &[]);
    }

    #[test]
    fn no_text_makes_it_panic(text in mangled()) {
        let _ = parse(&text);
    }

    #[test]
    fn no_set_makes_it_panic(
        path in "(title|mesh|scheme|boundary|output|cloud|curl|initial|0|1|9)(\\.(0|1|5|kind|at|cells|file|rectangle|cfl|x)){0,3}",
        value in "\\PC{0,10}|[\\[\\]{}=\".,0-9a-z]{0,8}",
    ) {
        let _ = Scene::parse(GOOD, Path::new("case.toml"), &[format!("{path}={value}")]);
    }
}
