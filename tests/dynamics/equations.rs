//! Equations between displacements: tied meshes, sliders, levers, control nodes and prescribed
//! terms, with contact on both bodies.

use stickslip::dynamics::IncrementReport;
use stickslip::model::{
    Amplitude, Curve, Equation, Load, Model, PointLoad, Scheme, Support, SupportMotion, TimeBase,
    Variation,
};

use crate::blocks::{
    Block, SCHEMES, add_block, add_contact, fixed, model, run_to_end, settings, step, throw,
};
use crate::energies::{largest, unbalanced};
use crate::reading::read;

/// Adds u_dof = sum c u_k.
fn follow(model: &mut Model, dof: usize, terms: Vec<(usize, f64)>) {
    model.equations.push(Equation { dof, terms });
    model.equations.sort_by_key(|equation| equation.dof);
}

fn size(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, value| value.abs().max(most))
}

/// Balance of the ledger, the equations themselves, and reactions at supports alone.
fn assert_exact(model: &Model, reports: &[IncrementReport]) {
    let balance = unbalanced(reports);
    assert!(balance <= 1e-10, "{balance:e}");
    let supports = &model.steps[0].supports;
    for report in reports {
        for of in [&report.state.u, &report.state.v, &report.state.a] {
            for Equation { dof, terms } in &model.equations {
                let sum: f64 = terms.iter().map(|&(to, c)| c * of[to]).sum();
                assert!(
                    (of[*dof] - sum).abs() <= 1e-13 * size(of),
                    "{} {sum}",
                    of[*dof]
                );
            }
        }
        for (dof, reaction) in report.nodal.reaction.iter().enumerate() {
            let is_support = supports.iter().any(|support| support.dof == dof);
            assert!(is_support || *reaction == 0.0, "{dof}: {reaction:e}");
        }
    }
}

/// A fixed base below y = 0; its supports.
fn add_base(model: &mut Model, length: f64) -> (Block, Vec<Support>) {
    let base = add_block(model, [-1.0, -1.0], [length, 1.0], (5, 1), 0.0);
    let held = base.nodes().flat_map(|n| [2 * n, 2 * n + 1]).map(fixed);
    let held = held.collect();
    (base, held)
}

/// Gives the nodes of a block a velocity that turns and stretches it.
fn stir(model: &mut Model, block: &Block) {
    throw(model, block, [1.5, -3.0], 2.0, [1.0, 1.0]);
    for node in block.nodes() {
        let [x, y] = model.mesh.coordinates[node];
        model.initial_velocity[2 * node] += 2.0 * (x - 1.0) * y;
    }
}

#[test]
fn blocks_tied_along_an_interface_move_as_one_mesh() {
    for scheme in SCHEMES {
        let run_with = |tied: bool| {
            let mut model = model(2000.0, 0.3, 1.0);
            let (base, held) = add_base(&mut model, 6.0);
            let lower = |model: &mut Model, rows| {
                let height = 0.5 * rows as f64;
                add_block(model, [0.0, 0.05], [2.0, height], (4, rows), 0.0)
            };
            let (below, above) = match tied {
                false => (lower(&mut model, 4), None),
                true => {
                    let below = lower(&mut model, 2);
                    let above = add_block(&mut model, [0.0, 1.05], [2.0, 1.0], (4, 2), 0.0);
                    (below, Some(above))
                }
            };
            stir(&mut model, &below);
            if let Some(above) = &above {
                stir(&mut model, above);
                for k in 0..=4 {
                    let (upper, lower) = (above.node(k, 0), below.node(k, 2));
                    for i in 0..2 {
                        follow(&mut model, 2 * upper + i, vec![(2 * lower + i, 1.0)]);
                    }
                }
            }
            add_contact(&mut model, below.faces(0), base.faces(2), 0.3);
            model.steps = vec![step(0.005, 30, settings(scheme), held)];
            let (keep, _) = run_to_end(&model);
            assert_exact(&model, &keep.reports);
            let nodes: Vec<usize> = match &above {
                None => below.nodes().collect(),
                Some(above) => below.nodes().chain(above.nodes().skip(5)).collect(),
            };
            let of_nodes = |r: &IncrementReport| -> Vec<[f64; 4]> {
                let [u, v] = [&r.state.u, &r.state.v];
                let at = |&n: &usize| [u[2 * n], u[2 * n + 1], v[2 * n], v[2 * n + 1]];
                nodes.iter().map(at).collect()
            };
            assert!(keep.reports.iter().any(|r| r.contacts[0].closed > 0));
            keep.reports.iter().map(of_nodes).collect::<Vec<_>>()
        };
        let [one, tied] = [false, true].map(run_with);
        assert_eq!(one.len(), tied.len());
        for quantity in [[0, 1], [2, 3]] {
            let all = || one.iter().zip(&tied).flat_map(|(p, q)| p.iter().zip(q));
            let most = |f: fn(f64, f64) -> f64| {
                let each = all().flat_map(|(p, q)| quantity.map(|i| f(p[i], q[i]).abs()));
                each.fold(0.0, f64::max)
            };
            let (difference, scale) = (most(|p, q| p - q), most(|p, _| p));
            assert!(difference <= 1e-9 * scale, "{difference:e} of {scale:e}");
        }
    }
}

/// Two blocks of masses 2 and 3, and the x dofs of both.
fn two_blocks() -> (Model, [Vec<usize>; 2]) {
    let mut model = model(1000.0, 0.3, 1.0);
    let first = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (2, 1), 0.0);
    let second = add_block(&mut model, [5.0, 0.0], [3.0, 1.0], (2, 1), 0.0);
    let along = |block: &Block| block.nodes().map(|n| 2 * n).collect::<Vec<_>>();
    let dofs = [along(&first), along(&second)];
    (model, dofs)
}

fn force(dof: usize, magnitude: f64) -> Load<PointLoad> {
    Load {
        at: PointLoad { dof },
        magnitude,
        variation: Variation::Constant,
    }
}

#[test]
fn a_slider_or_lever_shares_a_force_by_its_coefficient() {
    for (scheme, c) in SCHEMES
        .into_iter()
        .flat_map(|s| [1.0, -2.5, 0.25].map(|c| (s, c)))
    {
        let (mut model, [first, second]) = two_blocks();
        // all of the first block along x as its first node; the second c times as far
        for &dof in &first[1..] {
            follow(&mut model, dof, vec![(first[0], 1.0)]);
        }
        for &dof in &second {
            follow(&mut model, dof, vec![(first[0], c)]);
        }
        let mut step = step(0.01, 50, settings(scheme), Vec::new());
        step.point_loads = vec![force(first[3], 7.0)];
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        let last = keep.reports.last().unwrap();
        // (m_1 + c² m_2) a = F
        let acceleration = 7.0 / (2.0 + c * c * 3.0);
        let v = acceleration * 0.5;
        assert!((last.state.v[first[5]] - v).abs() < 1e-10 * v);
        assert!((last.state.v[second[2]] - c * v).abs() < 1e-10 * v);
    }
}

#[test]
fn forces_in_the_ratio_of_a_lever_are_in_equilibrium() {
    for scheme in SCHEMES {
        let (mut model, [first, second]) = two_blocks();
        let (a, b) = (first[2], second[1]);
        follow(&mut model, a, vec![(b, -3.0)]);
        let mut step = step(0.01, 20, settings(scheme), Vec::new());
        // work of both forces: 5 u_a + 15 u_b = 0
        step.point_loads = vec![force(a, 5.0), force(b, 15.0)];
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        for report in &keep.reports[1..] {
            assert!(size(&report.state.u) < 1e-14);
            assert_eq!(size(&report.nodal.reaction), 0.0);
        }
    }
}

/// Two blocks thrown on a base with friction, joined by u_x = c u_x between one node of each.
fn thrown(scheme: Scheme, c: f64) -> Model {
    let mut model = model(2000.0, 0.3, 1.0);
    let (base, held) = add_base(&mut model, 9.0);
    let first = add_block(&mut model, [0.0, 0.02], [1.5, 1.0], (3, 2), 0.0);
    let second = add_block(&mut model, [4.0, 0.05], [1.0, 1.2], (2, 2), 0.1);
    throw(&mut model, &first, [2.0, -1.5], 0.0, [0.0; 2]);
    throw(&mut model, &second, [2.0 * c, -1.0], 0.0, [0.0; 2]);
    // a slave node of the one follows an inner node of the other
    let (slave, inner) = (first.node(1, 0), second.node(1, 1));
    follow(&mut model, 2 * slave, vec![(2 * inner, 1.0 / c)]);
    for block in [&first, &second] {
        add_contact(&mut model, block.faces(0), base.faces(2), 0.3);
    }
    model.steps = vec![step(0.004, 60, settings(scheme), held)];
    model
}

#[test]
fn contact_of_joined_bodies_is_complementary_and_keeps_the_balance() {
    for (scheme, c) in SCHEMES.into_iter().flat_map(|s| [1.0, 0.4].map(|c| (s, c))) {
        let model = thrown(scheme, c);
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        for contact in 0..2 {
            let closed = |r: &&IncrementReport| r.contacts[contact].closed > 0;
            assert!(keep.reports.iter().filter(closed).count() > 3, "{contact}");
            for report in keep.reports.iter().filter(closed) {
                let contact = &report.contacts[contact];
                assert!(contact.min_gap >= -1e-10, "{:e}", contact.min_gap);
                assert!(contact.normal >= 0.0 && contact.cone_violation <= 1e-10);
            }
        }
        if c == 1.0 {
            momentum_follows_contact(&model, &keep.reports);
        }
    }
}

/// Change of the momentum of the moving bodies: the impulses on the slave surfaces; the two forces of
/// an equation with coefficients 1 and -1 have no resultant.
fn momentum_follows_contact(model: &Model, reports: &[IncrementReport]) {
    let start = reports[0].momentum.linear[0];
    let mut impulse = 0.0;
    for report in reports {
        impulse += report
            .contacts
            .iter()
            .map(|c| c.impulse.vector[0])
            .sum::<f64>();
    }
    let last = reports.last().unwrap();
    let change = last.momentum.linear[0] - start;
    assert!(
        (change - impulse).abs() <= 1e-9 * start,
        "{change} {impulse}"
    );
    assert!(impulse.abs() > 1e-3 * start && model.contacts.len() == 2);
}

#[test]
fn a_dof_follows_a_prescribed_and_a_free_one() {
    for scheme in SCHEMES {
        let (mut model, [first, second]) = two_blocks();
        model.amplitudes = vec![Amplitude {
            name: "PULL".into(),
            time: TimeBase::Step,
            curve: Curve::Linear(vec![(0.0, 0.0), (0.1, 1.0), (0.3, -0.5)]),
        }];
        let motion = SupportMotion::Amplitude {
            value: 0.2,
            amplitude: 0,
        };
        let supports = vec![Support {
            dof: first[0],
            motion,
        }];
        // one follows both, one the support alone
        follow(
            &mut model,
            second[4],
            vec![(first[0], 0.6), (first[2], 0.4)],
        );
        follow(&mut model, second[0], vec![(first[0], -1.5)]);
        model.steps = vec![step(0.005, 60, settings(scheme), supports)];
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        let last = keep.reports.last().unwrap();
        assert!((last.state.u[second[0]] - 0.15).abs() < 1e-14);
        assert!(last.energy.external_work.abs() > 1e-2);
    }
}

#[test]
fn a_node_without_element_moves_with_those_that_follow_it() {
    for scheme in SCHEMES {
        let mut model = model(1000.0, 0.3, 1.0);
        let block = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
        let control = model.mesh.node_count();
        model.mesh.coordinates.push([1.0, 3.0]);
        model.mesh.node_labels.push(1000);
        model.initial_velocity.extend([0.0; 2]);
        for i in 0..=4 {
            follow(
                &mut model,
                2 * block.node(i, 2) + 1,
                vec![(2 * control + 1, 1.0)],
            );
        }
        let mut step = step(0.01, 50, settings(scheme), Vec::new());
        step.point_loads = vec![force(2 * control + 1, 3.0)];
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        let last = keep.reports.last().unwrap();
        // F t = 3 x 0.5
        assert!((last.momentum.linear[1] - 1.5).abs() < 1e-10);
        assert!(last.state.u[2 * control + 1] > 0.1 && last.state.u[2 * control] == 0.0);
        assert_exact(&model, &keep.reports);
    }
}

/// A square that is held at its lower side; its upper one follows a node without element, the control dof of
/// which is returned with the dofs of the upper and the lower side.
fn led_square() -> (Model, usize, [Vec<usize>; 2], Vec<Support>) {
    let mut model = model(1000.0, 0.0, 1e-3);
    let block = add_block(&mut model, [0.0, 0.0], [1.0, 1.0], (2, 2), 0.0);
    let control = 2 * model.mesh.node_count() + 1;
    model.mesh.coordinates.push([0.5, 2.0]);
    model.mesh.node_labels.push(1000);
    model.initial_velocity.extend([0.0; 2]);
    let [upper, lower] = [2, 0].map(|j| (0..=2).map(|i| 2 * block.node(i, j) + 1).collect());
    let upper: Vec<usize> = upper;
    let lower: Vec<usize> = lower;
    for &dof in &upper {
        follow(&mut model, dof, vec![(control, 1.0)]);
    }
    let held = lower.iter().flat_map(|&dof| [dof - 1, dof]).map(fixed);
    let held = held.chain([fixed(control - 1)]).collect();
    (model, control, [upper, lower], held)
}

#[test]
fn the_reaction_of_a_driven_dof_is_what_its_support_exerts_through_equations() {
    for scheme in SCHEMES {
        let (mut model, control, [upper, lower], mut supports) = led_square();
        supports.push(Support {
            dof: control,
            motion: SupportMotion::Ramp { to: 0.01 },
        });
        let dt = 0.01;
        model.steps = vec![step(dt, 100, settings(scheme), supports)];
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        let most = largest(&keep.reports, |r| size(&r.nodal.reaction));
        for pair in keep.reports.windows(2) {
            let [before, now] = pair else { unreachable!() };
            let of = |dof: usize| now.nodal.reaction[dof];
            assert!(upper.iter().all(|&dof| of(dof) == 0.0));
            // the supports give the momentum, and that which moves does the work
            let all = of(control) + lower.iter().map(|&dof| of(dof)).sum::<f64>();
            let momentum = (now.momentum.linear[1] - before.momentum.linear[1]) / dt;
            assert!((all - momentum).abs() < 1e-9 * most, "{all} {momentum}");
            let work = now.energy.external_work - before.energy.external_work;
            let exact = of(control) * (now.state.u[control] - before.state.u[control]);
            let is_steady = before.time > 0.0;
            assert!(!is_steady || (work - exact).abs() < 1e-9 * most * 1e-4);
        }
        // E A strain, the mean of the last increment with the default scheme, and the vibration
        let last = keep.reports.last().unwrap();
        let force = last.nodal.reaction[control];
        assert!((force - 10.0).abs() < 0.5, "{force}");
    }
}

#[test]
fn a_loaded_dof_that_others_follow_has_no_reaction() {
    for scheme in SCHEMES {
        let (mut model, control, [_, lower], supports) = led_square();
        let mut step = step(0.01, 100, settings(scheme), supports);
        step.point_loads = vec![force(control, 10.0)];
        model.steps = vec![step];
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        let last = keep.reports.last().unwrap();
        assert!(last.state.u[control] > 1e-3);
        let held: f64 = lower.iter().map(|&dof| last.nodal.reaction[dof]).sum();
        assert!(last.nodal.reaction[control] == 0.0 && held < -1.0, "{held}");
    }
}

#[test]
fn random_equations_do_no_work() {
    let mut seed = 7_u64;
    let mut random = move |n: usize| {
        seed = seed
            .wrapping_mul(6364136223846793005)
            .wrapping_add(1442695040888963407);
        (seed >> 33) as usize % n
    };
    for case in 0..12 {
        let mut model = thrown(SCHEMES[case % 2], 1.0);
        model.equations.clear();
        // eliminated: odd nodes of the blocks; followed: even ones and the base
        let (from, nodes) = (12, model.mesh.node_count());
        for _ in 0..4 {
            let dof = 2 * (from + 2 * random((nodes - from) / 2) + 1 - from % 2) + random(2);
            let terms = (0..1 + random(3)).map(|_| {
                let to = 2 * (2 * random(nodes / 2)) + random(2);
                (to, 0.25 * (1 + random(8)) as f64 - 1.1)
            });
            let mut terms: Vec<_> = terms.collect();
            terms.sort_by_key(|term| term.0);
            terms.dedup_by_key(|term| term.0);
            if model.equations.iter().all(|equation| equation.dof != dof) && dof < 2 * nodes {
                follow(&mut model, dof, terms);
            }
        }
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
    }
}

/// Two squares on a base, as one mesh or tied by `*EQUATION`; the upper square is thrown sideways.
fn text(tied: bool) -> String {
    let [upper, nodes, tie] = match tied {
        false => ["5, 6, 7, 8", "", ""],
        true => [
            "15, 16, 7, 8",
            "15, 0., 1.1\n16, 1., 1.1\n",
            "*NSET, NSET=UPPER\n16, 15\n*NSET, NSET=LOWER\n5, 6\n*EQUATION\n\
             2\nUPPER, 1, 2., LOWER, 1, -2.\n2\nUPPER, 2, 1., LOWER, 2, -1.\n",
        ],
    };
    format!(
        "*NODE\n1, -2., 0.\n2, 4., 0.\n3, 0., 0.1\n4, 1., 0.1\n5, 0., 1.1\n6, 1., 1.1\n7, 1., 2.1\n\
         8, 0., 2.1\n9, -2., -1.\n10, 4., -1.\n{nodes}*ELEMENT, TYPE=CPS4, ELSET=BASE\n1, 9, 10, 2, 1\n\
         *ELEMENT, TYPE=CPS4, ELSET=BODY\n2, 3, 4, 6, 5\n3, {upper}\n*SURFACE, NAME=FLOOR\nBASE, S3\n\
         *SURFACE, NAME=SOLE\n2, S1\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n1.\n\
         *SOLID SECTION, ELSET=BASE, MATERIAL=M\n*SOLID SECTION, ELSET=BODY, MATERIAL=M\n\
         *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.3\n*CONTACT PAIR, INTERACTION=DRY\nSOLE, FLOOR\n\
         *BOUNDARY\n1, 1, 2\n2, 1, 2\n9, 1, 2\n10, 1, 2\n{tie}*INITIAL CONDITIONS, TYPE=VELOCITY\n\
         7, 1, 1.\n8, 1, 1.\n3, 2, -2.\n4, 2, -2.\n5, 2, -2.\n6, 2, -2.\n7, 2, -2.\n8, 2, -2.\n\
         *STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.005, 0.2\n*END STEP\n"
    )
}

#[test]
fn a_deck_ties_sets_of_nodes() {
    let run_with = |tied: bool| {
        let model = read(&text(tied));
        assert_eq!(model.equations.len(), if tied { 4 } else { 0 });
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        keep.reports
    };
    let [one, tied] = [false, true].map(run_with);
    assert!(one.iter().any(|r| r.contacts[0].closed == 2));
    let scale = largest(&one, |r| size(&r.state.u));
    for (one, tied) in one.iter().zip(&tied) {
        let u = one.state.u.iter().zip(&tied.state.u);
        let difference: Vec<f64> = u.map(|(p, q)| p - q).collect();
        assert!(size(&difference) <= 1e-9 * scale, "{:e}", size(&difference));
    }
}

/// The sides of a pre-tension section slide past each other at its ends, and the nodes there touch nothing of the other side.
#[test]
fn ends_of_a_section_do_not_touch() {
    for formulation in ["", "*CONTACT FORMULATION, TYPE=SURFACE TO SURFACE\n"] {
        let text = format!(
            "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 0., 1.\n4, 1., 1.\n5, 0., 2.\n6, 1., 2.\n99, 5., 5.\n\
             *ELEMENT, TYPE=CPE4, ELSET=ALL\n1, 1, 2, 4, 3\n2, 3, 4, 6, 5\n\
             *SOLID SECTION, ELSET=ALL, MATERIAL=M\n1.,\n*MATERIAL, NAME=M\n*ELASTIC\n1000., 0.3\n*DENSITY\n\
             1.\n*SURFACE, NAME=CUT\n2, S1\n*PRE-TENSION SECTION, NODE=99, SURFACE=CUT\n\
             *SURFACE INTERACTION, NAME=DRY\n*FRICTION\n0.3\n*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n\
             {formulation}*CONTACT PROPERTY ASSIGNMENT\n, , DRY\n*BOUNDARY\n1, 1, 2\n2, 1, 2\n5, 1, 2\n\
             6, 1, 2\n*STEP, NLGEOM\n*STATIC\n0.25, 1.\n*BOUNDARY\n99, 1, 1, 0.02\n*END STEP\n"
        );
        for report in &run_to_end(&read(&text)).0.reports {
            assert_eq!(report.contacts[0].closed, 0, "{formulation}");
            assert_eq!(size(&report.nodal.contact_force), 0.0, "{formulation}");
        }
    }
}

/// All exterior faces may touch each other: those of a tied interface carry no contact force.
#[test]
fn tied_faces_do_not_touch() {
    for scheme in SCHEMES {
        let mut model = model(2000.0, 0.3, 1.0);
        let below = add_block(&mut model, [0.0, 0.0], [2.0, 1.0], (4, 2), 0.0);
        let above = add_block(&mut model, [0.0, 1.0], [2.0, 1.0], (3, 2), 0.0);
        stir(&mut model, &below);
        stir(&mut model, &above);
        // the nodes of the upper side lie between those of the lower one
        for k in 0..=3 {
            let place = 4.0 * f64::from(k) / 3.0;
            let from = (place.floor() as usize).min(3);
            let xi = place - from as f64;
            for i in 0..2 {
                let [a, b] = [from, from + 1].map(|n| 2 * below.node(n, 2) + i);
                follow(
                    &mut model,
                    2 * above.node(k as usize, 0) + i,
                    vec![(a, 1.0 - xi), (b, xi)],
                );
            }
        }
        add_contact(&mut model, above.faces(0), below.faces(2), 0.3);
        model.steps = vec![step(0.005, 30, settings(scheme), Vec::new())];
        let (keep, _) = run_to_end(&model);
        assert_exact(&model, &keep.reports);
        assert!(keep.reports.iter().all(|r| r.contacts[0].normal == 0.0));
        // no external force acts
        let momentum = |r: &IncrementReport| r.momentum.linear;
        let (first, last) = (
            momentum(&keep.reports[0]),
            momentum(keep.reports.last().unwrap()),
        );
        assert!((0..2).all(|i| (last[i] - first[i]).abs() < 1e-11 * size(&first)));
    }
}
