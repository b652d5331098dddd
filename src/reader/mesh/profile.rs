//! Rows of `*SURFACE, TYPE=SEGMENTS`.

use crate::deck::{Card, Row};
use crate::diagnostics::{Code, Diagnostic, Span, shown};
use crate::reader::context::Context;
use crate::vectors::{angle, difference};

/// Largest angle that a chord of an arc subtends.
const CHORD: f64 = std::f64::consts::PI / 180.0;
/// Largest relative difference of an arc's radii at its ends; smallest difference of its angle from
/// 180 degrees, in radians.
const ARC_ROUND_OFF: f64 = 1e-4;

/// A rigid profile: points and the sides between them, with the rigid body on the right of each
/// side.
#[derive(Default)]
pub(crate) struct Profile {
    /// Points in the order of the rows.
    pub points: Vec<[f64; 2]>,
    /// Chords [from, to] between the points.
    sides: Vec<[usize; 2]>,
    /// First point of the chain that is read.
    start: usize,
    /// Last point so far.
    end: usize,
}

impl Profile {
    /// Reads the rows of a card up to the first that has an error.
    pub fn read(card: &Card, cx: &mut Context) -> Profile {
        let mut profile = Profile::default();
        for row in card.rows.iter() {
            if profile.row(row, cx).is_none() {
                return profile;
            }
        }
        profile.drop_lone_point();
        if profile.sides.is_empty() && !card.rows.is_empty() {
            fault(
                card.span,
                "this rigid surface has no segments",
                "add LINE or CIRCL rows",
                cx,
            );
        }
        profile
    }

    /// Segments between nodes of which the first point is number `first`: the body lies on the
    /// left of the direction from a to b, so that they run from the last row to the first.
    pub fn segments(&self, first: usize) -> Vec<[usize; 2]> {
        let sides = self.sides.iter().rev();
        sides.map(|[from, to]| [first + to, first + from]).collect()
    }

    fn row(&mut self, row: Row, cx: &mut Context) -> Option<()> {
        let word = row.required(0, "START, LINE or CIRCL", cx.d)?;
        let kind = word.name_key();
        match kind.as_str() {
            "START" => self.start(point(row, 1, 3, cx)?),
            "LINE" | "CIRCL" if self.points.is_empty() => {
                let help = "begin with START, x, y";
                return fault(word.span, "the profile has no starting point", help, cx);
            }
            "LINE" => {
                let to = point(row, 1, 3, cx)?;
                if self.points.get(self.end) == Some(&to) {
                    return fault(row.span(), "this line has no length", "leave it out", cx);
                }
                self.side_to(to);
            }
            "CIRCL" => {
                let (to, centre) = (point(row, 1, 5, cx)?, point(row, 3, 5, cx)?);
                self.arc(to, centre, row, cx)?;
            }
            "PARAB" => {
                let help = "give it with LINE or CIRCL";
                return fault(word.span, "parabolas are not supported", help, cx);
            }
            _ => {
                let message = format!("expected START, LINE or CIRCL, found `{}`", word.text);
                return fault(
                    word.span,
                    &message,
                    "a profile is START, x, y; LINE, x, y; CIRCL, x, y, xc, yc",
                    cx,
                );
            }
        }
        Some(())
    }

    fn start(&mut self, at: [f64; 2]) {
        self.drop_lone_point();
        self.start = self.points.len();
        self.end = self.start;
        self.points.push(at);
    }

    /// Drops the last point if no side begins or ends there: a START without a LINE or CIRCL.
    fn drop_lone_point(&mut self) {
        let is_last = |end: &usize| end + 1 == self.points.len();
        if !self.sides.iter().rev().take(1).flatten().any(is_last) {
            self.points.pop();
        }
    }

    /// A chord to the next point, which may be the first of the chain again.
    fn side_to(&mut self, to: [f64; 2]) {
        let closes = self.points.get(self.start) == Some(&to);
        let next = if closes {
            self.start
        } else {
            self.points.len()
        };
        if !closes {
            self.points.push(to);
        }
        self.sides.push([self.end, next]);
        self.end = next;
    }

    /// Equal chords of at most [`CHORD`] on the shorter arc about a centre.
    fn arc(&mut self, to: [f64; 2], centre: [f64; 2], row: Row, cx: &mut Context) -> Option<()> {
        let from = *self.points.get(self.end)?;
        let [p, q] = [from, to].map(|x| difference(centre, x));
        let [r, s] = [p, q].map(|[x, y]| x.hypot(y));
        let angle = angle(p, q);
        let help = "an arc of less than 180 degrees from the point before to x, y about xc, yc";
        if (r - s).abs() > ARC_ROUND_OFF * r.max(s) {
            let message = format!(
                "the ends of this arc are {} and {} away from its centre",
                shown(r),
                shown(s)
            );
            return fault(row.span(), &message, help, cx);
        }
        if angle == 0.0 || angle.abs() > std::f64::consts::PI - ARC_ROUND_OFF {
            let message = format!("this arc has {} degrees", shown(angle.abs().to_degrees()));
            return fault(row.span(), &message, help, cx);
        }
        // round-off must not add a chord to angles such as 90 degrees
        let count = (angle.abs() / CHORD * (1.0 - 1e-9)).ceil();
        for k in 1..count as usize {
            let part = k as f64 / count;
            let (sin, cos) = (part * angle).sin_cos();
            let scale = 1.0 + part * (s / r - 1.0);
            self.side_to([
                centre[0] + scale * (cos * p[0] - sin * p[1]),
                centre[1] + scale * (sin * p[0] + cos * p[1]),
            ]);
        }
        self.side_to(to);
        Some(())
    }
}

/// The point in the fields `index` and the next, of `count` fields.
fn point(row: Row, index: usize, count: usize, cx: &mut Context) -> Option<[f64; 2]> {
    if index == 1 {
        row.at_most(count, cx.d);
    }
    let x = row.real(index, "a coordinate", cx.d);
    let y = row.real(index + 1, "a coordinate", cx.d);
    Some([x?, y?])
}

fn fault(span: Span, message: &str, help: &str, cx: &mut Context) -> Option<()> {
    cx.d.push(Diagnostic::error(Code::RigidSurface, span, message).help(help));
    None
}
