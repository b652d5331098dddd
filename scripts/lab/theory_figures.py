"""Draws the figures of docs/theory and of docs/architecture.md as SVG: curves from the equations, sketches from coordinates.

`scripts/lab/run theory_figures` writes them; a test compares the files with what it draws.
"""

import sys
from collections.abc import Callable, Iterable, Sequence
from functools import partial
from html import escape
from itertools import pairwise
from math import atan2, cos, exp, hypot, log, sin, sqrt
from pathlib import Path

ROOT = Path(__file__).parents[2]

Point = tuple[float, float]

BLACK, GREY, BLUE, RED, GREEN, PALE = "#222", "#888", "#1f5fa8", "#b3261e", "#2e7d32", "#e8eef6"
FONT = 14


class Drawing:
    """Shapes on a white sheet; y runs downwards, in pixels."""

    def __init__(self, width: int, height: int, title: str) -> None:
        self.width, self.height, self.title = width, height, title
        self.shapes: list[str] = []

    def line(
        self, points: Iterable[Point], color: str = BLACK, width: float = 1.5, dash: str = ""
    ) -> None:
        """A polyline; `dash` as in SVG."""
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        dashes = f' stroke-dasharray="{dash}"' if dash else ""
        self.shapes.append(
            f'<polyline points="{text}" fill="none" stroke="{color}" stroke-width="{width}"{dashes}/>'
        )

    def area(self, points: Iterable[Point], fill: str = PALE, color: str = BLACK) -> None:
        """A polygon."""
        text = " ".join(f"{x:.1f},{y:.1f}" for x, y in points)
        self.shapes.append(
            f'<polygon points="{text}" fill="{fill}" stroke="{color}" stroke-width="1.5"/>'
        )

    def dot(self, at: Point, radius: float = 4, fill: str = BLACK, color: str = BLACK) -> None:
        """A filled circle."""
        self.shapes.append(
            f'<circle cx="{at[0]:.1f}" cy="{at[1]:.1f}" r="{radius:.1f}" fill="{fill}" stroke="{color}"/>'
        )

    def cross(self, at: Point, color: str = RED, size: float = 4) -> None:
        """A mark of an integration point."""
        x, y = at
        self.line([(x - size, y - size), (x + size, y + size)], color)
        self.line([(x - size, y + size), (x + size, y - size)], color)

    def arrow(self, start: Point, end: Point, color: str = BLACK, width: float = 1.5) -> None:
        """A line with a head at its end."""
        angle = atan2(end[1] - start[1], end[0] - start[0])

        def wing(turn: float) -> Point:
            return (end[0] - 9 * cos(angle + turn), end[1] - 9 * sin(angle + turn))

        self.line([start, end], color, width)
        self.area([end, wing(0.4), wing(-0.4)], color, color)

    def text(
        self, at: Point, words: str, color: str = BLACK, anchor: str = "start", size: int = FONT
    ) -> None:
        """Words that begin, end or have their middle at a place."""
        self.shapes.append(
            f'<text x="{at[0]:.1f}" y="{at[1]:.1f}" fill="{color}" font-size="{size}"'
            f' text-anchor="{anchor}">{escape(words)}</text>'
        )

    def box(self, at: Point, size: Point, lines: Sequence[str], fill: str = PALE) -> None:
        """A rectangle with lines of words in its middle."""
        (x, y), (w, h) = at, size
        self.area([(x, y), (x + w, y), (x + w, y + h), (x, y + h)], fill)
        first = y + h / 2 + 5 - 9 * (len(lines) - 1)
        for k, words in enumerate(lines):
            self.text((x + w / 2, first + 18 * k), words, anchor="middle")

    def svg(self) -> str:
        """The text of the file."""
        head = (
            f'<svg xmlns="http://www.w3.org/2000/svg" width="{self.width}" height="{self.height}"'
            f' viewBox="0 0 {self.width} {self.height}" font-family="Helvetica, Arial, sans-serif">'
        )
        sheet = f'<rect width="{self.width}" height="{self.height}" fill="white"/>'
        return (
            "\n".join([head, f"<title>{escape(self.title)}</title>", sheet, *self.shapes, "</svg>"])
            + "\n"
        )


class Graph:
    """Axes within a drawing, with values from `low` to `high`."""

    def __init__(
        self, drawing: Drawing, corner: Point, size: Point, low: Point, high: Point
    ) -> None:
        self.drawing, self.corner, self.size, self.low, self.high = drawing, corner, size, low, high

    def place(self, at: Point) -> Point:
        """Where a value is drawn."""
        part = [(v - a) / (b - a) for v, a, b in zip(at, self.low, self.high, strict=True)]
        return self.corner[0] + part[0] * self.size[0], self.corner[1] + (1 - part[1]) * self.size[
            1
        ]

    def axes(self, names: tuple[str, str], ticks: tuple[Sequence[float], Sequence[float]]) -> None:
        """Axes at the low values, or through zero."""
        x0, y0 = (min(max(0.0, low), high) for low, high in zip(self.low, self.high, strict=True))
        self.drawing.arrow(self.place((self.low[0], y0)), self.place((self.high[0], y0)))
        self.drawing.arrow(self.place((x0, self.low[1])), self.place((x0, self.high[1])))
        for tick in ticks[0]:
            x, y = self.place((tick, y0))
            self.drawing.line([(x, y), (x, y + 5)])
            self.drawing.text((x, y + 19), f"{tick:g}", anchor="middle", size=12)
        for tick in ticks[1]:
            x, y = self.place((x0, tick))
            self.drawing.line([(x, y), (x - 5, y)])
            self.drawing.text((x - 8, y + 4), f"{tick:g}", anchor="end", size=12)
        x, y = self.place((self.high[0], y0))
        self.drawing.text((x, y - 8), names[0], anchor="end")
        x, y = self.place((x0, self.high[1]))
        self.drawing.text((x + 8, y + 6), names[1])

    def curve(
        self, function: Callable[[float], float], span: Point, color: str, dash: str = ""
    ) -> None:
        """The part of a curve within the axes."""
        values = [span[0] + (span[1] - span[0]) * k / 200 for k in range(201)]
        points = [(x, function(x)) for x in values]
        inside = [p for p in points if self.low[1] <= p[1] <= self.high[1]]
        self.drawing.line([self.place(p) for p in inside], color, 2, dash)


def elements() -> Drawing:
    """Shapes with nodes and points of the strains."""
    drawing = Drawing(760, 190, "Elements, their nodes and the integration points of the strains")
    g, h = 1 / sqrt(3), sqrt(0.6)
    corners = [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
    sides = [(0.0, -1.0), (1.0, 0.0), (0.0, 1.0), (-1.0, 0.0)]
    triangle = [(-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0)]
    middle = [(0.0, -1.0), (0.0, 0.0), (-1.0, 0.0)]
    square = [(a, b) for a in (-g, g) for b in (-g, g)]
    nine = [(a, b) for a in (-h, 0, h) for b in (-h, 0, h)]
    three = [(-2 / 3, -2 / 3), (1 / 3, -2 / 3), (-2 / 3, 1 / 3)]
    shapes: list[tuple[str, Sequence[Point], Sequence[Point], Sequence[Point]]] = [
        ("CPE3", triangle, triangle, [(-1 / 3, -1 / 3)]),
        ("CPE4", corners, corners, square),
        ("CPE4R", corners, corners, [(0.0, 0.0)]),
        ("CPE6", triangle, triangle + middle, three),
        ("CPE8", corners, corners + sides, nine),
        ("CPE8R", corners, corners + sides, square),
    ]
    for k, (name, outline, nodes, points) in enumerate(shapes):

        def at(p: Point, left: int = 65 + 125 * k) -> Point:
            return left + 42 * p[0], 72 - 42 * p[1]

        drawing.area([at(p) for p in outline])
        for node in nodes:
            drawing.dot(at(node))
        for point in points:
            drawing.cross(at(point))
        drawing.text((65 + 125 * k, 148), name, anchor="middle")
    drawing.dot((250, 174))
    drawing.text((262, 179), "node")
    drawing.cross((340, 174))
    drawing.text((352, 179), "point of the strains")
    return drawing


def materials() -> Drawing:
    """Force of a bar over its stretch."""
    drawing = Drawing(640, 380, "Force of a bar per reference area over its stretch")
    graph = Graph(drawing, (70, 20), (540, 320), (0.0, -1.0), (3.0, 1.5))
    graph.axes(("stretch l", "force / (E area)"), ((0.5, 1, 1.5, 2, 2.5), (-1, -0.5, 0.5, 1)))
    graph.curve(lambda s: s * (s * s - 1) / 2, (0.01, 1.75), RED)
    graph.curve(lambda s: (s - s**-2) / 3, (0.3, 2.95), BLUE)
    graph.curve(lambda s: log(s) / s, (0.2, 2.95), GREEN)
    drawing.text((395, 60), "St. Venant-Kirchhoff: l (l² - 1)/2", RED, size=13)
    drawing.text((452, 88), "neo-Hooke: (l - 1/l²)/3", BLUE, size=13)
    drawing.text((490, 178), "Hencky: ln(l)/l", GREEN, "middle", 13)
    worst = graph.place((1 / sqrt(3), -1 / (3 * sqrt(3))))
    drawing.dot(worst, 3, RED, RED)
    drawing.line([worst, (215, 258)], GREY, 1)
    drawing.text((218, 263), "1/sqrt(3): its bar softens", RED, size=13)
    drawing.dot(graph.place((exp(1), exp(-1))), 3, GREEN, GREEN)
    drawing.text(graph.place((2.72, 0.43)), "l = e", GREEN, "middle", 13)
    return drawing


def yield_curve() -> Drawing:
    """Parts of sigma_y that strain and hourglass modes use."""
    drawing = Drawing(520, 330, "Yield curve of strain (w) and hourglass modes (z)")
    graph = Graph(drawing, (60, 20), (380, 260), (0.0, 0.0), (1.15, 1.0))
    graph.axes(("w", "z"), ((0.5, 1), (0.5,)))
    limit = sqrt(3) / 2

    def curve(part: float) -> Callable[[float], float]:
        return lambda w: limit * ((1 - part) * (1 - w * w) + part * sqrt(max(1 - w * w, 0)))

    graph.curve(curve(0), (0, 1), GREY, "5 4")
    graph.curve(curve(1), (0, 1), GREY, "2 3")
    graph.curve(curve(0.5), (0, 1), BLUE)
    drawing.text((380, 90), "e = 1: ellipse", GREY, size=13)
    drawing.text((380, 112), "e = 1/2: the program", BLUE, size=13)
    drawing.text((380, 134), "e = 0: 1 - w²", GREY, size=13)
    drawing.text(graph.place((0.03, limit + 0.03)), "sqrt(3)/2", size=12)
    return drawing


def pair() -> Drawing:
    """A slave node at a segment."""
    drawing = Drawing(560, 270, "Gap g, projection xi and directions of a contact pair")
    a, b, s = (90.0, 205.0), (450.0, 165.0), (300.0, 70.0)
    length = hypot(b[0] - a[0], b[1] - a[1])
    t = ((b[0] - a[0]) / length, (b[1] - a[1]) / length)
    along = (s[0] - a[0]) * t[0] + (s[1] - a[1]) * t[1]
    foot = (a[0] + along * t[0], a[1] + along * t[1])
    drawing.area([a, b, (480, 260), (60, 260)], PALE, PALE)
    drawing.line([a, b], width=2.5)
    drawing.line([(190, 30), s, (420, 25)], width=2.5)
    drawing.line([s, foot], RED, 1.5, "5 4")
    for point, name, shift in ((a, "a", (-14, 18)), (b, "b", (8, 18)), (s, "s", (-4, -12))):
        drawing.dot(point)
        drawing.text((point[0] + shift[0], point[1] + shift[1]), name)
    drawing.text(((s[0] + foot[0]) / 2 + 8, (s[1] + foot[1]) / 2), "g", RED)
    drawing.text((foot[0] - 90, foot[1] + 46), "xi l", BLUE)
    drawing.arrow((a[0] + 6, a[1] + 14), (foot[0], foot[1] + 15), BLUE)
    drawing.arrow(a, (a[0] + 60 * t[0], a[1] + 60 * t[1]), GREEN, 2)
    drawing.arrow(a, (a[0] + 60 * t[1], a[1] - 60 * t[0]), GREEN, 2)
    drawing.text((a[0] + 40, a[1] - 14), "e_t", GREEN)
    drawing.text((a[0] - 36, a[1] - 46), "e_n", GREEN)
    drawing.text((230, 252), "master body, on the left of a to b", GREY, "start", 13)
    drawing.text((315, 42), "slave body", GREY, "start", 13)
    return drawing


def law() -> Drawing:
    """Contact law and a coefficient that falls with the slip rate."""
    drawing = Drawing(760, 260, "Normal law, Coulomb's law and a coefficient over the slip rate")
    first = Graph(drawing, (40, 25), (170, 180), (-0.3, 0.0), (1.0, 1.0))
    first.axes(("g", "Pn"), ((), ()))
    drawing.line([first.place(p) for p in ((0, 0.85), (0, 0), (0.9, 0))], BLUE, 3)
    second = Graph(drawing, (280, 25), (190, 180), (-1.0, -1.0), (1.0, 1.0))
    second.axes(("Dt", "-Pt"), ((), ()))
    drawing.line(
        [second.place(p) for p in ((-0.9, -0.6), (0, -0.6), (0, 0.6), (0.9, 0.6))], BLUE, 3
    )
    drawing.text(second.place((0.35, 0.66)), "mu Pn", BLUE)
    third = Graph(drawing, (545, 25), (190, 180), (0.0, 0.0), (1.0, 1.0))
    third.axes(("|Dt|/dt", "mu"), ((), ()))
    third.curve(lambda v: 0.35 + 0.45 * exp(-5 * v), (0, 0.92), BLUE)
    drawing.text(third.place((-0.03, 0.77)), "mu_s", anchor="end")
    drawing.text(third.place((-0.03, 0.33)), "mu_k", anchor="end")
    drawing.line([third.place((0, 0.35)), third.place((0.92, 0.35))], GREY, 1, "4 4")
    for x, words in ((125, "open or pressed"), (375, "stick or slip"), (640, "eq. (3.10)")):
        drawing.text((x, 240), words, GREY, "middle", 13)
    return drawing


def cells() -> Drawing:
    """Cells of two slave faces over two master segments."""
    drawing = Drawing(640, 300, "Cells of slave faces over master segments, between bisectors")
    master = [(40.0, 230.0), (330.0, 205.0), (600.0, 250.0)]
    slave = [(70.0, 110.0), (270.0, 95.0), (480.0, 110.0)]
    drawing.area([*master, (600, 285), (40, 285)], PALE, PALE)
    drawing.area([*slave, (480, 40), (70, 40)], PALE, PALE)
    drawing.line(master, width=2.5)
    drawing.line(slave, width=2.5)
    normals = []
    for a, b in pairwise(master):
        length = hypot(b[0] - a[0], b[1] - a[1])
        normals.append(((b[1] - a[1]) / length, -(b[0] - a[0]) / length))
    m = (normals[0][0] + normals[1][0], normals[0][1] + normals[1][1])
    vertex, (p, q) = master[1], (slave[1], slave[2])
    along = ((p[0] - vertex[0]) * m[1] - (p[1] - vertex[1]) * m[0]) / (
        (p[0] - q[0]) * m[1] - (p[1] - q[1]) * m[0]
    )
    cut = (p[0] + along * (q[0] - p[0]), p[1] + along * (q[1] - p[1]))
    drawing.line([vertex, cut], RED, 1.5, "6 4")
    for start, end, normal in ((slave[0], slave[1], 0), (slave[1], cut, 0), (cut, slave[2], 1)):
        for place in (0.5 - 0.5 / sqrt(3), 0.5 + 0.5 / sqrt(3)):
            at = (start[0] + place * (end[0] - start[0]), start[1] + place * (end[1] - start[1]))
            a, n = master[normal], normals[normal]
            gap = (at[0] - a[0]) * n[0] + (at[1] - a[1]) * n[1]
            drawing.line([at, (at[0] - gap * n[0], at[1] - gap * n[1])], BLUE, 1)
            drawing.cross(at, BLUE)
    for node in (*master, *slave):
        drawing.dot(node)
    drawing.dot(cut, 4, "white", RED)
    drawing.text((cut[0] + 8, cut[1] + 20), "end of a cell", RED, size=13)
    drawing.text((vertex[0] + 8, vertex[1] + 18), "vertex x_v", size=13)
    drawing.text((slave[1][0] - 8, slave[1][1] - 12), "node j", size=13)
    drawing.text((136, 178), "gaps g_q of points", BLUE, size=13)
    drawing.text((90, 65), "slave faces", GREY, size=13)
    drawing.text((70, 270), "master segments", GREY, size=13)
    return drawing


def corners() -> Drawing:
    """Targets of a node at a convex and at a concave corner."""
    drawing = Drawing(700, 280, "Targets of a node at a convex and at a concave corner")
    for shift, convex in ((0, True), (360, False)):
        tip = (160.0 + shift, 130.0 if convex else 190.0)
        left = (40.0 + shift, 190.0 if convex else 120.0)
        right = (280.0 + shift, 210.0 if convex else 110.0)
        drawing.area([left, tip, right, (right[0], 260), (left[0], 260)], PALE, PALE)
        drawing.line([left, tip, right], width=2.5)
        drawing.dot(tip)
        node = (150.0 + shift, 60.0) if convex else (165.0 + shift, 120.0)
        for a, b, color in ((left, tip, BLUE), (tip, right, GREEN)):
            length = hypot(b[0] - a[0], b[1] - a[1])
            n = ((b[1] - a[1]) / length, -(b[0] - a[0]) / length)
            gap = (node[0] - a[0]) * n[0] + (node[1] - a[1]) * n[1]
            foot = (node[0] - gap * n[0], node[1] - gap * n[1])
            drawing.line([node, foot], color, 1.5, "5 4")
            drawing.line([tip, foot], GREY, 1, "2 3")
        drawing.dot(node, 5, RED, RED)
        words = (
            "convex: the larger gap is the target"
            if convex
            else "concave: both segments are targets"
        )
        drawing.text((160 + shift, 276), words, anchor="middle", size=13)
        drawing.text((node[0] + 10, node[1] - 6), "slave node", RED, size=13)
    return drawing


def kept_energy(scheme: str, step: float) -> float:
    """Part of the energy of a vibration that an increment of the length `step`, times its frequency, leaves."""
    if scheme == "quasi-static":
        return 1 / (1 + step * step)
    theta = 0.5 if scheme == "energy-momentum" else 1.0
    # state (u, v dt): (2 + theta w²) d = 2 v dt - w² u, u1 = u + d, v1 dt = 2 d - v dt
    w = step * step
    d = (-w / (2 + theta * w), 2 / (2 + theta * w))
    matrix = ((1 + d[0], d[1]), (2 * d[0], 2 * d[1] - 1))
    trace = matrix[0][0] + matrix[1][1]
    determinant = matrix[0][0] * matrix[1][1] - matrix[0][1] * matrix[1][0]
    root = trace * trace / 4 - determinant
    largest = abs(trace) / 2 + sqrt(root) if root > 0 else sqrt(abs(determinant))
    return largest**2


def schemes() -> Drawing:
    """Energy that an increment keeps of a vibration."""
    drawing = Drawing(620, 340, "Energy of a vibration after an increment over its energy before")
    graph = Graph(drawing, (60, 25), (520, 265), (0.0, 0.0), (8.0, 1.2))
    graph.axes(("", "energy kept in an increment"), ((2, 4, 6), (0.5, 1)))
    drawing.text((575, 325), "omega dt", anchor="end")
    for name, color in (
        ("energy-momentum", BLUE),
        ("SS22, weights 1", RED),
        ("quasi-static", GREEN),
    ):
        graph.curve(partial(kept_energy, name), (0, 7.8), color)
    drawing.text((390, 62), "ENERGY-MOMENTUM", BLUE, size=13)
    drawing.text((390, 235), "SS22, THETA1=THETA2=1", RED, size=13)
    drawing.text((70, 262), "QUASI-STATIC", GREEN, size=13)
    return drawing


def flow(
    drawing: Drawing,
    boxes: Sequence[tuple[Point, Point, Sequence[str]]],
    links: Sequence[tuple[int, int]],
) -> None:
    """Boxes with arrows from one to another, from the nearest edges."""
    for at, size, lines in boxes:
        drawing.box(at, size, lines)
    for start, end in links:
        ((x, y), (w, h), _), ((u, v), (a, b), _) = boxes[start], boxes[end]
        if abs((x + w / 2) - (u + a / 2)) < 5:
            down = v > y
            drawing.arrow((x + w / 2, y + h if down else y), (u + a / 2, v if down else v + b))
        else:
            right = u > x
            drawing.arrow((x + w if right else x, y + h / 2), (u if right else u + a, v + b / 2))


def increment() -> Drawing:
    """The algorithm of an increment."""
    drawing = Drawing(760, 260, "An increment: predictor, passes, checks")
    size = (150.0, 60.0)
    boxes = [
        ((20.0, 30.0), size, ["predictor", "d from rigid motion"]),
        ((210.0, 30.0), size, ["residual r (4.5)", "targets and rows"]),
        ((400.0, 30.0), size, ["contact forces", "LCP (5.2)"]),
        ((590.0, 30.0), size, ["correction (4.7)", "impulses (6.2)"]),
        ((590.0, 160.0), size, ["converged?"]),
        ((400.0, 160.0), size, ["checks", "penetration, energy"]),
        ((210.0, 160.0), size, ["ledger, results", "next increment"]),
        ((20.0, 160.0), size, ["shorter increment"]),
    ]
    flow(drawing, boxes, [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (5, 6)])
    drawing.line([(640, 160), (640, 125), (285, 125)])
    drawing.arrow((285, 125), (285, 90))
    drawing.text((440, 119), "no: another pass", GREY, size=13)
    drawing.text((570, 180), "yes", GREY, "middle", 13)
    drawing.line([(475, 220), (475, 242), (95, 242)], RED)
    drawing.arrow((95, 242), (95, 220), RED)
    drawing.text((255, 238), "failed: cutback", RED, size=13)
    drawing.arrow((95, 160), (95, 90), RED)
    return drawing


def landing() -> Drawing:
    """Height of a body over time, with the three rules for a landing within an increment."""
    drawing = Drawing(660, 320, "A body that lands after the part s of an increment")
    graph = Graph(drawing, (60, 25), (560, 240), (0.0, 0.0), (3.2, 1.6))
    graph.axes(("", "height"), ((1, 2, 3), ()))
    drawing.text((620, 300), "time / dt", anchor="end")
    s = 0.3
    start, ground = (0.0, 1 + s), (1 + s, 0.0)
    graph.drawing.line([graph.place(start), graph.place((1, s))], BLACK, 2.5)
    drawing.line([graph.place((1, s)), graph.place(ground)], GREEN, 2)
    drawing.line([graph.place(ground), graph.place((2.8, 1.5))], GREEN, 2)
    drawing.line([graph.place((1, s)), graph.place((2, 0))], RED, 2)
    drawing.line([graph.place((2, 0)), graph.place((3, 1 - 2 * s))], RED, 2, "6 4")
    drawing.line([graph.place((2, 0)), graph.place((3, 1))], BLUE, 2, "6 4")
    for tick in (1, 2, 3):
        drawing.line([graph.place((tick, 0)), graph.place((tick, 1.45))], GREY, 0.8, "2 4")
    drawing.text(graph.place((2.42, 1.25)), "IMPACT TIME=EVENT", GREEN, "end", 13)
    drawing.text(graph.place((2.72, 0.62)), "LANDING=RETURN", BLUE, "start", 13)
    drawing.text(graph.place((2.4, 0.07)), "force alone: 1 - 2s", RED, "start", 13)
    drawing.text(graph.place((1.02, 1.43)), "increment of the landing", GREY, "start", 13)
    drawing.text(graph.place((1.06, 0.05)), "s dt", GREEN, "start", 12)
    drawing.text(
        (340, 312),
        "A stiff body, without the impulses that stop the mass of its landing nodes.",
        anchor="middle",
        size=13,
    )
    return drawing


def hybrid() -> Drawing:
    """The order in which methods are tried."""
    drawing = Drawing(760, 200, "The hybrid of active set, sweeps and Lemke's method")
    size = (160.0, 60.0)
    boxes = [
        ((20.0, 30.0), (120.0, 60.0), ["problem (8.2)"]),
        ((170.0, 30.0), size, ["active set from the", "last states, joints"]),
        ((360.0, 30.0), size, ["sweeps, proximal steps,", "active set each"]),
        ((550.0, 30.0), (185.0, 60.0), ["Lemke's method,", "lexicographic rule"]),
        (
            (170.0, 130.0),
            (565.0, 45.0),
            ["forces: residual below 1e-9 of the deepest penetration (rule 7)"],
        ),
    ]
    flow(drawing, boxes, [(0, 1), (1, 2), (2, 3)])
    for x in (250.0, 440.0, 642.0):
        drawing.arrow((x, 90), (x, 130), GREEN)
    drawing.text((338, 22), "states repeat", GREY, "middle", 12)
    drawing.text((536, 22), "still repeat", GREY, "middle", 12)
    return drawing


def arms() -> Drawing:
    """Arms of a node of a rigid body that turns."""
    drawing = Drawing(520, 300, "Arms at start, middle and end of an increment")
    pole, radius, turn = (110.0, 260.0), 270.0, 0.9
    first, second = 0.1, 0.1 + turn

    def at(angle: float, r: float = radius) -> Point:
        return pole[0] + r * cos(angle), pole[1] - r * sin(angle)

    middle = radius * cos(turn / 2)
    drawing.line([at(first + turn * k / 30) for k in range(31)], GREY, 1, "4 4")
    drawing.arrow(pole, at(first), BLUE, 2)
    drawing.arrow(pole, at(second), BLUE, 2)
    drawing.arrow(pole, at((first + second) / 2, middle), GREEN, 2)
    drawing.arrow(at(first), at(second), RED, 2)
    drawing.dot(pole, 5)
    drawing.line([at(first + turn * k / 20, 70) for k in range(21)], BLACK, 1)
    drawing.text(at(first + 0.2, 80), "dtheta")
    drawing.text((at(first)[0] + 8, at(first)[1] + 4), "r_0", BLUE)
    drawing.text((at(second)[0] - 4, at(second)[1] - 10), "r_1", BLUE)
    x, y = at((first + second) / 2, middle)
    drawing.text((x - 92, y + 6), "r_m", GREEN)
    drawing.text((x + 45, y - 62), "d = c J r_m", RED)
    drawing.text((360, 285), "r_m = (r_0 + r_1)/2,  c = 2 tan(dtheta/2)", anchor="middle", size=13)
    drawing.text((pole[0] - 60, pole[1] + 24), "pole, at rest here")
    return drawing


def pins() -> Drawing:
    """A body on pins whose far ends move until they carry nothing."""
    drawing = Drawing(620, 260, "Pins hold K*; their far ends move until the pins carry nothing")
    drawing.area([(40, 225), (580, 225), (580, 245), (40, 245)], "#ddd", BLACK)
    drawing.area([(200, 90), (380, 90), (380, 190), (200, 190)])
    drawing.text((290, 145), "body that no support holds", anchor="middle", size=13)

    def spring(start: Point, end: Point) -> None:
        length = hypot(end[0] - start[0], end[1] - start[1])
        t = ((end[0] - start[0]) / length, (end[1] - start[1]) / length)
        points = [start]
        for k in range(1, 8):
            side = 7 if k % 2 else -7
            along = length * (0.15 + 0.1 * (k - 1) + 0.05)
            points.append(
                (start[0] + along * t[0] - side * t[1], start[1] + along * t[1] + side * t[0])
            )
        drawing.line([*points, end], BLUE)

    spring((200, 190), (110, 190))
    spring((200, 90), (200, 25))
    spring((380, 90), (380, 25))
    for at in ((110.0, 190.0), (200.0, 25.0), (380.0, 25.0)):
        drawing.dot(at, 5, "white", BLUE)
    drawing.arrow((110, 172), (75, 172), BLUE)
    drawing.text((40, 160), "far end p", BLUE, size=13)
    drawing.text((212, 62), "stiffness a", BLUE, size=13)
    drawing.arrow((470, 90), (470, 150), RED, 2)
    drawing.text((480, 125), "load", RED, size=13)
    for x in (215.0, 290.0, 365.0):
        drawing.arrow((x, 223), (x, 192), GREEN)
    drawing.text((395, 212), "contact forces", GREEN, size=13)
    return drawing


def architecture() -> Drawing:
    """The way from a deck to results, with the modules that do it."""
    drawing = Drawing(860, 330, "From the deck to the results")
    size = (140.0, 62.0)
    boxes = [
        ((20.0, 40.0), size, ["DECK.inp", "deck::read"]),
        ((190.0, 40.0), size, ["cards", "reader::build"]),
        ((360.0, 40.0), size, ["Model", "prepare"]),
        ((530.0, 40.0), size, ["PreparedModel", "dynamics::run"]),
        ((700.0, 40.0), size, ["IncrementReport", "observer"]),
        ((700.0, 220.0), size, ["output", ".vtkhdf .sta .log"]),
        ((360.0, 220.0), size, ["increment", "passes, cutbacks"]),
        ((530.0, 220.0), size, ["step", "loads, K*, M"]),
        ((190.0, 220.0), size, ["contact, lcp", "targets, forces"]),
        ((20.0, 220.0), size, ["elements,", "materials, linear"]),
    ]
    flow(drawing, boxes, [(0, 1), (1, 2), (2, 3), (3, 4), (4, 5), (3, 7), (7, 6), (6, 8)])
    drawing.line([(430, 282), (430, 305), (90, 305)])
    drawing.arrow((90, 305), (90, 282))
    drawing.line([(260, 102), (260, 150)], RED)
    drawing.text(
        (90, 168), "errors: all at once, with file, line and a caret (diagnostics)", RED, size=13
    )
    drawing.text((592, 165), "each step", GREY, "end", 13)
    drawing.text((762, 165), "each increment", GREY, "end", 13)
    return drawing


FIGURES: dict[str, Callable[[], Drawing]] = {
    **{
        f"docs/theory/figures/{draw.__name__}.svg": draw
        for draw in (
            elements,
            materials,
            yield_curve,
            pair,
            law,
            cells,
            corners,
            schemes,
            increment,
            landing,
            hybrid,
            arms,
            pins,
        )
    },
    "docs/figures/architecture.svg": architecture,
}
"""Paths of the figures, and what draws them."""


def main(arguments: Sequence[str]) -> int:
    """Writes all figures."""
    if arguments:
        print(__doc__)
        return 2
    for path, draw in FIGURES.items():
        (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / path).write_text(draw().svg())
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
