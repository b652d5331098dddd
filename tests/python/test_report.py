"""The report page: what it holds, and what it does in a browser."""

import base64
import html.parser
import json
import re
import shutil
import subprocess
import zlib
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pytest
from bodies import FAMILIES, bent_bodies, rigid_only, two_materials
from conftest import COMMAND, ROOT, Job
from decks import CANTILEVERS, COLUMN, oblique_impact, shortened, spinning_bar
from oracle.shapes import shape_functions
from stickslip.deck import Deck
from stickslip.errors import Fault
from stickslip.report import Choice, page_of
from stickslip.report.collect import collect
from stickslip.report.pack import FINE, Packed
from stickslip.result import Result

CHROMIUM = next(
    filter(None, map(shutil.which, ("chromium", "chromium-browser", "google-chrome"))), None
)

QUIET = (
    "--no-sandbox",
    "--disable-gpu",
    "--no-first-run",
    "--disable-background-networking",
    "--disable-component-update",
    "--disable-sync",
)
"""Options of a Chromium that runs as any user, without a graphics card or a network."""

RUBBER = ROOT / "input" / "rubber_ring"


# Decks.


def two_bodies(job: Job, folder: Path) -> Path:
    return job(shortened(CANTILEVERS / "A_mu04.inp", 300))


def without_friction(job: Job, folder: Path) -> Path:
    return job(shortened(CANTILEVERS / "A_mu00.inp", 300))


def rigid_surface(job: Job, folder: Path) -> Path:
    return job(shortened(RUBBER / "rubber_ring_mu05.inp", 60, "default"))


def self_contact(job: Job, folder: Path) -> Path:
    return job(shortened(COLUMN / "column_mu02.inp", 20, "default"))


def free_bodies(job: Job, folder: Path) -> Path:
    return job(oblique_impact(0.3, folder))


def no_contact(job: Job, folder: Path) -> Path:
    return job(spinning_bar(folder))


def without_elements(job: Job, folder: Path) -> Path:
    return job(rigid_only())


def stopped(job: Job, folder: Path) -> Path:
    """What a run leaves that stops in the solve."""
    path = folder / "stopped.vtkhdf"
    shutil.copy(two_bodies(job, folder), path)
    with h5py.File(path, "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = 8
        file["history"].attrs["rows"] = 25
        file["run"].attrs["exit_status"] = 1
    return path


def one_frame(job: Job, folder: Path) -> Path:
    """What a run leaves that is killed after its first frame."""
    path = folder / "one_frame.vtkhdf"
    shutil.copy(two_bodies(job, folder), path)
    with h5py.File(path, "r+") as file:
        file["VTKHDF/Steps"].attrs["NSteps"] = 1
        file["history"].attrs["rows"] = 1
        file["run"].attrs["exit_status"] = -1
    return path


KINDS = {
    each.__name__: each
    for each in (
        two_bodies,
        rigid_surface,
        self_contact,
        free_bodies,
        no_contact,
        stopped,
        one_frame,
    )
}


# Arrays.


def unpacked(packed: Packed, described: dict[str, Any]) -> np.ndarray:
    """What decode.js makes of an array."""
    count = described["rows"] * described["columns"]
    planes = np.frombuffer(
        zlib.decompress(base64.b64decode(packed.blobs[described["blob"]])), np.uint8
    )
    folded = np.zeros((count, 4), np.uint8)
    folded[:, : described["planes"]] = planes.reshape(described["planes"], count).T
    unsigned = folded.view("<u4").ravel()
    whole = ((unsigned >> 1).astype(np.int32) ^ -(unsigned & 1).astype(np.int32)).reshape(
        described["rows"], described["columns"]
    )
    for _ in range(described["order"]):
        whole = np.cumsum(whole, axis=0, dtype=np.int32)
    if described["map"] == "bits":
        return whole.view(np.float32)
    if described["map"] == "linear":
        return whole * described["step"]
    values = described["small"] * np.sinh(whole * described["fine"])
    values[whole == described["none"]] = np.nan
    return values


@pytest.fixture
def walk() -> np.ndarray:
    """Numbers of many sizes, smooth from row to row in a part of the columns."""
    random = np.random.default_rng(3)
    smooth = np.sin(np.linspace(0.0, 6.0, 90)[:, None] * np.arange(1, 5)) * 10.0 ** np.arange(-3, 1)
    return np.concatenate(
        [smooth, random.normal(size=(90, 7)) * 10.0 ** random.integers(-6, 6, (90, 7))], axis=1
    )


def test_arrays_keep_what_they_promise(walk: np.ndarray) -> None:
    packed = Packed()
    linear = unpacked(packed, packed.linear(walk, 1e-3))
    assert np.abs(linear - walk).max() <= 0.5001e-3
    holes = walk.copy()
    holes[3, 2] = holes[80, 9] = np.nan
    described = packed.curved(holes)
    curved = unpacked(packed, described)
    assert np.array_equal(np.isnan(curved), np.isnan(holes))
    error = np.abs(curved - holes)
    assert np.nanmax(error / np.maximum(np.abs(holes), described["small"])) < 0.75 * FINE
    assert np.array_equal(unpacked(packed, packed.bits(walk)), walk.astype(np.float32))
    assert np.array_equal(
        unpacked(packed, packed.whole(np.array([[5, -7], [2**29, 0]]))), [[5, -7], [2**29, 0]]
    )


@pytest.mark.parametrize(
    "values",
    [np.zeros((4, 3)), np.full((4, 3), np.nan), np.zeros((4, 0)), np.array([[1e300, -1e-300]])],
)
def test_arrays_without_much_in_them(values: np.ndarray) -> None:
    packed = Packed()
    back = unpacked(packed, packed.curved(values))
    assert back.shape == values.shape and np.allclose(back, values, rtol=1e-3, equal_nan=True)


# The file.


@cache
def written(*paths: Path) -> str:
    """The page of results that no test changes afterwards; it is written once for all that look at it."""
    return page_of(paths)


class Tags(html.parser.HTMLParser):
    """Elements of a page by their ids, and the addresses that it would load."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.loaded: list[str] = []
        self.ids: list[str] = []
        self.data = ""
        self.inside = False
        self.feed(text)

    def handle_starttag(self, tag: str, attributes: list[tuple[str, str | None]]) -> None:
        values = dict(attributes)
        self.loaded += [values[name] or "" for name in ("src", "href") if name in values]
        self.ids += [values["id"] or ""] if "id" in values else []
        self.inside = values.get("id") == "data"

    def handle_data(self, data: str) -> None:
        if self.inside:
            self.data += data

    def handle_endtag(self, tag: str) -> None:
        self.inside = False


@pytest.mark.parametrize("kind", KINDS)
def test_a_page_is_one_file_that_loads_nothing(kind: str, job: Job, tmp_path: Path) -> None:
    path = KINDS[kind](job, tmp_path)
    tags = Tags(written(path))
    assert all(address.startswith(("#", "data:")) for address in tags.loaded), tags.loaded
    assert len(tags.ids) == len(set(tags.ids))
    (result,) = json.loads(tags.data)["results"]
    expected = Result(path)
    assert result["times"] == expected.frames.times.tolist()
    assert result["increments"] == expected.rows - 1
    assert result["deck"] == expected.deck


def test_elements_are_drawn_as_their_outlines(job: Job) -> None:
    """Quadratic elements: nodes between corners stand in their places, and the edges are those of the result."""
    packed = Packed()
    quadratic = job(Deck.read(ROOT / "tests" / "decks" / "quadratic.inp"), "--frames", "1")
    page = collect(quadratic, packed, Choice())
    with Result(quadratic) as result:
        assert max(map(len, result.outlines)) > 4
        mesh = {
            name: unpacked(packed, page["mesh"][name]).astype(int)
            for name in ("connectivity", "offsets", "outline")
        }
        ends = mesh["offsets"].ravel()
        rings = np.split(mesh["connectivity"].ravel(), ends[1:-1])
        nodes = len(result.coordinates)
        around = [ring[ring < nodes] for ring in rings]
        assert all(np.array_equal(*pair) for pair in zip(around, result.outlines, strict=True))
        assert [len(ring) for ring in rings] == [4 * len(one) for one in result.outlines]
        assert set(mesh["outline"].ravel()) >= set(result.boundary.ravel())
        assert len(mesh["outline"]) == 4 * len(result.boundary)
        slaves = np.isfinite(result.frames[0]["SLIP"])
        both = slaves[result.boundary].all(axis=1)
        # each surface goes along its edges, through the nodes between corners
        assert sum(len(one["nodes"]) - 1 for one in page["surfaces"]) == both.sum()
        bodies = {int(b) for b in result.body[result.boundary[both][:, 0]]}
        assert len(page["surfaces"]) == len(bodies)


def test_equal_results_give_equal_pages(job: Job, tmp_path: Path) -> None:
    path = rigid_surface(job, tmp_path)
    assert page_of([path]) == written(path)


def test_fields_and_frames_are_chosen(job: Job, tmp_path: Path) -> None:
    path = two_bodies(job, tmp_path)
    (result,) = json.loads(Tags(page_of([path], Choice(("MISES", "V"), 7))).data)["results"]
    # values of the von Mises stress at nodes are made of the stresses
    assert [field["name"] for field in result["fields"]] == ["V", "MISES", "S", "S33"]
    (known,) = json.loads(Tags(page_of([path], Choice(("mises", "V1", "cpress"), 2))).data)["results"]
    assert [field["name"] for field in known["fields"]] == ["CONTACT_PRESSURE", "V", "MISES", "S", "S33"]
    times = Result(path).frames.times
    assert (
        len(result["times"]) == 7
        and result["times"][0] == times[0]
        and result["times"][-1] == times[-1]
    )
    with pytest.raises(Fault, match="no field MISSES"):
        page_of([path], Choice(("MISSES",)))


def test_the_command(job: Job, tmp_path: Path) -> None:
    def command(*words: object) -> subprocess.CompletedProcess[str]:
        line = [*COMMAND, "report", *map(str, words)]
        return subprocess.run(line, capture_output=True, text=True, cwd=tmp_path)

    path = stopped(job, tmp_path)
    done = command(path)
    assert done.returncode == 0 and (tmp_path / "stopped.html").stat().st_size > 100_000, (
        done.stderr
    )
    assert done.stdout.startswith(f"wrote {tmp_path}/stopped.html (")
    (tmp_path / "text.vtkhdf").write_text("no result")
    for words in (
        [tmp_path / "none.vtkhdf"],
        [tmp_path / "text.vtkhdf"],
        [path, "-o", "page.txt"],
        [path, "--fields", "X"],
    ):
        done = command(*words)
        assert (
            done.returncode == 2 and "error: " in done.stderr and "Traceback" not in done.stderr
        ), done.stderr
        assert done.stderr.count("\n") == 1


# In a browser.

Shown = Callable[..., Any]


@pytest.fixture(scope="session")
def browser() -> Iterator[Any]:
    """Chromium, started once."""
    sync_api = pytest.importorskip(
        "playwright.sync_api", reason="the Python package playwright is not installed"
    )
    if CHROMIUM is None:
        pytest.skip("no Chromium is installed (Debian: apt-get install chromium)")
    with sync_api.sync_playwright() as playwright:
        started = playwright.chromium.launch(executable_path=CHROMIUM, args=QUIET)
        yield started
        started.close()


@pytest.fixture
def shown(browser: Any, job: Job, tmp_path: Path) -> Iterator[Shown]:
    """Opens the page of results, and asks at the end that the browser did not complain."""
    complaints: list[str] = []
    contexts = []

    def show(*paths: Path, **settings: Any) -> Any:
        file = tmp_path / "page.html"
        file.write_text(written(*paths), encoding="utf-8")
        size = {"width": 800, "height": 560}
        context = browser.new_context(viewport=size, offline=True, **settings)
        contexts.append(context)
        page = context.new_page()
        page.on(
            "console",
            lambda message: (
                complaints.append(message.text) if message.type in ("error", "warning") else None
            ),
        )
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on(
            "request",
            lambda request: (
                None
                if request.url.startswith(("file:", "data:", "blob:"))
                else complaints.append(request.url)
            ),
        )
        page.goto(file.as_uri())
        page.wait_for_selector("body[data-ready=yes]")
        return page

    yield show
    for context in contexts:
        context.close()
    assert complaints == []


def picture(page: Any) -> str:
    """The bodies as they are drawn now."""
    return page.evaluate("(page.view.draw(), document.getElementById('bodies').toDataURL())")


def charts(page: Any) -> list[int]:
    """Numbers of points of all charts, which are drawn wherever they stand."""
    page.evaluate("Promise.all(page.charts.map((chart) => ((chart.seen = true), chart.build())))")
    return page.evaluate("page.charts.map((chart) => chart.plot.data[0].length)")


@pytest.mark.parametrize("kind", KINDS)
def test_it_plays_and_changes_its_field(kind: str, shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(KINDS[kind](job, tmp_path))
    frames = page.evaluate("page.result.frames")
    first = picture(page)
    if frames == 1:
        assert page.locator("#play").is_disabled()
    else:
        page.select_option("#speed", "4")
        page.evaluate("page.player.go(page.result.frameAt(0.8 * page.result.end))")
        page.keyboard.press("Space")
        page.wait_for_function(f"page.view.frame === {frames - 1} && !page.player.playing")
        page.keyboard.press("Home")
        assert page.evaluate("page.view.frame") == 0 and picture(page) == first
        page.keyboard.press("ArrowRight")
        page.keyboard.press("Shift+ArrowRight")
        assert page.evaluate("page.view.frame") == min(11, frames - 1)
        assert picture(page) != first
        page.select_option("#field", "S:yy")
        page.wait_for_function("page.view.look.scalar.id === 'S:yy'")
        before = picture(page)
        page.select_option("#field", "V:magnitude")
        page.wait_for_function("page.view.look.scalar.id === 'V:magnitude'")
        assert picture(page) != before
    points = charts(page)
    assert len(points) >= 5 and all(points), points


def test_values_under_the_mouse_are_those_of_the_file(
    shown: Shown, job: Job, tmp_path: Path
) -> None:
    path = two_bodies(job, tmp_path)
    page = shown(path)
    frame = page.evaluate("page.result.frames") - 1
    page.keyboard.press("End")
    page.evaluate("page.view.draw()")
    expected = Result(path).frames[frame]
    for element in (0, 17, 70):
        nodes = Result(path).cells[element]
        spots = page.evaluate(
            "(nodes) => nodes.map((node) => page.view.spot(node))", nodes.tolist()
        )
        x, y = np.mean(spots, axis=0)
        page.hover("#overlay", position={"x": x, "y": y})
        lines = dict(
            zip(
                page.locator("#tip dt").all_inner_texts(), page.locator("#tip dd").all_inner_texts()
            )
        )
        assert lines["element"].split(",")[0] == str(Result(path).element_labels[element])
        assert float(lines["mean of the element"]) == pytest.approx(
            expected["MISES"][element], rel=1e-3
        )
        # linear elements: in the middle stands the mean of the values at their nodes
        middle = expected.nodal("MISES")[nodes].mean()
        assert float(lines["von Mises stress"]) == pytest.approx(middle, rel=2e-3)
    for field in ("MISES", "S", "V", "U", "CONTACT_FORCE"):
        values = page.evaluate(
            """async ([name, frame]) => {
                const field = page.result.field(name);
                await field.load();
                return Array.from({ length: field.places }, (_, i) =>
                    Array.from({ length: field.components }, (_, k) => field.value(frame, i, k)));
            }""",
            [field, frame],
        )
        exact = expected[field].reshape(len(values), -1)
        size = np.abs(exact).max()
        assert np.allclose(values, exact, rtol=FINE, atol=1e-4 * size), field
    nodal = page.evaluate(
        """async ([name, frame]) => {
            const { nodal } = page.result.scalar(name);
            await nodal.field.load();
            return Array.from({ length: nodal.field.places }, (_, place) => nodal.value(frame, place));
        }""",
        ["S:xx", frame],
    )
    exact = expected.at_places("S11")
    assert np.allclose(nodal, exact, rtol=2.0 * FINE, atol=1e-3 * np.abs(exact).max())
    page.mouse.move(5, 5)
    assert page.locator("#tip").is_hidden()


@pytest.mark.parametrize("family", FAMILIES)
def test_the_right_element_is_under_every_point(family: str, shown: Shown, job: Job) -> None:
    """Points inside of elements of every type, by their shape functions, in the bent bodies."""
    path = job(bent_bodies(family), "--frames", "1")
    page = shown(path)
    page.keyboard.press("End")
    page.evaluate("page.view.draw()")
    random = np.random.default_rng(1)
    with Result(path) as result:
        types = result.read("model/element_types")
        assert len(set(types)) == len(FAMILIES[family])
        positions = result.frames[-1].positions
        bent = sum(
            np.abs(positions[m] - 0.5 * (positions[a] + positions[b])).max() for m, (a, b) in result.middles.items()
        )
        assert bent / len(result.middles) > 0.01, "sides are curved"
        points, expected = [], []
        for element, cell in enumerate(result.cells):
            natural = random.uniform(-0.96, 0.96, (6, 2))
            if len(cell) in (3, 6):
                natural = random.dirichlet((1.0, 1.0, 1.0), 6)[:, 1:] * 0.94 + 0.02
            shapes, _ = shape_functions(len(cell), natural)
            points += (shapes @ positions[cell]).tolist()
            expected += [element] * len(natural)
    found = page.evaluate(
        """(points) => points.map(([x, y]) => {
            const [mx, my] = page.result.mesh.middle;
            return page.view.elementAt(x - mx, y - my);
        })""",
        points,
    )
    assert len(points) >= 200 and found == expected


@pytest.mark.parametrize("kind", ["CPE4", "CAX8"])
def test_values_differ_on_both_sides_of_two_materials(kind: str, shown: Shown, job: Job) -> None:
    """What is drawn at the nodes of every element, those between materials among them."""
    deck = two_materials(kind, stretch=5.0)
    path = job(deck, "--frames", "1")
    page = shown(path)
    page.keyboard.press("End")
    page.select_option("#field", "S:yy")
    page.wait_for_function("page.view.look.scalar.id === 'S:yy'")
    drawn = page.evaluate(
        """(() => {
            page.view.draw();
            const { connectivity, offsets, elements } = page.result.mesh;
            const cells = Array.from({ length: elements }, (_, cell) => connectivity.subarray(offsets[cell], offsets[cell + 1]));
            return cells.map((ring) => Array.from(ring, (vertex) => page.view.layer.values[vertex]));
        })()"""
    )
    with Result(path) as result:
        places = result.frames[-1].at_places("S22")
        twins = result.recovery.twins
        assert np.abs(places[len(result.coordinates) :] - places[twins]).min() > 0.02 * np.abs(places).max()
        values = result.drawing.values(places)
        for ring, found in zip(result.drawing.rings, drawn):
            assert np.allclose(found, values[ring], rtol=2e-3, atol=1e-3 * np.abs(places).max())


def test_invariants_at_nodes_are_those_of_the_stresses_there(shown: Shown, job: Job) -> None:
    deck = two_materials("CPE8", stretch=5.0)
    deck.cards[-1:-1] = Deck.parse("*OUTPUT, FIELD\n*ELEMENT OUTPUT\nS, SP, PRESS\n").cards
    path = job(deck, "--frames", "1")
    page = shown(path)
    with Result(path) as result:
        frame = result.frames[-1]
        stress, across = frame.at_places("S"), frame.at_places("S33")
        full = np.zeros((len(across), 3, 3))
        full[:, [0, 1, 0, 1], [0, 1, 1, 0]], full[:, 2, 2] = stress[:, [0, 1, 2, 2]], across
        principal = np.linalg.eigvalsh(full)
        deviator = full - np.trace(full, axis1=1, axis2=2)[:, None, None] / 3.0 * np.eye(3)
        expected = {
            "MISES": np.sqrt(1.5 * (deviator**2).sum(axis=(1, 2))),
            "PRESS": -np.trace(full, axis1=1, axis2=2) / 3.0,
            **{f"SP{k + 1}": principal[:, k] for k in range(3)},
        }
        for name, exact in expected.items():
            size = np.abs(exact).max()
            assert np.allclose(frame.at_places(name), exact, rtol=1e-9, atol=1e-9 * size), name
            found = page.evaluate(
                """async (name) => {
                    const { nodal } = page.result.scalar(name);
                    await nodal.field.load();
                    const frame = page.result.frames - 1;
                    return Array.from({ length: nodal.field.places }, (_, place) => nodal.value(frame, place));
                }""",
                name,
            )
            assert np.allclose(found, exact, rtol=2e-3, atol=2e-3 * size), name


def test_outlines_laid_over_are_curved_too(shown: Shown, job: Job) -> None:
    path = job(bent_bodies("CPS"), "--frames", "1")
    page = shown(path, path)
    page.keyboard.press("End")
    own, other = page.evaluate(
        """(page.view.draw(), [page.view.layer, page.view.otherLayer].map(({ mesh, positions }) =>
            Array.from(mesh.outline, (vertex) => [positions[2 * vertex], positions[2 * vertex + 1]])))"""
    )
    assert len(own) > 200 and np.allclose(own, other, rtol=0.0, atol=2e-3)


def test_window_zoom_nodes_range_and_theme(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(two_bodies(job, tmp_path), color_scheme="dark")
    scale = "page.view.camera.scale"
    whole = page.evaluate(scale)
    box = page.locator("#overlay").bounding_box()
    page.mouse.move(box["x"] + 200, box["y"] + 150)
    page.mouse.wheel(0, -400)
    page.wait_for_function(f"{scale} > {1.5 * whole}")
    page.keyboard.press("0")
    assert page.evaluate(scale) == pytest.approx(whole)
    page.keyboard.press("w")
    page.mouse.down()
    page.mouse.move(box["x"] + 320, box["y"] + 250)
    page.mouse.up()
    assert page.evaluate(scale) > 2.0 * whole
    page.keyboard.press("0")
    page.evaluate("page.view.draw()")
    x, y = page.evaluate("page.view.spot(20)")
    page.click("#overlay", position={"x": x, "y": y})
    page.get_by_label("number of a node").fill("3")
    page.get_by_role("button", name="add").click()
    labels = page.evaluate("page.view.picked.map((node) => page.result.mesh.nodeLabels[node])")
    assert len(labels) == 2 and labels[1] == 3
    page.wait_for_function("page.nodes.plot?.series.length === 3")
    page.fill("#high", "5")
    page.press("#high", "Tab")
    page.wait_for_function("page.view.ends().high === 5")
    assert page.evaluate("document.getElementById('range').value") == "own"
    dark = picture(page)
    page.click("#theme")
    assert picture(page) != dark


def test_elements_fill_their_pixels_without_gaps(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(no_contact(job, tmp_path))
    missed = page.evaluate(
        """(() => {
            const { view } = page;
            Object.assign(view.look, { scalar: null, lines: false });
            view.setFrame(view.result.frames - 1);
            const { painter } = view;
            const edges = painter.drawEdges;
            painter.drawEdges = () => {};
            view.draw();
            painter.drawEdges = edges;
            const body = pixelOf(bytesOf(styleColour("body")));
            let missed = 0;
            for (let row = 0; row < painter.height; row += 5) {
                for (let column = 0; column < painter.width; column += 5) {
                    const x = (column + 0.5) / view.seen.density;
                    const y = (row + 0.5) / view.seen.density;
                    const inside = view.elementAt(...view.point(x, y)) >= 0;
                    const pixel = painter.pixels[row * painter.width + column];
                    if (inside !== (pixel === body)) missed++;
                }
            }
            return missed;
        })()"""
    )
    assert missed == 0


def test_a_peak_does_not_set_the_colours(shown: Shown, job: Job, tmp_path: Path) -> None:
    path = tmp_path / "peak.vtkhdf"
    shutil.copy(two_bodies(job, tmp_path), path)
    with h5py.File(path, "r+") as file:
        stress = file["VTKHDF/CellData/MISES"]
        usual = np.nanmax(stress)
        cells = len(file["VTKHDF/Types"])
        stress[5 * cells + 3] = 1e4 * usual
    page = shown(path)
    page.keyboard.press("v")
    page.wait_for_function("page.view.look.scalar.at === 'elements'")
    ends = page.evaluate("page.view.ends()")
    assert 0.1 * usual < ends["high"] <= 1.01 * usual
    assert ends["most"] == pytest.approx(1e4 * usual, rel=1e-3) and ends["mostFrame"] == 5
    page.select_option("#range", "full")
    page.wait_for_function(f"page.view.ends().high > {9e3 * usual}")


def test_a_second_result_is_laid_over_the_first(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(two_bodies(job, tmp_path), without_friction(job, tmp_path))
    page.keyboard.press("End")
    both = picture(page)
    page.uncheck("#other")
    assert picture(page) != both
    assert all(charts(page))
    labels = page.evaluate(
        "page.charts.find((chart) => chart.title === 'Contact').plot.series.map((series) => series.label)"
    )
    assert labels == ["t", "normal", "tangential", "normal, other", "tangential, other"]


def test_chart_and_picture_show_the_same_time(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(two_bodies(job, tmp_path))
    charts(page)
    over = page.locator(".chart .u-over").first
    over.scroll_into_view_if_needed()
    box = over.bounding_box()
    over.click(position={"x": box["width"] / 2, "y": box["height"] / 2})
    middle = page.evaluate(
        "page.result.nearestFrame(page.charts[0].plot.posToVal(%s, 'x'))" % (box["width"] / 2)
    )
    assert page.evaluate("page.view.frame") == middle > 0


def pressed_ring(job: Job) -> Path:
    """A static result of a body of revolution between rigid plates."""
    return job(Deck.read(ROOT / "input" / "disc_spring" / "disc_spring_mu014.inp"))


def test_static_runs_of_bodies_of_revolution(shown: Shown, job: Job) -> None:
    """Force against displacement comes first, momenta are left out, directions are r and z."""
    path = pressed_ring(job)
    page = shown(path)
    charts(page)
    titles = page.evaluate("page.charts.map((chart) => chart.title)")
    assert titles[0] == "Force and displacement" and "Momenta" not in titles
    x, y = page.evaluate("page.charts[0].plot.data")
    with Result(path) as result:
        assert np.allclose(x, result.quantity("nodes/PLATE/U2"), rtol=1e-6)
        assert np.allclose(y, result.quantity("nodes/PLATE/RF2"), rtol=1e-6)
    assert page.evaluate("page.charts[0].made.along") == "displacement of PLATE, z"
    # the abscissa goes to and fro: the line stands where the frame is, pressed and let go
    with Result(path) as result:
        time, moved = result.history.time, result.quantity("nodes/PLATE/U2")
    for at in (0.6, 1.0, 1.4):
        page.evaluate(f"page.player.go(page.result.nearestFrame({at}))")
        place = float(page.evaluate("page.charts[0].line.style.transform")[len("translateX(") : -len("px)")])
        there = page.evaluate(f"page.charts[0].plot.valToPos({np.interp(at, time, moved)}, 'x')")
        assert place == pytest.approx(there, abs=0.5)
    labels = page.locator("#field option").all_inner_texts()
    assert {"stress, rr (S11)", "stress around the axis (S33)", "displacement, z (U2)"} <= set(labels)
    page.select_option('[aria-label="abscissa"]', "contact/SKIN_ABOVE/normal|0")
    page.wait_for_function("page.charts.at(-1).made.way === true")
    with Result(path) as result:
        x = page.evaluate("page.charts.at(-1).plot.data[0]")
        assert np.allclose(x, result.quantity("contact/SKIN_ABOVE/normal"), rtol=1e-6, atol=1e-3)


def test_forces_on_rigid_lines_stand_where_the_contact_is(shown: Shown, job: Job) -> None:
    path = pressed_ring(job)
    page = shown(path)
    middle = page.evaluate("Math.round(0.5 * (page.result.frames - 1))")
    page.evaluate(f"(page.player.go({middle}), page.view.draw())")
    found = page.evaluate(
        """(() => {
            const marks = new Marks(page.view, page.view.overlay.getContext("2d"));
            return marks.onRigid(page.result.field("CONTACT_FORCE")).map(([spot, x, y]) => {
                const [px, py] = page.view.point(...spot);
                return [px + page.result.mesh.middle[0], py + page.result.mesh.middle[1], x, y];
            });
        })()"""
    )
    with Result(path) as result:
        frame = result.frames[middle]
        force = frame["CONTACT_FORCE"]
        rigid = np.unique(result.rigid)
        closed = result.in_cells[np.abs(force[result.in_cells]).any(axis=1)]
        assert len(found) == len(closed) >= 2
        for at, node in zip(np.array(found), closed):
            assert np.allclose(at[:2], frame.positions[node], atol=0.01)
            assert np.allclose(at[2:], -force[node], rtol=1e-3)
        # the same as the file has at the ends of the segments
        assert np.allclose(np.sum(found, axis=0)[2:], force[rigid].sum(axis=0), rtol=1e-3, atol=1e-3)


def test_keys_reach_values_and_nodes(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(two_bodies(job, tmp_path))
    page.evaluate("page.view.draw()")
    page.keyboard.press("m")
    cross = page.evaluate("page.view.cross")
    target = page.evaluate("page.view.spot(20)")
    for axis, keys in enumerate((("ArrowLeft", "ArrowRight"), ("ArrowUp", "ArrowDown"))):
        way = target[axis] - cross[axis]
        for _ in range(int(abs(way) / 10)):
            page.keyboard.press(keys[way > 0])
        for _ in range(round(abs(way) % 10)):
            page.keyboard.press(f"Shift+{keys[way > 0]}")
    assert np.allclose(page.evaluate("page.view.cross"), target, atol=1.0)
    lines = dict(zip(page.locator("#tip dt").all_inner_texts(), page.locator("#tip dd").all_inner_texts()))
    assert lines["node"] == str(page.evaluate("page.result.mesh.nodeLabels[20]"))
    page.keyboard.press("+")
    assert np.allclose(page.evaluate("(page.view.draw(), page.view.spot(20))"), target, atol=2.0)
    page.keyboard.press("Enter")
    assert page.evaluate("page.view.picked") == [20]
    page.keyboard.press("Escape")
    assert page.evaluate("page.view.cross") is None and page.locator("#tip").is_hidden()
    before = picture(page)
    page.keyboard.press("End")
    page.keyboard.press("u")
    assert picture(page) != before and page.locator("#undeformed").is_checked()
    # all that a mouse clicks is in the order of the tabulator
    charts(page)
    skipped = page.evaluate(
        """[...document.querySelectorAll("button, select, input, summary, a, .u-series th")]
            .filter((each) => each.tabIndex < 0 || (each.matches("th") && each.tabIndex !== 0)).length"""
    )
    assert skipped == 0


def test_keys_zoom_and_move_the_window_of_a_chart(shown: Shown, job: Job) -> None:
    """Of one over the time, and of one whose abscissa goes to and fro, in both directions."""
    page = shown(pressed_ring(job))
    charts(page)
    chart = "page.charts.find((chart) => chart.title === 'Energies')"

    def ends(of: str, axis: str) -> tuple[float, float]:
        page.wait_for_timeout(50)  # the chart draws in a later turn
        return tuple(page.evaluate(f"[{of}.plot.scales.{axis}.min, {of}.plot.scales.{axis}.max]"))

    page.evaluate(f"{chart}.plotted.focus()")
    whole, frame = ends(chart, "x"), page.evaluate("page.view.frame")
    page.keyboard.press("+")
    low, high = ends(chart, "x")
    assert high - low == pytest.approx(0.7 * (whole[1] - whole[0])) and low > whole[0]
    page.keyboard.press("ArrowLeft")
    assert ends(chart, "x") == pytest.approx((low - 0.1 * (high - low), high - 0.1 * (high - low)))
    assert page.evaluate("page.view.frame") == frame, "the arrow moves no frame"
    page.keyboard.press("0")
    assert ends(chart, "x") == pytest.approx(whole)
    page.keyboard.press("Shift+ArrowRight")
    page.keyboard.press("Shift+ArrowRight")
    time, value = page.evaluate(f"{chart}.plot.legend.values.slice(0, 2).map((each) => each._)")
    times, kinetic = page.evaluate(f"{chart}.plot.data.slice(0, 2).map((column) => column[1])")
    assert page.evaluate(f"{chart}.plot.cursor.idx") == 1
    assert (time, value) == (page.evaluate(f"number({times}, 5)"), page.evaluate(f"number({kinetic}, 5)"))
    page.keyboard.press("Enter")
    assert page.evaluate("page.view.frame") == page.evaluate(f"page.result.nearestFrame({times})")

    force = "page.charts[0]"
    page.evaluate(f"{force}.plotted.focus()")
    before = [ends(force, axis) for axis in "xy"]
    page.keyboard.press("+")
    page.keyboard.press("ArrowUp")
    page.keyboard.press("ArrowRight")
    for axis, (low, high) in zip("xy", before):
        found = ends(force, axis)
        assert found[1] - found[0] == pytest.approx(0.7 * (high - low))
        assert found[0] + found[1] == pytest.approx(low + high + 0.2 * 0.7 * (high - low))
    page.keyboard.press("0")
    assert [ends(force, axis) for axis in "xy"] == [pytest.approx(each) for each in before]
    page.keyboard.press("+")
    assert ends(force, "x") != pytest.approx(before[0])
    page.locator(".chart .u-over").first.dblclick()
    assert [ends(force, axis) for axis in "xy"] == [pytest.approx(each) for each in before]


def test_values_of_elements_bands_and_marks_are_a_choice(shown: Shown, job: Job, tmp_path: Path) -> None:
    path = two_bodies(job, tmp_path)
    page = shown(path)
    page.keyboard.press("End")
    colours = "(page.view.draw(), new Set(page.view.painter.table).size)"
    assert page.evaluate(colours) == 12
    nodal = picture(page)
    page.select_option("#bands", "0")
    assert page.evaluate(colours) > 100 and picture(page) != nodal
    page.select_option("#values", "elements")
    page.wait_for_function("page.view.look.scalar.at === 'elements'")
    with Result(path) as result:
        assert page.evaluate("page.view.ends().most") == pytest.approx(
            max(frame["MISES"].max() for frame in result.frames), rel=FINE
        )
    marked = "(page.view.draw(), document.getElementById('overlay').toDataURL())"
    with_marks = page.evaluate(marked)
    page.keyboard.press("e")
    assert page.evaluate(marked) != with_marks


def test_a_model_without_elements_is_shown(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(without_elements(job, tmp_path))
    first = picture(page)
    spots = page.evaluate("Array.from(page.result.mesh.rigid, (node) => page.view.spot(node))")
    assert all(0.0 < x < 800.0 and 0.0 < y < 560.0 for x, y in spots)
    page.keyboard.press("End")
    assert picture(page) != first
    page.select_option("#field", "V:y")
    page.wait_for_function("page.view.look.scalar.id === 'V:y'")
    assert all(charts(page))


def test_a_deck_with_markup_in_it_stays_text(shown: Shown, job: Job, tmp_path: Path) -> None:
    text = (
        spinning_bar(tmp_path)
        .text()
        .replace("spinning, vibrating bar", "a </script><b>bold</b> &amp; {{data}} bar")
    )
    path = tmp_path / "markup.inp"
    path.write_text(text)
    page = shown(job(Deck.read(path)))
    assert page.inner_text("#heading") == "a </script><b>bold</b> &amp; {{data}} bar"


# On paper.


def pictures_of_pdf(data: bytes) -> list[np.ndarray]:
    """The pictures of a PDF in colour [rows, columns, 3]."""
    found = []
    for matched in re.finditer(rb"/Subtype /Image\s([^>]*)>>\s*stream\r?\n", data):
        numbers = {name: int(value) for name, value in re.findall(rb"/(\w+) (\d+)", matched[1])}
        pixels = np.frombuffer(zlib.decompress(data[matched.end() :][: numbers[b"Length"]]), np.uint8)
        if len(pixels) == 3 * numbers[b"Width"] * numbers[b"Height"]:
            found.append(pixels.reshape(numbers[b"Height"], numbers[b"Width"], 3))
    return found


def test_paper_has_the_bodies_the_rigid_lines_and_all_charts(shown: Shown, job: Job, tmp_path: Path) -> None:
    page = shown(rigid_surface(job, tmp_path))
    page.select_option("#field", "none")
    page.wait_for_function("page.charts.every((chart) => chart.plot)")
    on_screen = page.evaluate(
        """(() => {
            const { width, height } = page.view.overlay;
            return Array.from(page.drawn().getContext("2d").getImageData(0, 0, width, height).data);
        })()"""
    )
    shapes = page.evaluate("page.charts.map((chart) => [chart.plot.ctx.canvas.height, chart.plot.ctx.canvas.width])")
    data = page.pdf()
    images = pictures_of_pdf(data)
    assert len(images) >= len(shapes)
    bodies = max(images, key=lambda image: (image == (0xCD, 0xD8, 0xE4)).all(axis=2).sum())
    pixels = np.reshape(on_screen, (-1, 4))[:, :3]
    for colour in ((0xCD, 0xD8, 0xE4), (0x3D, 0x4A, 0x58)):
        wanted = (pixels == colour).all(axis=1).sum()
        assert wanted > 300
        assert (bodies == colour).all(axis=2).sum() == wanted
    printed = [list(image.shape[:2]) for image in images]
    assert all(shape in printed for shape in shapes), "charts are whole"
    assert page.locator(".printed").count() == 0, "the screen is as it was"
