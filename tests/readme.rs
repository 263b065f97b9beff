//! README and docs say what is so: their commands run, their scenes are accepted, their links lead somewhere.

use dgmpm::parts::scene::Scene;
use std::path::{Path, PathBuf};
use std::process::Command;

const README: &str = include_str!("../README.md");
const RUN: &str = include_str!("../docs/run.md");
const SCENE: &str = include_str!("../docs/scene.md");

/// The fenced blocks of a language in a section of a document.
fn blocks<'a>(document: &'a str, section: &str, language: &str) -> Vec<&'a str> {
    let start = document.find(&format!("\n## {section}\n")).unwrap();
    let text = &document[start + 4..];
    let text = text.find("\n## ").map_or(text, |end| &text[..end]);
    let fence = format!("```{language}\n");
    text.split(&fence).skip(1).map(|block| block.split("```").next().unwrap()).collect()
}

/// The one block of a language in a section.
fn block<'a>(document: &'a str, section: &str, language: &str) -> &'a str {
    let [block] = blocks(document, section, language)[..] else { panic!("{section}: one block of {language}") };
    block
}

/// Runs a block of commands in a folder, the program on the path.
fn run(commands: &str, folder: &Path) {
    let program = Path::new(env!("CARGO_BIN_EXE_dgmpm")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let run = Command::new("sh").args(["-e", "-c", commands]).env("PATH", &path).current_dir(folder).output();
    let run = run.unwrap();
    assert!(run.status.success(), "{commands}\n{}", String::from_utf8_lossy(&run.stderr));
}

/// In a folder with a copy of `meshes/`; the runs are cut short.
#[test]
fn commands_of_the_pipeline_run() {
    let folder = tempfile::tempdir().unwrap();
    let meshes = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes");
    std::fs::create_dir(folder.path().join("meshes")).unwrap();
    for path in std::fs::read_dir(meshes).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_file()) {
        std::fs::copy(&path, folder.path().join("meshes").join(path.file_name().unwrap())).unwrap();
    }
    for scene in ["square_impact", "plate_hole"] {
        let path = folder.path().join(format!("meshes/{scene}.toml"));
        let text = std::fs::read_to_string(&path).unwrap();
        let short = text.replace("1.77e-3", "2e-5").replace("[3e-4, 6e-4, 2e-5]", "[2e-5]");
        std::fs::write(&path, short.replace("6e-4", "2e-5").replace("5e-5", "1e-5")).unwrap();
    }
    run(block(README, "The pipeline", "sh"), folder.path());
    run(block(RUN, "The stages", "sh"), folder.path());
    let files = ["scene.toml", "mesh.h5", "cloud.h5", "operators.h5", "snapshots", "ledger.csv", "summary.json"];
    let exported =
        ["grid.pvd", "points.pvd", "series.xdmf", "mesh.xdmf", "boundary.xdmf"].map(|f| format!("export/{f}"));
    for run in ["square_impact", "plate"] {
        for file in files.iter().copied().chain(exported.iter().map(String::as_str)) {
            let path = folder.path().join("runs").join(run).join(file);
            // Matrices that `--operators` gives are used where they are.
            assert!(path.exists() || (run == "plate" && file == "operators.h5"), "{}", path.display());
        }
    }
    assert!(folder.path().join("runs/square_impact/lines/bottom.csv").exists());
}

/// The scene of the README is complete: it runs without any other file.
#[test]
fn the_scene_of_the_readme_runs() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("impact.toml"), block(README, "A scene", "toml")).unwrap();
    run("dgmpm run impact.toml --set time.end=1e-5", folder.path());
}

#[test]
fn the_scene_with_all_keys_is_accepted() {
    Scene::parse(block(SCENE, "A scene, key by key", "toml"), Path::new("meshes/readme.toml"), &[]).unwrap();
}

/// The anchor that a heading gets: lower case, blanks as `-`, nothing else but letters, digits, `-` and `_`.
fn anchor(heading: &str) -> String {
    let kept = heading.chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c));
    kept.map(|c| if c == ' ' { '-' } else { c.to_ascii_lowercase() }).collect()
}

/// Every link to a file of the checkout, with its heading where it names one.
#[test]
fn links_lead_somewhere() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let docs = std::fs::read_dir(root.join("docs")).unwrap().map(|entry| entry.unwrap().path());
    let mut documents: Vec<PathBuf> = docs.filter(|path| path.extension().is_some_and(|e| e == "md")).collect();
    documents.push(root.join("README.md"));
    for document in documents {
        let text = std::fs::read_to_string(&document).unwrap();
        let links = text.split("](").skip(1).map(|rest| rest.split(')').next().unwrap());
        for link in links.filter(|link| !link.starts_with("http") && !link.contains(' ')) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { document.clone() } else { document.parent().unwrap().join(file) };
            assert!(target.exists(), "{}: {link}", document.display());
            if !heading.is_empty() {
                let there = std::fs::read_to_string(&target).unwrap();
                let headings = there.lines().filter(|line| line.starts_with('#'));
                let found =
                    headings.map(|line| anchor(line.trim_start_matches('#').trim())).any(|found| found == heading);
                assert!(found, "{}: {link}", document.display());
            }
        }
    }
}

/// `tools/program.sh` finds the program wherever cargo puts it, and every tool asks it.
#[cfg(unix)]
#[test]
fn tools_find_the_program() {
    use std::os::unix::fs::PermissionsExt;

    let tools = Path::new(env!("CARGO_MANIFEST_DIR")).join("tools");
    let place = tempfile::tempdir().unwrap();
    let place = place.path().canonicalize().unwrap();
    let ask = |variable: &str, value: &Path| {
        let mut command = Command::new(tools.join("program.sh"));
        for name in ["DGMPM", "CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
            command.env_remove(name);
        }
        let answer = command.env(variable, value).output().unwrap();
        answer.status.success().then(|| String::from_utf8(answer.stdout).unwrap().trim_end().to_owned())
    };
    assert_eq!(ask("CARGO_TARGET_DIR", &place), None, "no program there yet");

    let program = place.join("release/dgmpm");
    std::fs::create_dir(place.join("release")).unwrap();
    std::fs::write(&program, "").unwrap();
    std::fs::set_permissions(&program, std::fs::Permissions::from_mode(0o755)).unwrap();
    // The second is what `build.target-dir` in a configuration of cargo sets.
    for variable in ["CARGO_TARGET_DIR", "CARGO_BUILD_TARGET_DIR"] {
        assert_eq!(ask(variable, &place).as_deref(), program.to_str(), "{variable}");
    }
    assert_eq!(ask("DGMPM", Path::new("/any/dgmpm")).as_deref(), Some("/any/dgmpm"));

    for entry in std::fs::read_dir(&tools).unwrap() {
        let path = entry.unwrap().path();
        if path.extension().is_some_and(|e| e == "sh") {
            let text = std::fs::read_to_string(&path).unwrap();
            let asks = text.contains("dgmpm=$(tools/program.sh)");
            assert!(asks || !text.contains("\"$dgmpm\""), "{} does not ask for the program", path.display());
        }
    }
}
