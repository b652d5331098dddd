//! The table of diagnostic codes: identifiers and meanings, grouped by the part of the deck they
//! concern.

macro_rules! codes {
    ($($name:ident $id:literal $meaning:literal)*) => {
        /// Subject of a diagnostic.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $meaning] $name,)*
        }

        impl Code {
            /// All codes, in the order of their numbers.
            pub const ALL: &'static [Code] = &[$(Code::$name),*];

            /// The number shown in messages, such as `D103`.
            pub fn id(self) -> &'static str {
                match self {
                    $(Code::$name => $id,)*
                }
            }

            /// One sentence on what the code stands for.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Code::$name => $meaning,)*
                }
            }
        }
    };
}

// D1: files, lines, fields. D2: cards and where they stand. D3: mesh, sets, surfaces.
// D4: materials, sections, contact. D5: supports, loads, steps, output.
codes! {
    FileUnreadable "D101" "A deck file cannot be read."
    IncludeCycle "D102" "A file includes itself, or files are nested too deeply."
    UnknownKeyword "D103" "A keyword that no code knows, usually a typing error."
    UnknownParameter "D104" "A parameter that the keyword does not have."
    RepeatedParameter "D105" "A parameter given twice on one keyword line."
    MissingParameter "D106" "A required parameter is not given."
    BadValue "D107" "A parameter's value is missing, out of place or not one of those allowed."
    BadNumber "D108" "A field is not the number it should be."
    MissingField "D109" "A required field of a data line is empty."
    ExtraField "D110" "A data line has more fields than the keyword reads."
    StrayData "D111" "A data line stands where none belongs."
    MissingData "D112" "A keyword lacks its data lines."
    BadName "D113" "A name is too long or has characters a name cannot have."
    EmptyDeck "D114" "The deck holds no keyword."
    OpenQuote "D115" "A quotation mark is not closed."
    LongLine "D116" "A line is longer than other codes read."
    FortranNumber "D117" "A real number has an exponent without its letter."
    LongNumber "D118" "A number is longer than other codes read."
    Abbreviation "D119" "A keyword, parameter or value is abbreviated."
    NonAscii "D120" "A character outside ASCII in a keyword or data line."
    NotText "D121" "A file holds a NUL byte: it is not a text."
    EndlessLine "D122" "A line is longer than the program reads."
    UnsupportedKeyword "D201" "A known keyword that cannot be honoured and would change the answer."
    UnsupportedParameter "D202"
        "A known parameter or value that cannot be honoured and would change the answer."
    IgnoredKeyword "D203" "A known keyword that is left out without changing the answer."
    IgnoredParameter "D204" "A parameter or value that is left out or replaced."
    WrongPlace "D205" "A keyword stands where it has no meaning."
    MissingEndStep "D206" "A step is not closed by `*END STEP`."
    StepStructure "D207" "Steps without a procedure, with two, or not paired with their ends."
    RepeatedCard "D208" "A keyword that may appear once appears again."
    AssemblyStructure "D209" "Parts, instances or the assembly are not closed, or of no use."
    Placement "D210" "An instance is moved or turned out of the plane."
    RepeatedNode "D301" "A node is defined twice with different coordinates."
    NotPlanar "D302" "The nodes do not lie in one plane."
    RepeatedElement "D303" "An element number, or the nodes of an element, appear twice."
    UndefinedNode "D304" "A node is named that does not exist."
    UndefinedElement "D305" "An element is named that does not exist."
    UndefinedName "D306"
        "A set, surface, material, amplitude or interaction is named that does not exist."
    RepeatedName "D307" "A name is defined twice."
    ElementType "D308" "An element type that cannot be used."
    BadShape "D309" "An element is clockwise, degenerate or not convex."
    UnusedNode "D310" "A node belongs to no element."
    BadRange "D311" "A generated range does not meet its end or has no direction."
    SetCycle "D312" "A set contains itself."
    NoSuchFace "D313" "An element has no face of that number."
    InteriorFace "D314" "A face of a surface lies inside a body."
    RepeatedFace "D315" "A face or node stands twice in a surface."
    EmptyMesh "D316" "There are no nodes or no elements."
    EmptySurface "D317" "A surface or set has no members."
    LineElement "D318" "A line element, which only names a side of a plane element."
    CoincidentNodes "D319" "Nodes lie at the same place and nothing joins them."
    IncompleteMaterial "D401" "A material lacks a constant."
    MaterialRange "D402" "A material constant lies outside its range."
    NoSection "D403" "Elements have no section."
    TwoSections "D404" "An element has two sections."
    Locking "D405" "A nearly incompressible material in plane strain locks."
    ThicknessMismatch "D406" "The two sides of a contact differ in thickness."
    SurfaceUse "D407"
        "A surface cannot be used as it is: slave and master at once, or nodes where faces are needed."
    FrictionRange "D408" "A friction coefficient lies outside its range."
    UnitsHint "D409" "A magnitude that hints at mixed units."
    InitialPenetration "D410" "A slave node starts inside the master body."
    GeneralContact "D411" "General contact of other than all exterior faces alike, or pairs beside it."
    Adjusted "D412" "Slave nodes are moved onto the master surface before the start."
    RigidSurface "D413" "A rigid surface, or its reference node, that cannot be used as it is."
    NothingFaced "D414" "No node of the slave surface faces the master surface at the start."
    Magnitude "D415" "A quantity of the model is too large or too small to be computed with."
    PlaneStrainOnly "D416" "A material that is for plane strain only in plane stress elements."
    BrakedFlight "D417" "Mass-proportional damping of a body without support."
    FacingAway "D418" "The master surface looks away from the slave surface."
    FixedSlave "D419" "Most slave nodes are prescribed in both directions."
    BadDof "D501" "A degree of freedom that plane elements do not have."
    ValueOutsideStep "D502" "A motion is prescribed before the first step."
    VelocityOnSupport "D503" "An initial velocity on a prescribed degree of freedom."
    RampedSupport "D504" "A prescribed displacement without amplitude grows over the step."
    AmplitudeTable "D505" "An amplitude whose times do not increase, or whose numbers make no curve."
    BadIncrement "D506" "The times of a step make no sense."
    UnstableScheme "D507" "Weights that make the time integration unstable."
    BadDirection "D508" "A direction is zero or not of unit length."
    NoStep "D509" "The deck has no step."
    OutputTimes "D510" "An output request whose times make no sense."
    ShortIncrement "D511" "The last increment of a step is shortened."
    NonlinearStep "D512" "A step is geometrically nonlinear although the deck does not ask for it."
    MixedOperation "D513" "OP=NEW and OP=MOD are mixed in one step."
    ConflictingSupport "D514" "A degree of freedom is prescribed twice in a step."
    IgnoredVariable "D515" "An output variable that is not written."
    ConstantIncrement "D516" "Increments do not grow, although the step lets them."
    BadEquation "D517" "An equation between displacements that cannot be used as it is."
    SchemeOption "D518" "An option that the scheme of the time integration does not have."
    OutOfProportion "D519" "The increment or the duration is out of proportion to the speed of waves."
    NothingToDo "D520" "Nothing moves: there is no load, no velocity and no prescribed motion."
}

#[cfg(test)]
mod tests {
    use super::Code;

    #[test]
    fn numbers_are_unique_and_ordered() {
        assert!(Code::ALL.windows(2).all(|pair| pair[0].id() < pair[1].id()));
        assert!(Code::ALL.iter().all(|code| code.meaning().ends_with('.')));
    }
}
