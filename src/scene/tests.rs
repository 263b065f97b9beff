use super::*;
use crate::registry::{self, FLUXES, LAYOUTS, Table};

const MINIMAL: &str = r#"
[mesh]
rectangle = { size = [3.0, 1.0], cells = [30, 10] }
[[material]]
law = "neo-hookean"
young = 2e11
poisson = 0.3
density = 7800
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
kind = "symmetry"
[scheme]
method = "ader-dgmpm"
degree = 2
[time]
end = 1e-3
"#;

fn parse(text: &str, sets: &[&str]) -> Result<Scene> {
    let sets: Vec<String> = sets.iter().map(|set| (*set).to_owned()).collect();
    Scene::parse(text, Path::new("folder/case.toml"), &sets)
}

/// An entry with its defaults for degree 2.
fn plain<B>(entries: &'static Table<B>, name: &str) -> Chosen<B> {
    let entry = entries.find(name).unwrap();
    Chosen { entry, values: registry::defaults(entry.parameters, 2) }
}

fn cloud(layout: &str, per_direction: usize) -> Cloud {
    Cloud { layout: plain(&LAYOUTS, layout), per_direction }
}

/// The control of the curl and its rate.
fn control(scene: &Scene) -> (&'static str, Option<f64>) {
    (scene.curl.name(), scene.curl.values.maybe("alpha"))
}

fn message(text: &str, sets: &[&str]) -> String {
    parse(text, sets).unwrap_err().to_string()
}

#[test]
fn defaults() {
    let scene = parse(MINIMAL, &[]).unwrap();
    assert_eq!((scene.title.as_str(), scene.name().as_str()), ("case", "case"));
    assert_eq!(scene.mesh, Mesh::Rectangle { size: [3.0, 1.0], cells: [30, 10] });
    assert_eq!(scene.cloud, cloud("paper", 3));
    assert_eq!(scene.materials[0].cloud, scene.cloud);
    assert_eq!(scene.materials[0].law.values.number("young"), 2e11);
    assert_eq!(scene.initial.deformation.each_ref().map(|f| f.constant().unwrap()), [1.0, 0.0, 0.0, 1.0]);
    let wall = &scene.boundaries[0].condition;
    assert_eq!((wall.name(), wall.values.expression("speed")), ("wall", Some(&Expression::number(0.0))));
    assert_eq!((control(&scene), scene.scheme.flux.name()), (("rotation", Some(3.0)), "dual"));
    let scheme = Scheme {
        method: Method::AderDgmpm,
        degree: 2,
        time_degree: 2,
        flux: plain(&FLUXES, "dual"),
        step: Step::Safety(0.9),
        sweeps: Sweeps::Ladder,
        angular_momentum: false,
        springs: false,
    };
    assert_eq!(scene.scheme, scheme);
    assert!(scene.outputs.is_empty() && scene.sources.is_empty());
    let high = parse(MINIMAL, &["scheme.degree=4"]).unwrap();
    assert_eq!(high.cloud, cloud("midpoints", 5));
    assert_eq!((control(&high), high.scheme.time_degree), (("rotation", Some(6.0)), 4));
}

#[test]
fn outputs() {
    let text = format!(
        "{MINIMAL}{}",
        r#"
[[output]]
kind = "fields"
every = 1e-4
exact_times = true
[[output]]
kind = "line"
name = "bottom"
from = [0, 0]
to = [3, 0]
samples = 300
at = [1e-3, 5e-4]
[[output]]
kind = "ledger"
"#
    );
    let scene = parse(&text, &[]).unwrap();
    let [fields, line, ledger] = &scene.outputs[..] else { panic!("three outputs") };
    assert_eq!((fields.name.as_str(), &fields.when, fields.exact_times), ("fields", &When::Every(1e-4), true));
    assert_eq!(scene.fields_of(fields).len(), 7);
    let values = &line.what.values;
    assert_eq!((values.vector("from"), values.vector("to"), values.integer("samples")), ([0.0, 0.0], [3.0, 0.0], 300));
    assert_eq!(line.when, When::At(vec![5e-4, 1e-3]));
    assert_eq!(values.texts("fields"), ["cauchy_stress", "velocity"]);
    assert_eq!((&ledger.when, scene.fields_of(ledger).len()), (&When::EverySteps(1), 0));
}

#[test]
fn expressions_and_numbers() {
    let more = r#"
[initial]
velocity = [-200, "300*sin(pi*x)"]
[[source]]
kind = "gravity"
value = [0, -9.81]
"#;
    let sets = ["boundary.0.speed=10*t", "boundary.1.kind=traction", "boundary.1.value=[\"-1e8*step(1e-4-t)\", 0]"];
    let scene = parse(&format!("{MINIMAL}{more}"), &sets).unwrap();
    assert!((scene.initial.velocity[1].eval([0.5, 0.0], 0.0) - 300.0).abs() < 1e-9);
    assert_eq!(scene.sources[0].source.values.expressions("value")[1].constant(), Some(-9.81));
    let speed = scene.boundaries[0].condition.values.expression("speed").unwrap();
    assert_eq!(speed.eval([0.0; 2], 2.0), 20.0);
    let push = scene.boundaries[1].condition.values.expression("value").unwrap();
    assert!(push.depends_on_time());
}

#[test]
fn sets_change_the_text_and_keep_comments() {
    let text = MINIMAL.replace("degree = 2", "degree = 2   # N").replace("[time]", "cfl = 0.4\n# the end\n[time]");
    let scene = parse(&text, &["scheme.degree=1", "scheme.safety=0.8", "scheme.method=rk-dgfem", "title=A b"]).unwrap();
    assert_eq!((scene.scheme.degree, scene.scheme.method), (1, Method::RkDgfem));
    assert_eq!((scene.scheme.step, scene.title.as_str()), (Step::Safety(0.8), "A b"));
    let run = scene.to_toml();
    assert!(run.contains("degree = 1   # N") && run.contains("# the end") && !run.contains("cfl"), "{run}");
    let again = parse(&run, &[]).unwrap();
    assert_eq!(serde_json::to_value(&scene).unwrap(), serde_json::to_value(&again).unwrap());
}

#[test]
fn sets_replace_rivals_and_grow_lists() {
    let file = MINIMAL.replace("rectangle = { size = [3.0, 1.0], cells = [30, 10] }", "file = \"a.msh\"");
    let scene = parse(&file, &[]).unwrap();
    assert_eq!(scene.mesh_path(), Some(PathBuf::from("folder/a.msh")));
    let scene = parse(&file, &["mesh.rectangle.size=[1, 1]", "mesh.rectangle.cells=[2, 2]"]).unwrap();
    assert_eq!(scene.mesh, Mesh::Rectangle { size: [1.0, 1.0], cells: [2, 2] });
    let scene = parse(MINIMAL, &["mesh.rectangle.cells.1=7", "mesh.rectangle.cells.0=5"]).unwrap();
    assert_eq!(scene.mesh, Mesh::Rectangle { size: [3.0, 1.0], cells: [5, 7] });
    let scene = parse(MINIMAL, &["mesh.file=b.msh"]).unwrap();
    assert_eq!(scene.mesh, Mesh::File("b.msh".into()));
    let sets = ["output.0.kind=ledger", "output.1.kind=fields", "output.1.at=[1e-4]"];
    let scene = parse(&parse(MINIMAL, &sets).unwrap().to_toml(), &["output.1.every_steps=5"]).unwrap();
    assert_eq!(scene.outputs[1].when, When::EverySteps(5));
    let scene = parse(MINIMAL, &["curl.control=off", "cloud={layout=\"gauss\"}"]).unwrap();
    assert_eq!((control(&scene), scene.cloud.layout), (("off", None), plain(&LAYOUTS, "gauss")));
    let scene = parse(MINIMAL, &["boundary.1={group=\"right\", kind=\"traction\", value=[0, 1]}"]).unwrap();
    assert_eq!(scene.boundaries[1].condition.name(), "traction");
    assert_eq!(parse(&scene.to_toml(), &[]).unwrap().boundaries, scene.boundaries);
    let sets = ["output.0={kind=\"fields\", every=1e-4}", "boundary.1={group=\"right\", kind=\"clamped\"}"];
    let scene = parse(MINIMAL, &sets).unwrap();
    assert_eq!((scene.outputs.len(), scene.boundaries[1].condition.name()), (1, "clamped"));
    assert_eq!(parse(&scene.to_toml(), &[]).unwrap().boundaries, scene.boundaries);
    let with_table = format!("{MINIMAL}[cloud]\nlayout = \"paper\" # where\n[curl]\ncontrol = \"lcf\"\n");
    let scene = parse(&with_table, &["cloud={layout=\"gauss\"}", "curl.alpha=5"]).unwrap();
    assert_eq!((control(&scene), scene.cloud.layout), (("lcf", Some(5.0)), plain(&LAYOUTS, "gauss")));
}

#[test]
fn a_set_that_replaces_another_key_says_so_and_two_sets_that_exclude_each_other_are_refused() {
    let with_times = format!("{MINIMAL}[[output]]\nkind = \"fields\"\nat = [0.0]\n");
    let of_file = with_times.replace("degree = 2", "degree = 2\ncfl = 0.4");
    let warnings = |set: &str| parse(&of_file, &[set]).unwrap().warnings();
    let words = "takes the place of";
    let found = warnings("scheme.safety=0.8");
    assert_eq!(found, [format!("--set scheme.safety=0.8: {words} `scheme.cfl` in the scene file")]);
    assert!(warnings("output.0.every=1e-3")[0].ends_with(&format!("{words} `output.0.at` in the scene file")));
    for (sets, keys) in [
        (["scheme.cfl=0.4", "scheme.safety=0.8"], "`scheme.cfl` and `scheme.safety` exclude each other"),
        (["output.0.at=[1e-4]", "output.0.every_steps=5"], "`output.0.at` and `output.0.every_steps`"),
        (["output.0={kind=\"fields\",every=1e-4}", "output.0.every_steps=5"], "`output.0.every` and"),
        (["regrid=[{at=[1e-4],refine=2}]", "regrid.0.coarsen=2"], "`regrid.0.refine` and `regrid.0.coarsen`"),
    ] {
        let found = message(&with_times, &sets);
        let remedy = format!("leave out this --set, or --set {}", sets[0]);
        assert!(found.starts_with(&format!("--set {}: ", sets[1])) && found.contains(keys), "{found}");
        assert!(found.contains(&remedy), "{found}");
    }
}

#[test]
fn bad_sets_say_so() {
    let table = [
        ("scheme.metod=rk-dgfem", "--set scheme.metod=rk-dgfem: unknown key `metod`", "did you mean `method`"),
        ("scheme.method=rk", "--set scheme.method=rk: unknown `method` \"rk\"", "\"rk-dgfem\""),
        ("scheme.degree=9", "--set scheme.degree=9: `degree` is 9", "from 0 to 6"),
        ("boundary.9.kind=free", "--set boundary.9.kind=free: `boundary.9` has no place", "0 to 3, and 4 appends"),
        ("boundary.4.kind=free", "--set boundary.4.kind=free: ", "needs the key `group`"),
        ("scheme.degree.x=1", "--set scheme.degree.x=1: ", "`scheme.degree` is a value"),
        ("mesh.rectangle.cells.5=1", "--set mesh.rectangle.cells.5=1: ", "entries are 0 to 1"),
        ("scheme.degree", "--set scheme.degree: there is no `=`", "key.path=value"),
        ("=1", "--set =1: ", "key.path=value"),
        ("time.end=[1", "--set time.end=[1: `[1` is not a TOML value", "brackets"),
        ("time.end=-1", "--set time.end=-1: `end` is -1", "greater than 0"),
        ("tme.end=1", "--set tme.end=1: unknown key `tme` in the scene", "did you mean `time`"),
        ("boundary.0.group=lft", "--set boundary.0.group=lft: the mesh has no group \"lft\"", "did you mean `left`"),
    ];
    for (set, begin, words) in table {
        let found = message(MINIMAL, &[set]);
        assert!(found.starts_with(begin) && found.contains(words), "{set}: {found}");
    }
}

#[test]
fn an_error_of_the_file_keeps_its_line_when_sets_move_lines() {
    let text = MINIMAL.replace("end = 1e-3", "end = 0").replace("[scheme]", "[scheme]\ncfl = 0.4");
    let found = message(&text, &["scheme.safety=0.5", "cloud.layout=gauss", "scheme.flux=acoustic"]);
    assert!(found.starts_with("folder/case.toml:26:7: `end` is 0"), "{found}");
}

#[test]
fn groups() {
    let names = |list: &[&str]| list.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>();
    let text = MINIMAL.replace("rectangle = { size = [3.0, 1.0], cells = [30, 10] }", "file = \"a.msh\"");
    let edges = names(&["left", "right", "bottom", "top"]);
    let scene = parse(&text, &[]).unwrap();
    scene.check_groups(&names(&["a", "b"]), &edges).unwrap();
    let found = scene.check_groups(&[], &names(&["left", "right", "botom", "top"])).unwrap_err().to_string();
    assert!(found.starts_with("folder/case.toml:16:9: the mesh has no group \"bottom\""), "{found}");
    assert!(found.contains("did you mean `botom`? its groups of boundary edges are left, right"), "{found}");
    let found = scene.check_groups(&[], &names(&["left", "right", "bottom", "top", "hole"])).unwrap_err().to_string();
    assert!(found.starts_with("folder/case.toml:9:1: the group hole of the mesh has no [[boundary]]"), "{found}");
    assert!(found.contains("kind = \"free\""), "{found}");
    let some = parse(&text, &["material.0.group=a"]).unwrap();
    let found = some.check_groups(&names(&["a", "b", "c"]), &edges).unwrap_err().to_string();
    assert!(found.contains("the groups b, c of the mesh have no [[material]]"), "{found}");
    let found = some.check_groups(&names(&["b"]), &edges).unwrap_err().to_string();
    assert!(found.starts_with("--set material.0.group=a: the mesh has no group \"a\""), "{found}");
    let found = some.check_groups(&[], &edges).unwrap_err().to_string();
    assert!(found.contains("no named group of cells"), "{found}");
}

#[test]
fn the_ladder_needs_equal_degrees_and_the_papers_sweeps_do_not() {
    let sweeps = |sets: &[&str]| parse(MINIMAL, sets).unwrap().scheme.sweeps;
    assert_eq!(sweeps(&["scheme.time_degree=1"]), Sweeps::Paper);
    assert_eq!(sweeps(&["scheme.time_degree=2"]), Sweeps::Ladder);
    assert_eq!(sweeps(&["scheme.sweeps=paper"]), Sweeps::Paper);
    let text = message(MINIMAL, &["scheme.sweeps=ladder", "scheme.time_degree=1"]);
    assert!(text.contains("scheme.sweeps=ladder: the ladder needs time_degree = degree"), "{text}");
}

#[test]
fn errors_of_later_checks_have_places_too() {
    let scene = parse(MINIMAL, &["scheme.cfl=0.4"]).unwrap();
    assert!(scene.error("scheme.cfl", "a", "b").to_string().starts_with("--set scheme.cfl=0.4: a"));
    assert!(scene.error("scheme.degree", "a", "b").to_string().starts_with("folder/case.toml:23:10: a"));
    assert!(scene.error("initial.velocity", "a", "b").to_string().starts_with("folder/case.toml:1:1: a"));
}

#[test]
fn layouts_per_material() {
    let text = MINIMAL.replace("density = 7800", "density = 7800\nlayout = \"jitter\"\nseed = 7\nper_direction = 4");
    let scene = parse(&text, &[]).unwrap();
    assert_eq!(scene.cloud, cloud("paper", 3));
    let own = &scene.materials[0].cloud;
    let values = &own.layout.values;
    assert_eq!((own.layout.name(), own.per_direction), ("jitter", 4));
    assert_eq!((values.integer("seed"), values.number("amount")), (7, 0.2));
    let file = parse(MINIMAL, &["cloud={layout=\"file\", path=\"points.vtu\"}"]).unwrap();
    assert_eq!(file.cloud_path(), Some(PathBuf::from("folder/points.vtu")));
    assert!(message(&text, &["cloud={layout=\"file\", path=\"p\"}"]).contains("the points come from the file"));
}

/// [`MINIMAL`] with other conditions on the left, right and at the top.
fn with_sides(left: &str, right: &str, top: &str) -> String {
    let side = |text: String, group: &str, old: &str, new: &str| {
        text.replace(&format!("group = \"{group}\"\nkind = \"{old}\""), &format!("group = \"{group}\"\n{new}"))
    };
    let text = side(MINIMAL.to_owned(), "left", "wall", left);
    side(side(text, "right", "free", right), "top", "symmetry", top)
}

#[test]
fn periodic_groups_are_named_once_or_by_both_and_join_the_mesh() {
    let (left, right) = ("kind = \"periodic\"\npartner = \"right\"", "kind = \"periodic\"\npartner = \"left\"");
    let symmetry = "kind = \"symmetry\"";
    let both = parse(&with_sides(left, right, symmetry), &[]).unwrap();
    let once = with_sides(left, right, symmetry).replace(&format!("[[boundary]]\ngroup = \"right\"\n{right}\n"), "");
    let once = parse(&once, &[]).unwrap();
    assert_eq!((both.boundaries.len(), once.boundaries.len()), (4, 3));
    for scene in [both, once] {
        let mesh = scene.build_mesh().unwrap();
        assert_eq!(scene.periodic_groups(&mesh), [[0, 1]]);
        let across = crate::mesh::Link::Cell { cell: 29, face: 1, flip: false };
        assert_eq!(scene.links(&mesh).unwrap()[0][0], across);
    }
}

#[test]
fn partners_that_do_not_agree_are_refused() {
    let (left, symmetry) = ("kind = \"periodic\"\npartner = \"right\"", "kind = \"symmetry\"");
    let agree = "do not agree";
    for (text, part) in [
        (with_sides(left, "kind = \"free\"", symmetry), agree),
        (with_sides(left, "kind = \"periodic\"\npartner = \"top\"", symmetry), agree),
        (with_sides(left, "kind = \"periodic\"\npartner = \"left\"", left), agree),
        (with_sides("kind = \"periodic\"\npartner = \"left\"", "kind = \"free\"", symmetry), "its own `partner`"),
        (with_sides("kind = \"contact\"\npartner = \"right\"", "kind = \"free\"", symmetry), agree),
        (
            with_sides(
                "kind = \"contact\"\npartner = \"right\"",
                "kind = \"contact\"\npartner = \"left\"\nfriction = 0.1",
                symmetry,
            ),
            agree,
        ),
        (with_sides("kind = \"periodic\"", "kind = \"free\"", symmetry), "needs the key `partner`"),
        (with_sides("kind = \"periodic\"\npartner = \"rigt\"", "kind = \"free\"", symmetry), "did you mean `right`"),
    ] {
        let error = message(&text, &[]);
        assert!(error.contains(part), "{error}");
    }
}

#[test]
fn exact_solutions_have_defaults_and_fit_law_and_end() {
    let scene = parse(MINIMAL, &["exact.kind=simple-wave", "exact.width=0.2", "time.end=1e-4"]).unwrap();
    let exact = scene.exact.as_ref().unwrap();
    let of = |name: &str| exact.solution.values.number(name);
    assert_eq!((of("amplitude"), of("width"), exact.initial), (0.1, 0.2, true));
    assert!(scene.build_exact().unwrap().body_force([0.0; 2], 0.0).is_none());
    let given = parse(MINIMAL, &["exact.kind=wall-impact", "initial.velocity=[-200, 0]"]).unwrap();
    assert!(!given.exact.unwrap().initial);
    assert!(parse(MINIMAL, &["exact.kind=linear-bar", "material.0.law=linear-elastic"]).is_ok());
    for (sets, part) in [
        (&["exact.kind=simple-wave"][..], "then it breaks"),
        (&["exact.kind=linear-bar"], "linear-elastic"),
        (&["exact.kind=simple-wav"], "did you mean `simple-wave`"),
        (&["exact.kind=wall-impact", "exact.width=1"], "unknown key `width`"),
        (&["exact.speed=1"], "needs the key `kind`"),
    ] {
        let error = message(MINIMAL, sets);
        assert!(error.contains(part), "{error}");
    }
}
