//! The text of a first scene, `dgmpm new`: what a mesh says of a body becomes a scene with comments. All that a comment says of a key
//! comes from the tables and the registry.

use super::tables;
use crate::registry::{CONDITIONS, Entry, LAWS, METHODS, OUTPUTS, Parameter, Preset, Table};

/// Columns of the text that stand before a comment.
const COLUMN: usize = 40;
/// Columns of a line of comment.
const WIDTH: usize = 118;
/// The law of the example.
pub const LAW: &str = "neo-hookean";
/// Steel: the values of the parameters of [`LAW`].
pub const STEEL: [(&str, f64); 3] = [("young", 2e11), ("poisson", 0.3), ("density", 7800.0)];

/// What a first scene says. Names are as in scenes, lengths in m, times in s.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Draft {
    /// What moves where, in one sentence without its full stop.
    pub title: String,
    /// The file of the mesh, relative to the scene.
    pub mesh: String,
    /// The groups of cells.
    pub groups: Vec<String>,
    /// The conditions.
    pub boundaries: Vec<Condition>,
    /// The groups of edges inside of the body.
    pub inside: Vec<String>,
    /// The initial velocity, m/s: two expressions, and what it is.
    pub velocity: ([String; 2], String),
    /// The end of the run, and why.
    pub end: (f64, String),
    /// Time between two snapshots.
    pub every: f64,
    /// The group whose force is recorded.
    pub force: String,
    /// The point that is followed, and where it is.
    pub probe: ([f64; 2], String),
}

/// A condition of a [`Draft`].
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Condition {
    /// The group.
    pub group: String,
    /// The name of the condition.
    pub kind: &'static str,
    /// Its keys with their values as in scenes.
    pub keys: Vec<(&'static str, String)>,
    /// Why, in words; empty: what the registry says of the condition.
    pub why: String,
}

impl Draft {
    /// The text of the scene.
    pub fn text(&self) -> String {
        let mut page = Page(String::new());
        page.title(self);
        page.mesh(self);
        page.materials(self);
        page.boundaries(self);
        page.start(self);
        page.scheme();
        page.time(self);
        page.outputs(self);
        page.0
    }
}

/// A text in quotes, as TOML has it.
pub fn quoted(text: &str) -> String {
    toml_edit::Value::from(text).to_string()
}

/// A text that grows line by line.
struct Page(String);

impl Page {
    fn title(&mut self, draft: &Draft) {
        let Draft { title, mesh, .. } = draft;
        self.comment(&format!("{title}. Made by `dgmpm new` from {mesh}."), "");
        self.comment(
            "It runs as it is. What follows is an example: change what is different in your case. All units are SI (m, s, kg, Pa). \
             `dgmpm check` looks at a scene without a run, `dgmpm effects` lists all that a scene can ask for, and docs/scene.md has all keys.",
            "",
        );
        self.key("title", quoted(title), tables::TOP);
    }

    fn mesh(&mut self, draft: &Draft) {
        self.table("[mesh]");
        self.key("file", quoted(&draft.mesh), tables::MESH);
    }

    fn materials(&mut self, draft: &Draft) {
        self.blank();
        self.comment("One [[material]] for each group of cells. Here all are steel. The laws are:", "");
        self.choices(&LAWS);
        let law: &[Parameter] = LAWS.find(LAW).map_or(&[], |law| law.parameters);
        for group in &draft.groups {
            self.table("[[material]]");
            self.key("group", quoted(group), tables::MATERIAL);
            self.key("law", quoted(LAW), tables::MATERIAL);
            STEEL.iter().for_each(|(name, value)| self.key(name, number(*value), law));
        }
    }

    fn boundaries(&mut self, draft: &Draft) {
        self.blank();
        self.comment("One [[boundary]] for each group of edges. The conditions are:", "");
        self.choices(&CONDITIONS);
        for Condition { group, kind, keys, why } in &draft.boundaries {
            let entry = CONDITIONS.find(kind);
            let why = if why.is_empty() { entry.map_or("", |entry| entry.about) } else { why };
            self.table("[[boundary]]");
            self.line(&format!("group = {}", quoted(group)), "");
            self.line(&format!("kind = {}", quoted(kind)), why);
            let parameters = entry.map_or(&[][..], |entry| entry.parameters);
            keys.iter().for_each(|(name, value)| self.key(name, value.clone(), parameters));
        }
        if !draft.inside.is_empty() {
            self.blank();
            let groups: Vec<String> = draft.inside.iter().map(|group| quoted(group)).collect();
            let about = "these groups have edges inside of the body, and need no condition. One cuts the body there: a crack (free, contact), or a \
                         joint that breaks (cohesive).";
            self.comment(&format!("{}: {about}", groups.join(", ")), "");
        }
    }

    fn start(&mut self, draft: &Draft) {
        let ([v1, v2], what) = &draft.velocity;
        self.table("[initial]");
        self.comment(what, "");
        self.key("velocity", format!("[{}, {}]", quoted(v1), quoted(v2)), tables::INITIAL);
    }

    fn scheme(&mut self) {
        self.blank();
        self.comment("The methods are:", "");
        self.choices(&METHODS);
        self.table("[scheme]");
        self.key("method", quoted(METHODS.first().name), tables::SCHEME);
        self.key("degree", "2".to_owned(), tables::SCHEME);
    }

    fn time(&mut self, draft: &Draft) {
        self.table("[time]");
        self.comment(&draft.end.1, "");
        self.key("end", number(draft.end.0), tables::TIME);
        self.table("[checkpoint]");
        self.comment("A run that was stopped goes on by `dgmpm resume`.", "");
        self.key("every_minutes", "10.0".to_owned(), tables::CHECKPOINT);
    }

    fn outputs(&mut self, draft: &Draft) {
        self.blank();
        self.comment("What is recorded. The kinds are:", "");
        self.choices(&OUTPUTS);
        self.output("fields");
        self.key("every", number(draft.every), tables::WHEN);
        self.output("ledger");
        self.key("every_steps", "10".to_owned(), tables::WHEN);
        if let Some(force) = OUTPUTS.find("force") {
            self.output(force.name);
            self.key("name", quoted("force"), force.parameters);
            self.key("groups", format!("[{}]", quoted(&draft.force)), force.parameters);
        }
        if let Some(probe) = OUTPUTS.find("probe") {
            let ([x, y], place) = &draft.probe;
            self.output(probe.name);
            self.comment(place, "");
            self.key("name", quoted("probe"), probe.parameters);
            self.key("point", format!("[{}, {}]", number(*x), number(*y)), probe.parameters);
        }
    }

    /// The head of an output of a kind.
    fn output(&mut self, kind: &str) {
        self.table("[[output]]");
        self.line(&format!("kind = {}", quoted(kind)), OUTPUTS.find(kind).map_or("", |entry| entry.about));
    }

    fn blank(&mut self) {
        self.0.push('\n');
    }

    fn table(&mut self, head: &str) {
        if !self.0.ends_with("\n\n") {
            self.blank();
        }
        self.0 += head;
        self.blank();
    }

    /// A key, with what its table says of it.
    fn key(&mut self, name: &str, value: String, of: &[Parameter]) {
        let about = of.iter().find(|parameter| parameter.name == name).map_or(String::new(), about);
        self.line(&format!("{name} = {value}"), &about);
    }

    /// A line with a comment behind it, or above it where it is too long for that.
    fn line(&mut self, text: &str, comment: &str) {
        let width = text.chars().count();
        if comment.is_empty() {
            self.0 += text;
        } else if width < COLUMN && COLUMN + 2 + comment.chars().count() <= WIDTH {
            self.0 += &format!("{text:COLUMN$}# {comment}");
        } else {
            self.comment(comment, "");
            self.0 += text;
        }
        self.blank();
    }

    /// The entries of a table of the registry, each with its keys.
    fn choices<B>(&mut self, table: &'static Table<B>) {
        let width = table.iter().map(|entry| entry.name.len()).max().unwrap_or(0);
        for Entry { name, about, parameters, .. } in table {
            let keys: Vec<&str> = parameters.iter().map(|parameter| parameter.name).collect();
            let keys = if keys.is_empty() { String::new() } else { format!(" [{}]", keys.join(", ")) };
            self.comment(&format!("  {name:width$}  {about}{keys}"), &" ".repeat(width + 4));
        }
    }

    /// Lines of comment; all but the first begin with `indent`.
    fn comment(&mut self, text: &str, indent: &str) {
        let start = text.len() - text.trim_start().len();
        let mut line = format!("# {}", &text[..start]);
        let mut is_empty = true;
        // Blanks inside of a line are kept: they align columns.
        for word in text[start..].split_inclusive(' ') {
            if !is_empty && line.chars().count() + word.trim_end().chars().count() > WIDTH {
                self.0 += line.trim_end();
                self.blank();
                line = format!("# {indent}");
            }
            line += word;
            is_empty = false;
        }
        self.0 += line.trim_end();
        self.blank();
    }
}

/// What a key is, its unit, and what holds without it.
fn about(Parameter { about, unit, default, .. }: &Parameter) -> String {
    let unit = if unit.is_empty() { String::new() } else { format!(", {unit}") };
    let default = match default {
        Preset::Number(value) => format!("; default {value}"),
        Preset::Boolean(value) => format!("; default {value}"),
        _ => String::new(),
    };
    format!("{about}{unit}{default}")
}

/// A number as a person writes it.
pub fn number(value: f64) -> String {
    match value.abs() {
        size if size == 0.0 || (1e-3..1e5).contains(&size) => format!("{value:?}"),
        _ => format!("{value:e}"),
    }
}
