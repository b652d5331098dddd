//! Scenes of many closed bodies for contact search.

use stickslip::contact::ContactSurfaces;

/// A body: centre, radius, number of nodes and the depth of its waves (in radii).
pub type Body = ([f64; 2], f64, usize, f64);

/// Bodies in contact with each other and with themselves.
pub fn scene(bodies: &[Body]) -> (ContactSurfaces, Vec<[f64; 2]>) {
    let mut x = Vec::new();
    let mut segments = Vec::new();
    for &(centre, radius, count, depth) in bodies {
        let first = x.len();
        for i in 0..count {
            let angle = std::f64::consts::TAU * i as f64 / count as f64;
            let r = radius * (1.0 + depth * (3.0 * angle).sin());
            x.push([centre[0] + r * angle.cos(), centre[1] + r * angle.sin()]);
            segments.push([first + i, first + (i + 1) % count]);
        }
    }
    let slaves = (0..x.len()).collect();
    let surfaces = ContactSurfaces::new(slaves, &segments.clone(), segments, 0.0);
    (surfaces, x)
}

/// Discs of 32 segments in a square lattice with small distances, about `segments` segments.
pub fn lattice(segments: usize) -> (ContactSurfaces, Vec<[f64; 2]>) {
    let discs = segments.div_ceil(32);
    let columns = (discs as f64).sqrt().ceil() as usize;
    let disc = |i: usize| {
        let centre = [i % columns, i / columns].map(|k| 2.1 * k as f64);
        (centre, 1.0, 32, 0.0)
    };
    scene(&(0..discs).map(disc).collect::<Vec<_>>())
}
