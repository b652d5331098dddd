//! Vectors of the plane: products, lengths and angles.

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

/// Angle from p to q, between -pi and pi, positive to the left (rad).
#[inline]
pub fn angle(p: [f64; 2], q: [f64; 2]) -> f64 {
    cross(p, q).atan2(dot(p, q))
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
    }
}
