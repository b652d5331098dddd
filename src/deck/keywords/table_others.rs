//! The table of keywords that are known but not read.

use super::keyword::{Keyword, Status};

const fn ignored(name: &'static str, text: &'static str) -> Keyword {
    Keyword::other(name, Status::Ignored, text)
}

const fn warned(name: &'static str, text: &'static str) -> Keyword {
    Keyword::other(name, Status::Warned, text)
}

const fn refused(name: &'static str, text: &'static str) -> Keyword {
    Keyword::other(name, Status::Refused, text)
}

const PROCEDURE: &str = "Steps are dynamic: use *DYNAMIC.";
const SECTION: &str = "Elements have solid sections: use *SOLID SECTION.";
const CONSTRAINT: &str = "Constraints between nodes are not supported yet.";
const RIGID: &str = "Define it with *SURFACE, TYPE=SEGMENTS and *RIGID BODY.";
const DISCRETE: &str = "Springs, dashpots, masses and connectors are not supported yet.";
const INELASTIC: &str = "Materials are elastic: *ELASTIC, or *HYPERELASTIC, NEO HOOKE.";
const GENERAL: &str = "General contact is that of all exterior faces alike.";
const CONTACT_CHANGE: &str = "Contacts hold for all steps.";
const THERMAL: &str = "There are no temperatures.";
const THERMAL_DATA: &str = "Material data of heat conduction without temperatures.";
const FIELD_LOAD: &str = "Only mechanical loads are supported.";
const OTHER_SOLVER: &str = "Its numbers belong to another solver.";
const UNWRITTEN: &str = "The result file holds everything this program writes.";
const HARMLESS: &str = "It does not touch the answer.";

/// Keywords that are known but not read.
pub(crate) static OTHERS: &[Keyword] = &[
    ignored("PREPRINT", HARMLESS),
    ignored("PHYSICAL CONSTANTS", HARMLESS),
    ignored("FILE FORMAT", HARMLESS),
    ignored("PRINT", HARMLESS),
    ignored(
        "NO ANALYSIS",
        "Use the program's check command to read a deck without running it.",
    ),
    warned("USER SUBROUTINES", "There are no user subroutines."),
    warned("CONTROLS", OTHER_SOLVER),
    warned("SOLVER CONTROLS", OTHER_SOLVER),
    warned("CONTACT CONTROLS", OTHER_SOLVER),
    warned("SECTION CONTROLS", OTHER_SOLVER),
    warned("DIAGNOSTICS", OTHER_SOLVER),
    warned("BULK VISCOSITY", OTHER_SOLVER),
    warned("VARIABLE MASS SCALING", "Masses are not scaled."),
    warned("FIXED MASS SCALING", "Masses are not scaled."),
    warned("ORIENTATION", "Materials are isotropic."),
    warned("FILTER", UNWRITTEN),
    warned("SECTION PRINT", UNWRITTEN),
    warned("SECTION FILE", UNWRITTEN),
    warned("INTEGRATED OUTPUT", UNWRITTEN),
    warned("INCREMENTATION OUTPUT", UNWRITTEN),
    warned("MODAL OUTPUT", UNWRITTEN),
    warned("RADIATION OUTPUT", UNWRITTEN),
    warned(
        "MONITOR",
        "Ask for the history of a node set with *NODE PRINT.",
    ),
    warned("CONDUCTIVITY", THERMAL_DATA),
    warned("SPECIFIC HEAT", THERMAL_DATA),
    warned("EXPANSION", THERMAL_DATA),
    warned("LATENT HEAT", THERMAL_DATA),
    warned("INELASTIC HEAT FRACTION", THERMAL_DATA),
    refused("TRANSFORM", "Directions are those of the axes x and y."),
    refused("SYSTEM", "Give coordinates in the axes x and y."),
    refused("NGEN", "Give all nodes with *NODE."),
    refused("NFILL", "Give all nodes with *NODE."),
    refused("NCOPY", "Give all nodes with *NODE."),
    refused("ELGEN", "Give all elements with *ELEMENT."),
    refused("ELCOPY", "Give all elements with *ELEMENT."),
    refused("PARAMETER", "Write numbers, not parameters."),
    refused("TIE", "Surfaces cannot be tied yet."),
    refused("MPC", CONSTRAINT),
    refused("COUPLING", CONSTRAINT),
    refused("KINEMATIC", CONSTRAINT),
    refused("DISTRIBUTING", CONSTRAINT),
    refused("DISTRIBUTING COUPLING", CONSTRAINT),
    refused("EMBEDDED ELEMENT", CONSTRAINT),
    refused("PRE-TENSION SECTION", CONSTRAINT),
    refused("CYCLIC SYMMETRY MODEL", CONSTRAINT),
    refused("RIGID SURFACE", RIGID),
    refused("SPRING", DISCRETE),
    refused("DASHPOT", DISCRETE),
    refused("MASS", DISCRETE),
    refused("ROTARY INERTIA", DISCRETE),
    refused("GAP", DISCRETE),
    refused("CONNECTOR SECTION", DISCRETE),
    refused("CONNECTOR BEHAVIOR", DISCRETE),
    refused("CONNECTOR MOTION", DISCRETE),
    refused("CONNECTOR LOAD", DISCRETE),
    refused("SUBMODEL", "Submodels are not supported."),
    refused("MODEL CHANGE", CONTACT_CHANGE),
    refused("CHANGE FRICTION", CONTACT_CHANGE),
    refused(
        "IMPERFECTION",
        "Write the imperfect coordinates with *NODE.",
    ),
    refused("MAP SOLUTION", "A run starts from its own deck."),
    refused("USER ELEMENT", "User elements are not supported."),
    refused("SUPERELEMENT", "Substructures are not supported."),
    refused("SHELL SECTION", SECTION),
    refused("BEAM SECTION", SECTION),
    refused("BEAM GENERAL SECTION", SECTION),
    refused("MEMBRANE SECTION", SECTION),
    refused("FLUID SECTION", SECTION),
    refused("COHESIVE SECTION", SECTION),
    refused("SURFACE SECTION", SECTION),
    refused("USER SECTION", SECTION),
    refused("HYPERFOAM", INELASTIC),
    refused("PLASTIC", INELASTIC),
    refused("CYCLIC HARDENING", INELASTIC),
    refused("CREEP", INELASTIC),
    refused("VISCOELASTIC", INELASTIC),
    refused("VISCOUS", INELASTIC),
    refused("DEFORMATION PLASTICITY", INELASTIC),
    refused("MOHR COULOMB", INELASTIC),
    refused("DRUCKER PRAGER", INELASTIC),
    refused("CONCRETE", INELASTIC),
    refused("RATE DEPENDENT", INELASTIC),
    refused("USER MATERIAL", INELASTIC),
    refused("DEPVAR", INELASTIC),
    refused("COMPRESSION ONLY", INELASTIC),
    refused("NO COMPRESSION", INELASTIC),
    refused("NO TENSION", INELASTIC),
    refused("DAMAGE INITIATION", INELASTIC),
    refused("DAMAGE EVOLUTION", INELASTIC),
    refused(
        "MODAL DAMPING",
        "There are no modes: give *DAMPING of the materials.",
    ),
    refused("CONTACT EXCLUSIONS", GENERAL),
    refused("CONTACT INITIALIZATION DATA", GENERAL),
    refused("CONTACT INITIALIZATION ASSIGNMENT", GENERAL),
    refused("CONTACT FORMULATION", GENERAL),
    refused("CONTACT DAMPING", "Contact has no damping."),
    refused(
        "CONTACT INTERFERENCE",
        "Nodes are not moved before the start.",
    ),
    refused("CLEARANCE", "Clearances are those of the mesh."),
    refused("COHESIVE BEHAVIOR", "Surfaces do not stick to each other."),
    refused("GAP CONDUCTANCE", THERMAL),
    refused("GAP HEAT GENERATION", THERMAL),
    refused("TEMPERATURE", THERMAL),
    refused("FIELD", FIELD_LOAD),
    refused("CFLUX", FIELD_LOAD),
    refused("DFLUX", FIELD_LOAD),
    refused("DSFLUX", FIELD_LOAD),
    refused("FILM", FIELD_LOAD),
    refused("SFILM", FIELD_LOAD),
    refused("RADIATE", FIELD_LOAD),
    refused("SRADIATE", FIELD_LOAD),
    refused("BASE MOTION", "Prescribe displacements with *BOUNDARY."),
    refused("INERTIA RELIEF", "Bodies move with their inertia."),
    refused("STATIC", PROCEDURE),
    refused("VISCO", PROCEDURE),
    refused("FREQUENCY", PROCEDURE),
    refused("COMPLEX FREQUENCY", PROCEDURE),
    refused("MODAL DYNAMIC", PROCEDURE),
    refused("BUCKLE", PROCEDURE),
    refused("STEADY STATE DYNAMICS", PROCEDURE),
    refused("RESPONSE SPECTRUM", PROCEDURE),
    refused("RANDOM RESPONSE", PROCEDURE),
    refused("HEAT TRANSFER", PROCEDURE),
    refused("COUPLED TEMPERATURE-DISPLACEMENT", PROCEDURE),
    refused("DYNAMIC TEMPERATURE-DISPLACEMENT", PROCEDURE),
    refused("UNCOUPLED TEMPERATURE-DISPLACEMENT", PROCEDURE),
    refused("ELECTROMAGNETICS", PROCEDURE),
    refused("CFD", PROCEDURE),
    refused("SUBSTRUCTURE GENERATE", PROCEDURE),
    refused("GREEN", PROCEDURE),
    refused("SENSITIVITY", PROCEDURE),
    refused("CRACK PROPAGATION", PROCEDURE),
    refused("ANNEAL", PROCEDURE),
    refused("GEOSTATIC", PROCEDURE),
    refused("SOILS", PROCEDURE),
];
