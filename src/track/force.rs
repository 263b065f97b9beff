//! Force, impulse and work of the conditions of boundary groups through time.
//!
//! The steps meter the traction t* of the corrector's own fluxes at each boundary point. So the impulse of all groups and of sources is
//! the change of momentum to rounding, whatever the step and the mesh. A force is a mean over the time since the row before, of the
//! step where each step has its row: an ADER step has one t* at a point, and a Runge-Kutta step the mean over its stages.

use super::{Column, Track};
use crate::error::Error;
use crate::mesh::Mesh;
use crate::quantity::Seen;
use crate::state::Received;
use crate::words::{Saved, Words};

/// What the conditions of boundary groups, or the other sides of contact pairs, give to the body: force (N/m, mean since the row before, 0 in the first row), impulse (N s/m) and work (J/m)
/// since the start of the run; a run that starts from a snapshot with forces goes on from them.
pub struct Forces {
    groups: Vec<Group>,
    /// Time of the row before, s.
    time: f64,
}

/// Who gives a force.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Giver {
    /// The condition of the group of this number in the mesh.
    Group(usize),
    /// A contact pair, in the order of [`crate::step::Scheme::pairs`]: to its first side (0) or its second (1).
    Pair(usize, usize),
    /// A pair of one group with itself: to both sides.
    Within(usize),
}

impl Giver {
    /// What it has given by [`crate::state::State::received`] of a mesh with so many groups.
    fn given(self, received: &[Received], groups: usize) -> Received {
        let at = |place: usize| received.get(place).copied().unwrap_or_default();
        match self {
            Self::Group(number) => at(number),
            Self::Pair(pair, side) => at(groups + 2 * pair + side),
            Self::Within(pair) => {
                let [one, two] = [0, 1].map(|side| at(groups + 2 * pair + side));
                let impulse = [0, 1].map(|axis| one.impulse[axis] + two.impulse[axis]);
                Received { impulse, work: one.work + two.work }
            }
        }
    }
}

/// A group that is followed, or one side of a contact pair.
struct Group {
    name: String,
    giver: Giver,
    /// What the body had received through it in the row before; none before the first.
    before: Option<Received>,
    /// The force of the row before, N/m.
    force: [f64; 2],
}

impl Forces {
    /// Of these groups and pairs, with the names of their columns.
    pub fn new(groups: Vec<(String, Giver)>) -> Self {
        let of = |(name, giver)| Group { name, giver, before: None, force: [0.0; 2] };
        Self { groups: groups.into_iter().map(of).collect(), time: f64::NEG_INFINITY }
    }
}

impl Track for Forces {
    fn columns(&self) -> Vec<Column> {
        let of = |group: &Group| {
            let columns = [
                ("force_1", "N/m"),
                ("force_2", "N/m"),
                ("impulse_1", "N s/m"),
                ("impulse_2", "N s/m"),
                ("work", "J/m"),
            ];
            columns.map(|(column, unit)| (format!("{}_{column}", group.name), unit))
        };
        self.groups.iter().flat_map(of).collect()
    }

    fn push(&mut self, seen: &Seen, row: &mut Vec<f64>) {
        let elapsed = seen.state.time - self.time;
        for group in &mut self.groups {
            let now = group.giver.given(&seen.state.received, seen.mesh.edge_groups.len());
            if let Some(before) = group.before.filter(|_| elapsed > 0.0) {
                group.force = [0, 1].map(|axis| (now.impulse[axis] - before.impulse[axis]) / elapsed);
            }
            group.before = Some(now);
            row.extend(group.force.into_iter().chain(now.impulse).chain([now.work]));
        }
        self.time = seen.state.time;
    }

    fn moved(&mut self, mesh: &Mesh) -> Result<(), Error> {
        // Another mesh may have its groups in another order.
        for Group { name, giver, .. } in &mut self.groups {
            let Giver::Group(number) = giver else { continue };
            let found = mesh.edge_groups.iter().position(|known| known == name);
            *number = found.ok_or_else(|| {
                let what = format!("the new mesh has no group \"{name}\", whose force an output records");
                Error::input(what, "give the boundary its old name in the new mesh")
            })?;
        }
        Ok(())
    }

    fn save(&self, to: &mut Words) {
        to.real(self.time).count(self.groups.len());
        for Group { name, before, force, .. } in &self.groups {
            let Received { impulse, work } = before.unwrap_or_default();
            to.text(name).flag(before.is_some()).reals(&[impulse[0], impulse[1], work]).reals(force);
        }
    }

    fn restore(&mut self, from: &mut Saved) -> Result<(), Error> {
        self.time = from.real()?;
        let count = from.count()?;
        let mut groups = Vec::new();
        for _ in 0..count {
            let (name, is_known) = (from.text()?, from.flag()?);
            let (received, force) = (from.reals()?, from.reals()?);
            // The columns have the order of the first mesh.
            let giver = self.groups.iter().find(|group| group.name == name).map(|group| group.giver);
            let ([one, two, work], [x, y], Some(giver)) = (&received[..], &force[..], giver) else {
                let what = format!("the checkpoint has forces of \"{name}\", which this output does not follow");
                return Err(Error::input(what, "resume with the outputs of that run"));
            };
            let before = is_known.then_some(Received { impulse: [*one, *two], work: *work });
            groups.push(Group { name, giver, before, force: [*x, *y] });
        }
        self.groups = groups;
        Ok(())
    }

    fn wants_forces(&self) -> bool {
        true
    }
}
