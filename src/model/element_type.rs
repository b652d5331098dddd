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
    pub const CPE4H: Self = ElementType {
        formulation: Formulation::MeanDilatation,
        ..Self::CPE4
    };

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

    /// All types that a deck may name, in the order of their names.
    pub const NAMED: [Self; 20] = [
        Self::CAX3,
        Self::CAX4,
        Self::CAX6,
        Self::CAX8,
        Self::CAX8R,
        Self::CPE3,
        Self::CPE4,
        Self::CPE4H,
        Self::CPE4I,
        Self::CPE4R,
        Self::CPE6,
        Self::CPE8,
        Self::CPE8R,
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

    const fn enhanced(self) -> Self {
        ElementType {
            formulation: Formulation::Enhanced,
            ..self
        }
    }

    const fn reduced(self) -> Self {
        ElementType {
            formulation: Formulation::Reduced,
            ..self
        }
    }

    /// The type with this name in upper case.
    pub fn from_name(name: &str) -> Option<Self> {
        Self::NAMED.into_iter().find(|known| known.name() == name)
    }

    /// Name in the deck.
    pub fn name(self) -> &'static str {
        let reduced = self.formulation == Formulation::Reduced;
        let mean = self.formulation == Formulation::MeanDilatation;
        let enhanced = self.formulation == Formulation::Enhanced;
        match (self.shape, self.plane) {
            (Shape::Tri3, Plane::Strain) => "CPE3",
            (Shape::Quad4, Plane::Strain) if mean => "CPE4H",
            (Shape::Quad4, Plane::Strain) if enhanced => "CPE4I",
            (Shape::Quad4, Plane::Strain) if reduced => "CPE4R",
            (Shape::Quad4, Plane::Strain) => "CPE4",
            (Shape::Tri6, Plane::Strain) => "CPE6",
            (Shape::Quad8, Plane::Strain) if reduced => "CPE8R",
            (Shape::Quad8, Plane::Strain) => "CPE8",
            (Shape::Tri3, Plane::Stress) => "CPS3",
            (Shape::Quad4, Plane::Stress) if enhanced => "CPS4I",
            (Shape::Quad4, Plane::Stress) if reduced => "CPS4R",
            (Shape::Quad4, Plane::Stress) => "CPS4",
            (Shape::Tri6, Plane::Stress) => "CPS6",
            (Shape::Quad8, Plane::Stress) if reduced => "CPS8R",
            (Shape::Quad8, Plane::Stress) => "CPS8",
            (Shape::Tri3, Plane::Revolution) => "CAX3",
            (Shape::Quad4, Plane::Revolution) => "CAX4",
            (Shape::Tri6, Plane::Revolution) => "CAX6",
            (Shape::Quad8, Plane::Revolution) if reduced => "CAX8R",
            (Shape::Quad8, Plane::Revolution) => "CAX8",
        }
    }

    /// Whether it is an element of a body of revolution.
    pub fn is_ring(self) -> bool {
        self.plane == Plane::Revolution
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
