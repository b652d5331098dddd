//! Bodies: the outline of all elements of a material, filled, and the sides of the elements.

use super::canvas::{Canvas, Pen};
use super::legend::{Legend, Symbol};
use crate::model::{Element, Model};
use std::collections::{BTreeMap, HashSet};

/// Fills of the materials, in turn.
const FILLS: [&str; 6] = [
    "#cdd9e8", "#eddfc0", "#d3e6cc", "#ead0da", "#dbd3ec", "#cfe6e6",
];
const OUTLINE: Pen = Pen("#5b6675", 1.2);
const SIDES: Pen = Pen("#9aa6b5", 0.4);

/// Pixels that an element takes on average, below which its sides are not drawn.
const SMALLEST: f64 = 5.0;

/// Draws the bodies, their materials in the legend.
pub(super) fn draw(model: &Model, canvas: &mut Canvas, legend: &mut Legend) {
    for (index, material) in model.materials.iter().enumerate() {
        let is_of = |element: &&Element| model.sections[element.section].material == index;
        let elements: Vec<&Element> = model.mesh.elements.iter().filter(is_of).collect();
        if elements.is_empty() {
            continue;
        }
        let colour = FILLS[index % FILLS.len()];
        let (outline, inside) = sides(&elements);
        let place = |&node: &usize| model.mesh.coordinates[node];
        let loops = loops(outline);
        let loops: Vec<Vec<[f64; 2]>> = loops
            .iter()
            .map(|l| l.iter().map(place).collect())
            .collect();
        canvas.fill(&loops, colour, OUTLINE);
        let ends = |side: &[usize; 2]| side.map(|node| place(&node));
        let inside: Vec<[[f64; 2]; 2]> = inside.iter().map(ends).collect();
        if mean_length(&inside, canvas) > SMALLEST {
            canvas.lines(&inside, SIDES);
        }
        legend.add(Symbol::Fill(colour), &format!("material {}", material.name));
    }
}

/// Sides without an element of the group on their right, and the others, each once.
fn sides(elements: &[&Element]) -> (Vec<[usize; 2]>, Vec<[usize; 2]>) {
    let all: HashSet<[usize; 2]> = elements
        .iter()
        .flat_map(|element| element.segments())
        .collect();
    let in_order = elements.iter().flat_map(|element| element.segments());
    let (inside, outline): (Vec<_>, Vec<_>) = in_order.partition(|&[a, b]| all.contains(&[b, a]));
    (outline, inside.into_iter().filter(|[a, b]| a < b).collect())
}

/// The closed ways along sides.
fn loops(sides: Vec<[usize; 2]>) -> Vec<Vec<usize>> {
    let mut from: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for [a, b] in sides {
        from.entry(a).or_default().push(b);
    }
    let mut loops = Vec::new();
    while let Some((&start, _)) = from.first_key_value() {
        let mut nodes = Vec::new();
        let mut node = start;
        while let Some(next) = take(&mut from, node) {
            nodes.push(node);
            node = next;
        }
        loops.push(nodes);
    }
    loops
}

/// The end of a side that begins at a node; the side is taken away.
fn take(from: &mut BTreeMap<usize, Vec<usize>>, node: usize) -> Option<usize> {
    let ends = from.get_mut(&node)?;
    let next = ends.pop();
    if ends.is_empty() {
        from.remove(&node);
    }
    next
}

fn mean_length(sides: &[[[f64; 2]; 2]], canvas: &Canvas) -> f64 {
    let lengths = (sides.iter()).map(|[a, b]| canvas.pixels((b[0] - a[0]).hypot(b[1] - a[1])));
    lengths.sum::<f64>() / sides.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn outlines_are_closed_and_holes_are_loops_of_their_own() {
        let ring = |nodes: &[usize]| -> Vec<[usize; 2]> {
            let next = nodes.iter().cycle().skip(1);
            nodes.iter().zip(next).map(|(&a, &b)| [a, b]).collect()
        };
        let sides = [ring(&[0, 1, 2, 3]), ring(&[7, 6, 5, 4])].concat();
        assert_eq!(loops(sides), [vec![0, 1, 2, 3], vec![4, 7, 6, 5]]);
    }
}
