//! Vectors of the plane: products, lengths and angles.

mod bounding_circles;

pub(crate) use bounding_circles::{Circle, CircleTree};

/// From `p` to `q`: q - p.
#[inline]
pub fn difference(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [q[0] - p[0], q[1] - p[1]]
}

/// Scalar product p.q.
#[inline]
pub fn dot(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[0] + p[1] * q[1]
}

/// Cross product p x q, the component out of the plane: positive where q lies to the left of p.
#[inline]
pub fn cross(p: [f64; 2], q: [f64; 2]) -> f64 {
    p[0] * q[1] - p[1] * q[0]
}

/// Length sqrt(p.p), for lengths whose squares neither overflow nor underflow.
#[inline]
pub fn length(p: [f64; 2]) -> f64 {
    dot(p, p).sqrt()
}

/// Distance of two points, also of those so near or far that its square underflows or overflows.
#[inline]
pub fn distance(p: [f64; 2], q: [f64; 2]) -> f64 {
    let d = difference(p, q);
    match dot(d, d) {
        square if square.is_normal() => square.sqrt(),
        _ => d[0].hypot(d[1]),
    }
}

/// Angle from p to q, between -pi and pi, positive to the left (rad).
#[inline]
pub fn angle(p: [f64; 2], q: [f64; 2]) -> f64 {
    cross(p, q).atan2(dot(p, q))
}

/// Area of a polygon with the given corners, counter-clockwise: sum (p_i - p_0) x (p_i+1 - p_0) / 2.
pub fn polygon_area(corners: impl IntoIterator<Item = [f64; 2]>) -> f64 {
    let mut corners = corners.into_iter();
    let Some(first) = corners.next() else {
        return 0.0;
    };
    // the terms of the first and last side are zero, being relative to the first corner
    let mut last = [0.0; 2];
    let terms = corners.map(|corner| {
        let side = [last, difference(first, corner)];
        last = side[1];
        cross(side[0], side[1])
    });
    terms.sum::<f64>() / 2.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn products_of_vectors_by_hand() {
        let (p, q) = ([3.0, 4.0], [-4.0, 3.0]);
        assert_eq!((dot(p, q), cross(p, q), cross(q, p)), (0.0, 25.0, -25.0));
        assert_eq!((length(p), difference(p, q)), (5.0, [-7.0, -1.0]));
        assert_eq!(angle(p, q), std::f64::consts::FRAC_PI_2);
        assert_eq!(angle(q, p), -std::f64::consts::FRAC_PI_2);
        for scale in [1.0, 1e-200, 1e200] {
            let [p, q] = [p, q].map(|p| p.map(|x| x * scale));
            assert_eq!(distance(p, q), 50f64.sqrt() * scale);
        }
    }
}
