"""What the pictures show: histories by name, panels that fill their page, one scale."""

import shutil
from pathlib import Path

import h5py
import matplotlib
import numpy as np
import pytest
from bodies import rigid_only
from conftest import ROOT, Job
from decks import CANTILEVERS, RINGS, parse, shortened
from matplotlib.axes import Axes
from matplotlib.collections import Collection, LineCollection, PathCollection, PolyCollection
from matplotlib.figure import Figure
from matplotlib.quiver import Quiver
from PIL import Image
from stickslip.deck import Deck
from stickslip.errors import Fault
from stickslip.plot import along as plot_along
from stickslip.plot import history as plot_history
from stickslip.plot import style
from stickslip.plot.fields import BANDS, Colouring, Field, on_lines, usual
from stickslip.plot.motion import Look, animate, chosen_times, overlay, panels, shown_at
from stickslip.quantity import find, listed
from stickslip.result import Result

PLAIN = Look()


@pytest.fixture
def contact(job: Job) -> Result:
    """Case A of the cantilevers, up to the contact."""
    return Result(job(shortened(CANTILEVERS / "A_mu04.inp", 300)))


@pytest.fixture
def other(job: Job) -> Result:
    """The same without friction."""
    return Result(job(shortened(CANTILEVERS / "A_mu00.inp", 300)))


# Histories.


def test_histories_by_name(contact: Result) -> None:
    tip = contact.history.nodes["UPPER_TIP"]
    (part,) = find(contact, "nodes/UPPER_TIP/U:2").parts.values()
    assert np.array_equal(part, tip.U[:, :, 1].mean(axis=1))
    (part,) = find(contact, f"nodes/UPPER_TIP[{tip.labels[1]}]/U:1").parts.values()
    assert np.array_equal(part, tip.U[:, 1, 0])
    parts = find(contact, "nodes/UPPER_TIP/RF").parts
    assert np.array_equal(parts["y"], tip.RF.sum(axis=1)[:, 1])
    assert find(contact, "energy/kinetic").title == "kinetic energy"
    assert find(contact, "momentum/linear:1").title == "linear momentum, x"
    assert find(contact, "nodes/UPPER_TIP/U:2").title == "displacement, mean over UPPER_TIP, y"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("energi/kinetic", "contact, dt, energy, "),
        ("energy/kinetik", "energy has balance, damping, external_work, "),
        ("nodes/TIP/U:2", "nodes has LOWER_TIP, UPPER_TIP"),
        ("nodes/UPPER_TIP[1]/U:2", "there are 21, 42, 63"),
        ("nodes/UPPER_TIP/U:3", "components 1 to 2"),
        ("energy/kinetic:1", "leave out the :1"),
        ("contact/UPPER_FACE_LOWER_FACE", "closed, cone_violation"),
        ("a:b", "no name of a history"),
    ],
)
def test_names_that_there_are_not(contact: Result, name: str, words: str) -> None:
    with pytest.raises(Fault) as fault:
        find(contact, name)
    assert words in str(fault.value)


def test_every_listed_history_is_found(contact: Result) -> None:
    names = listed(contact)
    assert "energy/kinetic" in names and "nodes/UPPER_TIP/U:1 to :2" in names
    for name in names:
        find(contact, name.partition(" ")[0].replace("[BODY]", "[0]"))


def test_one_column_for_each_body(contact: Result, tmp_path: Path) -> None:
    path = Path(shutil.copy(contact.path, tmp_path / "bodies.vtkhdf"))
    rows = contact.rows
    with h5py.File(path, "r+") as file:
        history = file["history"]
        for name, shape in (("bodies/kinetic", (2,)), ("bodies/velocity", (2, 2))):
            if name in history:
                del history[name]
            values = np.arange(rows * float(np.prod(shape))).reshape(rows, *shape)
            history.create_dataset(name, data=values, maxshape=(None, *shape))
    with Result(path) as results:
        both = find(results, "bodies/kinetic").parts
        assert list(both) == ["body 0", "body 1"]
        assert np.array_equal(find(results, "bodies/kinetic[1]").parts[""], both["body 1"])
        (part,) = find(results, "bodies/velocity[1]:2").parts.values()
        assert part[:2].tolist() == [3.0, 7.0]
        assert "bodies/velocity[BODY]:1 to :2" in listed(results)
        for name, words in (("bodies/velocity", "[0]"), ("bodies/kinetic[2]", "2 bodies")):
            with pytest.raises(Fault, match="bodies") as fault:
                find(results, name)
            assert words in str(fault.value)


def test_a_history_against_another(contact: Result, other: Result) -> None:
    along, shown = "nodes/UPPER_TIP/U:2", "contact/UPPER_FACE_LOWER_FACE/force:1"
    figure = plot_history.draw_named([contact, other], along, [[shown], ["energy/kinetic"]])
    first, second = figure.axes
    for results, line in zip((contact, other), first.lines):
        assert np.array_equal(line.get_xdata(), find(results, along).parts["y"])
        assert np.array_equal(line.get_ydata(), find(results, shown).parts["x"])
    words = [text.get_text() for text in first.get_legend().get_texts()]
    assert words == plot_history.names([contact, other])
    assert " ".join(first.get_ylabel().split()) == (
        "contact force on the slave surface, UPPER_FACE_LOWER_FACE, x"
    )
    assert second.get_xlabel() == "displacement, mean over UPPER_TIP, y"
    with pytest.raises(Fault, match="which component"):
        plot_history.draw_named([contact], "momentum/linear", [["time"]])


def test_results_of_one_name_are_told_apart(contact: Result) -> None:
    assert plot_history.names([contact]) == [contact.job]
    assert plot_history.names([contact, contact])[0] == str(contact.path.with_suffix(""))


def test_results_side_by_side_have_the_same_scales(contact: Result, other: Result) -> None:
    figure = plot_history.draw([contact, other])
    left, right = figure.axes[0:-1:2], figure.axes[1::2]
    assert len(left) == len(right) == 6
    for one, two in zip(left, right):
        assert one.get_ylim() == two.get_ylim()
        assert one.get_legend() is None, "one legend, on the right"


def test_results_on_top_of_each_other(contact: Result, other: Result) -> None:
    figure = plot_history.compare([contact, other])
    kinetic = figure.axes[0]
    assert [len(axes.lines) for axes in figure.axes] == [2] * 7
    assert np.array_equal(kinetic.lines[1].get_ydata(), other.history.energy["kinetic"])
    words = [text.get_text() for text in kinetic.get_legend().get_texts()]
    assert words == plot_history.names([contact, other])


def test_the_stacked_accounts_sum_up_to_what_was_put_in(contact: Result) -> None:
    _, axes = style.subplots()
    plot_history.energy(axes, contact)
    account = contact.history.energy
    put_in = account["kinetic"][0] + account["strain"][0] + account["external_work"]
    parts = sum(sign * account[name] for name, _, sign in plot_history.LEDGER)
    assert np.abs(parts - put_in).max() < 1e-9 * contact.history.energy.largest
    tops = [layer.get_paths()[0].vertices[:, 1] for layer in axes.collections]
    assert max(top.max() for top in tops) == pytest.approx(put_in.max(), rel=1e-9)


def test_round_off_of_a_momentum_looks_like_nothing(job: Job) -> None:
    with Result(job(shortened(RINGS / "rings_mu02.inp", 40, "default"))) as results:
        _, axes = style.subplots(2)
        plot_history.linear_momentum(axes[0], results)
        plot_history.angular_momentum(axes[1], results)
        assert np.ptp(axes[0].get_ylim()) > 0.1
        assert np.ptp(axes[1].get_ylim()) > 0.1


# Motion.


def filled(figure: Figure) -> float:
    """Part of the page that panels take, without their titles and labels."""
    boxes = [axes.get_window_extent() for axes in shapes(figure)]
    return sum(box.width * box.height for box in boxes) / figure.bbox.width / figure.bbox.height


def shapes(figure: Figure) -> list[Axes]:
    """The axes that are no colour bars."""
    figure.canvas.draw()
    return [axes for axes in figure.axes if axes.get_aspect() == 1.0]


def mappable(axes: Axes) -> Collection:
    """What is coloured by a field in a panel."""
    (found,) = (each for each in axes.collections if each.get_array() is not None)
    return found


@pytest.mark.parametrize("count", [1, 4, 6, 8])
def test_panels_of_a_long_model_fill_their_page(other: Result, count: int) -> None:
    figure = panels([shown_at(other, np.linspace(0.0, 0.5, count))], Look("von-mises"))
    assert filled(figure) > 0.55
    assert figure.get_size_inches().max() <= 11.0


def test_an_overlay_of_a_long_model_fills_its_page(other: Result) -> None:
    assert filled(overlay([shown_at(other, [0.0, 0.5])])) > 0.65


def test_legends_stand_beside_the_mesh_when_there_is_something_in_them(contact: Result) -> None:
    start = panels([[(contact, 0)]], PLAIN)
    assert start.legends == []
    touching = panels(
        [shown_at(contact, contact.frames.times[::10])], Look(vectors="CONTACT_FORCE")
    )
    touching.canvas.draw()
    (legend,) = touching.legends
    words = [text.get_text() for text in legend.get_texts()]
    assert words[0] == "stick" and words[-1].startswith("contact force,\nlongest ")
    box = legend.get_window_extent()
    assert not any(box.overlaps(axes.get_window_extent()) for axes in touching.axes)
    assert touching.bbox.containsx(box.x0) and touching.bbox.containsx(box.x1)
    assert all(axes.get_legend() is None for axes in touching.axes)


def test_several_results_have_one_scale(contact: Result, other: Result) -> None:
    rows = [shown_at(results, np.array([0.0, 2.0, 4.0])) for results in (contact, other)]
    figure = panels(rows, Look("von-mises"))
    shown = shapes(figure)
    assert len(shown) == 6
    assert len({(axes.get_xlim(), axes.get_ylim()) for axes in shown}) == 1
    assert len({mappable(axes).norm.vmax for axes in shown}) == 1
    assert [axes.get_title().startswith(contact.job) for axes in shown[:3]] == [True, False, False]
    assert shown[3].get_title().startswith(other.job)


def test_vectors_are_drawn_as_arrows(contact: Result) -> None:
    last = len(contact.frames) - 1
    for name, most in (("V", len(contact.coordinates)), ("CONTACT_FORCE", 3)):
        figure = panels([[(contact, last)]], Look(vectors=name))
        (quiver,) = (each for each in figure.axes[0].collections if isinstance(each, Quiver))
        assert 0 < quiver.N <= most
        drawn = np.stack([quiver.U, quiver.V], axis=1)
        vectors = contact.frames[last][name]
        assert all((vectors == arrow).all(axis=1).any() for arrow in drawn)
        assert (drawn != 0.0).any(axis=1).all()


def test_without_contact_there_are_no_arrows_and_no_marks(job: Job) -> None:
    deck = shortened(CANTILEVERS / "A_mu04.inp", 3)
    with Result(job(deck, "--frames", "1")) as results:
        figure = panels([[(results, 0), (results, 1)]], Look(vectors="CONTACT_FORCE"))
        assert "longest 0" in figure.legends[0].get_texts()[0].get_text()


def test_fields_have_all_their_names(contact: Result) -> None:
    """Those of the file, of Abaqus, and words; elements in the middle between their nodes, or as they are."""
    shown = [(contact, len(contact.frames) - 1)]
    for name, label in {
        "MISES": "von Mises stress",
        "von-mises": "von Mises stress",
        "S11": "stress, xx",
        "mean-stress": "stress, mean in the plane",
        "speed": "velocity, magnitude",
        "U2": "displacement, y",
        "cpress": "contact pressure",
    }.items():
        assert Colouring.of(Field(name), shown).label.startswith(label), name
    frame = contact.frames[-1]
    assert np.array_equal(Field("S12", False).values(*shown[0]), frame["S"][:, 2])
    assert np.array_equal(Field("S12").values(*shown[0]), frame.at_places("S")[:, 2])
    bands, elements = (mappable(shapes(panels([shown], Look("MISES", at_nodes)))[0]) for at_nodes in (True, False))
    assert len(bands.levels) == BANDS + 1 and isinstance(elements, PolyCollection)
    with pytest.raises(Fault, match="no field MISSES"):
        panels([shown], Look("MISSES"))


def test_default_times_have_the_ends_of_steps_and_the_peak(job: Job) -> None:
    """The largest value in the picture is that of the history at every increment."""
    deck = Deck.read(ROOT / "input" / "disc_spring" / "disc_spring_mu014.inp")
    sets = "*ELEMENT OUTPUT, ELSET=DISC, POSITION=NODES\nMISES, S\n"
    for at in reversed([i for i, card in enumerate(deck.cards) if card.keyword == "ENDSTEP"]):
        fields = f"*OUTPUT, FIELD, FREQUENCY=1\n{sets.replace(', ELSET=DISC', '')}"
        deck.cards[at:at] = Deck.parse(f"{fields}*OUTPUT, HISTORY, FREQUENCY=1\n{sets}").cards
    with Result(job(deck, "--frames", "40")) as result:
        history = result.file["history/elements/DISC/at_nodes/MISES"][()]
        field = Field("MISES")
        times = chosen_times(result, None, None, field)
        ends = [result.history.time[result.history.step == step].max() for step in (1, 2)]
        assert len(times) == 6 and set(ends) < set(times) and times[0] == 0.0
        figure = panels([shown_at(result, times)], Look("MISES"))
        words = [text.get_text() for axes in shapes(figure) for text in axes.texts]
        assert words == [f"{history.max():.4g}"]
        peak = result.history.time[history.max(axis=1).argmax()]
        assert peak in times
        assert Colouring.of(field, shown_at(result, times)).peak.value == history.max()


def test_force_against_displacement_is_in_the_picture_of_histories(job: Job, contact: Result) -> None:
    deck = Deck.read(ROOT / "input" / "disc_spring" / "disc_spring_mu014.inp")
    with Result(job(deck)) as result:
        *over_time, last = plot_history.draw([result]).axes
        (line,) = last.lines
        assert np.array_equal(line.get_xdata(), result.quantity("nodes/PLATE/U2"))
        assert np.array_equal(line.get_ydata(), result.quantity("nodes/PLATE/RF2"))
        assert last.get_xlabel() == "displacement of PLATE, z"
        # nothing moves with a momentum
        assert [axes.get_ylabel() for axes in over_time[2:]] == ["contact force", "pairs"]
        assert over_time[-1].get_xlabel() == "time"


def test_the_undeformed_outline_is_drawn(contact: Result) -> None:
    shown = [[(contact, len(contact.frames) - 1)]]
    plain, with_outline = panels(shown, PLAIN), panels(shown, Look(undeformed=True))
    assert len(lines_of(with_outline)) == len(lines_of(plain)) + 1
    outline = sorted(contact.coordinates[contact.boundary].sum(axis=(1, 2)))
    sums = [sorted(np.sum(line) for line in lines) for lines in lines_of(with_outline) if len(lines) == len(outline)]
    assert any(np.allclose(each, outline) for each in sums)


def lines_of(figure: Figure) -> list[list[np.ndarray]]:
    """Lines of the collections of a figure."""
    return [each.get_segments() for each in figure.axes[0].collections if isinstance(each, LineCollection)]


def test_nothing_of_the_users_figures_changes(contact: Result) -> None:
    with matplotlib.rc_context({"lines.linewidth": 7.0, "backend": "svg"}):
        before = dict(matplotlib.rcParams)
        figure = plot_history.draw([contact])
        assert figure.axes[2].lines[0].get_linewidth() == style.LOOK["lines.linewidth"]
        assert dict(matplotlib.rcParams) == before


def test_fields_of_slave_nodes_colour_the_outline(contact: Result, tmp_path: Path) -> None:
    path = Path(shutil.copy(contact.path, tmp_path / "slip.vtkhdf"))
    nodes, frames = len(contact.coordinates), len(contact.frames)
    slid = np.full(nodes * frames, np.nan)
    edge = contact.boundary[0]
    slid[nodes + edge] = 1.0, 3.0
    with h5py.File(path, "r+") as file:
        grid = file["VTKHDF"]
        for name in ("PointData/SLIP", "Steps/PointDataOffsets/SLIP"):
            if name in grid:
                del grid[name]
        grid["PointData/SLIP"] = slid
        grid["Steps/PointDataOffsets/SLIP"] = np.arange(frames) * nodes
    with Result(path) as results:
        values = on_lines(results, Field("slip").values(results, 1))
        first = (results.drawing.outline == edge).all(axis=1)
        assert values[first] == 2.0
        assert sorted(values[np.isfinite(values)]) == [1.0, 2.0, 3.0], "with the edges beside it"
        figure = panels([[(results, 0), (results, 1)]], Look("slip"))
        assert Colouring.of(Field("slip"), [(results, 1)]).norm.vmax == 3.0
        assert len(figure.axes) == 3


def test_nodes_in_contact_do_not_cover_coloured_edges(contact: Result) -> None:
    last = int(np.argmax([(contact.frames[k]["CONTACT_STATUS"] > 1).any() for k in range(9)]))
    shown = [[(contact, last)]]
    marked, coloured = panels(shown, PLAIN), panels(shown, Look("contact-pressure"))
    kinds = [[type(each) for each in figure.axes[0].collections] for figure in (marked, coloured)]
    assert PathCollection in kinds[0] and PathCollection not in kinds[1]
    assert not coloured.legends


def test_a_frame_that_is_a_peak_does_not_set_the_colours() -> None:
    largest = np.array([1.0, 1.2, 0.9, 1.1, 100.0, 0.0])
    assert 3.0 < usual(largest) < 4.0
    assert usual(np.array([1.0, 2.0, 2.5])) == 2.5
    assert usual(np.zeros(3)) == 0.0


def test_ends_of_the_colours_can_be_given(contact: Result) -> None:
    last = len(contact.frames) - 1
    colouring = Colouring.of(Field("von-mises"), [(contact, last)], (0.0, 1e-3))
    assert (colouring.norm.vmin, colouring.norm.vmax, colouring.extend) == (0.0, 1e-3, "max")
    assert ", largest " in colouring.label


def test_lines_of_a_fine_mesh_do_not_drown_its_colours(contact: Result) -> None:
    near = np.array([0.0, 0.0]), np.array([1.0, 1.0])
    far = np.array([-900.0, -900.0]), np.array([900.0, 900.0])
    widths = [
        panels([[(contact, 0)]], Look(window=window)).axes[0].collections[0].get_linewidth()[0]
        for window in (near, far)
    ]
    assert widths[0] > 0.2 and widths[1] == 0.0


def test_an_animation_has_every_frame(job: Job, tmp_path: Path) -> None:
    with Result(job(shortened(CANTILEVERS / "A_mu04.inp", 3), "--frames", "3")) as results:
        animate([results], Look("von-mises"), tmp_path / "motion.gif", 15)
        with Image.open(tmp_path / "motion.gif") as film:
            assert film.n_frames == len(results.frames)
            film.seek(film.n_frames - 1)
            assert np.asarray(film.convert("RGB")).std() > 3.0


def test_many_lines_have_colours_of_their_own(contact: Result) -> None:
    names = [name for name in listed(contact) if name.startswith("energy/")]
    figure = plot_history.draw_named([contact], "time", [names])
    colours = [line.get_color() for line in figure.axes[0].lines]
    assert len(colours) == len(set(colours)) == len(names) > 10


def test_pressure_along_a_surface(job: Job) -> None:
    with Result(job(shortened(RINGS / "rings_mu02.inp", 120))) as results:
        nodes = np.flatnonzero(np.isfinite(results.frames[0]["SLIP"]))
        lines = plot_along.chains(results, nodes)
        assert sorted(np.concatenate([np.unique(line) for line in lines])) == sorted(nodes)
        last = len(results.frames) - 1
        figure = plot_along.draw(results, lines, [0, last], "CONTACT_PRESSURE", "length")
        (start, end) = figure.axes[0].lines
        assert not np.nan_to_num(start.get_ydata()).any()
        assert len(end.get_xdata()) == len(lines[0]) and (np.diff(end.get_xdata()) > 0.0).all()
        stress = plot_along.draw(results, lines, [last], "S22", "y").axes[0].lines[0]
        assert np.array_equal(stress.get_ydata(), results.frames[last].nodal("S22")[lines[0]])
        with pytest.raises(Fault, match="say which part of S"):
            plot_along.draw(results, lines, [last], "S", "length")


def test_times(contact: Result) -> None:
    assert chosen_times(contact, None, 2.0).tolist() == [0.0, 2.0, 4.0]
    assert len(chosen_times(contact, None, None)) == 6
    with pytest.raises(Fault, match="100 at most"):
        chosen_times(contact, None, 1e-3)
    assert shown_at(contact, [1e9, -1.0, 0.0]) == [
        (contact, 0),
        (contact, len(contact.frames) - 1),
    ]


def test_the_view_follows_the_bodies(job: Job, tmp_path: Path) -> None:
    deck = (ROOT / "tests/decks/rigid_floor.inp").read_text()
    far = deck.replace("*RIGID BODY", "LINE, 1000., 0.\n*RIGID BODY", 1)
    with Result(job(parse(far, tmp_path))) as results:
        low, high = panels([[(results, 0)]], PLAIN).axes[0].get_xlim()
        assert high - low < 30.0
        window = np.array([0.0, 1.0]), np.array([2.0, 4.0])
        axes = panels([[(results, 0)]], Look(window=window)).axes[0]
        assert axes.get_xlim() == (0.0, 2.0) and axes.get_ylim() == (1.0, 4.0)


def test_rigid_surfaces_are_in_the_picture(job: Job) -> None:
    with Result(job(Deck.read(ROOT / "tests/decks/rigid_floor.inp"))) as results:
        figure = panels([[(results, 0)]], PLAIN)
        low, high = figure.axes[0].get_xlim()
        assert low < -3.0 and high > 5.0


@pytest.mark.parametrize("look", [Look("MISES"), Look("MISES", at_nodes=False), Look("U2", undeformed=True)])
def test_a_model_without_elements_is_drawn(look: Look, job: Job) -> None:
    with Result(job(rigid_only())) as result:
        times = chosen_times(result, None, None, Field(look.field))
        figure = panels([shown_at(result, times)], look)
        figure.canvas.draw()
        assert len(shapes(figure)) == 6
