//! The legend: a symbol and a text for everything that is drawn, and the contacts.

use super::canvas::{Canvas, MARGIN, Pen};

const LINE: f64 = 20.0;
const INK: &str = "#222222";
/// Most characters of a line.
const LONGEST: usize = 40;
/// Most lines.
const MOST: usize = 32;

/// What stands in front of a line of the legend.
#[derive(Clone, Copy)]
pub(super) enum Symbol {
    /// A filled square.
    Fill(&'static str),
    /// A line.
    Line(Pen),
    /// A line with dots, the nodes of a slave surface.
    Dotted(Pen),
    /// An arrow.
    Arrow(Pen),
    /// A support in both directions.
    Fixed(&'static str),
    /// A support in one direction.
    Guided(&'static str),
    /// Nothing.
    None,
}

/// Lines of the legend, each once.
#[derive(Default)]
pub(super) struct Legend(Vec<(Symbol, String)>);

impl Legend {
    /// Adds a line that is not there yet.
    pub fn add(&mut self, symbol: Symbol, text: &str) {
        if !self.0.iter().any(|(_, known)| known == text) {
            self.0.push((symbol, text.to_owned()));
        }
    }

    /// Draws the legend on the right.
    pub fn draw(mut self, canvas: &mut Canvas) {
        let more = self.0.len().saturating_sub(MOST);
        if more > 0 {
            self.0.truncate(MOST);
            self.0.push((Symbol::None, format!("and {more} more")));
        }
        let x = canvas.size[0] + 2.0 * MARGIN;
        for (i, (symbol, text)) in self.0.iter().enumerate() {
            let y = MARGIN + i as f64 * LINE;
            draw_symbol(*symbol, [x, y], canvas);
            let mut cut: String = text.chars().take(LONGEST).collect();
            if cut.len() < text.len() {
                cut.push_str("...");
            }
            canvas.label([x + 36.0, y + 4.0], "start", INK, &cut);
        }
        canvas.least_height = 2.0 * MARGIN + self.0.len() as f64 * LINE;
    }
}

fn draw_symbol(symbol: Symbol, [x, y]: [f64; 2], canvas: &mut Canvas) {
    let line = format!("M{x:.1} {y:.1}h26");
    match symbol {
        Symbol::Fill(colour) => {
            let (x1, y0, y1) = (x + 26.0, y - 6.0, y + 6.0);
            canvas.polygon(&[[x, y0], [x1, y0], [x1, y1], [x, y1]], colour);
        }
        Symbol::Line(pen) => canvas.stroke(&line, pen),
        Symbol::Dotted(pen) => {
            canvas.stroke(&line, pen);
            for i in 0..3 {
                canvas.dot([x + 3.0 + 10.0 * f64::from(i), y], 2.5, pen.0);
            }
        }
        Symbol::Arrow(pen) => canvas.arrow([x, y], [26.0, 0.0], pen),
        Symbol::Fixed(colour) => fixed([x + 13.0, y], canvas, colour),
        Symbol::Guided(colour) => guided([x + 13.0, y - 4.0], 1, canvas, colour),
        Symbol::None => {}
    }
}

/// A square: neither direction moves.
pub(super) fn fixed([x, y]: [f64; 2], canvas: &mut Canvas, colour: &str) {
    let r = 3.5;
    canvas.polygon(
        &[
            [x - r, y - r],
            [x + r, y - r],
            [x + r, y + r],
            [x - r, y + r],
        ],
        colour,
    );
}

/// A triangle below the node (y is held) or on its left (x is held).
pub(super) fn guided([x, y]: [f64; 2], direction: usize, canvas: &mut Canvas, colour: &str) {
    let (half, deep) = (3.5, 7.0);
    let corners = match direction {
        0 => [[x, y], [x - deep, y - half], [x - deep, y + half]],
        _ => [[x, y], [x - half, y + deep], [x + half, y + deep]],
    };
    canvas.polygon(&corners, colour);
}
