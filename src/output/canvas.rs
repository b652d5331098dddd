//! The canvas of an SVG picture. The canvas maps places of the model to points of the picture (y points upwards in the
//! model), and draws marks and a legend with a symbol and a text for everything that is drawn.

use std::collections::HashMap;
use std::fmt::Write;

use super::format::general;

/// Width of the drawing without margins and legend.
const WIDTH: f64 = 860.0;
/// Largest and smallest height of the drawing.
const HEIGHTS: [f64; 2] = [760.0, 160.0];
/// Width of the space around the drawing, for arrows and names.
const MARGIN: f64 = 70.0;
/// Width of the part of this space into which bodies and surfaces reach that are not shown completely.
const BEYOND: f64 = 20.0;
/// Width of the legend; its line height, and the largest numbers of characters in a line and of lines follow.
const LEGEND: f64 = 300.0;
const LEGEND_LINE: f64 = 20.0;
const LONGEST: usize = 40;
const MOST_LINES: usize = 32;

const INK: &str = "#222222";
const GREY: &str = "#777777";

/// A point of the picture, or a vector in it, in pixels, with y downwards.
pub(super) type Pixels = [f64; 2];

/// Colour of the line and its width in pixels.
#[derive(Clone, Copy)]
pub(super) struct Pen(pub &'static str, pub f64);

/// Symbol in front of a line of the legend.
#[derive(Clone, Copy)]
pub(super) enum Symbol {
    /// A filled rectangle.
    Fill(&'static str),
    /// A line.
    Line(Pen),
    /// A line with dots, which represent the nodes of a slave surface.
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

/// An SVG picture being drawn.
pub(super) struct Canvas {
    body: String,
    /// Smallest and largest coordinates of the part of the model that is shown.
    extents: [[f64; 2]; 2],
    /// The part of the model that is shown, with the space around it.
    area: Window,
    /// Pixels per unit of length.
    scale: f64,
    /// Width and height of the drawing.
    size: [f64; 2],
    /// Lines of the legend, without duplicates.
    legend: Vec<(Symbol, String)>,
}

impl Canvas {
    /// An empty canvas that shows a part of the plane.
    pub fn new(window: Window) -> Self {
        let Window(extents) = window;
        // half of the size, which does not overflow
        let half = [0, 1].map(|i| extents[1][i] / 2.0 - extents[0][i] / 2.0);
        let scale = (WIDTH / half[0]).min(HEIGHTS[0] / half[1]) / 2.0;
        let inner = half.map(|half| 2.0 * half * scale);
        let size = [inner[0].max(WIDTH / 2.0), inner[1].max(HEIGHTS[1])];
        let beyond = [0, 1].map(|i| ((size[i] - inner[i]) / 2.0 + BEYOND) / scale);
        Canvas {
            body: String::new(),
            extents,
            area: window.widened(beyond),
            scale,
            size,
            legend: Vec::new(),
        }
    }

    /// The point of the picture for a place of the model; the model is in the middle of the picture.
    pub fn at(&self, x: [f64; 2]) -> Pixels {
        let from_middle = |i: usize| {
            let [low, high] = [self.extents[0][i], self.extents[1][i]];
            (x[i] - (low / 2.0 + high / 2.0)) * self.scale
        };
        let middle = self.size.map(|size| MARGIN + size / 2.0);
        [middle[0] + from_middle(0), middle[1] - from_middle(1)]
    }

    /// Whether a place is shown.
    pub fn shows(&self, x: [f64; 2]) -> bool {
        self.area.holds(x)
    }

    /// The point of a place for a mark, if the place is shown and has room; the mark then occupies this room.
    pub fn room(&self, place: [f64; 2], spacing: &mut Spacing) -> Option<Pixels> {
        let at = self.at(place);
        (self.area.holds(place) && spacing.takes(at)).then_some(at)
    }

    /// The part of a line between two places that is shown.
    pub fn part(&self, line: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        self.area.part(line)
    }

    /// Number of pixels of a length of the model.
    pub fn pixels(&self, length: f64) -> f64 {
        length * self.scale
    }

    /// Draws closed loops of places, filled; a part inside two loops is a hole.
    pub fn fill(&mut self, loops: &[Vec<[f64; 2]>], colour: &str, pen: Pen) {
        let path: String = loops.iter().map(|places| self.path(places) + "Z").collect();
        let Pen(stroke, width) = pen;
        let is_whole = loops.iter().flatten().all(|&place| self.shows(place));
        let clip = if is_whole {
            ""
        } else {
            " clip-path=\"url(#area)\""
        };
        self.tag(&format!(
            "<path d=\"{path}\" fill=\"{colour}\" fill-rule=\"evenodd\" stroke=\"{stroke}\" \
             stroke-width=\"{width}\"{clip}/>"
        ));
    }

    /// Draws lines between two places each, as far as they are shown.
    pub fn lines(&mut self, lines: &[[[f64; 2]; 2]], pen: Pen) {
        let parts = lines.iter().filter_map(|&line| self.part(line));
        let path: String = parts.map(|part| self.path(&part)).collect();
        self.stroke(&path, pen);
    }

    fn path(&self, places: &[[f64; 2]]) -> String {
        let mut path = String::new();
        for (i, &place) in places.iter().enumerate() {
            let [x, y] = self.at(place);
            let letter = if i == 0 { 'M' } else { 'L' };
            // writing to a string does not fail
            let _ = write!(path, "{letter}{x:.1} {y:.1}");
        }
        path
    }

    /// Draws a path through points of the picture.
    pub fn stroke(&mut self, path: &str, Pen(colour, width): Pen) {
        if !path.is_empty() {
            self.tag(&format!(
                "<path d=\"{path}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
                 stroke-linecap=\"round\" stroke-linejoin=\"round\"/>"
            ));
        }
    }

    /// Draws a filled polygon of points.
    pub fn polygon(&mut self, points: &[Pixels], colour: &str) {
        let points: Vec<String> = points
            .iter()
            .map(|[x, y]| format!("{x:.1},{y:.1}"))
            .collect();
        self.tag(&format!(
            "<polygon points=\"{}\" fill=\"{colour}\"/>",
            points.join(" ")
        ));
    }

    /// Draws a dot with its centre at a point.
    pub fn dot(&mut self, [x, y]: Pixels, radius: f64, colour: &str) {
        self.tag(&format!(
            "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{colour}\"/>"
        ));
    }

    /// Draws a filled rectangle around a point, given by half its width and height.
    fn rectangle(&mut self, [x, y]: Pixels, [half_width, half_height]: Pixels, colour: &str) {
        let ([x0, x1], [y0, y1]) = (
            [x - half_width, x + half_width],
            [y - half_height, y + half_height],
        );
        self.polygon(&[[x0, y0], [x1, y0], [x1, y1], [x0, y1]], colour);
    }

    /// Draws a square, the mark of a node that is held in both directions.
    pub fn fixed(&mut self, at: Pixels, colour: &str) {
        self.rectangle(at, [3.5, 3.5], colour);
    }

    /// Draws a triangle below the node if y is held, or on its left if x is held.
    pub fn guided(&mut self, [x, y]: Pixels, direction: usize, colour: &str) {
        let (half, deep) = (3.5, 7.0);
        let corners = match direction {
            0 => [[x, y], [x - deep, y - half], [x - deep, y + half]],
            _ => [[x, y], [x - half, y + deep], [x + half, y + deep]],
        };
        self.polygon(&corners, colour);
    }

    /// Draws an arrow from `from` along the vector `way`.
    pub fn arrow(&mut self, from: Pixels, direction: Pixels, pen: Pen) {
        let length = direction[0].hypot(direction[1]);
        if !(length > 0.0 && length.is_finite()) {
            return;
        }
        let to = [from[0] + direction[0], from[1] + direction[1]];
        let e = direction.map(|x| x / length);
        let head = (3.0 + 2.0 * pen.1).min(0.6 * length);
        let base = [to[0] - head * e[0], to[1] - head * e[1]];
        let [x0, y0] = from;
        self.stroke(
            &format!("M{x0:.1} {y0:.1}L{:.1} {:.1}", base[0], base[1]),
            pen,
        );
        let side = [-0.45 * head * e[1], 0.45 * head * e[0]];
        let corners = [
            to,
            [base[0] + side[0], base[1] + side[1]],
            [base[0] - side[0], base[1] - side[1]],
        ];
        self.polygon(&corners, pen.0);
    }

    /// Writes text with a white rim; `anchor` is start, middle or end.
    pub fn label(&mut self, [x, y]: Pixels, anchor: &str, colour: &str, text: &str) {
        let text = escaped(text);
        let place = format!("x=\"{x:.1}\" y=\"{y:.1}\" text-anchor=\"{anchor}\"");
        let rim = "fill=\"#ffffff\" stroke=\"#ffffff\" stroke-width=\"3\"";
        self.tag(&format!("<text {place} {rim}>{text}</text>"));
        self.tag(&format!("<text {place} fill=\"{colour}\">{text}</text>"));
    }

    /// Adds a line to the legend, unless it is there already.
    pub fn explain(&mut self, symbol: Symbol, text: &str) {
        if !self.legend.iter().any(|(_, known)| known == text) {
            self.legend.push((symbol, text.to_owned()));
        }
    }

    /// Draws title and extents.
    fn frame(&mut self, title: &str) {
        self.label([MARGIN, 24.0], "start", INK, title);
        let [low, high] = self.extents;
        let ([left, bottom], [right, top]) = (self.at(low), self.at(high));
        let (y, x) = (self.size[1] + 1.6 * MARGIN, 0.45 * MARGIN);
        let (pen, y0, x0) = (Pen(GREY, 1.0), y - 4.0, x - 4.0);
        let across =
            format!("M{left:.1} {y:.1}H{right:.1}M{left:.1} {y0:.1}v8M{right:.1} {y0:.1}v8");
        self.stroke(&across, pen);
        let up = format!("M{x:.1} {bottom:.1}V{top:.1}M{x0:.1} {bottom:.1}h8M{x0:.1} {top:.1}h8");
        self.stroke(&up, pen);
        for (at, value) in [
            ([left, y + 18.0], low[0]),
            ([right, y + 18.0], high[0]),
            ([x, bottom + 16.0], low[1]),
            ([x, top - 8.0], high[1]),
        ] {
            self.label(at, "middle", GREY, &general(value, 4));
        }
    }

    /// Draws the legend on the right; returns the height that it needs.
    fn draw_legend(&mut self) -> f64 {
        let mut legend = std::mem::take(&mut self.legend);
        let more = legend.len().saturating_sub(MOST_LINES);
        if more > 0 {
            legend.truncate(MOST_LINES);
            legend.push((Symbol::None, format!("and {more} more")));
        }
        let (x, mut y) = (self.size[0] + 2.0 * MARGIN, MARGIN);
        for (symbol, text) in &legend {
            self.symbol(*symbol, [x, y]);
            let mut cut: String = text.chars().take(LONGEST).collect();
            if cut.len() < text.len() {
                cut.push_str("...");
            }
            self.label([x + 36.0, y + 4.0], "start", INK, &cut);
            y += LEGEND_LINE;
        }
        y + MARGIN
    }

    fn symbol(&mut self, symbol: Symbol, [x, y]: Pixels) {
        let line = format!("M{x:.1} {y:.1}h26");
        match symbol {
            Symbol::Fill(colour) => self.rectangle([x + 13.0, y], [13.0, 6.0], colour),
            Symbol::Line(pen) => self.stroke(&line, pen),
            Symbol::Dotted(pen) => {
                self.stroke(&line, pen);
                for i in 0..3 {
                    self.dot([x + 3.0 + 10.0 * f64::from(i), y], 2.5, pen.0);
                }
            }
            Symbol::Arrow(pen) => self.arrow([x, y], [26.0, 0.0], pen),
            Symbol::Fixed(colour) => self.fixed([x + 13.0, y], colour),
            Symbol::Guided(colour) => self.guided([x + 13.0, y - 4.0], 1, colour),
            Symbol::None => {}
        }
    }

    fn tag(&mut self, tag: &str) {
        self.body.push_str(tag);
        self.body.push('\n');
    }

    /// The whole picture.
    pub fn text(mut self, title: &str) -> String {
        self.frame(title);
        let of_legend = self.draw_legend();
        let width = self.size[0] + 2.0 * MARGIN + LEGEND;
        let height = (self.size[1] + 2.0 * MARGIN).max(of_legend);
        let from = MARGIN - BEYOND;
        let [across, down] = self.size.map(|size| size + 2.0 * BEYOND);
        format!(
            "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width:.0}\" height=\"{height:.0}\" \
             viewBox=\"0 0 {width:.0} {height:.0}\" font-family=\"sans-serif\" font-size=\"12\">\n\
             <clipPath id=\"area\"><rect x=\"{from}\" y=\"{from}\" width=\"{across:.1}\" \
             height=\"{down:.1}\"/></clipPath>\n\
             <rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n{}</svg>\n",
            self.body
        )
    }
}

/// A rectangle, given by its smallest and largest coordinates (length).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Window(pub [[f64; 2]; 2]);

impl Window {
    /// The rectangle widened on every side (length).
    fn widened(self, [x, y]: [f64; 2]) -> Self {
        let Window([low, high]) = self;
        Window([[low[0] - x, low[1] - y], [high[0] + x, high[1] + y]])
    }

    /// Whether a place lies in the rectangle.
    fn holds(&self, x: [f64; 2]) -> bool {
        let Window([low, high]) = self;
        (0..2).all(|i| low[i] <= x[i] && x[i] <= high[i])
    }

    /// The part of a line from `a` to `b` that lies in the rectangle, after Liang & Barsky (1984).
    fn part(&self, [a, b]: [[f64; 2]; 2]) -> Option<[[f64; 2]; 2]> {
        let Window([low, high]) = self;
        let (mut start, mut end) = (0.0_f64, 1.0_f64);
        for i in 0..2 {
            let along = b[i] - a[i];
            let [enter, leave] = if along >= 0.0 {
                [low[i], high[i]]
            } else {
                [high[i], low[i]]
            };
            if along == 0.0 && !(low[i]..=high[i]).contains(&a[i]) {
                return None;
            }
            if along != 0.0 {
                start = start.max((enter - a[i]) / along);
                end = end.min((leave - a[i]) / along);
            }
        }
        let at = |part: f64| match part {
            0.0 => a,
            1.0 => b,
            _ => [0, 1].map(|i| a[i] + part * (b[i] - a[i])),
        };
        (start <= end).then(|| [at(start), at(end)])
    }
}

/// Text in which the characters with a meaning in SVG are escaped.
fn escaped(text: &str) -> String {
    let mut escaped = String::new();
    for c in text.chars() {
        match c {
            '&' => escaped.push_str("&amp;"),
            '<' => escaped.push_str("&lt;"),
            '>' => escaped.push_str("&gt;"),
            c if c.is_control() => escaped.push(' '),
            c => escaped.push(c),
        }
    }
    escaped
}

/// Keeps marks of one kind apart: few are drawn where many would cover each other.
pub(super) struct Spacing {
    distance: f64,
    taken: HashMap<[i64; 2], Pixels>,
}

impl Spacing {
    /// Keeps marks at least `distance` pixels apart.
    pub fn new(distance: f64) -> Self {
        Spacing {
            distance,
            taken: HashMap::new(),
        }
    }

    /// Whether there is room for a mark at a point; if so, the mark occupies it.
    pub fn takes(&mut self, at: Pixels) -> bool {
        // a cell has room for one mark
        let cell = at.map(|x| (x / self.distance * std::f64::consts::SQRT_2).floor() as i64);
        let is_near = |[x, y]: &Pixels| (x - at[0]).hypot(y - at[1]) < self.distance;
        for i in -2..=2 {
            for j in -2..=2 {
                let other = [cell[0].saturating_add(i), cell[1].saturating_add(j)];
                if self.taken.get(&other).is_some_and(is_near) {
                    return false;
                }
            }
        }
        self.taken.insert(cell, at);
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_stay_apart() {
        let mut spacing = Spacing::new(10.0);
        let points = [
            [0.0, 0.0],
            [9.0, 0.0],
            [10.0, 0.0],
            [-7.0, -7.0],
            [-7.0, -8.0],
        ];
        assert_eq!(
            points.map(|at| spacing.takes(at)),
            [true, false, true, false, true]
        );
    }

    #[test]
    fn text_is_escaped() {
        assert_eq!(escaped("a<b>&\u{1}c"), "a&lt;b&gt;&amp; c");
    }

    #[test]
    fn the_model_is_in_the_middle_and_upright() {
        let canvas = Canvas::new(Window([[1.0, 2.0], [5.0, 4.0]]));
        let ([x0, y0], [x1, y1]) = (canvas.at([1.0, 2.0]), canvas.at([5.0, 4.0]));
        assert!((x1 - x0 - 860.0).abs() < 1e-9 && (y0 - y1 - 430.0).abs() < 1e-9);
        assert!((x0 - MARGIN).abs() < 1e-9 && (y1 - MARGIN).abs() < 1e-9);
    }

    #[test]
    fn lines_end_at_the_sides_of_a_window() {
        let window = Window([[0.0, 0.0], [2.0, 1.0]]);
        let part = |a, b| window.part([a, b]);
        assert_eq!(
            part([-8.0, 0.5], [12.0, 0.5]),
            Some([[0.0, 0.5], [2.0, 0.5]])
        );
        assert_eq!(
            part([12.0, 0.5], [-8.0, 0.5]),
            Some([[2.0, 0.5], [0.0, 0.5]])
        );
        assert_eq!(
            part([0.5, 0.5], [1.0, 0.75]),
            Some([[0.5, 0.5], [1.0, 0.75]])
        );
        assert_eq!(part([-1.0, 2.0], [3.0, 2.0]), None);
        assert_eq!(part([-2.0, 0.0], [0.0, 3.0]), None);
        assert_eq!(part([3.0, -1.0], [3.0, 2.0]), None);
    }
}
