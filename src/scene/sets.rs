//! Overrides of the command line, `--set key.path=value`, on the text of a scene.

use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, Key, Table, Value};

use super::tables::WHEN;
use crate::error::{Error, Place, Result};
use crate::registry::GRIDS;

/// An override that was applied: its key path, and the argument of `--set`.
type Applied = (Vec<String>, String);

/// Lists of keys, of which a table has at most one: setting one removes the others.
fn exclusive(table: &str) -> Vec<Vec<&'static str>> {
    let times = || WHEN.iter().map(|key| key.name).collect();
    match table {
        "scheme" => vec![vec!["cfl", "safety"]],
        "mesh" => vec![vec!["file", "rectangle"]],
        "cloud" | "material" => vec![vec!["per_direction", "spacing"]],
        "output" => vec![times()],
        "regrid" => vec![times(), GRIDS.names()],
        _ => vec![],
    }
}

/// Applies `key.path=value` to a document, after others; answers the path, and the keys of the file that gave way to it.
pub(super) fn apply(
    document: &mut DocumentMut,
    argument: &str,
    before: &[Applied],
) -> Result<(Vec<String>, Vec<String>)> {
    let wrong = |what: String, remedy: &str| Error::at(place(argument), what, remedy);
    let form = "write --set key.path=value, as in scheme.degree=3 or boundary.0.kind=free";
    let (left, right) = argument.split_once('=').ok_or_else(|| wrong("there is no `=`".to_owned(), form))?;
    let keys = Key::parse(left.trim()).map_err(|_| wrong(format!("`{left}` is not a key path"), form))?;
    let path: Vec<String> = keys.iter().map(|key| key.get().to_owned()).collect();
    let Some((last, parents)) = path.split_last() else { return Err(wrong("the key path is empty".to_owned(), form)) };
    let mut item = document.as_item_mut();
    let removed = remove_rivals(item, &path, argument, before)?;
    for (depth, key) in parents.iter().enumerate() {
        let next_is_index = path[depth + 1].parse::<usize>().is_ok();
        let no_place = missing(item, &path, depth, argument);
        item = enter(item, key, next_is_index).ok_or(no_place)?;
    }
    let value = parse_value(right);
    let value =
        value.ok_or_else(|| wrong(format!("`{right}` is not a TOML value"), "check its quotes and brackets"))?;
    if !put(item, last, value) {
        return Err(missing(item, &path, parents.len(), argument));
    }
    Ok((path, removed))
}

/// The place of errors that an override causes.
fn place(argument: &str) -> Place {
    Place::file(std::path::Path::new(&format!("--set {argument}")))
}

/// TOML, or a bare text where it is none.
fn parse_value(text: &str) -> Option<Value> {
    let text = text.trim();
    match text.parse::<Value>() {
        Ok(value) => Some(value.decorated("", "")),
        Err(_) if text.starts_with(['"', '\'', '[', '{']) => None,
        Err(_) => Some(Value::from(text)),
    }
}

/// The entry `key` of a table or list, made where it is missing (a list grows by one entry at its end).
fn enter<'a>(item: &'a mut Item, key: &str, is_list: bool) -> Option<&'a mut Item> {
    if let Some(tables) = item.as_array_of_tables_mut() {
        let index: usize = key.parse().ok()?;
        if index == tables.len() {
            tables.push(Table::new());
        }
    } else if let Some(table) = item.as_table_mut() {
        if !table.contains_key(key) {
            let new = if is_list { Item::ArrayOfTables(Default::default()) } else { Item::Table(Table::new()) };
            table.insert(key, new);
        }
    } else if let Some(table) = item.as_inline_table_mut()
        && !table.contains_key(key)
        && !is_list
    {
        table.insert(key, Value::InlineTable(InlineTable::new()));
    }
    match item.is_table_like() {
        true => item.get_mut(key),
        false => item.get_mut(key.parse::<usize>().ok()?),
    }
}

/// Gives `key` of a table or list a value, keeping the comments around the old one; false where there is no such place.
fn put(item: &mut Item, key: &str, mut value: Value) -> bool {
    if let Some(table) = item.as_table_like_mut() {
        if let Some(old) = table.get(key).and_then(Item::as_value) {
            *value.decor_mut() = old.decor().clone();
        } else {
            table.remove(key);
        }
        table.insert(key, Item::Value(value));
        return true;
    }
    let Ok(index) = key.parse::<usize>() else { return false };
    if let Some(tables) = item.as_array_of_tables_mut() {
        return put_table(tables, index, value);
    }
    let Some(list) = item.as_array_mut() else { return false };
    match index {
        _ if index < list.len() => {
            list.replace(index, value);
        }
        _ if index == list.len() => list.push(value),
        _ => return false,
    }
    true
}

/// Replaces a whole table of a list of tables, or appends one: `boundary.1={group = "right", kind = "free"}`.
fn put_table(tables: &mut ArrayOfTables, index: usize, value: Value) -> bool {
    let Value::InlineTable(inline) = value else { return false };
    let mut table = inline.into_table();
    let count = tables.len();
    match tables.get_mut(index) {
        Some(old) => {
            // The place in the text and the comment before it stay.
            *table.decor_mut() = old.decor().clone();
            table.set_position(old.position());
            *old = table;
        }
        None if index == count => tables.push(table),
        None => return false,
    }
    true
}

/// Removes the keys that exclude the key of a path; answers their paths.
///
/// # Errors
/// A key that another override gives.
fn remove_rivals(root: &mut Item, path: &[String], argument: &str, before: &[Applied]) -> Result<Vec<String>> {
    let Some(section) = path.first() else { return Ok(vec![]) };
    let depth = if root.get(section).is_some_and(|item| !item.is_table_like()) { 2 } else { 1 };
    let Some(key) = path.get(depth) else { return Ok(vec![]) };
    let mut table = root.get_mut(section);
    if depth == 2 {
        table = table.and_then(|list| match path[1].parse::<usize>() {
            Ok(entry) => list.get_mut(entry),
            Err(_) => None,
        });
    }
    let Some(table) = table.and_then(Item::as_table_like_mut) else { return Ok(vec![]) };
    let groups = exclusive(section).into_iter().filter(|keys| keys.contains(&key.as_str()));
    let rivals = groups.flatten().filter(|rival| rival != key).filter(|rival| table.contains_key(rival));
    let mut removed = Vec::new();
    for rival in rivals.collect::<Vec<_>>() {
        let mut other = path[..depth].to_vec();
        other.push(rival.to_owned());
        let gives = |(set, _): &&Applied| set.iter().zip(&other).all(|(a, b)| a == b);
        if let Some((_, first)) = before.iter().rev().find(gives) {
            let what =
                format!("`{}` and `{}` exclude each other, and --set gives both", other.join("."), path.join("."));
            let remedy = format!("leave out this --set, or --set {first}");
            return Err(Error::at(place(argument), what, remedy));
        }
        table.remove(rival);
        removed.push(other.join("."));
    }
    Ok(removed)
}

/// The error of a path whose key `depth` has no place in `item`.
fn missing(item: &Item, path: &[String], depth: usize, argument: &str) -> Error {
    let above = path[..depth].join(".");
    let what = format!("`{}` has no place in the scene", path[..=depth].join("."));
    let entries = item.as_array_of_tables().map(|list| list.len()).or(item.as_array().map(|list| list.len()));
    let remedy = match (item.as_table_like(), entries) {
        (Some(table), _) => {
            let keys: Vec<&str> = table.iter().map(|(key, _)| key).collect();
            format!("`{above}` has the keys {}", keys.join(", "))
        }
        (None, Some(0)) => format!("`{above}` is an empty list: start with 0"),
        (None, Some(n)) => format!("`{above}` is a list: its entries are 0 to {}, and {n} appends one", n - 1),
        (None, None) => format!("`{above}` is a value, without keys below it"),
    };
    Error::at(place(argument), what, remedy)
}
