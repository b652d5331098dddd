//! Bodies of Hencky's material: free flight of every element type, and bars in closed form beside other laws.

use stickslip::model::ElementType;

use crate::energies::{energy, largest};
use crate::homogeneous::patch;
use crate::statics::run_deck;

const HENCKY: &str = "*ELASTIC, TYPE=HENCKY\n5., 0.3\n";

/// A square that flies and turns, stretched at a third of its wave speed; rings fly along their axis.
#[test]
fn a_free_body_keeps_energy_and_momenta_to_round_off() {
    for element_type in ElementType::NAMED {
        let (mut deck, x) = patch(element_type, &format!("{HENCKY}*DENSITY\n1.\n"));
        let is_ring = element_type.is_ring();
        deck += "*INITIAL CONDITIONS, TYPE=VELOCITY\n";
        for (n, [x, y]) in (1..).zip(&x) {
            let (across, up) = (x - 0.5, y - 0.5);
            let [vx, vy] = match is_ring {
                true => [0.0, 0.4 + 1.2 * up],
                false => [0.4 - 1.5 * up + 1.2 * across, -0.3 + 1.5 * across],
            };
            deck += &format!("{n}, 1, {vx:?}\n{n}, 2, {vy:?}\n");
        }
        if is_ring {
            deck += "*BOUNDARY\nL, 1, 1\n";
        }
        deck +=
            "*STEP, NLGEOM\n*DYNAMIC, DIRECT\n0.02, 2.\n*STICKSLIP, TOLERANCE=1.E-12\n*END STEP\n";
        let (keep, failure) = run_deck(&deck);
        let name = element_type.name();
        assert_eq!(failure, None, "{name}");
        let (first, all) = (&keep.reports[0], &keep.reports);
        let drift = largest(all, |r| (energy(r) - energy(first)).abs()) / energy(first);
        let of_axis = |i: usize| {
            let change = largest(all, |r| {
                (r.momentum.linear[i] - first.momentum.linear[i]).abs()
            });
            change / first.momentum.linear[1].abs()
        };
        let turned = largest(all, |r| (r.momentum.angular - first.momentum.angular).abs());
        let strain = largest(all, |r| r.strain.strain);
        println!(
            "{name}: {drift:.1e} {:.1e} {turned:.1e} {strain:.2}",
            of_axis(1)
        );
        assert!(all.len() > 100 && strain > 0.15, "{name} {strain}");
        assert!(drift < 1e-12, "{name}: energy {drift:e}");
        assert!(of_axis(1) < 1e-12, "{name}: momentum {:e}", of_axis(1));
        if !is_ring {
            let turned = turned / first.momentum.angular.abs();
            assert!(of_axis(0) < 1e-12, "{name}: momentum {:e}", of_axis(0));
            assert!(turned < 1e-12, "{name}: angular momentum {turned:e}");
        }
    }
}

/// Force at the top of a square of one element whose height is prescribed, free across. Several elements would wrinkle at
/// their free sides at half the height, and neck beyond e times the height, where the force falls.
fn force_at_height(kind: &str, law: &str, height: f64) -> f64 {
    let (keep, failure) = run_deck(&format!(
        "*NODE\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*ELEMENT, TYPE={kind}, ELSET=E\n1, 1, 2, 3, 4\n\
         *MATERIAL, NAME=M\n{law}*SOLID SECTION, ELSET=E, MATERIAL=M\n1.\n\
         *BOUNDARY\n1, 1, 2\n2, 2\n4, 1\n*STEP, NLGEOM\n*STATIC\n0.05, 1.\n\
         *BOUNDARY\n3, 2, 2, {by:?}\n4, 2, 2, {by:?}\n*END STEP\n",
        by = height - 1.0
    ));
    assert_eq!(failure, None, "{kind} {law} {height}");
    let reaction = &keep.reports.last().expect("reports").nodal.reaction;
    reaction[5] + reaction[7]
}

/// A bar has T = E' ln l and the force T/l, with E' = E/(1 - nu²) in plane strain.
#[test]
fn forces_at_half_and_at_three_times_the_length() {
    for kind in ["CPE4", "CPE4H", "CPE4I", "CPE4R", "CPS4", "CPS4I", "CPS4R"] {
        let modulus = match kind.starts_with("CPE") {
            true => 5.0 / (1.0 - 0.3 * 0.3),
            false => 5.0,
        };
        for height in [0.5_f64, 3.0] {
            let (found, exact) = (
                force_at_height(kind, HENCKY, height),
                modulus * height.ln() / height,
            );
            assert!(
                (found / exact - 1.0).abs() < 1e-9,
                "{kind} {height}: {found} {exact}"
            );
        }
    }
}

/// E = 1000 and nu = 0, pressed to half the length:
///
/// ```text
/// St. Venant-Kirchhoff         l S = E l (l² - 1)/2   -187.5
/// Hencky                       T/l = E ln(l)/l        -1386.3
/// a metal that does not yield  the same
/// ```
///
/// Abaqus' law, true stress over logarithmic strain, has E ln l = -693.1.
#[test]
fn forces_of_other_laws_at_half_the_length() {
    let hencky = 1000.0 * 0.5_f64.ln() / 0.5;
    let laws = [
        ("*ELASTIC\n1000., 0.\n", -187.5),
        ("*ELASTIC, TYPE=HENCKY\n1000., 0.\n", hencky),
        ("*ELASTIC\n1000., 0.\n*PLASTIC\n1.E6, 0.\n", hencky),
    ];
    for (law, exact) in laws {
        let found = force_at_height("CPE4", law, 0.5);
        assert!((found / exact - 1.0).abs() < 1e-9, "{law}: {found} {exact}");
    }
}
