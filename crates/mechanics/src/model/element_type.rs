//! Element types of a deck: shape, formulation and assumption across the thickness, with the nodes,
//! sides and cell of each shape. See docs/theory/elements.md; the mechanics of each type is in
//! its own file of `elements`.

use std::fmt;

use super::Plane;

/// Type of an element, as named in the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ElementType {
    /// Shape and interpolation.
    pub shape: Shape,
    /// Formulation: the way in which strains are computed from the displacements.
    pub formulation: Formulation,
    /// Plane stress, plane strain or body of revolution.
    pub plane: Plane,
}

/// Shape and interpolation of an element.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Shape {
    /// Three-node triangle with linear displacements.
    Tri3,
    /// Four-node quadrilateral with bilinear displacements.
    Quad4,
    /// Six-node triangle with quadratic displacements.
    Tri6,
    /// Eight-node quadrilateral with quadratic displacements (serendipity).
    Quad8,
}

/// Way in which the strains of an element are computed from its displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Formulation {
    /// Strains of the displacements at every integration point.
    Displacement,
    /// One volume strain for all integration points of the element.
    MeanDilatation,
    /// Strains of the displacements plus own strains of the element, which minimise its stored
    /// energy.
    Enhanced,
    /// Strains of the displacements at fewer integration points.
    Reduced,
    /// Volume strain that is linear in the element.
    LinearPressure,
    /// Volume strain that is linear in the element, at fewer integration points.
    ReducedLinearPressure,
}

/// Nodes and sides of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topology {
    /// Number of nodes.
    pub nodes: usize,
    /// Local nodes of every side from corner to corner, with the element on the left; side 0 is S1/P1. Corners come
    /// first among the nodes, and the side number i begins at the corner number i.
    pub sides: &'static [&'static [usize]],
    /// Cell type of VTK.
    pub vtk_cell: u8,
}

/// ```text
///   2
///   | \
///   |  \
///   0 -- 1
/// ```
static TRI3: Topology = Topology {
    nodes: 3,
    sides: &[&[0, 1], &[1, 2], &[2, 0]],
    vtk_cell: 5,
};

/// ```text
///   3 ---- 2
///   |      |
///   |      |
///   0 ---- 1
/// ```
static QUAD4: Topology = Topology {
    nodes: 4,
    sides: &[&[0, 1], &[1, 2], &[2, 3], &[3, 0]],
    vtk_cell: 9,
};

/// ```text
///   2
///   | \
///   5  4
///   |   \
///   0-3-1
/// ```
static TRI6: Topology = Topology {
    nodes: 6,
    sides: &[&[0, 3, 1], &[1, 4, 2], &[2, 5, 0]],
    vtk_cell: 22,
};

/// ```text
///   3 - 6 - 2
///   |       |
///   7       5
///   |       |
///   0 - 4 - 1
/// ```
static QUAD8: Topology = Topology {
    nodes: 8,
    sides: &[&[0, 4, 1], &[1, 5, 2], &[2, 6, 3], &[3, 7, 0]],
    vtk_cell: 23,
};

impl Shape {
    /// Nodes, counter-clockwise, and sides.
    pub const fn topology(self) -> &'static Topology {
        match self {
            Shape::Tri3 => &TRI3,
            Shape::Quad4 => &QUAD4,
            Shape::Tri6 => &TRI6,
            Shape::Quad8 => &QUAD8,
        }
    }
}

/// Defines the constants, names and numbers of the types from one row for each type.
macro_rules! element_types {
    ($($(#[$about:meta])* $name:ident = $number:literal: $shape:ident $plane:ident $formulation:ident;)*) => {
        impl ElementType {
            $($(#[$about])*
            pub const $name: Self = ElementType {
                shape: Shape::$shape,
                formulation: Formulation::$formulation,
                plane: Plane::$plane,
            };)*

            /// All types that a deck may name.
            pub const NAMED: [Self; NAMES.len()] = [$(Self::$name),*];

            /// Numbers and names of the types, as result files list these.
            pub const NUMBERS: &str =
                concat!($(", ", stringify!($number), " ", stringify!($name)),*).split_at(2).1;
        }

        /// Names in the deck and numbers in result files, which never change, in the order of [`ElementType::NAMED`].
        const NAMES: &[(&str, u8)] = &[$((stringify!($name), $number)),*];
    };
}

element_types! {
    /// Triangle in plane strain.
    CPE3 = 0: Tri3 Strain Displacement;
    /// Quadrilateral in plane strain.
    CPE4 = 1: Quad4 Strain Displacement;
    /// Triangle in plane stress.
    CPS3 = 2: Tri3 Stress Displacement;
    /// Quadrilateral in plane stress.
    CPS4 = 3: Quad4 Stress Displacement;
    /// Quadrilateral in plane strain with mean dilatation.
    CPE4H = 4: Quad4 Strain MeanDilatation;
    /// Quadratic triangle in plane strain.
    CPE6 = 5: Tri6 Strain Displacement;
    /// Quadratic triangle in plane stress.
    CPS6 = 6: Tri6 Stress Displacement;
    /// Quadratic quadrilateral in plane strain.
    CPE8 = 7: Quad8 Strain Displacement;
    /// Quadratic quadrilateral in plane stress.
    CPS8 = 8: Quad8 Stress Displacement;
    /// Quadratic quadrilateral in plane strain, integrated with 2 x 2 points.
    CPE8R = 9: Quad8 Strain Reduced;
    /// Quadratic quadrilateral in plane stress, integrated with 2 x 2 points.
    CPS8R = 10: Quad8 Stress Reduced;
    /// Ring with the section of a triangle.
    CAX3 = 11: Tri3 Revolution Displacement;
    /// Ring with the section of a quadrilateral.
    CAX4 = 12: Quad4 Revolution Displacement;
    /// Ring with the section of a quadratic triangle.
    CAX6 = 13: Tri6 Revolution Displacement;
    /// Ring with the section of a quadratic quadrilateral.
    CAX8 = 14: Quad8 Revolution Displacement;
    /// Ring with the section of a quadratic quadrilateral, integrated with 2 x 2 points.
    CAX8R = 15: Quad8 Revolution Reduced;
    /// Quadrilateral in plane strain with enhanced strains.
    CPE4I = 16: Quad4 Strain Enhanced;
    /// Quadrilateral in plane stress with enhanced strains.
    CPS4I = 17: Quad4 Stress Enhanced;
    /// Quadrilateral in plane strain with one strain and hourglass stiffness.
    CPE4R = 18: Quad4 Strain Reduced;
    /// Quadrilateral in plane stress with one strain and hourglass stiffness.
    CPS4R = 19: Quad4 Stress Reduced;
    /// Quadratic quadrilateral in plane strain with a linear pressure.
    CPE8H = 20: Quad8 Strain LinearPressure;
    /// Quadratic quadrilateral in plane strain with a linear pressure, integrated with 2 x 2 points.
    CPE8RH = 21: Quad8 Strain ReducedLinearPressure;
    /// Ring with the section of a quadrilateral with mean dilatation.
    CAX4H = 22: Quad4 Revolution MeanDilatation;
    /// Ring with the section of a quadrilateral with enhanced strains.
    CAX4I = 23: Quad4 Revolution Enhanced;
    /// Ring with the section of a quadrilateral with one strain and hourglass stiffness.
    CAX4R = 24: Quad4 Revolution Reduced;
    /// Ring with the section of a quadratic quadrilateral and a linear pressure.
    CAX8H = 25: Quad8 Revolution LinearPressure;
    /// Ring with the section of a quadratic quadrilateral and a linear pressure, integrated with 2 x 2 points.
    CAX8RH = 26: Quad8 Revolution ReducedLinearPressure;
}

impl ElementType {
    /// Largest number of nodes of any type.
    pub const MOST_NODES: usize = {
        let (mut most, mut k) = (0, 0);
        while k < Self::NAMED.len() {
            let nodes = Self::NAMED[k].shape.topology().nodes;
            most = if nodes > most { nodes } else { most };
            k += 1;
        }
        most
    };

    /// The type with a given name in upper case.
    pub fn from_name(name: &str) -> Option<Self> {
        let at = NAMES.iter().position(|(known, _)| *known == name)?;
        Some(Self::NAMED[at])
    }

    fn entry(self) -> (&'static str, u8) {
        let at = Self::NAMED.iter().position(|known| *known == self);
        at.map_or(("", u8::MAX), |at| NAMES[at])
    }

    /// Name in the deck.
    pub fn name(self) -> &'static str {
        self.entry().0
    }

    /// Number in result files.
    pub fn number(self) -> u8 {
        self.entry().1
    }

    /// Whether the type has one strain and a potential of its hourglass modes.
    pub fn has_hourglass_modes(&self) -> bool {
        self.formulation == Formulation::Reduced && self.shape == Shape::Quad4
    }

    /// Whether the type is an element of a body of revolution.
    pub fn is_ring(self) -> bool {
        self.plane == Plane::Revolution
    }

    /// Whether the strains of the type also have a component across the section, as in rings and with a linear
    /// pressure.
    pub fn has_all_strains(self) -> bool {
        let pressures = [
            Formulation::LinearPressure,
            Formulation::ReducedLinearPressure,
        ];
        self.is_ring() || pressures.contains(&self.formulation)
    }

    /// Whether displacements within an element are quadratic, so sides have mid-side nodes.
    pub fn is_quadratic(self) -> bool {
        matches!(self.shape, Shape::Tri6 | Shape::Quad8)
    }

    /// Nodes, counter-clockwise, and sides.
    pub fn topology(self) -> &'static Topology {
        self.shape.topology()
    }
}

impl fmt::Display for ElementType {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        write!(f, "{}", self.name())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_type_is_found_by_its_name() {
        for element_type in ElementType::NAMED {
            let found = ElementType::from_name(element_type.name());
            assert_eq!(found, Some(element_type));
        }
        assert_eq!(ElementType::from_name("CPE4RT"), None);
    }

    #[test]
    fn sides_go_round_the_element_once() {
        for element_type in ElementType::NAMED {
            let Topology { nodes, sides, .. } = *element_type.topology();
            for (i, side) in sides.iter().enumerate() {
                let ends = [side[0], side[side.len() - 1]];
                assert_eq!(ends, [i, (i + 1) % sides.len()]);
            }
            let mut all: Vec<usize> = sides.iter().flat_map(|side| &side[1..]).copied().collect();
            all.sort_unstable();
            assert_eq!(all, Vec::from_iter(0..nodes));
        }
    }
}
