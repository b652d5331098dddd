//! Results at the points and nodes of elements, computed once for all datasets of an increment or a frame.

use std::cell::{Ref, RefCell};
use std::sync::Arc;

use crate::dynamics::State;
use crate::elements::{ElementNodes, Elements, LocalResult};
use crate::model::{HistorySet, Model};

/// Where results are.
enum ResultPlaces {
    /// At the integration points of elements (indices), one element after the other.
    Points(Vec<usize>),
    /// At the nodes of elements.
    Nodes(ElementNodes),
}

/// Results at places of elements.
pub(super) struct Local {
    elements: Arc<Elements>,
    places: ResultPlaces,
    /// The latest results, and what they are of.
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

    /// At the integration points of the `members` (indices), one element after the other.
    pub fn at_points(elements: &Arc<Elements>, members: &[usize]) -> Self {
        Self::new(elements, ResultPlaces::Points(members.to_vec()))
    }

    /// At the nodes of the `members` (indices), whose indices increase.
    pub fn at_nodes(elements: &Arc<Elements>, members: &[usize]) -> Self {
        Self::new(
            elements,
            ResultPlaces::Nodes(ElementNodes::new(elements, members)),
        )
    }

    /// The nodes (indices); none of integration points.
    pub fn nodes(&self) -> Vec<usize> {
        match &self.places {
            ResultPlaces::Points(_) => Vec::new(),
            ResultPlaces::Nodes(nodes) => nodes.nodes().collect(),
        }
    }

    /// Results of the increment or frame of a number, whose state is given.
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

/// The elements of a model if values at their points or nodes are asked for, else none.
pub(super) fn elements(model: &Model) -> Arc<Elements> {
    let in_history = |asked: &HistorySet| asked.at_points || asked.at_nodes;
    let sets = &model.sets;
    let is_asked = !sets.fields.at_nodes.is_empty() || sets.element_history.iter().any(in_history);
    Arc::new(match is_asked {
        true => Elements::new(model),
        false => Elements::new(&Model::default()),
    })
}
