//! Time of contact search against the number of segments.
//!
//! `cargo bench --bench search` measures a lattice of discs in contact with all others and with
//! themselves: a new search, pairing with valid lists, the penetration check of an
//! increment, and the search among all segments.

#[path = "../tests/contact/scenes.rs"]
mod scenes;

use std::hint::black_box;
use std::time::Duration;

use criterion::{BenchmarkId, Criterion, Throughput};
use scenes::{DISC, lattice};
use stickslip::contact::{
    ClosedPairs, Positions, RowForm, Search, SlaveChoice, SlaveNode, all_segments,
    find_penetration, find_targets,
};

/// Segments searched in one go: in many small scenes, or few large ones. Only so do caches and
/// branch predictors not learn the small ones by heart.
const TOTAL: usize = 200_000;

/// Displacements number `k` of the discs of a lattice: all are further than any margin from where
/// they were, and turned and pushed by other amounts.
fn elsewhere(x: &[[f64; 2]], k: usize) -> Vec<f64> {
    let shift = [0.0, 9.0][k % 2];
    let mut u = Vec::with_capacity(2 * x.len());
    for (i, disc) in x.chunks(DISC).enumerate() {
        let centre = [0, 1].map(|c| disc.iter().map(|p| p[c]).sum::<f64>() / DISC as f64);
        let by_chance = 1e3 * ((i + 1) as f64 * (k + 1) as f64).sin();
        let (sin, cos) = by_chance.sin_cos();
        let push = [0.03 * sin, 0.03 * (2.0 * by_chance).sin()];
        for p in disc {
            let r = [p[0] - centre[0], p[1] - centre[1]];
            let turned = [cos * r[0] - sin * r[1], sin * r[0] + cos * r[1]];
            u.extend([0, 1].map(|c| shift + push[c] + turned[c] - r[c]));
        }
    }
    u
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("search");
    group
        .sample_size(10)
        .measurement_time(Duration::from_secs(2));
    for n in [100, 1_000, 10_000, 100_000] {
        let (surfaces, x) = lattice(n);
        let contacts = [surfaces];
        let u = vec![0.0; 2 * x.len()];
        let mut search = Search::new(&contacts, &x);
        let places: Vec<_> = (0..TOTAL / n).map(|k| elsewhere(&x, k)).collect();
        group.throughput(Throughput::Elements(TOTAL as u64));
        group.bench_function(BenchmarkId::new("anew", n), |bencher| {
            bencher.iter(|| {
                for u in &places {
                    search.cover(black_box(u));
                }
                search.searches()
            });
        });
        group.throughput(Throughput::Elements(n as u64));
        search.cover(&u);
        let mut pairs = Vec::new();
        group.bench_function(BenchmarkId::new("pairs", n), |bencher| {
            bencher.iter(|| {
                search.cover(black_box(&u));
                find_targets(
                    &search,
                    [&u, &u],
                    &[],
                    (&ClosedPairs::default(), None),
                    (RowForm::DiscreteGradient, SlaveChoice::All),
                    &mut pairs,
                );
                pairs.len()
            });
        });
        let moved: Vec<f64> = (0..u.len()).map(|i| 1e-3 * (i as f64).sin()).collect();
        let closed = ClosedPairs::default();
        let unsolved = vec![0.0; x.len()];
        group.bench_function(BenchmarkId::new("ways", n), |bencher| {
            bencher.iter(|| {
                search.cover_path(&u, &moved);
                find_penetration(&search, [&u, black_box(&moved)], [&closed; 2], &unsolved)
            });
        });
        if n <= 1_000 {
            group.bench_function(BenchmarkId::new("all_segments", n), |bencher| {
                let [surfaces] = &contacts;
                let targets = |slave: usize| {
                    let node = SlaveNode {
                        surfaces,
                        start: Positions::new(&x, &u),
                        now: Positions::new(&x, black_box(&u)),
                        slave,
                        closed_on: &[],
                        allowed: [0.0; 2],
                    };
                    node.targets(all_segments(surfaces)).len()
                };
                bencher.iter(|| (0..surfaces.slaves.len()).map(targets).sum::<usize>());
            });
        }
    }
    group.finish();
    criterion.final_summary();
}
