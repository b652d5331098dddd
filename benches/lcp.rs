//! Time of the LCP methods on contacts of an elastic block, Q given.
//!
//! `cargo bench --bench lcp` measures 16 to 1024 contacts at the Courant numbers 1 and 100 with
//! mu = 0.3, planted states (30 % open, 40 % stick, 30 % slip) and warm states of which 3 % are
//! wrong; then, in one run at 1024 contacts, the ratios to a dense N x (N + 1) tableau.

use std::hint::black_box;
use std::time::{Duration, Instant};

use criterion::{BenchmarkId, Criterion};
use nalgebra::DVector;
use stickslip::lcp::{ContactState, FrictionalLcp, Lcp, LcpMethod, solve_frictional};

#[path = "../tests/lcp/block.rs"]
mod block;
#[path = "../tests/lcp/problems.rs"]
#[allow(dead_code)] // shared with the tests
mod problems;
#[path = "../tests/lcp/random.rs"]
#[allow(dead_code)] // shared with the tests
mod random;
#[path = "../tests/lcp/tableau.rs"]
#[allow(dead_code)] // shared with the tests
mod tableau;

use block::block_delassus;
use problems::{planted, states};
use random::Random;
use tableau::tableau_lemke;

const MU: f64 = 0.3;

/// A problem and states of which 3 % are wrong.
fn case(n: usize, courant: f64) -> (FrictionalLcp, Vec<ContactState>) {
    let mut random = Random(5);
    // Scaled to entries near 1, which the tableau needs and the other methods do not notice.
    let q = block_delassus(n, 8, courant);
    let q = &q / q[(0, 0)];
    let mut warm = states(&mut random, n, 0.3, 0.4);
    let problem = planted(&mut random, q, DVector::from_element(n, MU), &warm).0;
    for _ in 0..(0.03 * n as f64).ceil() as usize {
        let contact = random.below(n);
        warm[contact] = match warm[contact] {
            ContactState::Open => ContactState::Stick,
            ContactState::Stick => ContactState::SlipPlus,
            ContactState::SlipPlus | ContactState::SlipMinus => ContactState::Open,
        };
    }
    (problem, warm)
}

/// The general form with its covering vector (1, 1/(1 + mu), 0).
fn general(problem: &FrictionalLcp) -> (Lcp, Vec<f64>) {
    let n = problem.len();
    let d = (0..3 * n)
        .map(|i| [1.0, 1.0 / (1.0 + MU), 0.0][i / n])
        .collect();
    (problem.to_lcp(), d)
}

fn methods(criterion: &mut Criterion) {
    for courant in [1.0, 100.0] {
        let mut group = criterion.benchmark_group(format!("C={courant}"));
        group
            .sample_size(10)
            .measurement_time(Duration::from_secs(2));
        for n in [16, 64, 256, 1024] {
            let (problem, warm) = case(n, courant);
            let problem = &problem;
            let solve = |warm, method| solve_frictional(black_box(problem), warm, method);
            let id = |name| BenchmarkId::new(name, n);
            group.bench_function(id("lemke"), |b| b.iter(|| solve(None, LcpMethod::Lemke)));
            group.bench_function(id("hybrid cold"), |b| {
                b.iter(|| solve(None, LcpMethod::Hybrid))
            });
            group.bench_function(id("hybrid warm"), |b| {
                b.iter(|| solve(Some(&warm), LcpMethod::Hybrid))
            });
            if n <= 256 {
                let (lcp, d) = general(problem);
                group.bench_function(id("tableau"), |b| b.iter(|| tableau_lemke(&lcp, &d)));
            }
        }
        group.finish();
    }
}

/// Smallest of three times of `f`, in milliseconds.
fn milliseconds<T>(mut f: impl FnMut() -> T) -> f64 {
    let time = |_| {
        let start = Instant::now();
        black_box(f());
        start.elapsed().as_secs_f64() * 1e3
    };
    (0..3).map(time).fold(f64::INFINITY, f64::min)
}

/// Prints what 1024 contacts cost, and the ratios to the tableau.
fn ratios() {
    for courant in [1.0, 100.0] {
        let (problem, warm) = case(1024, courant);
        let (lcp, d) = general(&problem);
        let tableau = milliseconds(|| tableau_lemke(&lcp, &d).expect("no ray"));
        println!("1024 contacts, C = {courant}: dense tableau {tableau:.0} ms");
        let runs = [
            ("lemke", None, LcpMethod::Lemke),
            ("hybrid cold", None, LcpMethod::Hybrid),
            ("hybrid warm", Some(warm.as_slice()), LcpMethod::Hybrid),
        ];
        for (name, warm, method) in runs {
            let time = milliseconds(|| solve_frictional(&problem, warm, method));
            let solution = solve_frictional(&problem, warm, method).expect("a solution");
            println!(
                "  {name}: {time:.1} ms, {:.1} x; {:?}",
                tableau / time,
                solution.counters
            );
        }
    }
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    methods(&mut criterion);
    criterion.final_summary();
    // `cargo test --benches` runs every measurement once; the ratios take half a minute.
    if std::env::args().any(|a| a == "--bench") {
        ratios();
    }
}
