//! Results at the points and nodes of elements, computed once for all datasets of an increment or a frame.

use std::cell::{Ref, RefCell};
use std::sync::Arc;

use crate::dynamics::State;
use crate::elements::{ElementNodes, Elements, LocalResult};
use crate::model::{HistorySet, Model};

/// Places of results.
enum ResultPlaces {
    /// The integration points of elements (indices), element after element.
    Points(Vec<usize>),
    /// The nodes of elements.
    Nodes(ElementNodes),
}

/// Results at the integration points or nodes of elements.
pub(super) struct Local {
    elements: Arc<Elements>,
    places: ResultPlaces,
    /// The latest results, and the number of their increment or frame.
    latest: RefCell<(Option<usize>, Vec<LocalResult>)>,
}

impl Local {
    fn new(elements: &Arc<Elements>, places: ResultPlaces) -> Self {
        Local {
            elements: elements.clone(),
            places,
            latest: RefCell::default(),
        }
    }

    /// Results at the integration points of the elements `members` (indices), element after element.
    pub fn at_points(elements: &Arc<Elements>, members: &[usize]) -> Self {
        Self::new(elements, ResultPlaces::Points(members.to_vec()))
    }

    /// Results at the nodes of the elements `members` (indices, in increasing order).
    pub fn at_nodes(elements: &Arc<Elements>, members: &[usize]) -> Self {
        Self::new(
            elements,
            ResultPlaces::Nodes(ElementNodes::new(elements, members)),
        )
    }

    /// The nodes (indices); empty for results at integration points.
    pub fn nodes(&self) -> Vec<usize> {
        match &self.places {
            ResultPlaces::Points(_) => Vec::new(),
            ResultPlaces::Nodes(nodes) => nodes.nodes().collect(),
        }
    }

    /// Results for an increment or frame, given by its number and its state.
    pub fn of(&self, number: usize, state: &State) -> Ref<'_, [LocalResult]> {
        if self.latest.borrow().0 != Some(number) {
            let (all, motion) = (&self.elements, state.motion());
            let results = match &self.places {
                ResultPlaces::Points(members) => {
                    let of = |&e: &usize| all.at_points(e, motion);
                    members.iter().flat_map(of).collect()
                }
                ResultPlaces::Nodes(nodes) => nodes.results(all, motion),
            };
            *self.latest.borrow_mut() = (Some(number), results);
        }
        Ref::map(self.latest.borrow(), |(_, results)| &results[..])
    }
}

/// The elements of a model if values at their points or nodes are asked for; else `None`.
pub(super) fn elements(model: &Model) -> Arc<Elements> {
    let in_history = |asked: &HistorySet| asked.at_points || asked.at_nodes;
    let sets = &model.sets;
    let is_asked = !sets.fields.at_nodes.is_empty() || sets.element_history.iter().any(in_history);
    Arc::new(match is_asked {
        true => Elements::new(model),
        false => Elements::new(&Model::default()),
    })
}
