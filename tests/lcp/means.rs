//! Problems of the constraints from surface to surface between random rough surfaces of unlike segments.

use crate::random::Random;
use crate::rectangles as blocks;
use nalgebra::DMatrix;
use stickslip::contact::{
    ClosedPairs, Configurations, Constraint, RowForm, Rows, Search, SlaveChoice, contact_surfaces,
    find_targets,
};
use stickslip::lcp::{FreeUnknowns, FrictionalLcp, LcpMethod, solve_frictional};
use stickslip::model::{ContactFormulation, Model};

/// Two blocks of unlike segments that face each other, turned together, the upper one past an end of the lower; and the
/// body of every node.
fn facing(random: &mut Random) -> (Model, Vec<usize>) {
    let mut model = blocks::model(1.0, 0.3, 1.0);
    let angle = random.range(-3.0, 3.0);
    let (sin, cos) = angle.sin_cos();
    let (lower, upper) = (2 + random.below(7), 2 + random.below(7));
    let shift = random.range(-0.4, 0.4);
    let at = |x: f64, y: f64| [cos * x - sin * y, sin * x + cos * y];
    let of = [(at(0.0, -1.0), lower), (at(shift, 0.0), upper)];
    let [below, above] =
        of.map(|(corner, nx)| blocks::add_block(&mut model, corner, [1.0, 1.0], (nx, 1), angle));
    blocks::add_contact(&mut model, above.faces(0), below.faces(2), 0.3);
    model.contacts[0].formulation = ContactFormulation::SurfaceToSurface;
    let bodies = (below.nodes().map(|_| 0)).chain(above.nodes().map(|_| 1));
    let bodies = bodies.collect();
    (model, bodies)
}

/// The constraints of a model between random displacements of the given sizes.
fn constraints(
    (model, bodies): (&Model, &[usize]),
    random: &mut Random,
    sizes: [f64; 2],
) -> Vec<Constraint> {
    let x = &model.mesh.coordinates;
    let u0: Vec<f64> = (0..2 * x.len())
        .map(|_| random.range(-sizes[0], sizes[0]))
        .collect();
    let u: Vec<f64> = (u0.iter())
        .map(|u| u + random.range(-sizes[1], sizes[1]))
        .collect();
    let surfaces = contact_surfaces(model, bodies);
    let mut search = Search::new(&surfaces, x);
    search.cover_path(&u0, &u);
    let (form, mut pairs) = (RowForm::DiscreteGradient, Vec::new());
    let none = (&ClosedPairs::default(), None);
    find_targets(
        &search,
        [&u0, &u],
        &[],
        none,
        (form, SlaveChoice::All),
        &mut pairs,
    );
    let at = Configurations {
        form,
        x,
        u0: &u0,
        u: &u,
    };
    let made = pairs.into_iter().map(|pair| Constraint::new(pair, &at));
    made.filter(Constraint::is_mean).collect()
}

/// Normal rows above tangential ones, over all dofs.
fn rows(constraints: &[Constraint], dofs: usize, of: fn(&Constraint) -> &Rows) -> DMatrix<f64> {
    let n = constraints.len();
    let mut matrix = DMatrix::zeros(2 * n, dofs);
    for (k, constraint) in constraints.iter().enumerate() {
        let rows = of(constraint);
        for (i, &dof) in constraint.dofs.iter().enumerate() {
            matrix[(k, dof)] = rows.normal[i];
            matrix[(k + n, dof)] = rows.tangential[i];
        }
    }
    matrix
}

#[test]
fn none_of_300_problems_of_means_is_unsolved() {
    let mut random = Random(29);
    let mut contacts = 0;
    for case in 0..300 {
        let (model, bodies) = facing(&mut random);
        let dofs = 2 * model.mesh.coordinates.len();
        let constraints = constraints((&model, &bodies), &mut random, [0.02, 0.05]);
        let n = constraints.len();
        let compliance = random.gram(dofs, dofs, dofs as f64);
        let force = rows(&constraints, dofs, |constraint| &constraint.force_rows);
        let derivative = match case % 2 {
            0 => force.clone(),
            _ => rows(&constraints, dofs, Constraint::derivative_rows),
        };
        let problem = FrictionalLcp {
            q: derivative * compliance * force.transpose(),
            gap: random.vector(n, -2.0, 1.0),
            slip: random.vector(n, -1.0, 1.0),
            mu: random.vector(n, 0.0, 1.0),
            free: FreeUnknowns::default(),
        };
        for method in [LcpMethod::Hybrid, LcpMethod::Lemke] {
            let solved = solve_frictional(&problem, None, method);
            let solved = solved.unwrap_or_else(|error| panic!("{case} {method:?}: {error:?}"));
            assert!(solved.residual < 1e-9, "{case}: {:e}", solved.residual);
        }
        contacts += n;
    }
    assert!(contacts > 1000, "{contacts}");
}
