//! Where the keys of a scene stand: line and column in its file, or the `--set` that gave them.

use std::ops::Range;
use std::path::{Path, PathBuf};

use toml_edit::{Document, Item};

use crate::error::{Error, Place};

/// The text that a scene was read from, kept for the places of later messages.
#[derive(Debug, Clone, Default)]
pub(super) struct Origin {
    /// The scene file.
    pub(super) path: PathBuf,
    /// Its text on disk.
    pub(super) text: String,
    /// The text after overrides.
    pub(super) run: String,
    /// The overrides: key path and the argument of `--set`.
    pub(super) sets: Vec<(Vec<String>, String)>,
    /// Keys of the file that gave way to an override, each in words.
    pub(super) replaced: Vec<String>,
}

/// The keys of a scene after overrides.
pub(super) struct Given<'a>(Option<Document<&'a str>>);

impl Given<'_> {
    /// Whether the scene has a key such as `boundary.0.kind`.
    pub(super) fn has(&self, key: &str) -> bool {
        let root = self.0.as_ref().map(|document| document.as_item());
        key.split('.').try_fold(root, |item, key| Some(Some(child(item?, key)?.1))).is_some_and(|item| item.is_some())
    }
}

/// What of a key a message is about.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Part {
    /// Its name.
    Key,
    /// Its value.
    Value,
    /// Its value, a text, at this byte from 0.
    Inside(usize),
}

impl Origin {
    /// The keys of the scene.
    pub(super) fn given(&self) -> Given<'_> {
        Given(Document::parse(&self.run[..]).ok())
    }

    /// Bad input at a key.
    pub(super) fn error(
        &self,
        path: &[String],
        part: Part,
        what: impl Into<String>,
        remedy: impl Into<String>,
    ) -> Error {
        Error::at(self.place(path, part), what, remedy)
    }

    /// Bad input at a byte of the file.
    pub(super) fn error_at_byte(path: &Path, text: &str, byte: usize, what: String, remedy: &str) -> Error {
        Error::at(place_of_byte(path, text, byte), what, remedy)
    }

    /// The place of a key, or of the nearest table around it that exists.
    pub(super) fn place(&self, path: &[String], part: Part) -> Place {
        let (depth, byte) = locate(&self.text, path, part);
        let common = |set: &[String]| set.iter().zip(path).take_while(|(a, b)| a == b).count();
        let blamed = self.sets.iter().rev().find(|(set, _)| common(set) == set.len() || common(set) > depth);
        match blamed {
            Some((_, argument)) => Place::file(Path::new(&format!("--set {argument}"))),
            None => place_of_byte(&self.path, &self.text, byte),
        }
    }
}

fn place_of_byte(path: &Path, text: &str, byte: usize) -> Place {
    let mut end = byte.min(text.len());
    while !text.is_char_boundary(end) {
        end -= 1;
    }
    let before = &text[..end];
    let start = before.rfind('\n').map_or(0, |i| i + 1);
    let line = before.matches('\n').count() + 1;
    Place::line(path, line, before[start..].chars().count() + 1)
}

/// How many keys of the path exist, and the first byte of the last of them.
fn locate(text: &str, path: &[String], part: Part) -> (usize, usize) {
    let Ok(document) = Document::parse(text) else { return (0, 0) };
    let mut item = document.as_item();
    let mut byte = 0;
    for (depth, key) in path.iter().enumerate() {
        let Some((key_span, next)) = child(item, key) else { return (depth, byte) };
        let value = next.span().filter(|span| !span.is_empty() || !next.is_table_like());
        let name = key_span.or(value.clone());
        let last = depth + 1 == path.len();
        let span = if last && part == Part::Key { name } else { value.or(name) };
        byte = span.map_or(byte, |span| span.start);
        if let (true, Part::Inside(offset)) = (last, part) {
            byte += inside(text, byte, offset);
        }
        item = next;
    }
    (path.len(), byte)
}

/// The entry of a table or list, with the span of its key.
pub(super) fn child<'a>(item: &'a Item, key: &str) -> Option<(Option<Range<usize>>, &'a Item)> {
    if let Some(table) = item.as_table_like() {
        let (key, value) = table.get_key_value(key)?;
        return Some((key.span(), value));
    }
    item.get(key.parse::<usize>().ok()?).map(|entry| (None, entry))
}

/// How far the byte `offset` of a quoted text lies behind its quote: 0 where escapes make that unsure.
fn inside(text: &str, start: usize, offset: usize) -> usize {
    let value = &text[start..];
    let quote = value.chars().next().filter(|c| matches!(c, '"' | '\''));
    let Some(quote) = quote else { return 0 };
    let body = &value[1..];
    let length = body.find(quote).unwrap_or(0);
    let plain = length > 0 && !body[..length].contains('\\');
    if plain && offset <= length { 1 + offset } else { 0 }
}
