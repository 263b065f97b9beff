//! The keys that say where material points stand, in `[cloud]` and in `[[material]]`, and what cells may have of them.

use super::reader::Reader;
use super::tables::{HISTORIES, LAYOUT, LIMITS, OWN_LAYOUT, PER_DIRECTION};
use super::{Cloud, Histories, Limits};
use crate::error::Result;
use crate::registry::layouts::{self, Layout};
use crate::registry::{Chosen, Entry, LAYOUTS, defaults};

/// What `[cloud]` says for all materials.
pub(super) struct General {
    /// Where points stand.
    pub cloud: Cloud,
    /// What cells may have of them.
    pub limits: Limits,
    /// Whether the layout is the scene's; else it is the default, and laws with memory have one of their own.
    named: bool,
    /// Where laws with memory have their internal variables.
    histories: Histories,
}

/// All keys that say where points stand, which a run folder replaces by its file.
pub(super) fn keys() -> impl Iterator<Item = &'static str> {
    let of_layouts = LAYOUTS.iter().flat_map(|entry| entry.parameters.iter().map(|parameter| parameter.name));
    [LAYOUT.name, PER_DIRECTION.name].into_iter().chain(of_layouts)
}

/// The layout of a name, with its defaults.
fn usual(name: &str) -> Chosen<Layout> {
    let entry = LAYOUTS.find(name).unwrap_or(LAYOUTS.first());
    Chosen { entry, values: defaults(entry.parameters, 0) }
}

/// Reads `[cloud]`, in a scene in which something presses on bodies where they touch, or nothing does.
pub(super) fn cloud(table: Option<&mut Reader>, degree: usize, presses: bool) -> Result<General> {
    let name = if presses { layouts::IN_CONTACT } else { layouts::default_name(degree) };
    let default = Cloud { layout: usual(name), per_direction: degree + 1 };
    let Some(table) = table else {
        let limits = Limits { face_lebesgue: None, condition: None };
        return Ok(General { cloud: default, limits, named: false, histories: Histories::Nodes });
    };
    let layout = table.maybe_entry(&LAYOUT, &LAYOUTS)?;
    let histories = histories(table)?.unwrap_or(Histories::Nodes);
    let given = layout.is_some() || table.has("path");
    // A path says that the points come from a file.
    let layout = match layout {
        None if table.has("path") => LAYOUTS.iter().find(|entry| entry.build.is_file()),
        Some(entry) if table.has("path") && !entry.build.is_file() => {
            let remedy = "give layout = \"file\" (the default where there is a path), or remove `path`";
            return Err(table.wrong("path", "[cloud] has a `path` and another `layout`", remedy));
        }
        layout => layout,
    };
    let cloud = points(table, layout, default, degree)?;
    if !cloud.layout.build().is_file() {
        table.know("path");
    }
    let limits = table.values(&LIMITS)?;
    let limits = Limits { face_lebesgue: limits.maybe("face_lebesgue"), condition: limits.maybe("condition") };
    table.finish()?;
    Ok(General { cloud, limits, named: given, histories })
}

fn histories(table: &mut Reader) -> Result<Option<Histories>> {
    let values = table.values(&[HISTORIES])?;
    let named = values.maybe_text(HISTORIES.name);
    Ok(named.and_then(|name| Histories::NAMES.iter().find(|(known, _)| *known == name)).map(|(_, value)| *value))
}

/// Reads the points of a `[[material]]`, and where its internal variables stand (none: the law has none).
pub(super) fn of_material(
    table: &mut Reader,
    general: &General,
    law: &str,
    has_memory: bool,
    degree: usize,
) -> Result<(Cloud, Option<Histories>)> {
    let mut cloud = general.cloud.clone();
    if has_memory && !general.named {
        cloud.layout = usual(layouts::WITH_MEMORY);
    }
    let histories = histories(table)?;
    if histories.is_some() && !has_memory {
        let what = format!("the law \"{law}\" has no internal variables");
        return Err(table.wrong("histories", what, "remove this key"));
    }
    let histories = has_memory.then(|| histories.unwrap_or(general.histories));
    let layout = table.maybe_entry(&OWN_LAYOUT, &LAYOUTS)?;
    if cloud.layout.build().is_file() && (layout.is_some() || table.has("per_direction")) {
        let key = if layout.is_some() { "layout" } else { "per_direction" };
        let remedy = "remove this key, or change [cloud] layout";
        return Err(table.wrong(key, "the points come from the file of [cloud]", remedy));
    }
    Ok((points(table, layout, cloud, degree)?, histories))
}

/// The keys that [cloud] and [[material]] share.
fn points(table: &mut Reader, layout: Option<&'static Entry<Layout>>, default: Cloud, degree: usize) -> Result<Cloud> {
    let given = match layout.is_some_and(|entry| entry.build.is_file()) {
        true => None,
        false => table.values(&[PER_DIRECTION])?.maybe_integer(PER_DIRECTION.name),
    };
    let Some(entry) = layout else {
        one_measure(table, &default.layout)?;
        return Ok(Cloud { per_direction: given.unwrap_or(default.per_direction), ..default });
    };
    let mut values = table.values(entry.parameters)?;
    table.complete(entry.parameters, &mut values, degree)?;
    table.fits(entry, &values)?;
    let more = entry.build.more;
    let usual = if more > 0 { degree + 1 + more } else { default.per_direction };
    let per_direction = given.unwrap_or(usual.max(default.per_direction));
    let layout = Chosen { entry, values };
    one_measure(table, &layout)?;
    Ok(Cloud { layout, per_direction })
}

/// Where a layout has a distance of its points, a number of them says nothing.
fn one_measure(table: &Reader, layout: &Chosen<Layout>) -> Result<()> {
    match layout.values.maybe("spacing") {
        Some(spacing) if table.has(PER_DIRECTION.name) => {
            let what = format!("the points of layout \"{}\" have the `spacing` {spacing} m already", layout.name());
            Err(table.wrong(PER_DIRECTION.name, what, "remove `per_direction`, or `spacing`"))
        }
        _ => Ok(()),
    }
}
