//! The first hour: what the tutorial and the cookbook say runs as it stands there; `new` makes a scene of every mesh, `info` knows every
//! file, `plot` draws what a run has, `schema` says what a scene is.

mod python;

use serde_json::Value;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

const TUTORIAL: &str = include_str!("../docs/tutorial.md");
const COOKBOOK: &str = include_str!("../docs/cookbook.md");
const README: &str = include_str!("../README.md");

/// The program, and `gmsh` where Python has it, on the path.
fn path() -> String {
    let program = Path::new(env!("CARGO_BIN_EXE_dgmpm")).parent().unwrap();
    let gmsh = python::python().and_then(|python| python.parent().map(|bin| format!("{}:", bin.display())));
    format!("{}:{}{}", program.display(), gmsh.unwrap_or_default(), std::env::var("PATH").unwrap())
}

/// Runs a block of commands in a folder; what it says.
fn run(commands: &str, folder: &Path) -> String {
    let run =
        Command::new("bash").args(["-e", "-c", commands]).env("PATH", path()).current_dir(folder).output().unwrap();
    let said = String::from_utf8_lossy(&run.stdout).into_owned();
    assert!(run.status.success(), "{commands}\n{said}\n{}", String::from_utf8_lossy(&run.stderr));
    said
}

/// Runs the program in a folder.
fn dgmpm(arguments: &[&str], folder: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dgmpm"));
    command.args(arguments).env("PATH", path()).current_dir(folder).output().unwrap()
}

/// What a command that has to go well says.
fn said(arguments: &[&str], folder: &Path) -> String {
    let run = dgmpm(arguments, folder);
    assert!(run.status.success(), "{arguments:?}\n{}", String::from_utf8_lossy(&run.stderr));
    String::from_utf8(run.stdout).unwrap()
}

/// The fenced blocks of a text: language and content.
fn blocks(text: &str) -> Vec<(&str, &str)> {
    let parts: Vec<&str> = text.split("```").collect();
    assert!(parts.len() % 2 == 1, "a block that is not closed");
    parts.iter().skip(1).step_by(2).map(|part| part.split_once('\n').unwrap()).collect()
}

/// The file that a block names in its first line, behind the sign of a comment.
fn file_of(block: &str) -> Option<&str> {
    let first = block.lines().next()?;
    let name = first.trim_start_matches(['#', '/']).trim();
    (first != name && Path::new(name).extension().is_some() && !name.contains(' ')).then_some(name)
}

fn has_gmsh() -> bool {
    Command::new("gmsh").arg("--version").env("PATH", path()).output().is_ok_and(|run| run.status.success()) || {
        assert!(std::env::var("DGMPM_REQUIRE_PYTHON").as_deref() != Ok("1"), "there is no gmsh");
        println!("SKIP: there is no gmsh");
        false
    }
}

/// A picture that is not of one colour.
fn assert_is_picture(path: &Path) {
    let mut reader =
        png::Decoder::new(std::io::BufReader::new(std::fs::File::open(path).unwrap())).read_info().unwrap();
    let mut pixels = vec![0; reader.output_buffer_size()];
    reader.next_frame(&mut pixels).unwrap();
    let colours: std::collections::BTreeSet<[u8; 3]> = pixels.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
    // White, frame, letters and the colours of a map or of curves.
    assert!(colours.len() > 20, "{}: {} colours", path.display(), colours.len());
}

#[test]
fn the_tutorial_gets_from_a_geometry_to_pictures_by_three_commands() {
    if !has_gmsh() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let all = blocks(TUTORIAL);
    let geometry = all.iter().find(|(language, _)| *language == "geo").unwrap().1;
    std::fs::write(folder.join("plate.geo"), geometry).unwrap();
    let commands: Vec<&str> = all.iter().filter(|(language, _)| *language == "sh").map(|(_, block)| *block).collect();
    assert_eq!(commands[0].trim().lines().count(), 3, "three commands");
    // The README has the same ones, with comments.
    let bare =
        |block: &str| block.lines().map(|line| line.split('#').next().unwrap().trim().to_owned()).collect::<Vec<_>>();
    assert!(blocks(README).iter().any(|(language, block)| *language == "sh" && bare(block) == bare(commands[0])));
    run(commands[0], folder);
    for name in ["von_mises", "pressure", "speed", "jacobian", "energy", "track_force", "track_probe"] {
        assert_is_picture(&folder.join(format!("runs/plate/plots/{name}.png")));
    }
    commands[1..].iter().for_each(|block| drop(run(block, folder)));
    // `new` leaves alone what is there.
    let again = dgmpm(&["new", "plate.geo"], folder);
    assert_eq!(again.status.code(), Some(2));
    assert!(String::from_utf8_lossy(&again.stderr).contains("plate.toml exists"));
}

#[test]
fn each_recipe_of_the_cookbook_runs() {
    if !has_gmsh() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let tools = python::root().join("tools");
    let mut count = 0;
    for (language, block) in blocks(COOKBOOK) {
        match language {
            "sh" => drop(run(block, folder)),
            "toml" | "csv" | "geo" => std::fs::write(folder.join(file_of(block).expect(block)), block).unwrap(),
            _ => {
                let script = folder.join(format!("recipe_{count}.py"));
                let head = format!("import os, sys\nsys.path.insert(0, {:?})\nos.chdir({:?})\n", tools, folder);
                std::fs::write(&script, head + block).unwrap();
                let arguments: [&str; 0] = [];
                match language {
                    "python" => drop(python::run(&python::python().unwrap(), script.to_str().unwrap(), arguments)),
                    "python dolfinx" => drop(python::run_dolfinx(script.to_str().unwrap(), arguments)),
                    other => panic!("a block of {other}"),
                }
            }
        }
        count += 1;
    }
    assert!(count > 25, "{count} blocks");
    for picture in
        ["gap/plots/track_wall", "slide/plots/track_middle", "bars/plots/von_mises", "crack/plots/track_opening"]
    {
        assert_is_picture(&folder.join(format!("runs/{picture}.png")));
    }
    // What the recipes say of their runs is so.
    let opening = std::fs::read_to_string(folder.join("runs/crack/tracks/opening.csv")).unwrap();
    let length = |line: &str| line.split(',').nth(1).unwrap().parse::<f64>().unwrap();
    let (first, last) = (length(opening.lines().nth(1).unwrap()), length(opening.lines().next_back().unwrap()));
    assert!(last > first + 1e-3, "the crack opens: {first} {last}");
    let log = std::fs::read_to_string(folder.join("log.jsonl")).unwrap();
    let events: Vec<Value> = log.lines().map(|line| serde_json::from_str(line).expect(line)).collect();
    assert!(events.iter().all(|event| event["event"].is_string()) && events.len() > 3, "{log}");
    assert_eq!(run("dgmpm check gap.toml --quiet", folder), "");
}

/// The meshes of the repository, and what else `new` has to cope with.
fn meshes() -> Vec<PathBuf> {
    let root = python::root();
    let named = ["square_unstructured", "plate_hole", "colliding_discs", "double_cantilever", "riemann"];
    let mut all: Vec<PathBuf> = named.iter().map(|name| root.join(format!("meshes/{name}.msh"))).collect();
    // An edge of the boundary that is in no physical curve; cells in two groups.
    all.extend(["untagged_edge", "two_surfaces_41_ascii"].map(|name| root.join(format!("tests/data/gmsh/{name}.msh"))));
    all
}

#[test]
fn a_scene_of_new_is_complete_and_steps_on_every_mesh() {
    for mesh in meshes() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        let name = mesh.file_stem().unwrap().to_string_lossy().into_owned();
        std::fs::copy(&mesh, folder.join(format!("{name}.msh"))).unwrap();
        said(&["new", &format!("{name}.msh")], folder);
        let scene = std::fs::read_to_string(folder.join(format!("{name}.toml"))).unwrap();
        // Comments are those of the registry: a word of it stands there.
        let law = dgmpm::registry::LAWS.first().about;
        assert!(scene.contains(law) && scene.lines().all(|line| line.chars().count() <= 120), "{scene}");
        said(&["check", &format!("{name}.toml")], folder);
        // Some steps: the speed is so small that nothing is lost.
        said(&["run", &format!("{name}.toml"), "--set", "time.end=2e-6", "--set", "scheme.degree=1"], folder);
    }
    let beam = tempfile::tempdir().unwrap();
    std::fs::copy(python::root().join("meshes/double_cantilever.msh"), beam.path().join("b.msh")).unwrap();
    said(&["new", "b.msh", "--out", "scenes/b.toml"], beam.path());
    let scene = std::fs::read_to_string(beam.path().join("scenes/b.toml")).unwrap();
    // A crack is not opened unasked.
    assert!(scene.contains("# \"crack\", \"joint\": these") && scene.contains("file = \"../b.msh\""), "{scene}");
    let discs = tempfile::tempdir().unwrap();
    std::fs::copy(python::root().join("meshes/colliding_discs.msh"), discs.path().join("d.msh")).unwrap();
    said(&["new", "d.msh"], discs.path());
    let scene = std::fs::read_to_string(discs.path().join("d.toml")).unwrap();
    assert!(scene.contains("kind = \"contact\"") && scene.contains("partner = \"second\""), "two bodies meet: {scene}");
}

#[test]
fn info_knows_each_file_of_a_run_and_says_of_others_what_it_can_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let recipe = blocks(COOKBOOK).into_iter().find(|(_, block)| block.starts_with("# probes.toml")).unwrap().1;
    let snapshots = "[[output]]\nkind = \"fields\"\nat = [1e-5]\n[checkpoint]\nevery_steps = 5\n";
    let scene = recipe.replace("= 1e-4", "= 1e-5").replace("[1e-4]", "[1e-5]") + snapshots;
    std::fs::write(folder.join("probes.toml"), scene).unwrap();
    std::fs::copy(python::root().join("meshes/riemann.msh"), folder.join("riemann.msh")).unwrap();
    said(&["run", "probes.toml"], folder);
    said(&["export", "runs/probes", "--format", "vtu,xdmf,vtkhdf"], folder);
    let first = |name: &str| {
        let mut all: Vec<PathBuf> = std::fs::read_dir(folder.join("runs/probes").join(name))
            .unwrap()
            .map(|entry| entry.unwrap().path())
            .collect();
        all.sort();
        format!("runs/probes/{name}/{}", all[0].file_name().unwrap().to_string_lossy())
    };
    let run = |name: &str| format!("runs/probes/{name}");
    let wanted = [
        ("riemann.msh".to_owned(), "Gmsh mesh"),
        ("probes.toml".to_owned(), "scene"),
        ("runs/probes".to_owned(), "folder of a run"),
        (run("scene.toml"), "scene"),
        (run("mesh.h5"), "mesh"),
        (run("cloud.h5"), "cloud of material points"),
        (run("operators.h5"), "operators: the stored matrices"),
        (first("snapshots"), "snapshot"),
        (first("checkpoints"), "checkpoint"),
        (run("ledger.csv"), "ledger: energy and momentum over time"),
        (run("tracks/corner.csv"), "numbers through time of an output"),
        (run("lines/bottom.csv"), "samples along a line"),
        (run("summary.json"), "summary of a run"),
        (run("export/grid.pvd"), "PVD: a series of VTU files"),
        (run("export/series.xdmf"), "XDMF: grids with their fields, whose numbers are in an .h5 file"),
        (run("export/grid.vtkhdf"), "VTKHDF: a series for ParaView, all times in one file"),
        (run("export/series.h5"), "HDF5 file of an export, which an .xdmf file names"),
    ];
    for (file, kind) in wanted {
        let info: Value = serde_json::from_str(&said(&["info", &file, "--json"], folder)).expect(&file);
        assert_eq!(info["kind"], kind, "{file}");
        assert!(said(&["info", &file], folder).lines().count() > 2, "{file}");
    }
    let info = |file: &str| -> Value { serde_json::from_str(&said(&["info", file, "--json"], folder)).unwrap() };
    let snapshot = info(&first("snapshots"));
    // 6 x 6 cells of degree 2.
    assert_eq!([&snapshot["cells"], &snapshot["degree"]], [36, 2]);
    assert_eq!(info("runs/probes")["status"], "done");
    assert_eq!(info(&run("mesh.h5"))["edges_of"]["left"]["boundary"], 6);
    unknown_files_are_refused(folder);
    // An output of another kind in the place of a mesh is no mesh.
    let wrong = dgmpm(&["mesh", "info", "runs/probes/cloud.h5"], folder);
    assert_eq!(wrong.status.code(), Some(2));
}

/// One message with the formats, and exit code 2.
fn unknown_files_are_refused(folder: &Path) {
    std::fs::write(folder.join("bytes.bin"), [0_u8, 159, 146, 150]).unwrap();
    std::fs::write(folder.join("empty.msh"), "").unwrap();
    std::fs::write(folder.join("words.txt"), "Dear reader,\nthis is, a letter\n").unwrap();
    std::fs::create_dir_all(folder.join("nothing")).unwrap();
    for file in ["bytes.bin", "empty.msh", "words.txt", "nothing", "absent"] {
        let refused = dgmpm(&["info", file], folder);
        let why = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert_eq!(refused.status.code(), Some(2), "{file}: {why}");
        assert!(why.contains(file) && why.contains("the files that can be read are"), "{why}");
        assert_eq!(why.matches("error: ").count(), 1, "{why}");
    }
}

#[test]
fn new_seed_and_preprocess_do_not_write_over_a_file_that_they_read() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    let (mesh, scene) = ("square_impact.msh", "square_impact.toml");
    for name in [mesh, scene] {
        std::fs::copy(from.join(name), folder.join(name)).unwrap();
    }
    let bytes = |name: &str| std::fs::read(folder.join(name)).unwrap();
    let before = [mesh, scene].map(bytes);
    // By the same name and by another path to it.
    let beside = folder.join("..").join(folder.file_name().unwrap()).join(mesh);
    for (command, out) in [
        (["new", mesh], mesh),
        (["new", mesh], beside.to_str().unwrap()),
        (["seed", scene], scene),
        (["seed", scene], mesh),
        (["preprocess", scene], scene),
        (["preprocess", scene], mesh),
    ] {
        let run = dgmpm(&[&command[..], &["--out", out, "--force"]].concat(), folder);
        let message = String::from_utf8_lossy(&run.stderr).into_owned();
        assert_eq!(run.status.code(), Some(2), "{command:?} --out {out}: {message}");
        assert!(message.contains("is read by this command") && message.contains("--out"), "{command:?}: {message}");
        assert_eq!([mesh, scene].map(bytes), before, "{command:?} --out {out}");
    }
}

#[test]
fn what_gmsh_says_of_a_wrong_geometry_reaches_the_user() {
    if !has_gmsh() {
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("bad.geo"), "Point(1) = {0, 0, 0};\nLine(1) = {1, 2;\n").unwrap();
    let run = dgmpm(&["new", "bad.geo"], folder.path());
    let message = String::from_utf8_lossy(&run.stderr).into_owned();
    // Gmsh names the line and what it met there.
    assert!(
        run.status.code() == Some(2) && message.contains("bad.geo") && message.contains("syntax error"),
        "{message}"
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1, "nothing is left behind");
}

#[test]
fn plot_refuses_what_it_cannot_draw_and_names_what_it_can() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = blocks(COOKBOOK).into_iter().find(|(_, block)| block.starts_with("# gap.toml")).unwrap().1;
    std::fs::write(folder.join("gap.toml"), scene).unwrap();
    said(&["run", "gap.toml", "--set", "time.end=2e-6"], folder);
    let refused = |arguments: &[&str]| {
        let run = dgmpm(&[&["plot"], arguments].concat(), folder);
        assert_eq!(run.status.code(), Some(2), "{arguments:?}");
        String::from_utf8(run.stderr).unwrap()
    };
    assert!(refused(&["runs/gap", "--field", "presure"]).contains("did you mean `pressure`"));
    assert!(refused(&["runs/gap", "--step", "7"]).contains("there are those after 0"));
    assert!(refused(&["nowhere"]).contains("not the folder of a run"));
    for time in ["nan", "inf", "-inf"] {
        assert!(refused(&["runs/gap", &format!("--time={time}")]).contains("--time is not a finite number"), "{time}");
    }
    let early = dgmpm(&["plot", "runs/gap", "--field", "speed,speed", "--time", "-1"], folder);
    let [drawn, note] = [early.stdout, early.stderr].map(|text| String::from_utf8(text).unwrap());
    assert!(drawn.contains("1 picture in") || note.contains("1 picture in"), "{drawn}{note}");
    assert!(format!("{drawn}{note}").contains("the nearest one is shown, after step 0, t = 0 s"), "{drawn}{note}");
    assert!(refused(&["runs/gap", "--field", "pressure", "--range", "2,1"]).contains("--range"));
    let drawn = said(&["plot", "runs/gap", "--format", "svg", "--field", "speed", "--step", "0"], folder);
    assert!(drawn.contains("1 picture in"), "{drawn}");
    let svg = std::fs::read_to_string(folder.join("runs/gap/plots/speed_000000.svg")).unwrap();
    assert!(svg.contains("data:image/png;base64,") && svg.contains("speed [m/s]"));
    // A new run removes the pictures of the old one; `verify` knows them.
    said(&["verify", "runs/gap", "--steps", "0"], folder);
    said(&["run", "gap.toml", "--set", "time.end=2e-6", "--force"], folder);
    assert!(!folder.join("runs/gap/plots/speed_000000.svg").exists());
}

/// A document of TOML as JSON.
fn json(item: &toml_edit::Item) -> Value {
    if let Some(table) = item.as_table_like() {
        return table.iter().map(|(key, item)| (key.to_owned(), json(item))).collect::<serde_json::Map<_, _>>().into();
    }
    if let Some(list) = item.as_array_of_tables() {
        return list.iter().map(|table| json(&toml_edit::Item::Table(table.clone()))).collect::<Vec<_>>().into();
    }
    match item.as_value().unwrap() {
        toml_edit::Value::String(text) => text.value().clone().into(),
        toml_edit::Value::Integer(n) => (*n.value()).into(),
        toml_edit::Value::Float(x) => (*x.value()).into(),
        toml_edit::Value::Boolean(is) => (*is.value()).into(),
        toml_edit::Value::Array(list) => {
            list.iter().map(|value| json(&toml_edit::Item::Value(value.clone()))).collect::<Vec<_>>().into()
        }
        other => panic!("{other}"),
    }
}

/// The scenes of the repository.
fn scenes() -> Vec<(String, String)> {
    let root = python::root();
    let mut all = Vec::new();
    for folder in ["meshes", "meshes/hard", "meshes/validation"] {
        let files = std::fs::read_dir(root.join(folder)).unwrap().map(|entry| entry.unwrap().path());
        for path in files.filter(|path| path.extension().is_some_and(|ending| ending == "toml")) {
            all.push((path.display().to_string(), std::fs::read_to_string(&path).unwrap()));
        }
    }
    for (language, block) in blocks(COOKBOOK).into_iter().chain(blocks(include_str!("../docs/scene.md"))) {
        if language == "toml" && block.contains("[scheme]") | block.contains("scheme = {") {
            all.push((block.lines().next().unwrap().to_owned(), block.to_owned()));
        }
    }
    all
}

/// A scene as it is right, and what makes it wrong.
fn misspelt(good: &str) -> Vec<(String, String)> {
    let cases = [
        ("title =", "titel ="),
        ("gap = 2e-4", "gab = 2e-4"),
        ("gap = 2e-4", "gap = -1"),
        ("\"unilateral\"", "\"unilaterall\""),
        ("degree = 2", "degree = 7"),
        ("degree = 2", "degre = 2"),
        ("poisson = 0.3", "poisson = 0.5"),
        ("young = 2e11", "young = 0"),
        ("every = 2e-5", "evry = 2e-5"),
        ("scheme =", "schema ="),
        ("cells = [20, 2]", "cells = [20.5, 2]"),
        ("cells = [20, 2]", "cells = [20]"),
        ("name = \"wall\"\n", ""),
    ];
    let wrong = cases.map(|(right, wrong)| {
        let text = good.replacen(right, wrong, 1);
        assert_ne!(text, good, "{right}");
        (wrong.to_owned(), text)
    });
    wrong.to_vec()
}

/// By Python's `jsonschema`.
#[test]
fn the_schema_accepts_every_scene_of_the_repository_and_refuses_what_the_program_refuses() {
    let Some(python) = python::python() else { return };
    let folder = tempfile::tempdir().unwrap();
    let schema: Value = serde_json::from_str(&said(&["schema"], folder.path())).unwrap();
    let of = |text: &str| json(text.parse::<toml_edit::DocumentMut>().unwrap().as_item());
    let good = scenes();
    assert!(good.len() > 30, "{}", good.len());
    let gap = blocks(COOKBOOK).into_iter().find(|(_, block)| block.starts_with("# gap.toml")).unwrap().1;
    let bad = misspelt(gap);
    for (name, text) in &bad {
        assert!(dgmpm::Scene::parse(text, Path::new("a.toml"), &[]).is_err(), "{name}");
    }
    let list = |all: &[(String, String)]| {
        all.iter().map(|(name, text)| serde_json::json!([name, of(text)])).collect::<Vec<_>>()
    };
    let all = serde_json::json!({ "schema": schema, "good": list(&good), "bad": list(&bad) });
    let path = folder.path().join("cases.json");
    std::fs::write(&path, all.to_string()).unwrap();
    python::run(&python, "tests/python/schema.py", [path]);
}

#[test]
fn what_is_said_follows_quiet_json_and_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let scene = blocks(COOKBOOK).into_iter().find(|(_, block)| block.starts_with("# gap.toml")).unwrap().1;
    std::fs::write(folder.join("gap.toml"), scene).unwrap();
    let quiet = dgmpm(&["run", "gap.toml", "--quiet", "--set", "time.end=2e-6"], folder);
    assert!(quiet.status.success() && quiet.stdout.is_empty(), "{}", String::from_utf8_lossy(&quiet.stdout));
    // What is asked for is said.
    assert!(said(&["--quiet", "info", "gap.toml"], folder).contains("kind"));
    let wrong = dgmpm(&["--json", "run", "gap.toml", "--set", "scheme.degree=9"], folder);
    assert_eq!(wrong.status.code(), Some(2));
    let error: Value = serde_json::from_slice(&wrong.stdout).unwrap();
    assert_eq!([&error["event"], &error["exit_code"]], [&Value::from("error"), &Value::from(2)]);
    assert!(error["remedy"].as_str().is_some_and(|remedy| remedy.contains("whole number")) && wrong.stderr.is_empty());
    // Neither a pipe nor a file gets colours.
    let plain = dgmpm(&["run", "absent.toml"], folder);
    assert!(plain.stderr.starts_with(b"error: ") && !plain.stderr.contains(&0x1b));
    for shell in ["bash", "zsh", "fish"] {
        assert!(said(&["completions", shell], folder).contains("preprocess"), "{shell}");
    }
    said(&["man", "pages"], folder);
    let page = std::fs::read_to_string(folder.join("pages/dgmpm-plot.1")).unwrap();
    assert!(page.contains("Draw maps of fields") && folder.join("pages/dgmpm.1").exists());
}
