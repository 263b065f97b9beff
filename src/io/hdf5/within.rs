//! Datasets in groups, as other programs have them.

use super::{Reader, Values, reason};
use crate::error::Result;
use hdf5_metno as h5;
use hdf5_metno::LinkType;

impl Reader {
    /// Shape and values of a dataset in groups, such as `Mesh/mesh/topology`. No link on the way is followed.
    ///
    /// # Errors
    /// As for [`Reader::get`]; a link; a name that is not there.
    pub fn get_within(&self, path: &str) -> Result<(Vec<usize>, Values)> {
        let fail = |e: h5::Error| self.error(format!("array `{path}` cannot be read: {}", reason(&e)));
        let names: Vec<&str> = path.split('/').filter(|name| !name.is_empty()).collect();
        let mut group: Option<h5::Group> = None;
        for (k, name) in names.iter().enumerate() {
            let here: &h5::Group = group.as_ref().unwrap_or(&self.file);
            match self.kind_of_link(here, name)? {
                Some(LinkType::Hard) => {}
                Some(_) => {
                    return Err(self.error(format!("`{name}` of `{path}` is a link, and links are not followed")));
                }
                None => return Err(self.error(format!("it has no array `{path}`"))),
            }
            if k + 1 < names.len() {
                group = Some(here.group(name).map_err(fail)?);
            }
        }
        self.get(&names.join("/"))
    }

    /// How an object of a group is linked there, if it is.
    fn kind_of_link(&self, group: &h5::Group, wanted: &str) -> Result<Option<LinkType>> {
        let mut found = None;
        let visited = group.iter_visit_default(|name, about| {
            if name == wanted {
                found = Some(about.link_type);
            }
            Ok(())
        });
        visited.map_err(|e| self.error(format!("its contents cannot be listed: {}", reason(&e))))?;
        Ok(found)
    }
}
