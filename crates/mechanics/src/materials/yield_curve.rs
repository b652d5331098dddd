//! The yield curve of a metal whose element has hourglass modes, eq. (2.47). The curve limits the parts w and z of the
//! yield stress sigma_y that strain and modes use:
//!
//! ```text
//! z <= sqrt(3)/2 ((1 - e) (1 - w²) + e sqrt(1 - w²)),   w = cos t
//! ```

/// Ratio sqrt(3)/2 of the mean absolute value to the root mean square, of a stress that is linear over a section with
/// mean zero.
const FULL_SECTION: f64 = 0.866_025_403_784_438_6;
/// e.
const ROUNDED: f64 = 0.5;

/// Whether the stress sizes Q (strain) and H (modes) are within the curve for a yield stress.
pub(super) fn contains([q, h]: [f64; 2], stress: f64) -> bool {
    let rest = (stress - q) * (stress + q);
    q <= stress
        && h * stress <= FULL_SECTION * ((1.0 - ROUNDED) * rest + ROUNDED * stress * rest.sqrt())
}

/// The point of the curve at an angle, and its first and second derivative.
pub(super) fn at(angle: f64) -> [[f64; 2]; 3] {
    let (sin, cos) = angle.sin_cos();
    let (square, line) = (FULL_SECTION * (1.0 - ROUNDED), FULL_SECTION * ROUNDED);
    [
        [cos, (square * sin + line) * sin],
        [-sin, (2.0 * square * sin + line) * cos],
        [-cos, 2.0 * square * (cos * cos - sin * sin) - line * sin],
    ]
}
