//! Two cards that move the same node, loads of directions that nothing has, results of one name: errors that name both.

use crate::reading::try_read;

/// Three blocks beside each other, with nodes of their own.
const BLOCKS: &str = "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n5, 2., 0.\n6, 2., 1.\n7, 3., 0.\n8, 3., 1.\n\
    90, 9., 9.\n91, 9., 8.\n92, .5, .5\n*ELEMENT, TYPE=CPE4, ELSET=A\n1, 1, 2, 3, 4\n*ELEMENT, TYPE=CPE4, ELSET=B\n\
    2, 2, 5, 6, 3\n*ELEMENT, TYPE=CPE4, ELSET=C\n3, 5, 7, 8, 6\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
    *SOLID SECTION, ELSET=A, MATERIAL=M\n*SOLID SECTION, ELSET=B, MATERIAL=M\n*SOLID SECTION, ELSET=C, MATERIAL=M\n\
    *SURFACE, NAME=LEFT\n1, S4\n*SURFACE, NAME=RIGHT\n3, S2\n*SURFACE, NAME=CUT\n1, S2\n";

/// Messages of the blocks with more cards, in the model and in a dynamic step.
fn messages(model: &str, step: &str) -> String {
    let text = format!(
        "{BLOCKS}{model}*STEP, NLGEOM\n*DYNAMIC, DIRECT\n.01, .1\n*DLOAD\n, GRAV, 1., 0., -1.\n{step}*END STEP\n"
    );
    let (model, d, messages) = try_read(&text);
    assert_eq!(model.is_some(), !d.has_errors());
    messages
}

/// Cards of the model, of the step, and what the messages hold.
const FAULTS: [(&str, &str, &[&str]); 16] = [
    (
        "*RIGID BODY, ELSET=A, REF NODE=90\n*RIGID BODY, ELSET=B, REF NODE=91\n",
        "",
        &[
            "D413",
            "node 2 belongs to the rigid body A and to the rigid body B",
            "the rigid body A stands at deck.inp:",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=90\n*RIGID BODY, ELSET=C, REF NODE=1\n",
        "",
        &[
            "D413",
            "node 1 belongs to the rigid body A and to the rigid body C",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=90\n*RIGID BODY, ELSET=A, REF NODE=90\n",
        "",
        &[
            "D413",
            "the rigid body A stands on two cards",
            "note: the rigid body A stands at",
        ],
    ),
    (
        "*COUPLING, CONSTRAINT NAME=D, REF NODE=90, SURFACE=LEFT\n*KINEMATIC\n\
         *COUPLING, CONSTRAINT NAME=D, REF NODE=91, SURFACE=RIGHT\n*KINEMATIC\n",
        "",
        &[
            "D307",
            "the coupling D has the name of the coupling D: the results of both would be rigid/D",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=90\n*COUPLING, CONSTRAINT NAME=A, REF NODE=91, SURFACE=RIGHT\n*KINEMATIC\n",
        "",
        &["D307", "the coupling A has the name of the rigid body A"],
    ),
    (
        "*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n",
        "*CLOAD\n90, 2, 5.\n",
        &[
            "D501",
            "this force acts in direction 2 of node 90",
            "the *PRE-TENSION SECTION stands at",
        ],
    ),
    (
        "*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n",
        "*BOUNDARY\n90, 2, 2, 0.1\n",
        &[
            "D501",
            "this motion is prescribed in direction 2 of node 90",
        ],
    ),
    (
        "*EQUATION\n2\n1, 1, 1., 90, 1, -1.\n",
        "*CLOAD\n90, 2, 7.\n",
        &[
            "D501",
            "this force acts in direction 2 of node 90, which the node does not have",
        ],
    ),
    (
        "*EQUATION\n2\n1, 1, 1., 90, 1, -1.\n*INITIAL CONDITIONS, TYPE=VELOCITY\n90, 2, 7.\n",
        "",
        &["D501", "this velocity is given in direction 2 of node 90"],
    ),
    (
        "*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n*RIGID BODY, ELSET=C, REF NODE=90\n",
        "",
        &[
            "D413",
            "node 90 belongs to the *PRE-TENSION SECTION and to the rigid body C",
        ],
    ),
    (
        "*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n0., 1.\n",
        "",
        &["D423", "the normal of the section lies along its faces"],
    ),
    (
        "*PRE-TENSION SECTION, NODE=90, SURFACE=CUT\n1., 0.\n0., 1.\n",
        "",
        &["D111", "has one data line, the normal"],
    ),
    (
        "*EQUATION\n2\n1, 1, 1., 7, 1, -1.\n2\n1, 1, 1., 8, 1, -1.\n",
        "",
        &[
            "D517",
            "direction 1 of node 1 follows other nodes twice: by an *EQUATION and by an *EQUATION",
            "stands at deck.inp:",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=92\n*EQUATION\n2\n1, 1, 1., 7, 1, -1.\n",
        "",
        &[
            "D517",
            "this equation has a node of the rigid body A",
            "the rigid body A stands at",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=92\n",
        "*CLOAD\n1, 6, 7.\n",
        &[
            "D501",
            "nodes that ride on the rigid body A have no direction 6",
            "node 92",
        ],
    ),
    (
        "*RIGID BODY, ELSET=A, REF NODE=90\n*RIGID BODY, ELSET=C, REF NODE=91\n*NODE\n93, 5., 5.\n94, 5., 5.\n95, 6., 5.\n96, 6., 5.\n\
         *KINEMATIC COUPLING, REF NODE=90, NAME=K\n93, 1, 2\n95, 1, 2\n*KINEMATIC COUPLING, REF NODE=91, NAME=L\n94, 1, 2\n96, 1, 2\n\
         *MPC\nPIN, 93, 94\nPIN, 95, 96\n",
        "",
        &[
            "D421",
            "the hinge of nodes 95 and 96 holds in step 1 what other hinges or supports hold already",
        ],
    ),
];

#[test]
fn two_cards_that_move_one_node_are_an_error_that_names_both() {
    for (model, step, words) in FAULTS {
        let text = messages(model, step);
        for word in words {
            assert!(text.contains(word), "{model}{step}: {word}\n{text}");
        }
    }
}

#[test]
fn two_orders_of_a_pair_with_different_friction_are_told() {
    let pairs = |second: &str| {
        format!(
            "*SURFACE INTERACTION, NAME=I\n*FRICTION\n0.1\n*SURFACE INTERACTION, NAME=J\n*FRICTION\n0.2\n\
             *CONTACT PAIR, INTERACTION=I\nLEFT, RIGHT\n*CONTACT PAIR, INTERACTION={second}\nRIGHT, LEFT\n"
        )
    };
    let [same, different] = ["I", "J"].map(|second| messages(&pairs(second), ""));
    assert!(!same.contains("different friction"), "{same}");
    assert!(
        different.contains("warning[D427]: both orders of this pair have different friction"),
        "{different}"
    );
    assert!(
        different.contains("the other order stands at"),
        "{different}"
    );
}
