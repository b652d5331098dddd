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
    let surfaces = ContactSurfaces::new(slaves, &segments.clone(), segments);
    (surfaces, x)
}

/// Segments of a disc of a lattice.
pub const DISC: usize = 32;

/// Discs, about `segments` segments, in fours with small distances. The fours lie in a square
/// lattice and too far apart to touch: what a disc has near it does not depend on their number.
pub fn lattice(segments: usize) -> (ContactSurfaces, Vec<[f64; 2]>) {
    let fours = segments.div_ceil(4 * DISC);
    let columns = (fours as f64).sqrt().ceil() as usize;
    let disc = |i: usize| {
        let four = [i / 4 % columns, i / 4 / columns];
        let place = [i % 2, i % 4 / 2];
        let centre = [0, 1].map(|k| 6.0 * four[k] as f64 + 2.1 * place[k] as f64);
        (centre, 1.0, DISC, 0.0)
    };
    scene(&(0..4 * fours).map(disc).collect::<Vec<_>>())
}
