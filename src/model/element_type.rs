//! Element types of a deck: shape, formulation and assumption across the thickness, with the nodes,
//! sides and cell of each shape. Section 2 of docs/theory.md; the mechanics of each type is in
//! its own file of `elements`.

use std::fmt;

use super::Plane;

/// Type of an element, as named in the deck.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct ElementType {
    /// Shape and interpolation.
    pub shape: Shape,
    /// How strains follow from the displacements.
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

/// How the strains of an element follow from its displacements.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Formulation {
    /// Strains of the displacements at every integration point.
    Displacement,
    /// Volume strain of the whole element at every integration point.
    MeanDilatation,
    /// Strains of the displacements and strains of the element that make its stored energy least.
    Enhanced,
    /// Strains of the displacements at fewer integration points.
    Reduced,
    /// Volume strains that are linear in the element.
    LinearPressure,
    /// The same at fewer integration points.
    ReducedLinearPressure,
}

/// Nodes and sides of a shape.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Topology {
    /// Number of nodes.
    pub nodes: usize,
    /// Local nodes of every side from corner to corner, the element on the left: side 0 is S1/P1. Corners come first
    /// among the nodes, and side i begins at corner i.
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

impl ElementType {
    /// Triangle in plane strain.
    pub const CPE3: Self = Self::standard(Shape::Tri3, Plane::Strain);
    /// Triangle in plane stress.
    pub const CPS3: Self = Self::standard(Shape::Tri3, Plane::Stress);
    /// Quadrilateral in plane strain.
    pub const CPE4: Self = Self::standard(Shape::Quad4, Plane::Strain);
    /// Quadrilateral in plane stress.
    pub const CPS4: Self = Self::standard(Shape::Quad4, Plane::Stress);
    /// Quadrilateral in plane strain with mean dilatation.
    pub const CPE4H: Self = Self::CPE4.with(Formulation::MeanDilatation);
    /// Quadrilateral in plane strain with enhanced strains.
    pub const CPE4I: Self = Self::CPE4.enhanced();
    /// Quadrilateral in plane stress with enhanced strains.
    pub const CPS4I: Self = Self::CPS4.enhanced();
    /// Quadrilateral in plane strain with one strain and hourglass stiffness.
    pub const CPE4R: Self = Self::CPE4.reduced();
    /// Quadrilateral in plane stress with one strain and hourglass stiffness.
    pub const CPS4R: Self = Self::CPS4.reduced();
    /// Quadratic triangle in plane strain.
    pub const CPE6: Self = Self::standard(Shape::Tri6, Plane::Strain);
    /// Quadratic triangle in plane stress.
    pub const CPS6: Self = Self::standard(Shape::Tri6, Plane::Stress);
    /// Quadratic quadrilateral in plane strain.
    pub const CPE8: Self = Self::standard(Shape::Quad8, Plane::Strain);
    /// Quadratic quadrilateral in plane stress.
    pub const CPS8: Self = Self::standard(Shape::Quad8, Plane::Stress);
    /// Quadratic quadrilateral in plane strain, integrated with 2 x 2 points.
    pub const CPE8R: Self = Self::CPE8.reduced();
    /// Quadratic quadrilateral in plane stress, integrated with 2 x 2 points.
    pub const CPS8R: Self = Self::CPS8.reduced();
    /// Quadratic quadrilateral in plane strain with a linear pressure.
    pub const CPE8H: Self = Self::CPE8.with(Formulation::LinearPressure);
    /// Quadratic quadrilateral in plane strain with a linear pressure, integrated with 2 x 2 points.
    pub const CPE8RH: Self = Self::CPE8.with(Formulation::ReducedLinearPressure);

    /// Ring with the section of a triangle.
    pub const CAX3: Self = Self::standard(Shape::Tri3, Plane::Revolution);
    /// Ring with the section of a quadrilateral.
    pub const CAX4: Self = Self::standard(Shape::Quad4, Plane::Revolution);
    /// Ring with the section of a quadratic triangle.
    pub const CAX6: Self = Self::standard(Shape::Tri6, Plane::Revolution);
    /// Ring with the section of a quadratic quadrilateral.
    pub const CAX8: Self = Self::standard(Shape::Quad8, Plane::Revolution);
    /// Ring with the section of a quadratic quadrilateral, integrated with 2 x 2 points.
    pub const CAX8R: Self = Self::CAX8.reduced();
    /// Ring with the section of a quadrilateral with mean dilatation.
    pub const CAX4H: Self = Self::CAX4.with(Formulation::MeanDilatation);
    /// Ring with the section of a quadrilateral with enhanced strains.
    pub const CAX4I: Self = Self::CAX4.enhanced();
    /// Ring with the section of a quadrilateral with one strain and hourglass stiffness.
    pub const CAX4R: Self = Self::CAX4.reduced();
    /// Ring with the section of a quadratic quadrilateral and a linear pressure.
    pub const CAX8H: Self = Self::CAX8.with(Formulation::LinearPressure);
    /// Ring with the section of a quadratic quadrilateral and a linear pressure, integrated with 2 x 2 points.
    pub const CAX8RH: Self = Self::CAX8.with(Formulation::ReducedLinearPressure);

    /// All types that a deck may name, in the order of their names.
    pub const NAMED: [Self; 27] = [
        Self::CAX3,
        Self::CAX4,
        Self::CAX4H,
        Self::CAX4I,
        Self::CAX4R,
        Self::CAX6,
        Self::CAX8,
        Self::CAX8H,
        Self::CAX8R,
        Self::CAX8RH,
        Self::CPE3,
        Self::CPE4,
        Self::CPE4H,
        Self::CPE4I,
        Self::CPE4R,
        Self::CPE6,
        Self::CPE8,
        Self::CPE8H,
        Self::CPE8R,
        Self::CPE8RH,
        Self::CPS3,
        Self::CPS4,
        Self::CPS4I,
        Self::CPS4R,
        Self::CPS6,
        Self::CPS8,
        Self::CPS8R,
    ];

    /// Most nodes of any of them.
    pub const MOST_NODES: usize = {
        let (mut most, mut k) = (0, 0);
        while k < Self::NAMED.len() {
            let nodes = Self::NAMED[k].shape.topology().nodes;
            most = if nodes > most { nodes } else { most };
            k += 1;
        }
        most
    };

    const fn standard(shape: Shape, plane: Plane) -> Self {
        ElementType {
            shape,
            formulation: Formulation::Displacement,
            plane,
        }
    }

    const fn with(self, formulation: Formulation) -> Self {
        ElementType {
            formulation,
            ..self
        }
    }

    const fn enhanced(self) -> Self {
        self.with(Formulation::Enhanced)
    }

    const fn reduced(self) -> Self {
        self.with(Formulation::Reduced)
    }

    /// The type with this name in upper case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|known| known.name() == name)
    }

    /// Name in the deck.
    pub fn name(self) -> &'static str {
        use Formulation::{
            Enhanced, LinearPressure, MeanDilatation, Reduced, ReducedLinearPressure,
        };
        match (self.shape, self.plane, self.formulation) {
            (Shape::Tri3, Plane::Strain, _) => "CPE3",
            (Shape::Quad4, Plane::Strain, MeanDilatation) => "CPE4H",
            (Shape::Quad4, Plane::Strain, Enhanced) => "CPE4I",
            (Shape::Quad4, Plane::Strain, Reduced) => "CPE4R",
            (Shape::Quad4, Plane::Strain, _) => "CPE4",
            (Shape::Tri6, Plane::Strain, _) => "CPE6",
            (Shape::Quad8, Plane::Strain, LinearPressure) => "CPE8H",
            (Shape::Quad8, Plane::Strain, Reduced) => "CPE8R",
            (Shape::Quad8, Plane::Strain, ReducedLinearPressure) => "CPE8RH",
            (Shape::Quad8, Plane::Strain, _) => "CPE8",
            (Shape::Tri3, Plane::Stress, _) => "CPS3",
            (Shape::Quad4, Plane::Stress, Enhanced) => "CPS4I",
            (Shape::Quad4, Plane::Stress, Reduced) => "CPS4R",
            (Shape::Quad4, Plane::Stress, _) => "CPS4",
            (Shape::Tri6, Plane::Stress, _) => "CPS6",
            (Shape::Quad8, Plane::Stress, Reduced) => "CPS8R",
            (Shape::Quad8, Plane::Stress, _) => "CPS8",
            (Shape::Tri3, Plane::Revolution, _) => "CAX3",
            (Shape::Quad4, Plane::Revolution, MeanDilatation) => "CAX4H",
            (Shape::Quad4, Plane::Revolution, Enhanced) => "CAX4I",
            (Shape::Quad4, Plane::Revolution, Reduced) => "CAX4R",
            (Shape::Quad4, Plane::Revolution, _) => "CAX4",
            (Shape::Tri6, Plane::Revolution, _) => "CAX6",
            (Shape::Quad8, Plane::Revolution, LinearPressure) => "CAX8H",
            (Shape::Quad8, Plane::Revolution, Reduced) => "CAX8R",
            (Shape::Quad8, Plane::Revolution, ReducedLinearPressure) => "CAX8RH",
            (Shape::Quad8, Plane::Revolution, _) => "CAX8",
        }
    }

    /// Whether it has one strain and a potential of its hourglass modes.
    pub fn has_hourglass_modes(&self) -> bool {
        self.formulation == Formulation::Reduced && self.shape == Shape::Quad4
    }

    /// Whether it is an element of a body of revolution.
    pub fn is_ring(self) -> bool {
        self.plane == Plane::Revolution
    }

    /// Whether its strains have a component across the section too: in rings, and with a linear pressure.
    pub fn has_all_strains(self) -> bool {
        let pressures = [
            Formulation::LinearPressure,
            Formulation::ReducedLinearPressure,
        ];
        self.is_ring() || pressures.contains(&self.formulation)
    }

    /// Whether displacements within an element are quadratic: sides have a node between their corners.
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
