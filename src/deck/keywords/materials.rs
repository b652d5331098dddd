//! The rows of the keyword table for materials and sections.

use super::common::{NAME, OTHER_NUMBERS, OTHER_SOLVER};
use super::types::{Data, Keyword, Parameter as P, Scope, Unread, Value as V, row};

const ONLY_NEO_HOOKE: &str =
    "only NEO HOOKE is supported: C10, D1 with C10 = mu/2, D1 = 2/K of small strains";
const THERMAL_DATA: &str = "There are no temperatures.";
const SECTION: &str = "Elements have solid sections: use *SOLID SECTION.";
const SOLID: &str = "*SOLID SECTION, ELSET=EBASE, MATERIAL=STEEL\n\
         1.";
const DENSE: &str = "*DENSITY\n\
         7.8E-9";
const INELASTIC: &str = "Materials are elastic: *ELASTIC, or *HYPERELASTIC, NEO HOOKE.";
const ELASTIC: &str = "*ELASTIC\n\
         210000., 0.3";
const DAMPING: &str = "*DAMPING, BETA=1.E-7";

pub(super) static MATERIALS: &[Keyword] = &[
    Keyword::read(
        "MATERIAL",
        Scope::Model,
        Data::None,
        &[
            NAME,
            P::optional("RTOL", OTHER_SOLVER).warned(),
            P::value("STRAIN RATE REGULARIZATION", OTHER_SOLVER).measuring("?").warned(),
            P::optional("SRATE FACTOR", OTHER_SOLVER).warned(),
        ],
        "Begins a material; its constants follow.",
    "*MATERIAL, NAME=STEEL\n\
         *ELASTIC\n\
         210000., 0.3\n\
         *DENSITY\n\
         7.8E-9"),
    Keyword::read(
        "ELASTIC",
        Scope::Block("MATERIAL"),
        Data::Required(&[row("E [force/length^2], nu, temperature")]),
        &[P::choice(
            "TYPE",
            &[
                V::read("ISO", "(default)"),
                V::read("ISOTROPIC", "the same"),
                V::refused("ORTHO", "only isotropic elasticity is supported"),
                V::refused("ORTHOTROPIC", "only isotropic elasticity is supported"),
                V::refused(
                    "ENGINEERING CONSTANTS",
                    "only isotropic elasticity is supported",
                ),
                V::refused("LAMINA", "only isotropic elasticity is supported"),
                V::refused("ANISO", "only isotropic elasticity is supported"),
                V::refused("ANISOTROPIC", "only isotropic elasticity is supported"),
                V::refused("TRACTION", "only isotropic elasticity is supported"),
                V::refused("SHEAR", "only isotropic elasticity is supported"),
            ],
            "symmetry",
        )],
        "E, nu of a St. Venant-Kirchhoff material: its second Piola-Kirchhoff stress is linear in \
         the Green-Lagrange strain, as in CalculiX. Abaqus' law agrees for small strains. In \
         plane strain elements lock from nu = 0.45 on (warning). A temperature in the third field \
         has no effect (warning).",
    "*ELASTIC\n\
         210000., 0.3"),
    Keyword::read(
        "HYPERELASTIC",
        Scope::Block("MATERIAL"),
        Data::Required(&[row("C10 [force/length^2], D1 [length^2/force], temperature")]),
        &[
            P::flag("NEO HOOKE", "the form of the energy; required"),
            P::flag("MOONEY-RIVLIN", ONLY_NEO_HOOKE).refused(),
            P::flag("YEOH", ONLY_NEO_HOOKE).refused(),
            P::flag("OGDEN", ONLY_NEO_HOOKE).refused(),
            P::flag("ARRUDA-BOYCE", ONLY_NEO_HOOKE).refused(),
            P::flag("POLYNOMIAL", ONLY_NEO_HOOKE).refused(),
            P::flag("REDUCED POLYNOMIAL", ONLY_NEO_HOOKE).refused(),
            P::flag("MARLOW", ONLY_NEO_HOOKE).refused(),
            P::flag("VAN DER WAALS", ONLY_NEO_HOOKE).refused(),
            P::flag("USER", ONLY_NEO_HOOKE).refused(),
            P::value("N", "order of other forms"),
            P::flag("TEST DATA INPUT", "give C10 and D1 on the data line").refused(),
            P::value(
                "POISSON",
                "give D1 = 3 (1 - 2 nu)/(2 C10 (1 + nu)) on the data line",
            )
            .refused(),
            P::choice(
                "MODULI",
                &[
                    V::read("INSTANTANEOUS", "(default)"),
                    V::refused("LONG TERM", "materials have no memory"),
                ],
                "moduli that the data line gives",
            ),
        ],
        "C10, D1 of a neo-Hookean material, for large strains in plane strain: U = C10 (Ibar1 - \
         3) + (J - 1)^2/D1. At small strains the shear modulus is mu = 2 C10, and the bulk \
         modulus K = 2/D1. D1 is positive: an incompressible material (D1 = 0) is an error, and \
         so is plane stress. A material has either *ELASTIC or *HYPERELASTIC. Poisson's ratio at \
         small strains is (3 K - 2 mu)/(6 K + 2 mu). Where it is 0.45 or more, elements lock \
         unless their section has FORMULATION=MEAN DILATATION (warning). A temperature in the \
         third field has no effect (warning).",
    "*HYPERELASTIC, NEO HOOKE\n\
         0.5, 0.04"),
    Keyword::read(
        "DENSITY",
        Scope::Block("MATERIAL"),
        Data::Required(&[row("rho [mass/length^3], temperature")]),
        &[],
        "Mass per volume; a temperature in the second field has no effect (warning).",
    "*DENSITY\n\
         7.8E-9"),
    Keyword::read(
        "DAMPING",
        Scope::BlockOrModel("MATERIAL"),
        Data::None,
        &[
            P::value(
                "ALPHA",
                "damping in proportion to the mass: ratio ALPHA/(2 omega) of a mode; also brakes the \
                 free flight of bodies without support (warning)",
            ).measuring("1/time"),
            P::value(
                "BETA",
                "viscosity in proportion to the moduli of shear and volume at small strains: ratio BETA omega/2 of a \
                 mode; none in rigid motion, momenta are kept",
            ).measuring("time"),
            P::value(
                "COMPOSITE",
                "there are no modes to damp: give ALPHA and BETA",
            )
            .refused(),
            P::value(
                "STRUCTURAL",
                "give BETA, which damps in proportion to the rate",
            )
            .refused(),
        ],
        "Damping of a material (Rayleigh): at least one of ALPHA (1/time) and BETA (time), not \
         negative. A card outside materials holds for all materials that have no card of their own. What it dissipates is a term of the energy balance.",
    "*DAMPING, BETA=1.E-7"),
    Keyword::read(
        "SOLID SECTION",
        Scope::Model,
        Data::Rows(&[row("thickness [length = 1]")]),
        &[
            P::value("ELSET", "elements; required"),
            P::value("MATERIAL", "material; required"),
            P::choice(
                "FORMULATION",
                &[
                    V::read("DISPLACEMENT", "strains of the displacements (default)"),
                    V::read(
                        "MEAN DILATATION",
                        "one volume strain per element, for nearly incompressible materials; CPE4 only",
                    ),
                ],
                "how strains follow from the displacements",
            ),
            P::value("CONTROLS", OTHER_SOLVER).warned(),
            P::value("ORIENTATION", "materials are isotropic").refused(),
            P::flag("NODAL THICKNESS", "the thickness is constant").refused(),
            P::flag("COMPOSITE", "an element has one material").refused(),
        ],
        "Material and thickness (default 1) of elements.",
    "*SOLID SECTION, ELSET=EBASE, MATERIAL=STEEL\n\
         1."),
];

/// Keywords that are not read.
pub(super) static UNREAD_MATERIALS: &[Unread] = &[
    Unread::warned(
        "CONDUCTIVITY, SPECIFIC HEAT, EXPANSION, LATENT HEAT, \
         INELASTIC HEAT FRACTION, ELECTRICAL CONDUCTIVITY, MAGNETIC PERMEABILITY, \
         FLUID CONSTANTS, SPECIFIC GAS CONSTANT",
        THERMAL_DATA,
    ),
    Unread::warned("ORIENTATION", "Materials are isotropic."),
    Unread::warned(
        "DISTRIBUTION, DISTRIBUTION TABLE",
        "Materials and sections are uniform.",
    ),
    Unread::warned("USER OUTPUT VARIABLES", "There are no user subroutines."),
    Unread::warned("SECTION CONTROLS", OTHER_NUMBERS),
    Unread::refused(
        "SHELL SECTION, SHELL GENERAL SECTION, BEAM SECTION, \
         BEAM GENERAL SECTION, MEMBRANE SECTION, TRUSS SECTION, FRAME SECTION, \
         FLUID SECTION, COHESIVE SECTION, GASKET SECTION, SURFACE SECTION, REBAR LAYER, \
         USER SECTION",
        SECTION,
    )
    .example(SOLID),
    Unread::refused(
        "NODAL THICKNESS",
        "The thickness of a section is constant: give it under *SOLID SECTION.",
    )
    .example(SOLID),
    Unread::refused("NONSTRUCTURAL MASS", "Masses are those of the densities.").example(DENSE),
    Unread::refused(
        "HYPERFOAM, HYPOELASTIC, PLASTIC, CYCLIC HARDENING, CREEP, \
         VISCOELASTIC, VISCOUS, DEFORMATION PLASTICITY, MOHR COULOMB, \
         MOHR COULOMB HARDENING, DRUCKER PRAGER, DRUCKER PRAGER HARDENING, CAP PLASTICITY, \
         CLAY PLASTICITY, CRUSHABLE FOAM, CONCRETE, CONCRETE DAMAGED PLASTICITY, \
         BRITTLE CRACKING, CAST IRON PLASTICITY, POROUS METAL PLASTICITY, RATE DEPENDENT, \
         EOS, USER MATERIAL, DEPVAR, COMPRESSION ONLY, NO COMPRESSION, NO TENSION, \
         DAMAGE INITIATION, DAMAGE EVOLUTION, DAMAGE STABILIZATION, SHEAR FAILURE, \
         TENSILE FAILURE, MULLINS EFFECT",
        INELASTIC,
    )
    .example(ELASTIC),
    Unread::refused(
        "MODAL DAMPING",
        "There are no modes: give *DAMPING of the materials.",
    )
    .example(DAMPING),
    Unread::refused("GLOBAL DAMPING", "Give *DAMPING of the materials.").example(DAMPING),
];
