//! The table of diagnostic codes: identifiers, meanings, causes and cures, grouped by the part of
//! the deck they concern.

macro_rules! codes {
    ($($name:ident $id:literal $meaning:literal $cause:literal $cure:literal)*) => {
        /// Subject of a diagnostic.
        #[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
        pub enum Code {
            $(#[doc = $meaning] $name,)*
        }

        impl Code {
            /// All codes, in the order of their numbers.
            pub const ALL: &'static [Code] = &[$(Code::$name),*];

            /// The number shown in messages, for example `D103`.
            pub fn id(self) -> &'static str {
                match self {
                    $(Code::$name => $id,)*
                }
            }

            /// One sentence on the meaning of the diagnostic code.
            pub fn meaning(self) -> &'static str {
                match self {
                    $(Code::$name => $meaning,)*
                }
            }

            /// Usual cause of the diagnostic, or its consequence.
            pub fn cause(self) -> &'static str {
                match self {
                    $(Code::$name => $cause,)*
                }
            }

            /// Advice on what to do about the diagnostic.
            pub fn cure(self) -> &'static str {
                match self {
                    $(Code::$name => $cure,)*
                }
            }
        }
    };
}

// D1: files, lines, fields. D2: cards and where they stand. D3: mesh, sets, surfaces.
// D4: materials, sections, contact. D5: supports, loads, steps, output.
codes! {
    FileUnreadable "D101" "A deck file cannot be read."
        "The path is misspelt, or is relative to another folder: paths are relative to the including file, then to \
         the main deck."
        "Correct the path after INPUT=, in quotation marks if it has blanks."
    IncludeCycle "D102" "A file includes itself, or files are nested too deeply."
        "An *INCLUDE leads back to a file that is being read."
        "Remove one *INCLUDE of the chain that the message shows."
    UnknownKeyword "D103" "A keyword that no program knows, usually a typing error."
        "Leaving the keyword out could change the answer, so the run stops."
        "Correct the spelling; --lenient leaves unknown keywords out with a warning."
    UnknownParameter "D104" "A parameter that the keyword does not have."
        "The parameter is misspelt, or belongs to another program."
        "Write one of the parameters that the message lists; --lenient leaves unknown parameters out with a warning."
    RepeatedParameter "D105" "A parameter given twice on one keyword line."
        "Only one value can hold, and other programs differ in which one they read."
        "Remove one of the two values."
    MissingParameter "D106" "A required parameter is not given."
        "Without this parameter the keyword has no meaning."
        "Add the parameter; `stickslip explain KEYWORD` shows an example."
    BadValue "D107" "A parameter's value is missing, out of place or not an allowed word."
        "The word is misspelt, or the parameter takes no value."
        "Write one of the words that the message lists."
    BadNumber "D108" "A field is not the number it should be."
        "The field has a letter, lacks a comma, or has a fractional number instead of a whole one; inf and nan are no \
         numbers."
        "Correct the field at the caret."
    MissingField "D109" "A required field of a data line is empty."
        "The line ends too early, or two commas stand side by side."
        "Complete the line; only a field with a default may be empty."
    ExtraField "D110" "A data line has more fields than the keyword reads."
        "The line belongs to another keyword, or two lines run together."
        "Remove the fields from the caret on."
    StrayData "D111" "A data line stands where no data line belongs."
        "The keyword line is missing or allows no data lines; a comment begins with two stars."
        "Write the keyword above the line, or remove the line."
    MissingData "D112" "A keyword lacks its data lines."
        "The lines are missing, or stand under another keyword."
        "Write the data lines below the keyword line."
    BadName "D113" "A name is too long or has characters a name cannot have."
        "A name has at most 80 characters: letters, digits and a few signs."
        "Choose another name."
    EmptyDeck "D114" "The deck holds no keyword."
        "The file is empty, or is not the intended one."
        "Check the path of the deck."
    OpenQuote "D115" "A quotation mark is not closed."
        "Everything behind the quotation mark would belong to the name."
        "Close the quotation."
    LongLine "D116" "A line is longer than other programs read."
        "Abaqus reads 256 characters, and CalculiX cuts a line; both read eight numbers of a line of *AMPLITUDE or \
         *TIME POINTS and leave out the rest."
        "Break the line behind a comma; a keyword line continues on the next line."
    FortranNumber "D117" "A real number has an exponent without its letter."
        "1.+3 is read as 1.E+3, as Fortran programs do; Abaqus refuses it."
        "Write the letter E."
    LongNumber "D118" "A number is longer than other programs read."
        "CalculiX reads the first 20 characters of a field and loses the exponent behind them."
        "Write fewer digits."
    Abbreviation "D119" "A keyword, parameter or value is abbreviated."
        "The abbreviation is unique in this program, but may not be unique in other programs."
        "Write the whole word."
    NonAscii "D120" "A character outside ASCII in a keyword or data line."
        "Other programs may not read the deck."
        "Use the letters A to Z."
    NotText "D121" "A file holds a NUL byte: it is not a text."
        "The file is binary, or a text in UTF-16."
        "Save the deck as ASCII or UTF-8."
    EndlessLine "D122" "A line is longer than the program reads."
        "No deck has a line of 65536 bytes, not even with the values of its parameters: the file is probably not a text."
        "Check that the file is a deck, and cut the line."
    BadExpression "D123" "A parameter cannot be computed."
        "The row of *PARAMETER is not `name = expression`, the expression is not a Python expression, or it has no \
         finite value."
        "Correct the row at the caret; `stickslip explain PARAMETER` lists operators and functions."
    UnknownValue "D124" "A name that stands for no value."
        "`<name>` needs a row of *PARAMETER above it, with the same capitals and small letters."
        "Define the parameter with *PARAMETER, or give it a value with --set name=value."
    UnusedValue "D125" "A parameter that nothing uses."
        "The name of the parameter is misspelt where it should stand, or a plain number stands in its place."
        "Use the parameter as `<name>`, or remove its row."
    UnsupportedKeyword "D201"
        "A known keyword that the program cannot obey, and that would change the answer."
        "The program does not have the feature that the keyword requests."
        "Use the keyword that the message names instead, or remove it if the model does not need it."
    UnsupportedParameter "D202"
        "A known parameter or value that the program cannot obey, and that would change the answer."
        "The program does not have the feature that the parameter requests."
        "Use the parameter or value that the message names instead, or remove it if the model does not need it."
    IgnoredKeyword "D203" "A known keyword that is left out without changing the answer."
        "The keyword concerns the solver or output of another program, or material data that are not used."
        "Nothing need be done; remove the keyword to silence the warning."
    IgnoredParameter "D204" "A parameter or value that is left out or replaced."
        "The parameter or value concerns methods of another program."
        "The message says what the program does instead. If this is acceptable, remove the parameter to silence the \
         warning."
    WrongPlace "D205" "A keyword stands where it has no meaning."
        "Keywords of the model stand before the first step, those of a step between *STEP and *END STEP, constants \
         under their material or interaction."
        "Move the keyword."
    MissingEndStep "D206" "A step is not closed by `*END STEP`."
        "The deck ends within the step, or another step begins; the step is read as if it ended there."
        "Add *END STEP."
    StepStructure "D207" "A step has no procedure, has two procedures, or is not paired with its *END STEP."
        "A step has exactly one *DYNAMIC, and *END STEP closes it."
        "Complete the step."
    RepeatedCard "D208" "A keyword that may appear once appears again."
        "Two cards of this keyword contradict each other."
        "Remove one of the cards."
    AssemblyStructure "D209" "Parts, instances or the assembly are not closed, or nothing uses them."
        "An *END PART, *END INSTANCE or *END ASSEMBLY is missing, cards stand outside these blocks, or a part has no \
         instance."
        "Close every block; parts come first, instances stand in the assembly."
    Placement "D210" "An instance is moved or turned out of the plane."
        "Bodies are plane: a translation has no z, and the axis of a rotation is parallel to z."
        "Correct the data lines of *INSTANCE."
    ChangedDeck "D211" "The deck differs from the deck of the checkpoint."
        "A card or a number has changed since the run began, so results before and after would not belong together."
        "Restore the deck, or run it anew with --overwrite; comments and *RESTART may change."
    EarlierJob "D212" "The deck continues another job, which does not fit."
        "*RESTART, READ reads the model and the previous steps from a checkpoint. The command line names the job of \
         the checkpoint, and STEP= and INC= of the card must be those of the checkpoint."
        "Name the job with --oldjob, and give a checkpoint of that step and increment."
    RepeatedNode "D301" "A node is defined twice with different coordinates."
        "Two meshes with the same numbers are joined, or a line was copied."
        "Renumber the nodes of one mesh."
    NotPlanar "D302" "The nodes do not lie in one plane."
        "The program is for plane bodies: z is the same for all nodes."
        "Project the mesh onto the plane x, y."
    RepeatedElement "D303" "An element number, or the nodes of an element, appear twice."
        "Two meshes with the same numbers are joined, or an element was copied."
        "Renumber or remove one of the elements."
    UndefinedNode "D304" "The deck names a node that does not exist."
        "The number is wrong, or the *NODE line is missing."
        "Correct the number."
    UndefinedElement "D305" "The deck names an element that does not exist."
        "The number is wrong, or the *ELEMENT line is missing."
        "Correct the number."
    UndefinedName "D306"
        "The deck names a set, surface, material, amplitude or interaction that does not exist."
        "The name is misspelt, or belongs to an object of another kind."
        "Write the name that the message suggests, or define the missing object."
    RepeatedName "D307" "A name is defined twice."
        "The program compares names without case and without blanks."
        "Rename one of the two."
    ElementType "D308" "An element type that cannot be used."
        "Elements are CPE3, CPE4, CPE4I, CPE4R, CPE4H, CPE6, CPE8, CPE8H, CPE8R or CPE8RH in plane strain, CPS3, \
         CPS4, CPS4I, CPS4R, CPS6, CPS8 or CPS8R in plane stress, CAX3, CAX4, CAX4H, CAX4I, CAX4R, CAX6, CAX8, CAX8H, \
         CAX8R or CAX8RH around an axis."
        "Mesh with one of these element types."
    BadShape "D309" "An element is clockwise, degenerate or not convex."
        "The nodes are listed in the wrong order, or two nodes coincide."
        "List the nodes counter-clockwise, or mend the mesh."
    UnusedNode "D310" "A node belongs to no element."
        "The node is a left-over of meshing, or its element is missing."
        "Remove the node. Nodes of rigid surfaces and equations need no element and get no warning."
    BadRange "D311" "A generated range runs backwards, or its steps do not meet its last number."
        "The difference of last and first is no multiple of the increment."
        "Correct first, last and increment."
    SetCycle "D312" "A set contains itself."
        "A set lists another set, which lists the first set."
        "Remove one of the two references."
    NoSuchFace "D313" "An element has no face of that number."
        "A triangle has the faces S1 to S3, a quadrilateral S1 to S4."
        "Correct the face; S1 is the side of the first two nodes."
    InteriorFace "D314" "A face of a surface lies inside a body."
        "Two elements share the face, so nothing can touch it."
        "Name faces on the outside; a row without a face names the free faces."
    RepeatedFace "D315" "A face or node stands twice in a surface."
        "Sets of the surface overlap."
        "Remove one of the two rows."
    EmptyMesh "D316" "There are no nodes or no elements."
        "The file with the mesh is not included."
        "Add *NODE and *ELEMENT, or the *INCLUDE."
    EmptySurface "D317" "A surface or set has no members."
        "The sets of the surface are empty, or all their faces are inside a body."
        "Add members, or remove the surface or set."
    LineElement "D318"
        "A line element that is no side of a plane element, or other traces of a mesh generator."
        "There are no trusses and beams: line elements only name sides. Gmsh writes line elements for curves, and \
         CPS3 and CPS4 for surfaces, whatever the physics."
        "Remove line elements that are no sides; write CPE3 and CPE4 for plane strain."
    CoincidentNodes "D319" "Nodes lie at the same place and nothing joins them."
        "Two parts were meshed apart and not merged: there is a crack between them."
        "Merge the nodes, or define contact between the two sides."
    OverlappingElements "D320" "Elements of a body lie over each other."
        "A part was meshed twice, or elements of two meshes share nodes: the body would have its mass and \
         stiffness twice there."
        "Remove one of the elements."
    OverlappingBodies "D321" "Bodies lie over each other."
        "Contact keeps apart bodies that start apart; a body that starts inside another body stays inside."
        "Move the bodies apart, or leave them if they lie in different planes and do not touch."
    Revolution "D322" "A model of bodies of revolution has a feature that it cannot have."
        "The model is the half plane x >= 0 of bodies around the axis x = 0, which move without torsion."
        "Keep x positive, use CAX elements only, and hold the rotation of rigid bodies."
    AxisNode "D323" "A node on the axis of revolution is free to leave the axis."
        "Only a support keeps a node on the axis."
        "Hold the node in direction 1 with *BOUNDARY."
    IncompleteMaterial "D401" "A material lacks a constant."
        "Motion and weight need a density, and stresses need elasticity."
        "Add *DENSITY or *ELASTIC under the *MATERIAL."
    MaterialRange "D402" "A material constant lies outside its range."
        "No material has a constant of this value, or the constant stands in a wrong field."
        "E and density are positive, Poisson's ratio lies above -1 and below 0.5."
    NoSection "D403" "Elements have no section."
        "Without a section elements have neither material nor thickness."
        "Give a *SOLID SECTION with a set that contains the elements."
    TwoSections "D404" "An element has two sections."
        "Two sets with sections overlap."
        "Remove the element from one of the sets."
    Locking "D405" "A nearly incompressible material locks."
        "Elements with few displacements cannot bend at constant volume, so they are too stiff."
        "Use CPE4H, CPE8H, CPE8R, CAX4H, CAX8H or CAX8R."
    ThicknessMismatch "D406" "The two sides of a contact differ in thickness."
        "The contact force acts on different areas of the two sides."
        "Give both sections the same thickness, unless the difference is intended."
    SurfaceUse "D407"
        "A surface cannot be used as it is: slave and master at once, or nodes where faces are \
         needed."
        "A master surface consists of faces, and a pair has two surfaces."
        "Exchange or correct the two names of the pair."
    FrictionRange "D408" "A number of friction lies outside its range."
        "A coefficient, slip rate, pressure or limit is negative, or the rows of a table are not in order."
        "Give numbers of 0 or more; list the slip rates for one pressure after the other; pressures and slip rates \
         increase."
    UnitsHint "D409" "A magnitude that hints at mixed units."
        "The wave speed or gravity is far from the values of real materials in usual units."
        "Check E, density and gravity: with mm, t and s they are about 2E5, 8E-9 and 9810 for \
         steel."
    InitialPenetration "D410" "A slave node starts inside the master body."
        "The bodies overlap in the mesh, often by rounding on curved surfaces."
        "Move the mesh, or give ADJUST= of *CONTACT PAIR, or *CONTACT INITIALIZATION DATA in general contact: both \
         move the nodes without strain."
    GeneralContact "D411"
        "General contact does not treat all exterior faces alike, or stands together with contact pairs."
        "General contact has one surface, ALL_EXTERIOR, and one interaction."
        "Give *CONTACT INCLUSIONS, ALL EXTERIOR, or contact pairs instead."
    Adjusted "D412" "Slave nodes are moved onto the master surface before the start."
        "ADJUST= of *CONTACT PAIR or *CONTACT INITIALIZATION DATA asks for the move. The message says how far the \
         nodes are moved."
        "Check that the largest move is small compared with the elements."
    RigidSurface "D413" "A rigid surface, or its reference node, that cannot be used as it is."
        "The profile is not a chain of lines and arcs, or the reference node is missing, shared or free."
        "Give LINE and CIRCL rows that continue each other, one *RIGID BODY for each surface with a node of its own, \
         and prescribe directions 1 and 2 of that node, or give the body mass."
    NothingFaced "D414" "No node of the slave surface faces the master surface at the start."
        "The names of the pair or the faces are wrong, or the bodies are far apart."
        "Check both surfaces; the pair still acts when the bodies meet."
    Magnitude "D415" "A quantity of the model is too large or too small to be computed with."
        "A product of the numbers of the deck overflows or vanishes."
        "Correct the number, or use units in which numbers are not so extreme."
    BrakedFlight "D417" "Mass-proportional damping of a body without support."
        "ALPHA acts on all velocities, also on the velocity of rigid motion."
        "Damp with BETA, or keep ALPHA if the braking is intended."
    FacingAway "D418" "The master surface faces away from the slave surface."
        "The named faces lie on the other side of the body."
        "Name the faces that face the slave surface."
    FixedSlave "D419" "Most slave nodes are prescribed in both directions."
        "Contact forces on prescribed nodes have no effect."
        "Make the moving body the slave, or keep the order if the obstacle has the finer mesh."
    Tie "D420" "Tied surfaces, and nodes of these surfaces that are not tied."
        "Slave nodes are farther from the master than the tolerance, or follow another tie or a support."
        "Give POSITION TOLERANCE=, or exchange slave and master."
    Coupling "D421" "Nodes that cannot be coupled as the deck says."
        "A node belongs to two couplings, no node is coupled, or the type of the constraint is not known."
        "Put a node into one coupling, name at least one node of a body besides the reference node, and write BEAM, \
         PIN or TIE; single directions are coupled with *EQUATION."
    Interference "D422" "A fit whose overlap cannot be removed as the deck gives it."
        "*CONTACT INTERFERENCE names surfaces without a contact pair, stands in a step in which a fit cannot begin, \
         or nothing overlaps."
        "Name slave and master of a *CONTACT PAIR, put SHRINK into the first step, and let the bodies overlap in the \
         mesh by the interference."
    PreTension "D423" "A pre-tension section that cannot be cut."
        "The surface of the section does not run through a body from side to side, or the node of the section belongs \
         to an element."
        "Let the surface run between elements from one side of the body to the other, with faces on one side of it \
         only, and use a node that no element has."
    ContactChange "D424" "A change of the contacts that cannot be made, or changes nothing."
        "No contact pair has these surfaces, the pair is removed already, or ADD and REMOVE or RESET and *FRICTION \
         contradict each other."
        "Write slave and master as on the data line of *CONTACT PAIR, remove a pair before it is added, and give one \
         of ADD and REMOVE, of RESET and *FRICTION."
    NoDensity "D425" "A material without density in static steps."
        "Static steps without gravity do not use a density; masses in the results are volumes then."
        "Give *DENSITY, if masses are to be read from the results."
    Incompressible "D426" "A hyperelastic material with D1 = 0."
        "Elements with displacements alone need a bulk modulus, so the program uses 10 000 times the shear modulus."
        "Use CPE4H, CPE8H or CPE8R in plane strain, or give D1."
    BothOrders "D427" "Both orders of pairs whose faces lie on each other."
        "The contact conditions of the nodes of both faces are nearly the same, so the complementarity problems are \
         slow to solve. Without TYPE one surface-to-surface contact replaces both orders."
        "Keep one order of each pair, with TYPE=SURFACE TO SURFACE, or use *CONTACT."
    BadDof "D501" "A degree of freedom that plane elements do not have."
        "Directions are 1 and 2; 3 to 6 may be given with value zero."
        "Correct the direction."
    ValueOutsideStep "D502" "A motion is prescribed before the first step."
        "A motion needs the time of a step."
        "Move the row into the step, or give the value 0."
    VelocityOnSupport "D503" "An initial velocity on a prescribed degree of freedom."
        "A node cannot have both an initial velocity and a prescribed motion."
        "Remove the node from one of the two cards."
    RampedSupport "D504" "A prescribed displacement without amplitude grows over the step."
        "A jump would have no finite velocity, so the displacement grows linearly, as in Abaqus."
        "Give an *AMPLITUDE for any other course."
    AmplitudeTable "D505"
        "An amplitude whose times do not increase, or whose numbers make no curve."
        "Two points have the same time, or a line was moved."
        "Sort the points; a jump is two points a short time apart."
    BadIncrement "D506" "The times of a step make no sense."
        "The increment is longer than the step, or not positive."
        "Give increment and duration under *DYNAMIC."
    UnstableScheme "D507" "Weights that make the time integration unstable."
        "SS22 needs THETA1 of at least 0.5, and THETA2 of at least THETA1."
        "Give larger weights."
    BadDirection "D508" "A direction is zero or not of unit length."
        "A magnitude stands in a field for the direction, or the direction is missing."
        "Give the components of a unit vector; other directions are normalised with a warning."
    NoStep "D509" "The deck has no step."
        "There is nothing to compute."
        "Add *STEP, *DYNAMIC and *END STEP."
    OutputTimes "D510" "An output request whose times make no sense."
        "Two ways of choosing the times exclude each other, or a time is not positive."
        "Give one of FREQUENCY, NUMBER INTERVAL, TIME INTERVAL, TIME POINTS."
    ShortIncrement "D511" "The last increment of a step is shortened."
        "The duration is no multiple of the fixed increment."
        "Nothing need be done; an increment that divides the duration avoids the shortened increment."
    NonlinearStep "D512" "A step is geometrically nonlinear although the deck does not ask for it."
        "Displacements are large in this program in any case."
        "Write NLGEOM on the line of *STEP, so that the deck says the same."
    MixedOperation "D513" "OP=NEW and OP=MOD are mixed in one step."
        "The first card of a kind decides for the step."
        "Give all cards of the kind the same OP."
    ConflictingSupport "D514" "A degree of freedom is prescribed twice in a step."
        "Two sets overlap and prescribe different values; the later value holds."
        "Remove the node from one of the sets."
    IgnoredVariable "D515" "An output variable that is not written."
        "The program does not compute this variable, or writes it under another name."
        "Remove the variable; docs/output.md lists the variables that are written."
    ScaledTolerance "D516"
        "A factor of the half-increment residual scales the tolerance of the truncation error."
        "In Abaqus the factor scales a force, so its increments differ."
        "Look at the increments and their errors in the log; a smaller factor makes the increments shorter."
    BadEquation "D517" "An equation between displacements that cannot be used as it is."
        "The first term of the equation has no coefficient, is prescribed, or belongs to another equation."
        "Exchange the terms so that the first term can be eliminated."
    SchemeOption "D518" "An option that the scheme of the time integration does not have."
        "Some options exist for the energy-momentum scheme only."
        "Leave out the option or SCHEME=SS22."
    OutOfProportion "D519"
        "The increment or the duration is out of proportion to the speed of waves."
        "Waves cross the model very often in an increment, or never in the whole step: units are \
         probably mixed."
        "Check E, density, lengths and times; `stickslip check` suggests an increment."
    NothingToDo "D520" "Nothing moves: there is no load, no velocity and no prescribed motion."
        "The cards are missing, or their magnitudes are zero."
        "Give a load, an initial velocity or a motion."
    ShortFeature "D521" "An amplitude rises and falls within one increment."
        "An increment sees the values of the amplitude at its two ends only."
        "Choose shorter increments, or remove the feature from the amplitude."
    StartJump "D522" "A prescribed displacement jumps at the start of a step."
        "The amplitude does not start at the current displacement, which is 0 before the first step."
        "Let the amplitude start at the current displacement, or prescribe the velocity."
    OwnIncrement "D523" "The first increment of a dynamic step is chosen by the program."
        "The first field of *DYNAMIC is empty, as in every EXPLICIT step of Abaqus/CAE. The first increment is then \
         the time of a wave through the shortest side of an element, between 1e-5 and 0.1 of the duration; the other \
         increments follow their truncation error."
        "Nothing need be done; to choose another increment, write it into the first field."
}

#[cfg(test)]
mod tests {
    use super::Code;

    #[test]
    fn numbers_are_unique_and_ordered() {
        assert!(Code::ALL.windows(2).all(|pair| pair[0].id() < pair[1].id()));
        let is_sentence = |text: &str| text.ends_with('.') && !text.contains("  ");
        for code in Code::ALL {
            let texts = [code.meaning(), code.cause(), code.cure()];
            assert!(texts.into_iter().all(is_sentence), "{code:?}");
        }
    }
}
