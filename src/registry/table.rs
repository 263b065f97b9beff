//! A table of entries: those of the crate, and those that a program adds.

use super::Entry;
use crate::error::{Error, Result};
use std::sync::RwLock;

/// All things of a kind that scenes can name.
pub struct Table<B: 'static> {
    /// Those of the crate.
    built_in: &'static [Entry<B>],
    /// Those that were added.
    added: RwLock<Vec<&'static Entry<B>>>,
}

impl<B: 'static> Table<B> {
    /// With the entries of the crate.
    pub(super) const fn new(built_in: &'static [Entry<B>]) -> Self {
        Self { built_in, added: RwLock::new(Vec::new()) }
    }

    /// All entries: those of the crate, then those that were added, in their order.
    pub fn iter(&'static self) -> impl Iterator<Item = &'static Entry<B>> {
        let added = self.added.read().unwrap_or_else(|poisoned| poisoned.into_inner()).clone();
        self.built_in.iter().chain(added)
    }

    /// Number of entries.
    pub fn len(&'static self) -> usize {
        self.iter().count()
    }

    /// Whether there is none.
    pub fn is_empty(&'static self) -> bool {
        self.len() == 0
    }

    /// The first entry of the crate.
    pub fn first(&self) -> &'static Entry<B> {
        &self.built_in[0]
    }

    /// The entry of a name.
    pub fn find(&'static self, name: &str) -> Option<&'static Entry<B>> {
        self.iter().find(|entry| entry.name == name)
    }

    /// The names of all entries.
    pub fn names(&'static self) -> Vec<&'static str> {
        self.iter().map(|entry| entry.name).collect()
    }

    /// Adds an entry: from then on scenes name it as if it were built in, for the rest of the program.
    ///
    /// # Errors
    /// An entry of that name that is there already.
    pub fn add(&'static self, entry: Entry<B>) -> Result<()> {
        let mut added = self.added.write().unwrap_or_else(|poisoned| poisoned.into_inner());
        if self.built_in.iter().chain(added.iter().copied()).any(|known| known.name == entry.name) {
            let what = format!("the registry has \"{}\" already", entry.name);
            return Err(Error::input(what, "give the entry another name"));
        }
        // Entries live as long as the program, as those of the crate do.
        added.push(Box::leak(Box::new(entry)));
        Ok(())
    }
}

impl<B: 'static> IntoIterator for &'static Table<B> {
    type Item = &'static Entry<B>;
    type IntoIter = std::vec::IntoIter<&'static Entry<B>>;

    fn into_iter(self) -> Self::IntoIter {
        self.iter().collect::<Vec<_>>().into_iter()
    }
}
