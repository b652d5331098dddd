//! Names of the deck that become names in the result file.

use std::collections::HashSet;

use crate::model::{ALL_EXTERIOR, Contact, Model};
use crate::output::error::NameError;

/// Checks the names of all sets and instances, and of the surfaces in contact or with a reference node.
pub fn check_names(model: &Model) -> Result<(), NameError> {
    for set in &model.sets.nodes {
        check("node set", &set.name)?;
    }
    for set in &model.sets.elements {
        check("element set", &set.name)?;
    }
    for instance in &model.sets.instances {
        check("instance", &instance.name)?;
    }
    for contact in &model.contacts {
        check("surface", &model.surfaces[contact.slave].name)?;
        check("surface", &model.surfaces[contact.master].name)?;
    }
    for body in &model.rigid_bodies {
        check("surface", &model.surfaces[body.surface].name)?;
    }
    Ok(())
}

fn check(what: &'static str, name: &str) -> Result<(), NameError> {
    if name.is_empty() || name == "." || name.contains(['/', '\0']) {
        let name = name.to_owned();
        return Err(NameError { what, name });
    }
    Ok(())
}

/// Names of the contacts, `<SLAVE>_<MASTER>`, for general contact `ALL_EXTERIOR`; the second of the
/// same name gets `_2`, and so on.
pub fn contact_names(model: &Model) -> Vec<String> {
    let mut taken = HashSet::new();
    (model.contacts.iter())
        .map(|contact| unique(base_name(model, contact), &mut taken))
        .collect()
}

fn base_name(model: &Model, contact: &Contact) -> String {
    let [slave, master] = [contact.slave, contact.master].map(|i| &model.surfaces[i].name);
    match contact.is_self_contact() && slave == ALL_EXTERIOR {
        true => slave.clone(),
        false => format!("{slave}_{master}"),
    }
}

fn unique(base: String, taken: &mut HashSet<String>) -> String {
    let mut name = base.clone();
    let mut number = 2;
    while !taken.insert(name.clone()) {
        name = format!("{base}_{number}");
        number += 1;
    }
    name
}
