//! Bad input of every kind: one message that names file and place and says what would be right, exit code 2, no panic, and no
//! more time and memory than the file deserves.
//!
//! Small texts are in `corpus/`; binary, large and special files are made here. The messages are in `messages.txt`;
//! `DGMPM_UPDATE=1 cargo test --release --test bad_inputs` writes them again, and the difference is to be read.

mod damage;
mod links;
mod made;
mod mutated;

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// Address space of the program, KiB: 100 MB, and what it maps to read a good mesh (measured: 60 to 90 MB).
const MEMORY: u64 = 190_000;
/// What a byte of a file deserves: the text, its words, and the numbers of a row.
const MEMORY_PER_BYTE: u64 = 16;
/// CPU seconds. A program that is not optimised is not measured.
const SECONDS: u32 = if cfg!(debug_assertions) { 20 } else { 1 };

/// A folder with the corpus and the files that are made.
struct Bench(tempfile::TempDir);

impl Bench {
    fn new() -> Self {
        let bench = Self(tempfile::tempdir().unwrap());
        for entry in std::fs::read_dir(corpus()).unwrap() {
            let path = entry.unwrap().path();
            std::fs::copy(&path, bench.path(path.file_name().unwrap().to_str().unwrap())).unwrap();
        }
        bench
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// The program under limits, in the folder.
    fn run(&self, arguments: &[&str]) -> Output {
        let length = |name: &&str| std::fs::metadata(self.path(name)).map_or(0, |about| about.len());
        let bytes: u64 = arguments.iter().map(|name| length(&name.rsplit('=').next().unwrap())).sum();
        let memory = MEMORY + MEMORY_PER_BYTE * bytes / 1024;
        let mut command = Command::new("sh");
        command.current_dir(self.0.path()).arg("-c");
        command.arg(format!("ulimit -t {SECONDS}; ulimit -v {memory}; exec \"$0\" \"$@\""));
        command.arg(env!("CARGO_BIN_EXE_dgmpm")).args(arguments);
        // An arena of each thread would map 64 MB that nobody uses.
        command.env("MALLOC_ARENA_MAX", "1").env("RAYON_NUM_THREADS", "1").env("HDF5_USE_FILE_LOCKING", "FALSE");
        command.output().unwrap()
    }

    /// The message of a run that must end with exit code 2.
    fn message(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(!said.contains("panicked"), "{arguments:?}\n{said}");
        assert_eq!(output.status.code(), Some(2), "{arguments:?}: {}\n{said}", output.status);
        let at = said.rfind("error: ").unwrap_or_else(|| panic!("{arguments:?}: no message\n{said}"));
        steady(&said[at..])
    }

    /// Runs it, which must succeed.
    fn good(&self, arguments: &[&str]) -> String {
        let output = self.run(arguments);
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(output.status.success(), "{arguments:?}: {}\n{said}", output.status);
        String::from_utf8_lossy(&output.stdout).into_owned()
    }
}

fn corpus() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_inputs/corpus")
}

/// A message without what differs from machine to machine: free memory.
fn steady(message: &str) -> String {
    let mut words: Vec<&str> = message.trim_end().split(' ').collect();
    for k in 1..words.len() {
        if words[k].starts_with("GiB") && words.get(k + 1) == Some(&"are") {
            words[k - 1] = "N";
        }
    }
    words.join(" ")
}

/// What is done with a file, by its ending.
fn arguments(file: &str) -> Vec<String> {
    let all = match file.rsplit_once('.').map(|(_, ending)| ending) {
        Some("toml") => vec!["run", file, "--out", "out", "--force"],
        // A VTU file may be points, too: those with the word are meshes.
        Some("vtu") if file.contains("mesh") => vec!["mesh", file, "--out", "out.h5", "--force"],
        Some("msh" | "h5" | "xdmf" | "vtk") => vec!["mesh", file, "--out", "out.h5", "--force"],
        _ => {
            let cloud = format!("cloud.path={file}");
            let all = ["seed", "good.toml", "--set", &cloud, "--out", "out.h5", "--force"];
            return all.map(str::to_owned).to_vec();
        }
    };
    all.into_iter().map(str::to_owned).collect()
}

/// Files of the corpus that are good, or parts of others.
const GOOD: [&str; 5] = ["good.toml", "good.vtu", "good_mesh.vtu", "good_mesh.xdmf", "two_bodies_mesh.msh"];

/// Files that name the file at fault.
const OTHERS: [(&str, &str); 5] = [
    ("device_for_a_mesh.toml", "error: /dev/zero: "),
    ("folder_for_a_mesh.toml", "error: .: "),
    ("numbers_missing.xdmf", "error: nowhere.h5: "),
    ("numbers_in_text.xdmf", "error: good.toml: "),
    ("numbers_of_others.xdmf", "error: others.h5: "),
];

#[test]
fn each_bad_file_has_its_message() {
    let bench = Bench::new();
    let mut cases: Vec<(String, Vec<String>)> = std::fs::read_dir(corpus())
        .unwrap()
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| !GOOD.contains(&name.as_str()))
        .map(|name| (name.clone(), arguments(&name)))
        .collect();
    cases.extend(made::cases(&bench));
    cases.sort();
    let mut text = String::new();
    for (name, arguments) in &cases {
        let message = bench.message(&arguments.iter().map(String::as_str).collect::<Vec<_>>());
        let (what, remedy) = message.split_once('\n').unwrap_or((&message, ""));
        let named = OTHERS.iter().find(|(scene, _)| scene == name).map_or(name.as_str(), |(_, file)| file);
        assert!(what.contains(named), "{name}: the message does not name it\n{message}");
        assert!(remedy.trim().len() > 10, "{name}: the message does not say what would be right\n{message}");
        text += &format!("{name}\n  {}\n\n", message.replace('\n', "\n  "));
    }
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/bad_inputs/messages.txt");
    if std::env::var_os("DGMPM_UPDATE").is_some() {
        std::fs::write(&file, &text).unwrap();
    }
    let known = std::fs::read_to_string(&file).unwrap_or_default();
    for (now, before) in text.split("\n\n").zip(known.split("\n\n")) {
        assert_eq!(now, before, "DGMPM_UPDATE=1 writes messages.txt again");
    }
    assert_eq!(text.len(), known.len());
}

#[test]
fn files_that_only_look_odd_are_read() {
    let bench = Bench::new();
    let scene = std::fs::read_to_string(bench.path("good.toml")).unwrap();
    let energy = |name: &str| {
        bench.good(&["run", name, "--out", "out", "--force"]);
        let text = std::fs::read_to_string(bench.path("out/summary.json")).unwrap();
        let summary: serde_json::Value = serde_json::from_str(&text).unwrap();
        summary["steps"].as_u64().unwrap()
    };
    let steps = energy("good.toml");
    assert!(steps > 5, "{steps}");
    std::fs::write(bench.path("crlf.toml"), scene.replace('\n', "\r\n")).unwrap();
    std::fs::write(bench.path("mark.toml"), format!("\u{feff}{scene}")).unwrap();
    assert_eq!([energy("crlf.toml"), energy("mark.toml")], [steps, steps]);
    // Cells without points carry virtual ones, and the program says so.
    let said = bench.good(&["run", "good.toml", "--set", "cloud.path=good.vtu", "--out", "out", "--force"]);
    assert!(said.contains("8 of 8 cells cannot carry degree 1"), "{said}");
    // A mesh with Windows' ends of lines.
    let mesh = std::fs::read_to_string(bench.path("two_bodies_mesh.msh")).unwrap();
    std::fs::write(bench.path("crlf.msh"), mesh.replace('\n', "\r\n")).unwrap();
    bench.good(&["mesh", "crlf.msh", "--out", "a.h5"]);
    bench.good(&["mesh", "two_bodies_mesh.msh", "--out", "b.h5"]);
    let [a, b] = ["a.h5", "b.h5"].map(|name| std::fs::read(bench.path(name)).unwrap());
    assert_eq!(a, b);
}

#[test]
fn a_file_name_never_reaches_a_shell() {
    let bench = Bench::new();
    let name = "a\"; touch pwned; $(touch pwned) `touch pwned` .msh";
    std::fs::copy(bench.path("two_bodies_mesh.msh"), bench.path(name)).unwrap();
    bench.good(&["mesh", name, "--out", "out.h5"]);
    // Where Gmsh is missing, the file is not looked at at all.
    let geometry = "b\" $(touch pwned).geo";
    std::fs::write(bench.path(geometry), "SystemCall \"true\";\n").unwrap();
    let rule = format!("[{{ at = [5e-5], geo = '{geometry}' }}]");
    bench.message(&["run", "good.toml", "--set", &format!("regrid={rule}"), "--out", "out"]);
    assert!(!bench.path("pwned").exists());
}

#[test]
fn a_mesh_for_gmsh_replaces_another_only_as_a_whole() {
    let bench = Bench::new();
    bench.good(&["mesh", "two_bodies_mesh.msh", "--out", "new.msh"]);
    // A link of that name is replaced; what it leads to stays.
    let (target, link) = (bench.path("target.msh"), bench.path("link.msh"));
    std::fs::write(&target, "mine").unwrap();
    std::os::unix::fs::symlink(&target, &link).unwrap();
    bench.good(&["mesh", "two_bodies_mesh.msh", "--out", "link.msh", "--force"]);
    assert_eq!(std::fs::read_to_string(&target).unwrap(), "mine");
    let [new, link] = ["new.msh", "link.msh"].map(|name| std::fs::read(bench.path(name)).unwrap());
    assert_eq!(new, link);
}
