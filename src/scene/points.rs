//! The keys that say where material points stand, in `[cloud]` and in `[[material]]`, and what cells may have of them.

use std::path::PathBuf;

use super::reader::{Check, FINITE, POSITIVE, Reader};
use super::{Body, Cloud, Histories, Law, Layout};
use crate::cloud::seed;
use crate::error::Result;
use crate::operators::Limits;

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

/// All keys of [`points`], which a run folder replaces by its file.
pub(super) const KEYS: [&str; 8] =
    ["layout", "per_direction", "seed", "amount", "clusters", "radius", "spacing", "angle"];

#[derive(Clone, Copy)]
enum Pattern {
    Paper,
    Midpoints,
    Gauss,
    Jitter,
    Random,
    Cluster,
    PoissonDisk,
    Rotated,
    File,
}

/// Without the last one: what a material may have of its own.
const PATTERNS: [(&str, Pattern); 9] = [
    ("paper", Pattern::Paper),
    ("midpoints", Pattern::Midpoints),
    ("gauss", Pattern::Gauss),
    ("jitter", Pattern::Jitter),
    ("random", Pattern::Random),
    ("cluster", Pattern::Cluster),
    ("poisson-disk", Pattern::PoissonDisk),
    ("rotated", Pattern::Rotated),
    ("file", Pattern::File),
];

const AMOUNT: Check = Check { range: "from 0 to 0.5 (of the spacing)", holds: |a| (0.0..=0.5).contains(&a) };
const RADIUS: Check = Check { range: "from 0 to 1 (of the cell)", holds: |a| (0.0..=1.0).contains(&a) };
const AT_LEAST_ONE: Check = Check { range: "at least 1", holds: |a| a >= 1.0 };

/// Reads `[cloud]`.
pub(super) fn cloud(table: Option<&mut Reader>, degree: usize) -> Result<General> {
    let layout = Layout::InCells(seed::default_layout(degree));
    let (default, mut limits) = (Cloud { layout, per_direction: degree + 1 }, Limits::of_degree(degree));
    let Some(table) = table else {
        return Ok(General { cloud: default, limits, named: false, histories: Histories::Nodes });
    };
    let pattern = table.choice("layout", &PATTERNS, &[])?;
    let histories = table.choice("histories", Histories::NAMES, &[])?.unwrap_or(Histories::Nodes);
    let cloud = match pattern {
        Some(Pattern::File) => {
            let path = table.text("path")?;
            let path =
                path.ok_or_else(|| table.missing("path", "the file of the points, for instance \"cloud.vtu\""))?;
            Cloud { layout: Layout::File(PathBuf::from(path)), ..default }
        }
        _ => points(table, pattern, default, degree)?,
    };
    if let Some(limit) = table.number("face_lebesgue", AT_LEAST_ONE)? {
        limits = Limits { lebesgue: limit, lattices: true, ..limits };
    }
    if let Some(limit) = table.number("condition", AT_LEAST_ONE)? {
        limits = Limits { condition: limit, lattices: true, ..limits };
    }
    table.finish()?;
    Ok(General { cloud, limits, named: pattern.is_some(), histories })
}

/// Reads the points of a `[[material]]`, and where its internal variables stand (none: the law has none).
pub(super) fn of_material(
    table: &mut Reader,
    general: &General,
    law: &Law,
    degree: usize,
) -> Result<(Cloud, Option<Histories>)> {
    let has_memory = law.has_memory();
    let mut cloud = general.cloud.clone();
    if has_memory && !general.named {
        // The Gauss nodes, which histories then need not leave.
        cloud.layout = Layout::InCells(seed::Layout::Gauss);
    }
    let histories = table.choice("histories", Histories::NAMES, &[])?;
    if histories.is_some() && !has_memory {
        let what = format!("the law \"{}\" has no internal variables", law.name);
        return Err(table.wrong("histories", what, "remove this key"));
    }
    let histories = has_memory.then(|| histories.unwrap_or(general.histories));
    let pattern = table.choice("layout", &PATTERNS[..PATTERNS.len() - 1], &[])?;
    if matches!(cloud.layout, Layout::File(_)) && (pattern.is_some() || table.has("per_direction")) {
        let key = if pattern.is_some() { "layout" } else { "per_direction" };
        let remedy = "remove this key, or change [cloud] layout";
        return Err(table.wrong(key, "the points come from the file of [cloud]", remedy));
    }
    Ok((points(table, pattern, cloud, degree)?, histories))
}

/// The keys that [cloud] and [[material]] share.
fn points(table: &mut Reader, pattern: Option<Pattern>, default: Cloud, degree: usize) -> Result<Cloud> {
    let given = table.integer("per_direction", 1..=30)?;
    let Some(pattern) = pattern else {
        return Ok(Cloud { per_direction: given.unwrap_or(default.per_direction), ..default });
    };
    let seed = |table: &mut Reader| -> Result<u64> { Ok(table.integer("seed", 0..=usize::MAX)?.unwrap_or(1) as u64) };
    let layout = match pattern {
        Pattern::Paper => Layout::InCells(seed::Layout::Paper),
        Pattern::Midpoints => Layout::InCells(seed::Layout::Midpoints),
        Pattern::Gauss => Layout::InCells(seed::Layout::Gauss),
        Pattern::Jitter => Layout::InCells(seed::Layout::Jitter {
            seed: seed(table)?,
            amount: table.number("amount", AMOUNT)?.unwrap_or(seed::Layout::JITTER),
        }),
        Pattern::Random => Layout::InCells(seed::Layout::Random { seed: seed(table)? }),
        Pattern::Cluster => Layout::InCells(seed::Layout::Cluster {
            seed: seed(table)?,
            clusters: table.integer("clusters", 1..=100)?.unwrap_or(seed::Layout::CLUSTERS),
            radius: table.number("radius", RADIUS)?.unwrap_or(seed::Layout::RADIUS),
        }),
        Pattern::PoissonDisk => {
            Layout::Body(Body::PoissonDisk { seed: seed(table)?, spacing: table.number("spacing", POSITIVE)? })
        }
        Pattern::Rotated => Layout::Body(Body::Rotated {
            angle: table.number("angle", FINITE)?.unwrap_or(Body::ANGLE),
            spacing: table.number("spacing", POSITIVE)?,
        }),
        // The only caller that has it reads the path itself.
        Pattern::File => default.layout.clone(),
    };
    // More than the unknowns, so that most cells carry their degree wherever chance puts their points: of random ones it
    // fails 0, 5, 40 % of the cells (N = 1, 2, 3), and 8, 39, 82 % with degree + 2.
    let usual = match layout {
        Layout::InCells(seed::Layout::Random { .. } | seed::Layout::Cluster { .. }) => degree + 3,
        Layout::Body(_) => degree + 2,
        Layout::InCells(_) | Layout::File(_) => 0,
    };
    Ok(Cloud { layout, per_direction: given.unwrap_or(usual.max(default.per_direction)) })
}
