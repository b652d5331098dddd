//! The result file of a made-up run, read back with the HDF5 library.

use std::fs;

use crate::writers::{INCREMENTS, deck_text, model, report, write_run};
use hdf5::types::VarLenUnicode;
use hdf5::{Dataset, File, Group, H5Type};
use stickslip::output::{JobFiles, ResultSummary};
use tempfile::TempDir;

const N: usize = 7;
const E: usize = 3;
const F: usize = 6;
const I: usize = INCREMENTS + 1;
const B: usize = 1;

fn written() -> (TempDir, JobFiles, File) {
    let folder = TempDir::new().expect("folder");
    let files = write_run(folder.path());
    let file = File::open(&files.result).expect("readable");
    (folder, files, file)
}

fn values<T: H5Type>(file: &File, path: &str) -> Vec<T> {
    file.dataset(path).expect(path).read_raw().expect(path)
}

fn text(group: &Group, name: &str) -> String {
    let value: VarLenUnicode = group.attr(name).expect(name).read_scalar().expect(name);
    value.as_str().to_owned()
}

/// All datasets with their paths.
fn datasets(group: &Group, path: &str, found: &mut Vec<(String, Dataset)>) {
    for name in group.member_names().expect(path) {
        let inner = format!("{path}/{name}");
        match group.group(&name) {
            Ok(inside) => datasets(&inside, &inner, found),
            Err(_) => found.push((inner, group.dataset(&name).expect("dataset"))),
        }
    }
}

/// The contract: every dataset with its shape.
fn shapes() -> Vec<(&'static str, Vec<usize>)> {
    let mut shapes = vec![
        ("/VTKHDF/NumberOfPoints", vec![1]),
        ("/VTKHDF/NumberOfCells", vec![1]),
        ("/VTKHDF/NumberOfConnectivityIds", vec![1]),
        ("/VTKHDF/Points", vec![N, 3]),
        ("/VTKHDF/Connectivity", vec![11]),
        ("/VTKHDF/Offsets", vec![E + 1]),
        ("/VTKHDF/Types", vec![E]),
        ("/VTKHDF/PointData/GAP", vec![F * N]),
        ("/VTKHDF/PointData/CONTACT_STATUS", vec![F * N]),
        ("/VTKHDF/CellData/S", vec![F * E, 6]),
        ("/VTKHDF/CellData/E", vec![F * E, 6]),
        ("/VTKHDF/Steps/Values", vec![F]),
        ("/VTKHDF/Steps/PartOffsets", vec![F]),
        ("/VTKHDF/Steps/NumberOfParts", vec![F]),
        ("/VTKHDF/Steps/PointOffsets", vec![F]),
        ("/VTKHDF/Steps/CellOffsets", vec![F, 1]),
        ("/VTKHDF/Steps/ConnectivityIdOffsets", vec![F, 1]),
        ("/VTKHDF/Steps/PointDataOffsets/GAP", vec![F]),
        ("/VTKHDF/Steps/PointDataOffsets/CONTACT_STATUS", vec![F]),
        ("/VTKHDF/Steps/CellDataOffsets/S", vec![F]),
        ("/VTKHDF/Steps/CellDataOffsets/E", vec![F]),
        ("/model/node_labels", vec![N]),
        ("/model/coordinates", vec![N, 2]),
        ("/model/element_labels", vec![E]),
        ("/model/connectivity", vec![11]),
        ("/model/node_sets/ALL", vec![N]),
        ("/model/node_sets/TIP", vec![1]),
        ("/model/node_sets/NOTHING", vec![0]),
        ("/model/element_sets/SQUARES", vec![2]),
        ("/history/momentum/linear", vec![I, 2]),
        ("/history/momentum/angular", vec![I]),
        ("/history/momentum/damped_linear", vec![I, 2]),
        ("/history/momentum/damped_angular", vec![I]),
        ("/history/touches/start", vec![0]),
        ("/history/touches/end", vec![0]),
        ("/history/touches/impulse", vec![0]),
        ("/history/touches/energy", vec![0]),
        ("/history/touches/first", vec![0]),
        ("/history/touches/last", vec![0]),
        ("/history/touches/nodes", vec![0]),
        ("/history/touches/corner", vec![0]),
        ("/history/touches/bodies", vec![0, 2]),
        ("/history/touches/node", vec![0]),
        ("/history/impacts/time", vec![1]),
        ("/history/impacts/increment", vec![1]),
        ("/history/impacts/slave", vec![1]),
        ("/history/impacts/segment", vec![1, 2]),
        ("/history/impacts/xi", vec![1]),
        ("/history/impacts/approach_speed", vec![1]),
        ("/history/nodes/TIP/labels", vec![1]),
        ("/history/nodes/TIP/U", vec![I, 1, 2]),
        ("/history/nodes/TIP/V", vec![I, 1, 2]),
        ("/history/nodes/TIP/RF", vec![I, 1, 2]),
        ("/history/nodes/ALL/labels", vec![N]),
        ("/history/elements/SQUARES/labels", vec![2]),
        ("/history/elements/SQUARES/EVOL", vec![2]),
        ("/history/elements/SQUARES/S", vec![I, 2, 3]),
        ("/history/elements/SQUARES/E", vec![I, 2, 3]),
        ("/history/elements/SQUARES/LE", vec![I, 2, 3]),
        ("/history/elements/SQUARES/S33", vec![I, 2]),
        ("/history/elements/SQUARES/MISES", vec![I, 2]),
        ("/history/elements/SQUARES/SP1", vec![I, 2]),
        ("/history/elements/SQUARES/SP2", vec![I, 2]),
        ("/history/elements/SQUARES/SP3", vec![I, 2]),
        ("/history/elements/SQUARES/PRESS", vec![I, 2]),
        ("/history/elements/SQUARES/ENER", vec![I, 2]),
        ("/history/elements/SQUARES/ELSE", vec![I, 2]),
        ("/history/elements/SQUARES/ELKE", vec![I, 2]),
        ("/history/elements/SQUARES/PEEQ", vec![I, 2]),
        ("/history/elements/SQUARES/ELHE", vec![I, 2]),
        ("/history/elements/SQUARES/points/S", vec![I, 8, 3]),
        ("/history/elements/SQUARES/points/E", vec![I, 8, 3]),
        ("/history/elements/SQUARES/points/S33", vec![I, 8]),
        ("/history/elements/SQUARES/points/E33", vec![I, 8]),
        ("/history/elements/SQUARES/points/MISES", vec![I, 8]),
        ("/history/elements/SQUARES/points/SP1", vec![I, 8]),
        ("/history/elements/SQUARES/points/SP2", vec![I, 8]),
        ("/history/elements/SQUARES/points/SP3", vec![I, 8]),
        ("/history/elements/SQUARES/points/PRESS", vec![I, 8]),
        ("/history/elements/SQUARES/points/ENER", vec![I, 8]),
        ("/history/elements/SQUARES/points/PEEQ", vec![I, 8]),
        ("/history/elements/SQUARES/points/LE", vec![I, 8, 3]),
        ("/history/elements/SQUARES/points/LE33", vec![I, 8]),
        ("/history/elements/SQUARES/points/labels", vec![8]),
        ("/history/elements/SQUARES/at_nodes/S", vec![I, 6, 3]),
        ("/history/elements/SQUARES/at_nodes/E", vec![I, 6, 3]),
        ("/history/elements/SQUARES/at_nodes/S33", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/E33", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/MISES", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/SP1", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/SP2", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/SP3", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/PRESS", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/ENER", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/PEEQ", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/LE", vec![I, 6, 3]),
        ("/history/elements/SQUARES/at_nodes/LE33", vec![I, 6]),
        ("/history/elements/SQUARES/at_nodes/labels", vec![6]),
        ("/history/elements/SQUARES/points/numbers", vec![8]),
        ("/VTKHDF/CellData/PEEQ", vec![F * E]),
        ("/VTKHDF/Steps/CellDataOffsets/PEEQ", vec![F]),
        ("/history/elements/SQUARES/sum/ELSE", vec![I]),
        ("/history/elements/SQUARES/sum/ELKE", vec![I]),
        ("/VTKHDF/PointData/CONTACT_PRESSURE", vec![F * N]),
        ("/VTKHDF/PointData/SLIP", vec![F * N]),
        ("/VTKHDF/CellData/SP1", vec![F * E]),
        ("/VTKHDF/Steps/CellDataOffsets/SP1", vec![F]),
        ("/VTKHDF/CellData/SP2", vec![F * E]),
        ("/VTKHDF/Steps/CellDataOffsets/SP2", vec![F]),
        ("/VTKHDF/CellData/SP3", vec![F * E]),
        ("/VTKHDF/Steps/CellDataOffsets/SP3", vec![F]),
        ("/VTKHDF/CellData/PRESS", vec![F * E]),
        ("/VTKHDF/Steps/CellDataOffsets/PRESS", vec![F]),
        ("/VTKHDF/CellData/ENER", vec![F * E]),
        ("/VTKHDF/CellData/LE", vec![F * E, 6]),
        ("/VTKHDF/Steps/CellDataOffsets/ENER", vec![F]),
        ("/VTKHDF/Steps/CellDataOffsets/LE", vec![F]),
        ("/VTKHDF/PointData/CF", vec![F * N, 3]),
        ("/VTKHDF/Steps/PointDataOffsets/CF", vec![F]),
        ("/VTKHDF/CellData/MISES", vec![F * E]),
        ("/VTKHDF/CellData/BODY", vec![E]),
        ("/VTKHDF/Steps/PointDataOffsets/CONTACT_PRESSURE", vec![F]),
        ("/VTKHDF/Steps/PointDataOffsets/SLIP", vec![F]),
        ("/VTKHDF/Steps/CellDataOffsets/MISES", vec![F]),
        ("/VTKHDF/Steps/CellDataOffsets/BODY", vec![F]),
        ("/model/bodies/node", vec![N]),
        ("/model/bodies/element", vec![E]),
        ("/model/bodies/mass", vec![B]),
        ("/model/bodies/edge_time", vec![B]),
        ("/model/bodies/wave_time", vec![B]),
        ("/model/element_types", vec![E]),
        ("/model/element_materials", vec![E]),
        ("/model/thickness", vec![E]),
        ("/model/materials/law", vec![1]),
        ("/model/materials/shape", vec![1, 4]),
        ("/model/materials/compressibility", vec![1, 3]),
        ("/model/materials/young", vec![1]),
        ("/model/materials/ogden_alpha", vec![1, 3]),
        ("/model/materials/ogden_mu", vec![1, 3]),
        ("/model/materials/poisson", vec![1]),
        ("/model/materials/density", vec![1]),
        ("/model/materials/alpha", vec![1]),
        ("/model/materials/beta", vec![1]),
        ("/model/steps/scheme", vec![1]),
        ("/model/steps/theta", vec![1, 2]),
        ("/model/supported_nodes", vec![1]),
        ("/model/constrained_nodes", vec![0]),
        ("/model/loaded_nodes", vec![0]),
        ("/model/load_groups", vec![E]),
        ("/model/contacts/BOTTOM_TOP/slaves", vec![4]),
        ("/model/contacts/BOTTOM_TOP/segments", vec![2, 2]),
        ("/model/contacts/BOTTOM_TOP/slave_faces", vec![0, 2]),
        ("/model/contacts/BOTTOM_TOP/friction", vec![2]),
        ("/model/contacts/BOTTOM_TOP/acts", vec![1]),
        (
            "/model/contacts/BOTTOM_TOP/friction_coefficients",
            vec![1, 2],
        ),
        ("/model/contacts/BOTTOM_TOP/friction_decay", vec![1]),
        ("/model/contacts/BOTTOM_TOP/table_steps", vec![0]),
        ("/model/contacts/BOTTOM_TOP/table_pressures", vec![0]),
        ("/model/contacts/BOTTOM_TOP/table_slip_rates", vec![0]),
        ("/model/contacts/BOTTOM_TOP/table_coefficients", vec![0]),
        ("/model/contacts/BOTTOM_TOP/shear_limit", vec![1]),
        ("/model/contacts/BOTTOM_TOP/friction_ramps", vec![1]),
        ("/model/contacts/BOTTOM_TOP_2/slaves", vec![4]),
        ("/model/contacts/BOTTOM_TOP_2/segments", vec![2, 2]),
        ("/model/contacts/BOTTOM_TOP_2/slave_faces", vec![0, 2]),
        ("/model/contacts/BOTTOM_TOP_2/friction", vec![2]),
        ("/model/contacts/BOTTOM_TOP_2/acts", vec![1]),
        (
            "/model/contacts/BOTTOM_TOP_2/friction_coefficients",
            vec![1, 2],
        ),
        ("/model/contacts/BOTTOM_TOP_2/friction_decay", vec![1]),
        ("/model/contacts/BOTTOM_TOP_2/table_steps", vec![0]),
        ("/model/contacts/BOTTOM_TOP_2/table_pressures", vec![0]),
        ("/model/contacts/BOTTOM_TOP_2/table_slip_rates", vec![0]),
        ("/model/contacts/BOTTOM_TOP_2/table_coefficients", vec![0]),
        ("/model/contacts/BOTTOM_TOP_2/shear_limit", vec![1]),
        ("/model/contacts/BOTTOM_TOP_2/friction_ramps", vec![1]),
        ("/history/bodies/center", vec![I, B, 2]),
        ("/history/bodies/velocity", vec![I, B, 2]),
        ("/history/bodies/angular_velocity", vec![I, B]),
        ("/history/bodies/kinetic", vec![I, B]),
        ("/history/bodies/strain", vec![I, B]),
        ("/history/bodies/contact_force", vec![I, B, 2]),
        ("/history/bodies/contact_moment", vec![I, B]),
    ];
    let each = |names: &[&'static str], shape: Vec<usize>| -> Vec<_> {
        names.iter().map(|&name| (name, shape.clone())).collect()
    };
    shapes.extend(each(
        &[
            "/VTKHDF/PointData/S_AT_NODES",
            "/VTKHDF/PointData/LE_AT_NODES",
        ],
        vec![F * N, 6],
    ));
    shapes.push(("/VTKHDF/PointData/MISES_AT_NODES", vec![F * N]));
    shapes.extend(each(&AT_NODES_OFFSETS, vec![F]));
    shapes.extend(each(&POINT_VECTORS, vec![F * N, 3]));
    shapes.extend(each(&POINT_VECTOR_OFFSETS, vec![F]));
    shapes.extend(each(&PER_INCREMENT, vec![I]));
    shapes.extend(each(&VECTOR_PER_INCREMENT, vec![I, 2]));
    shapes
}

const POINT_VECTORS: [&str; 5] = [
    "/VTKHDF/PointData/U",
    "/VTKHDF/PointData/V",
    "/VTKHDF/PointData/A",
    "/VTKHDF/PointData/RF",
    "/VTKHDF/PointData/CONTACT_FORCE",
];

const AT_NODES_OFFSETS: [&str; 3] = [
    "/VTKHDF/Steps/PointDataOffsets/S_AT_NODES",
    "/VTKHDF/Steps/PointDataOffsets/MISES_AT_NODES",
    "/VTKHDF/Steps/PointDataOffsets/LE_AT_NODES",
];

const POINT_VECTOR_OFFSETS: [&str; 5] = [
    "/VTKHDF/Steps/PointDataOffsets/U",
    "/VTKHDF/Steps/PointDataOffsets/V",
    "/VTKHDF/Steps/PointDataOffsets/A",
    "/VTKHDF/Steps/PointDataOffsets/RF",
    "/VTKHDF/Steps/PointDataOffsets/CONTACT_FORCE",
];

const VECTOR_PER_INCREMENT: [&str; 18] = [
    "/history/contact/BOTTOM_TOP/force",
    "/history/contact/BOTTOM_TOP/impulse",
    "/history/contact/BOTTOM_TOP/impulse_sum",
    "/history/contact/BOTTOM_TOP_2/force",
    "/history/contact/BOTTOM_TOP_2/impulse",
    "/history/contact/BOTTOM_TOP_2/impulse_sum",
    "/history/nodes/ALL/sum/RF",
    "/history/nodes/ALL/sum/CF",
    "/history/nodes/ALL/sum/CONTACT_FORCE",
    "/history/nodes/ALL/mean/U",
    "/history/nodes/ALL/mean/V",
    "/history/nodes/ALL/mean/A",
    "/history/nodes/TIP/sum/RF",
    "/history/nodes/TIP/sum/CF",
    "/history/nodes/TIP/sum/CONTACT_FORCE",
    "/history/nodes/TIP/mean/U",
    "/history/nodes/TIP/mean/V",
    "/history/nodes/TIP/mean/A",
];

const PER_INCREMENT: [&str; 86] = [
    "/history/contact/BOTTOM_TOP/normal_work",
    "/history/contact/BOTTOM_TOP/friction_dissipation",
    "/history/contact/BOTTOM_TOP/normal_impulse",
    "/history/contact/BOTTOM_TOP/tangential_impulse",
    "/history/contact/BOTTOM_TOP/impact_normal_impulse",
    "/history/contact/BOTTOM_TOP/impact_tangential_impulse",
    "/history/contact/BOTTOM_TOP/normal_impulse_sum",
    "/history/contact/BOTTOM_TOP/tangential_impulse_sum",
    "/history/contact/BOTTOM_TOP/impact_normal_impulse_sum",
    "/history/contact/BOTTOM_TOP/impact_tangential_impulse_sum",
    "/history/contact/BOTTOM_TOP/landing_return",
    "/history/contact/BOTTOM_TOP/release_loss",
    "/history/contact/BOTTOM_TOP/return_impulse",
    "/history/contact/BOTTOM_TOP/return_impulse_sum",
    "/history/contact/BOTTOM_TOP_2/normal_work",
    "/history/contact/BOTTOM_TOP_2/friction_dissipation",
    "/history/contact/BOTTOM_TOP_2/normal_impulse",
    "/history/contact/BOTTOM_TOP_2/tangential_impulse",
    "/history/contact/BOTTOM_TOP_2/impact_normal_impulse",
    "/history/contact/BOTTOM_TOP_2/impact_tangential_impulse",
    "/history/contact/BOTTOM_TOP_2/normal_impulse_sum",
    "/history/contact/BOTTOM_TOP_2/tangential_impulse_sum",
    "/history/contact/BOTTOM_TOP_2/impact_normal_impulse_sum",
    "/history/contact/BOTTOM_TOP_2/impact_tangential_impulse_sum",
    "/history/contact/BOTTOM_TOP_2/landing_return",
    "/history/contact/BOTTOM_TOP_2/release_loss",
    "/history/contact/BOTTOM_TOP_2/return_impulse",
    "/history/contact/BOTTOM_TOP_2/return_impulse_sum",
    "/history/time",
    "/history/strain/largest_principal",
    "/history/strain/largest_principal_elastic",
    "/history/dt",
    "/history/step",
    "/history/energy/kinetic",
    "/history/energy/strain",
    "/history/energy/external_work",
    "/history/energy/thermal_work",
    "/history/energy/normal_contact_work",
    "/history/energy/friction_dissipation",
    "/history/energy/impact_loss",
    "/history/energy/landing_return",
    "/history/energy/release_loss",
    "/history/energy/damping",
    "/history/energy/material_dissipation",
    "/history/energy/numerical_dissipation",
    "/history/energy/balance",
    "/history/energy/scale",
    "/history/energy/round_off",
    "/history/contact/BOTTOM_TOP/moment",
    "/history/contact/BOTTOM_TOP/normal",
    "/history/contact/BOTTOM_TOP/tangential",
    "/history/contact/BOTTOM_TOP/closed",
    "/history/contact/BOTTOM_TOP/sticking",
    "/history/contact/BOTTOM_TOP/min_gap",
    "/history/contact/BOTTOM_TOP/friction_coefficient",
    "/history/contact/BOTTOM_TOP/cone_violation",
    "/history/contact/BOTTOM_TOP/impulse_cone_violation",
    "/history/contact/BOTTOM_TOP/handover_work",
    "/history/contact/BOTTOM_TOP_2/moment",
    "/history/contact/BOTTOM_TOP_2/normal",
    "/history/contact/BOTTOM_TOP_2/tangential",
    "/history/contact/BOTTOM_TOP_2/closed",
    "/history/contact/BOTTOM_TOP_2/sticking",
    "/history/contact/BOTTOM_TOP_2/min_gap",
    "/history/contact/BOTTOM_TOP_2/friction_coefficient",
    "/history/contact/BOTTOM_TOP_2/cone_violation",
    "/history/contact/BOTTOM_TOP_2/impulse_cone_violation",
    "/history/contact/BOTTOM_TOP_2/handover_work",
    "/history/certificate/residual",
    "/history/certificate/overlap",
    "/history/certificate/gap",
    "/history/certificate/slip",
    "/history/certificate/penetration",
    "/history/certificate/cone",
    "/history/certificate/impulse_cone",
    "/history/certificate/balance",
    "/history/solver/passes",
    "/history/solver/lcps",
    "/history/solver/lcp_size",
    "/history/solver/pivots",
    "/history/solver/active_set_iterations",
    "/history/solver/gauss_seidel_sweeps",
    "/history/solver/lemke_calls",
    "/history/solver/factorizations",
    "/history/solver/held",
    "/history/solver/converged",
];

#[test]
fn every_dataset_has_its_shape_and_its_attributes() {
    let (_folder, _, file) = written();
    let mut found = vec![];
    datasets(&file, "", &mut found);
    let mut actual: Vec<_> = found.iter().map(|(p, d)| (p.as_str(), d.shape())).collect();
    let mut expected = shapes();
    actual.sort();
    expected.sort();
    assert_eq!(actual, expected);
    let history = [
        ("history", "time"),
        ("history/impacts", "time"),
        ("history/touches", "start"),
    ];
    for (group, counted) in history {
        let group = file.group(group).expect("group");
        let rows: i64 = (group.attr("rows").expect("rows").read_scalar()).expect("number");
        assert_eq!(rows as usize, group.dataset(counted).expect(counted).size());
    }
    for (path, dataset) in &found {
        for name in ["description", "dimension"] {
            let value: VarLenUnicode = dataset.attr(name).expect(path).read_scalar().expect(path);
            assert!(!value.is_empty(), "{path} {name}");
        }
    }
}

#[test]
fn frames_hold_the_state_of_their_increment() {
    let (_folder, _, file) = written();
    let grid = file.group("VTKHDF").expect("grid");
    let version: Vec<i64> = grid
        .attr("Version")
        .expect("version")
        .read_raw()
        .expect("2");
    assert_eq!(version, [2, 3]);
    let steps: i64 = (grid.group("Steps").expect("steps"))
        .attr("NSteps")
        .expect("attribute")
        .read_scalar()
        .expect("number");
    assert_eq!(steps, F as i64);
    let times: Vec<f64> = values(&file, "VTKHDF/Steps/Values");
    let u: Vec<f64> = values(&file, "VTKHDF/PointData/U");
    let forces: Vec<f64> = values(&file, "VTKHDF/PointData/CONTACT_FORCE");
    let gaps: Vec<f64> = values(&file, "VTKHDF/PointData/GAP");
    let status: Vec<u8> = values(&file, "VTKHDF/PointData/CONTACT_STATUS");
    let starts: Vec<i64> = values(&file, "VTKHDF/Steps/PointDataOffsets/U");
    for frame in 0..F {
        let report = report(2 * frame);
        assert_eq!(times[frame], report.time);
        assert_eq!(starts[frame], (frame * N) as i64);
        for node in 0..N {
            let row = frame * N + node;
            let expected = [report.state.u[2 * node], report.state.u[2 * node + 1], 0.0];
            assert_eq!(u[3 * row..3 * row + 3], expected);
            let y = report.nodal.contact_force[2 * node + 1];
            assert_eq!(forces[3 * row + 1], y);
        }
        assert_eq!(gaps[frame * N], report.nodal.gap[0]);
        assert!(gaps[frame * N + 1].is_nan());
        assert_eq!(status[frame * N..frame * N + 2], [3, 0]);
    }
    assert_eq!(values::<u8>(&file, "VTKHDF/Types"), [9, 9, 5]);
    assert_eq!(values::<i64>(&file, "VTKHDF/Offsets"), [0, 4, 8, 11]);
}

#[test]
fn history_has_a_row_per_increment() {
    let (_folder, _, file) = written();
    let times: Vec<f64> = values(&file, "history/time");
    let kinetic: Vec<f64> = values(&file, "history/energy/kinetic");
    let linear: Vec<f64> = values(&file, "history/momentum/linear");
    let second: Vec<f64> = values(&file, "history/contact/BOTTOM_TOP_2/normal");
    let tip: Vec<f64> = values(&file, "history/nodes/TIP/V");
    for k in 0..I {
        let report = report(k);
        assert_eq!(times[k], report.time);
        assert_eq!(kinetic[k], report.energy.kinetic);
        assert_eq!(linear[2 * k..2 * k + 2], report.momentum.linear);
        assert_eq!(second[k], report.contacts[1].normal);
        assert_eq!(tip[2 * k..2 * k + 2], report.state.v[12..14]);
    }
    let impulses: Vec<f64> = values(&file, "history/contact/BOTTOM_TOP_2/normal_impulse_sum");
    assert_eq!(impulses, [14.0; I]);
    let centers: Vec<f64> = values(&file, "history/bodies/center");
    assert_eq!(centers[2 * I - 2..], [INCREMENTS as f64, 0.5]);
    assert_eq!(values::<i64>(&file, "history/impacts/increment"), [4]);
    assert_eq!(values::<i64>(&file, "history/impacts/slave"), [70]);
    assert_eq!(values::<i64>(&file, "history/impacts/segment"), [50, 40]);
    assert_eq!(values::<i64>(&file, "history/nodes/TIP/labels"), [70]);
    assert_eq!(values::<i64>(&file, "model/element_sets/SQUARES"), [0, 1]);
}

/// Component i of node n is k + (2 n + i)/100 times a factor: 4 for RF, 10 for CF, 5 for the
/// contact force, 1, 2 and 3 for the motion.
#[test]
fn sums_and_means_over_node_sets() {
    let (_folder, _, file) = written();
    for (name, factor, count) in [
        ("sum/RF", 4.0, 7.0),
        ("sum/CF", 10.0, 7.0),
        ("sum/CONTACT_FORCE", 5.0, 7.0),
        ("mean/U", 1.0, 1.0),
        ("mean/V", 2.0, 1.0),
        ("mean/A", 3.0, 1.0),
    ] {
        let found: Vec<f64> = values(&file, &format!("history/nodes/ALL/{name}"));
        for k in 0..I {
            for i in 0..2 {
                let expected = count * factor * (k as f64 + 0.06 + i as f64 / 100.0);
                assert!((found[2 * k + i] - expected).abs() < 1e-12 * (1.0 + expected));
            }
        }
    }
    let all = file.group("history/nodes/ALL").expect("group");
    assert!(all.dataset("U").is_err(), "sums only");
    assert_eq!(values::<u8>(&file, "model/element_types"), [1, 1, 0]);
    assert_eq!(values::<f64>(&file, "model/thickness"), [0.5; E]);
    assert_eq!(values::<f64>(&file, "model/materials/young"), [1000.0]);
    let slaves: Vec<i64> = values(&file, "model/contacts/BOTTOM_TOP/slaves");
    assert_eq!(slaves, [0, 1, 2, 6]);
    let segments: Vec<i64> = values(&file, "model/contacts/BOTTOM_TOP/segments");
    assert_eq!(segments, [4, 3, 5, 4]);
    let friction: Vec<f64> = values(&file, "model/contacts/BOTTOM_TOP/friction");
    assert_eq!(friction, [0.3, 0.3]);
    let bodies: Vec<i64> = values(&file, "model/bodies/node");
    assert_eq!(bodies, [0; N]);
    let mass: Vec<f64> = values(&file, "model/bodies/mass");
    assert_eq!(mass, [2.5], "three pieces of thickness 0.5 and density 2");
    // sqrt(E/rho) = sqrt(500): edges of length 1, 3 along x
    for (name, length) in [("edge_time", 1.0), ("wave_time", 3.0)] {
        let time: Vec<f64> = values(&file, &format!("model/bodies/{name}"));
        assert!((time[0] * 500.0_f64.sqrt() - length).abs() < 1e-14);
    }
    let pressure: Vec<f64> = values(&file, "VTKHDF/PointData/CONTACT_PRESSURE");
    assert_eq!(pressure[F * N - 1], 2.5);
}

#[test]
fn the_record_says_what_ran() {
    let (_folder, _, file) = written();
    let run = file.group("run").expect("run");
    assert_eq!(text(&run, "program"), "stickslip");
    assert_eq!(text(&run, "deck"), deck_text());
    assert_eq!(text(&run, "deck_sha256").len(), 64);
    assert_eq!(text(&run, "command"), "stickslip run 'a b.inp'");
    assert!(text(&run, "finished") >= text(&run, "started"));
    let status: i64 = run
        .attr("exit_status")
        .expect("status")
        .read_scalar()
        .expect("status");
    assert_eq!(status, 0);
    for name in [
        "seconds_assembly",
        "seconds_factorization",
        "seconds_solve",
        "seconds_contact",
        "seconds_lcp",
        "seconds_output",
        "seconds_total",
    ] {
        let seconds: f64 = run.attr(name).expect(name).read_scalar().expect(name);
        assert!(seconds >= 0.0);
    }
}

#[test]
fn datasets_have_no_modification_time() {
    let (_folder, files, file) = written();
    let mut found = vec![];
    datasets(&file, "", &mut found);
    for (path, dataset) in found {
        let info = dataset.loc_info().expect("info");
        assert_eq!(info.mtime, 0, "{path} of {files:?}");
    }
}

#[test]
fn the_summary_reads_it_all_back() {
    let (_folder, files, file) = written();
    drop(file);
    let summary = ResultSummary::read(&files.result).expect("summary");
    assert_eq!((summary.nodes, summary.elements), (N, E));
    assert_eq!((summary.increments, summary.frames.len()), (INCREMENTS, F));
    assert_eq!(summary.contacts[1], ("BOTTOM_TOP_2".into(), 20.0));
    assert_eq!((summary.exit_status, summary.landings), (0, 1));
    let lines = summary.lines();
    assert!(lines.iter().all(|line| !line.is_empty()), "{lines:?}");
    let wrong = files.status;
    assert!(ResultSummary::read(&wrong).is_err());
}

#[test]
fn status_file_has_fixed_columns() {
    let (_folder, files, _) = written();
    let text = fs::read_to_string(files.status).expect("status");
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "# stickslip status file, format 1");
    assert_eq!(lines.len(), 2 + INCREMENTS);
    let names = lines[1].trim_start_matches('#').split_whitespace();
    let names: Vec<&str> = names.collect();
    assert_eq!((names.len(), &names[13..]), (15, &["U1(70)", "U2(10)"][..]));
    for (i, line) in lines[2..].iter().enumerate() {
        assert_eq!(line.len(), lines[1].len(), "{line}");
        let values = line.split_whitespace();
        let values: Vec<f64> = values.map(|v| v.parse().expect("number")).collect();
        let u = report(i + 1).state.u;
        for (value, dof) in values[13..].iter().zip([12, 1]) {
            assert!((value - u[dof]).abs() <= 1e-9 * u[dof].abs(), "{line}");
        }
    }
}

#[test]
fn names_with_a_slash_are_refused_before_any_file() {
    let folder = TempDir::new().expect("folder");
    let files = JobFiles::new("x.inp".as_ref(), folder.path());
    let mut model = model();
    model.sets.nodes[1].name = "A/B".into();
    let record = crate::writers::record();
    let verbosity = stickslip::output::Verbosity::Quiet;
    let claim =
        stickslip::output::Claim::take(&files, stickslip::output::Earlier::Stays).expect("claim");
    let Err(error) =
        stickslip::output::ResultWriter::create((&model, &[]), claim, &record, verbosity)
    else {
        panic!("accepted");
    };
    assert!(error.to_string().contains("node set name 'A/B'"));
    assert!(files.existing().is_empty());
}
