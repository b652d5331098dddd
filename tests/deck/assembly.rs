//! Decks with parts and an assembly: the flat model they describe, the names of nodes, sets and
//! surfaces of instances, and the messages.

use std::fs;

use assert_cmd::Command;
use stickslip::diagnostics::Span;
use stickslip::model::{Contact, Model};
use stickslip::output::ResultSummary;
use tempfile::TempDir;

use crate::reading::try_read;

/// Two instances of a part as Abaqus/CAE writes them, one on its end above the other.
const BLOCKS: &str = include_str!("../decks/cae_blocks.inp");

/// The model of a deck, if it has no errors, and its messages.
fn read(text: &str) -> (Option<Model>, String) {
    let (model, _, messages) = try_read(text);
    (model, messages)
}

/// The model of the blocks with a change.
fn blocks(old: &str, new: &str) -> (Option<Model>, String) {
    assert!(BLOCKS.contains(old), "{old}");
    read(&BLOCKS.replacen(old, new, 1))
}

/// The model without the places of its contacts.
fn without_places(model: Model) -> Model {
    let contacts = model.contacts.into_iter().map(|contact| Contact {
        span: Span::default(),
        ..contact
    });
    Model {
        contacts: contacts.collect(),
        ..model
    }
}

#[test]
fn an_assembly_is_the_flat_deck_of_its_instances() {
    let (model, messages) = read(BLOCKS);
    let mut model = model.unwrap_or_else(|| panic!("{messages}"));
    let instances = std::mem::take(&mut model.sets.instances);
    let names: Vec<&str> = instances.iter().map(|i| i.name.as_str()).collect();
    assert_eq!(names, ["Block-1", "Block-2"]);
    assert_eq!(
        (instances[1].first_node, instances[1].first_element),
        (6, 2)
    );
    assert_eq!(instances[1].node_numbers, [1, 2, 3, 4, 5, 6]);
    assert_eq!(instances[1].element_numbers, [1, 2]);
    let (flat, messages) = read(include_str!("../decks/cae_blocks_flat.inp"));
    let flat = flat.unwrap_or_else(|| panic!("{messages}"));
    assert_eq!(without_places(model), without_places(flat));
}

/// A block above a rigid floor with an arc, both in instances that are moved and turned, and without them.
#[test]
fn profiles_move_and_turn_with_their_instances() {
    let rest = |block: &str, floor: &str| {
        format!(
            "*SOLID SECTION, ELSET={block}ALL, MATERIAL=M\n1.\n*RIGID BODY, ANALYTICAL SURFACE={floor}FLOOR, REF NODE={floor}REF\n\
             *MATERIAL, NAME=M\n*ELASTIC\n1000., 0.\n*DENSITY\n1.\n*SURFACE INTERACTION, NAME=DRY\n\
             *CONTACT PAIR, INTERACTION=DRY\n{block}SKIN, {floor}FLOOR\n*BOUNDARY\n{floor}REF, 1, 6\n\
             *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.01, 0.1\n*DSLOAD\n{block}SKIN, P, 1.\n*END STEP\n"
        )
    };
    let block = "*ELEMENT, TYPE=CPE4, ELSET=ALL\n1, 1, 2, 3, 4\n*SURFACE, NAME=SKIN\nALL\n";
    let parts = format!(
        "*PART, NAME=BLOCK\n*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n{block}\
         *SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.\n*END PART\n\
         *PART, NAME=TOOL\n*NODE, NSET=REF\n1, 0., -3.\n*SURFACE, NAME=FLOOR, TYPE=SEGMENTS\n\
         START, -4., -1.\nLINE, 2., -1.\nCIRCL, 3., 0., 2., 0.\n*END PART\n"
    );
    let turn = "1., 2., 0.\n0., 0., 0., 0., 0., 1., 90.\n";
    let instances = format!(
        "*ASSEMBLY, NAME=A\n*INSTANCE, NAME=B, PART=BLOCK\n{turn}*END INSTANCE\n\
         *INSTANCE, NAME=T, PART=TOOL\n{turn}*END INSTANCE\n*END ASSEMBLY\n"
    );
    let section = "*SOLID SECTION, ELSET=B.ALL, MATERIAL=M\n1.\n";
    let (moved, messages) =
        read(&format!("{parts}{instances}{}", rest("B.", "T.")).replace(section, ""));
    let moved = moved.unwrap_or_else(|| panic!("{messages}"));
    // (x, y) is at (-y - 2, x + 1)
    let flat = format!(
        "*NODE\n1, -2., 1.\n2, -2., 2.\n3, -3., 2.\n4, -3., 1.\n{block}*NODE, NSET=REF\n5, 1., 1.\n\
         *SURFACE, NAME=FLOOR, TYPE=SEGMENTS\nSTART, -1., -3.\nLINE, -1., 3.\nCIRCL, -2., 4., -2., 3.\n{}",
        rest("", "")
    );
    let (flat, messages) = read(&flat);
    let flat = flat.unwrap_or_else(|| panic!("{messages}"));
    let near = |a: &[[f64; 2]], b: &[[f64; 2]]| {
        let mut both = a.iter().flatten().zip(b.iter().flatten());
        a.len() == b.len() && both.all(|(a, b)| (a - b).abs() < 1e-14)
    };
    let [a, b] = [&moved, &flat].map(|model| &model.mesh.coordinates[..]);
    assert!(near(a, b), "{a:?}\n{b:?}");
    let kinds =
        |model: &Model| -> Vec<_> { model.surfaces.iter().map(|s| s.kind.clone()).collect() };
    assert_eq!(kinds(&moved), kinds(&flat));
}

#[test]
fn nodes_and_elements_of_instances_are_called_by_both_names() {
    let (model, messages) = read(BLOCKS);
    let model = model.unwrap_or_else(|| panic!("{messages}"));
    assert_eq!(model.mesh.node_labels[10], 11);
    assert_eq!(model.node_name(10), "Block-2.5");
    assert_eq!(model.element_name(1), "Block-1.2");
}

#[test]
fn numbers_at_the_assembly_are_those_of_its_own_nodes() {
    let point = "*Node, nset=Point\n7, 1., 0.\n*Equation\n2\nBlock-1.2, 1, 1., Point, 1, -1.\n";
    let free = BLOCKS.replacen("Fix, ENCASTRE", "Fix, 2\nBlock-1.1, 1\n7, 1, 2", 1);
    let (model, messages) =
        read(&free.replacen("*End Assembly", &format!("{point}*End Assembly"), 1));
    let model = model.unwrap_or_else(|| panic!("{messages}"));
    assert_eq!(model.mesh.node_labels[..2], [8, 9]);
    assert_eq!(model.mesh.node_labels.last(), Some(&7));
    assert_eq!(model.node_name(12), "7");
    assert_eq!(model.equations[0].dof, 2);
    let dofs: Vec<usize> = model.steps[0].supports.iter().map(|s| s.dof).collect();
    assert_eq!(dofs, [0, 1, 3, 5, 24, 25]);
}

#[test]
fn an_instance_may_have_a_mesh_of_its_own() {
    let part = BLOCKS.find("*Node").expect("nodes")..BLOCKS.find("*End Part").expect("part");
    let own = format!("part=Block\n{}*End Instance", &BLOCKS[part.clone()]);
    let mut text = BLOCKS.to_string();
    text.replace_range(part, "");
    let text = text.replacen("part=Block\n*End Instance", &own, 1);
    let second = text.find("*Instance, name=Block-2").expect("second");
    let rows = text[second..].find("*End Instance").expect("end") + second;
    let nodes = own
        .trim_start_matches("part=Block\n")
        .replace("*End Instance", "");
    let text = format!("{}{nodes}{}", &text[..rows], &text[rows..]);
    let (model, messages) = read(&text);
    let model = model.unwrap_or_else(|| panic!("{messages}"));
    let (parts, _) = read(BLOCKS);
    let parts = parts.expect("no errors");
    assert_eq!(without_places(model), without_places(parts));
}

#[test]
fn a_translation_and_a_turn_by_any_angle() {
    let turned = blocks("1.,          90.\n", "-1.,          -30.\n");
    let model = turned.0.unwrap_or_else(|| panic!("{}", turned.1));
    let [x, y] = model.mesh.coordinates[8];
    let (cosine, sine) = (3f64.sqrt() / 2.0, 0.5);
    assert!((x - (1.5 + 2.0 * cosine)).abs() < 1e-15 * x);
    assert!((y - (1.03125 + 2.0 * sine)).abs() < 1e-15 * y);
}

/// Messages of the blocks with each change, one after the other.
fn all_messages(changes: &[(&str, &str)]) -> String {
    let texts = changes.iter().map(|(old, new)| {
        let (_, messages) = blocks(old, new);
        let blocks = messages.split_inclusive("\n\n");
        let messages: String = blocks.filter(|block| !block.contains("[D204]")).collect();
        format!("--- {}\n{messages}", new.lines().next().unwrap_or_default())
    });
    texts.collect()
}

#[test]
fn faults_of_the_structure() {
    insta::assert_snapshot!(all_messages(&[
        ("*End Part\n", ""),
        ("*End Assembly\n", ""),
        ("*End Instance\n", ""),
        ("*Part, name=Block\n", ""),
        ("*Part, name=Block\n", "*Part, name=Brick\n"),
        ("name=Block-2", "name=Block-1"),
        (
            "*Part, name=Block\n",
            "*Part, name=Spare\n*Node\n1, 0., 0.\n*End Part\n*Part, name=Block\n"
        ),
        (
            "*Part, name=Block\n",
            "*Part, name=block\n*End Part\n*Part, name=Block\n"
        ),
        ("*End Part\n", "*Density\n1.\n*End Part\n"),
        ("*End Part\n", "*Boundary\n1, 1\n*End Part\n"),
        (
            "*End Assembly\n",
            "*Solid Section, elset=Block-1.Set-1, material=Steel\n*End Assembly\n"
        ),
        (
            "*End Assembly\n",
            "*End Assembly\n*Nset, nset=Late\nBlock-1.1\n"
        ),
        (
            "*Assembly, name=Assembly\n",
            "*Instance, name=Early, part=Block\n*End Instance\n*Assembly, name=Assembly\n"
        ),
    ]));
}

#[test]
fn placements_out_of_the_plane() {
    insta::assert_snapshot!(all_messages(&[
        ("1.03125,           0.\n", "1.03125,           0.5\n"),
        (
            "1.5,         1.03125,           1.,          90.",
            "1.5,         2.,           1.,          90."
        ),
        ("1.,          90.\n", "1.\n"),
        ("1.,          90.\n", "1.,          90.\n1., 2.\n"),
    ]));
}

#[test]
fn names_and_numbers_that_instances_do_not_have() {
    insta::assert_snapshot!(all_messages(&[
        ("instance=Block-1\n 1, 2, 3", "instance=Block-3\n 1, 2, 3"),
        ("instance=Block-1\n 1, 2, 3", "instance=Block-1\n 1, 2, 30"),
        ("Block-2.3, 1, 0.5", "Block-2.30, 1, 0.5"),
        ("Block-2.3, 1, 0.5", "3, 1, 0.5"),
        ("Block-2.3, 1, 0.5", "Block-2.Set-2, 1, 0.5"),
        ("Block-2.Left, Surf-1", "Left, Surf-1"),
        (
            " Set-1,\n*Elset, elset=_Surf-1_S3",
            " Set-2,\n*Elset, elset=_Surf-1_S3"
        ),
    ]));
}

#[test]
fn a_fault_in_a_part_is_reported_once_with_its_instance() {
    insta::assert_snapshot!(all_messages(&[
        ("2, 2, 3, 6, 5", "2, 2, 3, 6, 50"),
        ("2, 2, 3, 6, 5", "2, 5, 6, 3, 2"),
        ("elset=Set-1, material=Steel", "elset=Set-3, material=Steel"),
        ("elset=Set-1, material=Steel", "elset=Set-1, material=Stel"),
    ]));
}

#[test]
fn sets_of_instances_need_an_assembly() {
    let flat = include_str!("../decks/cae_blocks_flat.inp");
    let (_, messages) = read(&flat.replacen("*Nset, nset=Fix", "*Nset, nset=Fix, instance=B", 1));
    insta::assert_snapshot!(messages);
}

#[test]
fn the_blocks_run_and_their_instances_are_in_the_result() {
    let folder = TempDir::new().expect("folder");
    let path = |name: &str| folder.path().join(name);
    let deck = BLOCKS.replacen("*End Step", "*Monitor, dof=2, node=Block-2.3\n*End Step", 1);
    let deck = deck.replacen("*Dynamic", "*Dynamic, direct", 1);
    fs::write(path("blocks.inp"), deck).expect("deck");
    let mut command = Command::cargo_bin("stickslip").expect("binary");
    let command = command
        .args(["run", "blocks.inp"])
        .current_dir(folder.path());
    let output = command.output().expect("started");
    let screen = String::from_utf8_lossy(&output.stdout);
    assert_eq!(output.status.code(), Some(0), "{screen}");
    assert!(screen.contains("\nmonitor  U2(Block-2.3)\n"), "{screen}");
    let status = fs::read_to_string(path("blocks.sta")).expect("status");
    assert!(
        status
            .lines()
            .nth(1)
            .is_some_and(|l| l.ends_with(" U2(Block-2.3)")),
        "{status}"
    );
    let summary = ResultSummary::read(&path("blocks.vtkhdf")).expect("result");
    assert_eq!((summary.exit_status, summary.increments), (0, 200));
    let file = hdf5::File::open(path("blocks.vtkhdf")).expect("result");
    let numbers = |name: &str| -> Vec<i64> {
        let dataset = file.dataset(&format!("model/{name}")).expect(name);
        dataset.read_raw().expect(name)
    };
    assert_eq!(numbers("instances/Block-2/nodes"), [6, 7, 8, 9, 10, 11]);
    assert_eq!(
        numbers("instances/Block-2/node_numbers"),
        [1, 2, 3, 4, 5, 6]
    );
    assert_eq!(numbers("instances/Block-2/elements"), [2, 3]);
    assert_eq!(numbers("instances/Block-2/element_numbers"), [1, 2]);
    assert_eq!(numbers("node_sets/Fix"), [0, 1, 2]);
    // it has landed and rebounds
    let force = file.dataset("history/contact/Block-2.Left_Surf-1/impulse_sum");
    let force: Vec<f64> = force.expect("contact").read_raw().expect("force");
    assert!(force.iter().any(|&force| force > 0.0));
}
