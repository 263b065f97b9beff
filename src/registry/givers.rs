//! Who gives forces that an output records: the conditions of boundary groups, and the sides of contact pairs.

use crate::mesh::Mesh;
use crate::operators::Neighbour;
use crate::step::Scheme;
use crate::track::Giver;

/// The groups of these names, or all that a face of the boundary belongs to.
pub(super) fn groups(names: &[String], mesh: &Mesh, scheme: &Scheme) -> Vec<(String, Giver)> {
    let mut faces = vec![false; mesh.edge_groups.len()];
    for neighbour in scheme.operators.blocks.neighbours.iter().flatten().flatten() {
        if let Neighbour::Boundary(group) = neighbour
            && let Some(face) = faces.get_mut(*group)
        {
            *face = true;
        }
    }
    let all = mesh.edge_groups.iter().enumerate().map(|(number, name)| (name.clone(), number));
    let wanted = |name: &String, number: usize| if names.is_empty() { faces[number] } else { names.contains(name) };
    all.filter(|(name, number)| wanted(name, *number)).map(|(name, number)| (name, Giver::Group(number))).collect()
}

/// Both sides of each contact pair, `a_by_b` and `b_by_a`, of those that receive something in the groups of these names, or of all; a group
/// that meets itself is one.
pub(super) fn pairs(names: &[String], mesh: &Mesh, scheme: &Scheme) -> Vec<(String, Giver)> {
    let mut out = vec![];
    for (pair, groups) in scheme.pairs().into_iter().enumerate() {
        let [one, two] = groups.map(|group| mesh.edge_groups[group].clone());
        let sides: &[_] = match one == two {
            true => &[(&one, &one, Giver::Within(pair))],
            false => &[(&one, &two, Giver::Pair(pair, 0)), (&two, &one, Giver::Pair(pair, 1))],
        };
        let wanted = sides.iter().filter(|(to, ..)| names.is_empty() || names.contains(to));
        out.extend(wanted.map(|(to, by, giver)| (format!("{to}_by_{by}"), *giver)));
    }
    out
}
