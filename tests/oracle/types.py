"""The element types that the oracle knows, by their numbers in result files."""

from dataclasses import dataclass

from oracle.block import Block
from oracle.enhanced import EnhancedBlock
from oracle.reduced import ReducedBlock
from oracle.rings import RingBlock
from oracle.whole import EnhancedRingBlock, PressureBlock, ReducedRingBlock


@dataclass(frozen=True)
class ElementType:
    """A type of elements."""

    nodes: int
    block: type[Block] = Block
    """What computes its energies and forces."""
    plane_stress: bool = False
    mean_dilatation: bool = False
    is_reduced: bool = False
    """Whether it has the points of a shape with fewer nodes."""
    is_ring: bool = False
    functions: int = 0
    """Number of functions of a volume ratio of its own."""
    has_hourglass_modes: bool = False


TYPES = {
    0: ElementType(3),
    1: ElementType(4),
    2: ElementType(3, plane_stress=True),
    3: ElementType(4, plane_stress=True),
    4: ElementType(4, mean_dilatation=True),
    5: ElementType(6),
    6: ElementType(6, plane_stress=True),
    7: ElementType(8),
    8: ElementType(8, plane_stress=True),
    9: ElementType(8, is_reduced=True),
    10: ElementType(8, plane_stress=True, is_reduced=True),
    11: ElementType(3, RingBlock, is_ring=True),
    12: ElementType(4, RingBlock, is_ring=True),
    13: ElementType(6, RingBlock, is_ring=True),
    14: ElementType(8, RingBlock, is_ring=True),
    15: ElementType(8, RingBlock, is_reduced=True, is_ring=True),
    16: ElementType(4, EnhancedBlock),
    17: ElementType(4, EnhancedBlock, plane_stress=True),
    18: ElementType(4, ReducedBlock, has_hourglass_modes=True),
    19: ElementType(4, ReducedBlock, plane_stress=True, has_hourglass_modes=True),
    20: ElementType(8, PressureBlock, functions=3),
    21: ElementType(8, PressureBlock, is_reduced=True, functions=3),
    22: ElementType(4, PressureBlock, is_ring=True, functions=1),
    23: ElementType(4, EnhancedRingBlock, is_ring=True),
    24: ElementType(4, ReducedRingBlock, is_ring=True, has_hourglass_modes=True),
    25: ElementType(8, PressureBlock, is_ring=True, functions=3),
    26: ElementType(8, PressureBlock, is_reduced=True, is_ring=True, functions=3),
}
