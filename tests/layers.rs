//! The order of the modules in `core/src/lib.rs` and, after these, in `src/lib.rs` is the order of dependency: a module uses only those above it.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// The sources of the discretisation and of what stands on it, each a crate.
fn sources() -> [PathBuf; 2] {
    ["core/src", "src"].map(|folder| Path::new(env!("CARGO_MANIFEST_DIR")).join(folder))
}

/// All modules, in their order.
fn order() -> Vec<String> {
    let texts = sources().map(|source| std::fs::read_to_string(source.join("lib.rs")).unwrap());
    texts.iter().flat_map(|text| text.lines().filter_map(declared)).map(str::to_owned).collect()
}

/// What stands in the folders of the sources.
fn entries() -> impl Iterator<Item = PathBuf> {
    sources().into_iter().flat_map(|source| std::fs::read_dir(source).unwrap()).map(|entry| entry.unwrap().path())
}

/// The module that a line `pub mod name;` or `mod name;` declares.
fn declared(line: &str) -> Option<&str> {
    let line = line.strip_prefix("pub ").unwrap_or(line);
    line.strip_prefix("mod ")?.strip_suffix(';')
}

/// Text without comments and without items under `#[cfg(test)]`, whose ends rustfmt makes easy to find: a `;` on the
/// same line, or a brace in the column where the item begins. Also the files that are modules under `#[cfg(test)]`.
fn without_tests(text: &str) -> (String, BTreeSet<String>) {
    let (mut kept, mut test_files) = (String::new(), BTreeSet::new());
    let mut lines = text.lines();
    while let Some(line) = lines.next() {
        if line.trim() != "#[cfg(test)]" {
            kept.push_str(line.split("//").next().unwrap_or_default());
            kept.push('\n');
            continue;
        }
        let end = format!("{}}}", &line[..line.len() - line.trim_start().len()]);
        let item = lines.by_ref().find(|line| !line.trim_start().starts_with("#[")).unwrap_or_default();
        match declared(item.trim().trim_start_matches("pub(crate) ")) {
            Some(name) => drop(test_files.insert(name.to_owned())),
            None if item.trim_end().ends_with([';', '}']) => {}
            None => drop(lines.by_ref().find(|line| *line == end)),
        }
    }
    (kept, test_files)
}

/// Modules of the crate that a text names: `crate::name`, and the names of `crate::{..}`.
fn used(text: &str) -> BTreeSet<String> {
    let word = |text: &str| text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect::<String>();
    let mut names = BTreeSet::new();
    for rest in text.split("crate::").skip(1) {
        let Some(group) = rest.strip_prefix('{') else {
            names.insert(word(rest));
            continue;
        };
        let mut depth = 0;
        let mut start = true;
        for (at, c) in group.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth == 0 => break,
                '}' => depth -= 1,
                ',' if depth == 0 => start = true,
                c if start && c.is_alphabetic() => {
                    names.insert(word(&group[at..]));
                    start = false;
                }
                _ => {}
            }
        }
    }
    names
}

/// The files of a module and of its folder, without tests and comments.
fn files_of_module(name: &str) -> Vec<(PathBuf, String)> {
    let both = sources();
    let mut files: Vec<_> =
        both.iter().flat_map(|root| [root.join(format!("{name}.rs")), root.join(name).join("mod.rs")]).collect();
    let mut found = Vec::new();
    while let Some(file) = files.pop() {
        let Ok(text) = std::fs::read_to_string(&file) else { continue };
        let (text, tests) = without_tests(&text);
        let stem = file.file_stem().unwrap_or_default();
        let folder = if stem == "mod" { file.parent().unwrap().to_owned() } else { file.with_extension("") };
        let children = text.lines().filter_map(|line| declared(line.trim().trim_start_matches("pub(crate) ")));
        for child in children.filter(|child| !tests.contains(*child)) {
            files.extend([folder.join(format!("{child}.rs")), folder.join(child).join("mod.rs")]);
        }
        found.push((file, text));
    }
    found
}

/// All that a module uses, over the files of its folder.
fn uses_of_module(name: &str) -> BTreeSet<String> {
    files_of_module(name).iter().flat_map(|(_, text)| used(text)).collect()
}

/// What writes to standard output or standard error; `println!` is in `eprintln!`, and so on.
const PRINTS: [&str; 5] = ["print!(", "println!(", "dbg!(", "stdout()", "stderr()"];

#[test]
fn only_the_command_line_writes_to_the_terminal() {
    let prints = |text: &str| PRINTS.into_iter().find(|word| text.contains(word));
    for module in order().iter().filter(|module| *module != "cli") {
        for (file, text) in files_of_module(module) {
            assert_eq!(prints(&text), None, "{}: give the words to an observer or return them", file.display());
        }
    }
    // The search works: the program does print.
    assert!(files_of_module("cli").iter().any(|(_, text)| prints(text).is_some()));
}

#[test]
fn a_file_of_the_command_line_has_arguments_one_call_and_words() {
    let files = files_of_module("cli");
    assert!(files.len() > 20, "{}", files.len());
    for (file, _) in files {
        // The design's figure: what is longer holds method, a plan or a table, which users of the library look for.
        let lines = std::fs::read_to_string(&file).unwrap().lines().count();
        assert!(lines <= 60, "{}: {lines} lines", file.display());
    }
}

#[test]
fn a_module_uses_only_those_above_it() {
    let order = order();
    // The list of the design has more than a dozen; an empty one would hold anything.
    assert!(["step", "problem"].iter().all(|name| order.iter().any(|module| module == name)), "{order:?}");
    let mut wrong = Vec::new();
    let mut found = 0;
    for (at, module) in order.iter().enumerate() {
        for name in uses_of_module(module) {
            found += 1;
            if order.iter().position(|other| *other == name).is_some_and(|below| below > at) {
                wrong.push(format!("{module} uses {name}, which stands below it"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    // Each module but the first few uses some other: the search works.
    assert!(found > 2 * order.len(), "only {found} uses found");
}

/// Files of a folder that a file of it names: `super::name` and the names of `super::{..}`. What the folder's `mod.rs` holds or
/// hands on belongs to no other file.
fn neighbours_used(text: &str, files: &BTreeSet<String>) -> BTreeSet<String> {
    used(&text.replace("super::super::", "super::").replace("crate::", "").replace("super::", "crate::"))
        .into_iter()
        .filter(|name| files.contains(name))
        .collect()
}

/// Files of a folder of the source, each with its neighbours that it uses; without tests.
fn neighbours(folder: &Path) -> Vec<(String, BTreeSet<String>)> {
    let own = [folder.join("mod.rs"), folder.with_extension("rs")];
    let text = own.iter().find_map(|path| std::fs::read_to_string(path).ok()).unwrap();
    let (text, tests) = without_tests(&text);
    let names = text.lines().filter_map(|line| declared(line.trim()));
    let files: BTreeSet<String> = names.filter(|name| !tests.contains(*name)).map(str::to_owned).collect();
    let uses = |file: &String| {
        let paths = [folder.join(format!("{file}.rs")), folder.join(file).join("mod.rs")];
        let texts = paths.iter().filter_map(|path| std::fs::read_to_string(path).ok());
        texts.flat_map(|text| neighbours_used(&without_tests(&text).0, &files)).collect()
    };
    files.iter().map(|file| (file.clone(), uses(file))).collect()
}

/// What is in a circle or uses one: what uses nothing that is left goes, until nothing goes any more.
fn in_circles(mut uses: Vec<(String, BTreeSet<String>)>) -> Vec<(String, BTreeSet<String>)> {
    let mut left = uses.len() + 1;
    while uses.len() < left {
        left = uses.len();
        let names: BTreeSet<String> = uses.iter().map(|(file, _)| file.clone()).collect();
        uses.retain(|(_, all)| all.intersection(&names).next().is_some());
    }
    uses
}

#[test]
fn no_files_of_a_folder_are_in_a_circle() {
    let mut found = 0;
    for folder in entries() {
        // The tables [[output]] and [[regrid]] have keys in common, which each reads from the other.
        if !folder.is_dir() || folder.ends_with("scene") {
            continue;
        }
        let uses = neighbours(&folder);
        found += uses.iter().map(|(_, all)| all.len()).sum::<usize>();
        let circles = in_circles(uses);
        assert!(circles.is_empty(), "{}: in a circle, or using one: {circles:#?}", folder.display());
    }
    assert!(found > 100, "the search finds uses: {found}");
    let pair = |name: &str, used: &str| (name.to_owned(), BTreeSet::from([used.to_owned()]));
    assert_eq!(in_circles(vec![pair("a", "b"), pair("b", "c"), pair("c", "b"), pair("d", "e")]).len(), 3);
}

/// A scene is data: text that is checked against the tables of the registry.
#[test]
fn a_scene_uses_names_expressions_and_the_registry_only() {
    let used = uses_of_module("scene");
    // `file`: its bytes, and whether they are whole.
    let allowed = ["error", "file", "names", "expression", "registry", "scene"];
    let wrong: Vec<&String> = used.iter().filter(|name| !allowed.contains(&&name[..])).collect();
    assert!(wrong.is_empty() && used.contains("registry"), "scene uses {wrong:?}");
    assert!(uses_of_module("expression").is_subset(&["error", "names"].map(str::to_owned).into()));
}

#[test]
fn every_folder_and_file_of_the_source_is_reached() {
    let order = order();
    for path in entries() {
        let name = path.file_stem().unwrap().to_string_lossy().into_owned();
        assert!(order.contains(&name) || name == "lib" || name == "main", "{name} is no module of lib.rs");
    }
}

#[test]
fn only_main_sees_the_command_line() {
    assert_eq!(order().last().map(|module| &module[..]), Some("cli"));
}

/// All files of the source with their texts.
fn all_files(folder: &Path) -> Vec<(PathBuf, String)> {
    let mut files = Vec::new();
    for path in std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        match path.is_dir() {
            true => files.extend(all_files(&path)),
            false => files.push((path.clone(), std::fs::read_to_string(&path).unwrap())),
        }
    }
    files
}

#[test]
fn unsafe_code_is_in_lane_alone() {
    let lib = std::fs::read_to_string(sources()[0].join("lib.rs")).unwrap();
    assert!(lib.contains("\n#![deny(unsafe_code)]\n") && lib.contains("\n#[allow(unsafe_code)]\npub mod lane;\n"));
    let (mut exceptions, mut found) = (Vec::new(), 0);
    for (file, text) in sources().iter().flat_map(|source| all_files(source)) {
        let lines = text.lines().filter(|line| line.contains("(unsafe_code)") && !line.trim_start().starts_with("//"));
        exceptions.extend(lines.map(|line| (file.file_name().unwrap().to_owned(), line.trim().to_owned())));
        found += usize::from(text.contains("unsafe {"));
    }
    exceptions.sort();
    let lines: Vec<(&str, &str)> =
        exceptions.iter().map(|(file, line)| (file.to_str().unwrap(), line.as_str())).collect();
    let [only, denied, main] = ["#[allow(unsafe_code)]", "#![deny(unsafe_code)]", "#![forbid(unsafe_code)]"];
    assert_eq!(lines, [("lib.rs", denied), ("lib.rs", main), ("lib.rs", only), ("main.rs", main)]);
    // The search works: `lane` has such code.
    assert!(found > 0);
}

#[test]
fn every_crate_has_a_licence_and_a_source_that_deny_toml_allows() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let rules: toml_edit::DocumentMut = std::fs::read_to_string(root.join("deny.toml")).unwrap().parse().unwrap();
    let list = |value: &toml_edit::Item| -> Vec<String> {
        value.as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned()).collect()
    };
    let allowed = list(&rules["licenses"]["allow"]);
    let (mut more, mut refused) = (Vec::new(), Vec::new());
    for entry in rules["licenses"]["exceptions"].as_array().unwrap() {
        let entry = entry.as_inline_table().unwrap();
        let names = entry["allow"].as_array().unwrap().iter().map(|text| text.as_str().unwrap().to_owned());
        more.push((entry["crate"].as_str().unwrap().to_owned(), names.collect::<Vec<_>>()));
    }
    let told = metadata(root);
    let packages = told["packages"].as_array().unwrap();
    for package in packages {
        let name = package["name"].as_str().unwrap();
        let own = more.iter().find(|(known, _)| known == name).map_or(&[][..], |(_, names)| names);
        let licence = package["license"].as_str().unwrap_or("none");
        if !is_allowed(licence, &|one| allowed.iter().chain(own).any(|known| known == one)) {
            refused.push(format!("{name}: licence {licence}"));
        }
        // None: the package itself.
        if let Some(from) = package["source"].as_str()
            && from != "registry+https://github.com/rust-lang/crates.io-index"
        {
            refused.push(format!("{name}: from {from}"));
        }
    }
    assert!(refused.is_empty(), "{refused:#?}");
    assert!(packages.len() > 100, "{}", packages.len());
}

/// All crates that a build on this kind of machine has, as cargo tells them.
fn metadata(root: &Path) -> serde_json::Value {
    let platform = format!("{}-unknown-linux-gnu", std::env::consts::ARCH);
    let ask = |network: &[&str]| {
        let all = ["metadata", "--format-version", "1", "--locked", "--filter-platform", &platform];
        std::process::Command::new(env!("CARGO")).args(all).args(network).current_dir(root).output().unwrap()
    };
    // The build has fetched what is needed; a first look at other crates may need the network.
    let offline = ask(&["--offline"]);
    let output = if offline.status.success() { offline } else { ask(&[]) };
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|why| panic!("cargo metadata: {why}\n{said}"))
}

/// Whether an expression of licences holds: one of each `OR` (`/`), all of each `AND`.
fn is_allowed(licence: &str, known: &dyn Fn(&str) -> bool) -> bool {
    let licence = licence.replace('/', " OR ");
    licence.split(" AND ").all(|part| {
        let part = part.trim().trim_start_matches('(').trim_end_matches(')');
        part.split(" OR ").any(|one| known(one.trim()))
    })
}

#[test]
fn a_licence_is_allowed_by_one_of_each_choice() {
    let known = |one: &str| ["MIT", "Zlib"].contains(&one);
    for (licence, holds) in [
        ("MIT", true),
        ("GPL-3.0", false),
        ("MIT/GPL-3.0", true),
        ("(MIT OR X) AND Y", false),
        ("(X OR MIT) AND Zlib", true),
    ] {
        assert_eq!(is_allowed(licence, &known), holds, "{licence}");
    }
}

#[test]
fn the_search_sees_groups_and_paths_and_not_tests_or_comments() {
    let text = "use crate::{a::B, c::{D, e}, f};\nfn g() { crate::h::i() } // crate::j\n#[cfg(test)]\nuse crate::k;\n\
        #[cfg(test)]\nmod tests {\n    use crate::l;\n}\nuse crate::m;\n";
    let (kept, files) = without_tests(&format!("{text}#[cfg(test)]\nmod suite;\n"));
    let names: Vec<String> = used(&kept).into_iter().collect();
    assert_eq!(names, ["a", "c", "f", "h", "m"]);
    assert_eq!(files.into_iter().collect::<Vec<_>>(), ["suite"]);
}
