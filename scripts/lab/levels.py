"""Factors and levels of the decks, and which levels may not stand together, with the reason.

A level is data: text that the writer of scenes (`lab.scene`) puts into the deck, or a name that it
knows. A pair of levels that neither `RULES` forbids nor the program runs is a failure.
"""

from collections.abc import Mapping
from dataclasses import dataclass

PLANE = "CPE3 CPE4 CPE4H CPE4I CPE4R CPE6 CPE8 CPE8H CPE8R CPE8RH CPS3 CPS4 CPS4I CPS4R CPS6 CPS8 CPS8R".split()
RINGS = "CAX3 CAX4 CAX4H CAX4I CAX4R CAX6 CAX8 CAX8H CAX8R CAX8RH".split()
PRESSURES = [name for name in PLANE + RINGS if name.endswith("H")]

MATERIALS = {
    "svk": "*ELASTIC\n1000., 0.3\n",
    "hencky": "*ELASTIC, TYPE=HENCKY\n1000., 0.3\n",
    "neo-hooke": "*ELASTIC, TYPE=NEO HOOKE\n1000., 0.3\n",
    "rubber": "*HYPERELASTIC, NEO HOOKE\n190., 0.0024\n",
    "mooney": "*HYPERELASTIC, MOONEY-RIVLIN\n150., 40., 0.0024\n",
    "yeoh": "*HYPERELASTIC, YEOH\n190., -2., 0.5, 0.0024, 0., 0.\n",
    "ogden": "*HYPERELASTIC, OGDEN, N=2\n350., 1.3, 30., -2., 0.0024, 0.\n",
    "metal": "*ELASTIC\n1000., 0.3\n*PLASTIC\n4., 0.\n8., 0.2\n",
    "kinematic metal": "*ELASTIC\n1000., 0.3\n*PLASTIC, HARDENING=KINEMATIC\n4., 0.\n8., 0.2\n",
    "viscous": "*ELASTIC\n1000., 0.3\n*DAMPING, BETA=0.002\n",
    "braked": "*ELASTIC\n1000., 0.3\n*DAMPING, ALPHA=0.5\n",
}
"""Cards below *MATERIAL and *DENSITY."""

INELASTIC = ["metal", "kinematic metal"]


@dataclass(frozen=True)
class Procedure:
    """A procedure card with its data line, and settings of *STICKSLIP."""

    card: str
    duration: float
    settings: str = ""

    @property
    def text(self) -> str:
        """The cards of a step."""
        settings = f"*STICKSLIP, {self.settings}\n" if self.settings else ""
        return settings + self.card


PROCEDURES = {
    "static": Procedure("*STATIC\n0.25, 1.\n", 1.0),
    "static direct": Procedure("*STATIC, DIRECT\n0.25, 1.\n", 1.0),
    "quasi-static": Procedure("*DYNAMIC, APPLICATION=QUASI-STATIC\n0.25, 1.\n", 1.0),
    "dynamic": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1),
    "automatic": Procedure("*DYNAMIC\n0.005, 0.1\n", 0.1),
    "ss22": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1, "SCHEME=SS22"),
    "events": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1, "IMPACT TIME=EVENT"),
    "return": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1, "LANDING=RETURN"),
    "redistributed": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1, "CONTACT MASS=REDISTRIBUTED"),
    "no impulses": Procedure("*DYNAMIC, DIRECT, IMPACT=NO\n0.01, 0.1\n", 0.1),
    "lemke": Procedure("*DYNAMIC, DIRECT\n0.01, 0.1\n", 0.1, "LCP=LEMKE, FACTORIZATION=EVERY PASS"),
}
STATIC = ["static", "static direct"]
SLOW = [*STATIC, "quasi-static"]
FAST = [name for name in PROCEDURES if name not in SLOW]

SEQUENCES = "one, on and off, hold, rest, removed, released, contact removed, friction changed, two loads".split(
    ", "
)

CONTACTS = (
    "none, node to surface, surface to surface, both orders, both orders s2s, node surface, general, general nodes, "
    "general surfaces, general adjusted, rigid floor, rigid floor s2s, general floor, clearance, adjusted, interference"
).split(", ")
GENERAL = [name for name in CONTACTS if name.startswith("general")]
FLOORS = [name for name in CONTACTS if name.endswith(("floor", "floor s2s"))]

INTERACTIONS = {
    "frictionless": "",
    "friction": "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n*FRICTION\n0.3\n",
    "table": "*FRICTION\n0.3, 0., 0.\n0.2, 1., 0.\n0.25, 0., 10.\n0.15, 1., 10.\n",
    "decay": "*FRICTION, EXPONENTIAL DECAY\n0.4, 0.2, 1.\n",
    "taumax": "*FRICTION, TAUMAX=0.5\n0.3\n",
    "rough": "*FRICTION, ROUGH\n",
    "wear": "*FRICTION\n0.3\n*WEAR SURFACE PROPERTIES\n1.E-5\n",
    "heat": "*FRICTION\n0.3\n*GAP HEAT GENERATION\n0.9, 0.5\n",
    "wear and heat": "*FRICTION\n0.3\n*WEAR SURFACE PROPERTIES, FRIC COEF DEPENDENT=YES\n1.E-5\n*GAP HEAT GENERATION\n",
}

CONNECTIONS = (
    "none, tie, kinematic, distributing, kinematic coupling, beam, pin, equation, hinge, springs, springs along axes, "
    "rigid nodes, rigid tie nodes, rigid elements, pre-tension, disc"
).split(", ")
TURNING = [
    "kinematic",
    "kinematic coupling",
    "beam",
    "rigid nodes",
    "rigid tie nodes",
    "rigid elements",
    "disc",
]
"""Connections whose reference node has an angle."""
WITH_REFERENCE = [*TURNING, "distributing", "pin", "equation"]
WITH_CAP = ["tie", "hinge", "springs", "springs along axes"]
"""Connections to a third body on top."""

LOADS = (
    "force, moment, pressure, traction, face pressure, face traction, gravity, body force, centrifugal, motion, "
    "rotation, velocity, acceleration, thrown, heat"
).split(", ")
DRIVEN = ["motion", "rotation", "velocity", "acceleration"]

AMPLITUDES = {
    "none": "",
    "tabular": "*AMPLITUDE, NAME=A\n0., 0., {half!r}, 0.7, {end!r}, 1.\n",
    "smooth": "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0., 0., {end!r}, 1.\n",
    "equal": "*AMPLITUDE, NAME=A, DEFINITION=EQUALLY SPACED, FIXED INTERVAL={quarter!r}\n0., 0.2, 0.5, 0.8, 1.\n",
    "periodic": "*AMPLITUDE, NAME=A, DEFINITION=PERIODIC\n1, {rate!r}, 0., 0.\n0., 1.\n",
    "decaying": "*AMPLITUDE, NAME=A, DEFINITION=DECAY\n1., -1., 0., {quarter!r}\n",
    "modulated": "*AMPLITUDE, NAME=A, DEFINITION=MODULATED\n0., 1., 0., {rate!r}, {rate!r}\n",
    "total time": "*AMPLITUDE, NAME=A, TIME=TOTAL TIME\n0., 0., {end!r}, 1.\n",
}
"""Cards with the times of a step; all are 1 (the decaying one nearly) at its end."""

WRITTEN = ["flat", "parts", "moved parts", "include", "parameters"]
"""How the deck is written."""

OUTPUTS = {
    "default": "",
    "fields": (
        "*NODE FILE, FREQUENCY=2\nU, CF\n"
        "*EL FILE, POSITION=NODES\nS, E, LE, SP, PRESS, ENER, PEEQ\n*CONTACT FILE\nCDIS\n"
    ),
    "histories": (
        "*OUTPUT, HISTORY\n*NODE OUTPUT, NSET={nodes}\nU, RF\n*ELEMENT OUTPUT, ELSET={elements}, "
        "POSITION=INTEGRATION POINTS\nS, E\n*ELEMENT OUTPUT, ELSET={elements}, POSITION=NODES\nS, PRESS\n"
        "*MONITOR, NODE={monitor}, DOF=2\n"
    ),
    "prints": (
        "*NODE PRINT, NSET={nodes}, TOTALS=ONLY\nRF\n*EL PRINT, ELSET={elements}\nS\n*CONTACT PRINT\n"
        "*ENERGY OUTPUT\n"
    ),
    "few": "*OUTPUT, FIELD, FREQUENCY=0\n*NODE OUTPUT\nU\n",
    "times": "*OUTPUT, FIELD, NUMBER INTERVAL=2\n*ELEMENT OUTPUT\nS\n*CONTACT OUTPUT\nCSTRESS\n",
    "points": "*TIME POINTS, NAME=T{number}\n{half!r},\n*OUTPUT, FIELD, TIME POINTS=T{number}\n*NODE OUTPUT\nU\n",
}

FORMS = (
    "moved, turned, mirrored, renumbered, reordered, units, powers of two, solved otherwise, flattened, otherwise written, "
    "threads, resumed, restarted, finer family, halves, removed as zero, slowly, exchanged"
).split(", ")
"""What else is run and compared (`lab.oracles`)."""

READERS = "h5py, pandas, xarray, PyVista, report".split(", ")
"""What the result is opened with."""

FACTORS: dict[str, list[str]] = {
    "family": PLANE + RINGS,
    "material": list(MATERIALS),
    "procedure": list(PROCEDURES),
    "sequence": SEQUENCES,
    "contact": CONTACTS,
    "interaction": list(INTERACTIONS),
    "connection": CONNECTIONS,
    "load": LOADS,
    "amplitude": list(AMPLITUDES),
    "written": WRITTEN,
    "output": list(OUTPUTS),
    "form": FORMS,
    "reader": READERS,
}


@dataclass(frozen=True)
class Rule:
    """Levels that may not stand together; a factor that is not named may have any level."""

    reason: str
    levels: Mapping[str, list[str]]
    code: str = ""
    """Code of the error that the program refuses them with, where it reads them at all."""


def but(factor: str, *levels: str) -> list[str]:
    """All levels of a factor but some."""
    return [level for level in FACTORS[factor] if level not in levels]


RULES = [
    Rule(
        "friction needs a contact",
        {"contact": ["none"], "interaction": but("interaction", "frictionless")},
    ),
    Rule(
        "contact is removed where there is one",
        {"contact": ["none"], "sequence": ["contact removed", "friction changed"]},
    ),
    Rule(
        "an overlap is pressed out in one step",
        {"contact": ["interference"], "sequence": but("sequence", "one", "hold", "rest")},
    ),
    Rule(
        "a fit is pressed together over increments",
        {"contact": ["interference"], "procedure": ["events"]},
        "D422",
    ),
    Rule("a disc rolls away under a moment", {"load": ["moment"], "connection": ["disc"]}),
    Rule("a node that is held is not thrown", {"load": ["thrown"], "sequence": ["released"]}),
    Rule(
        "a node of rigid elements is held with their reference node",
        {"contact": ["none"], "sequence": ["released"], "connection": ["rigid elements"]},
        "D413",
    ),
    Rule("general contact is no pair", {"contact": GENERAL, "sequence": ["contact removed"]}),
    Rule(
        "friction that is no coefficient does not change",
        {"interaction": ["rough", "frictionless"], "sequence": ["friction changed"]},
    ),
    Rule("rest begins with a static step of its own", {"sequence": ["rest"], "procedure": STATIC}),
    Rule(
        "an angle is that of a reference node that turns",
        {"load": ["moment", "rotation"], "connection": but("connection", *TURNING)},
    ),
    Rule(
        "a pressure acts on a side of elements",
        {
            "load": ["pressure", "traction", "face pressure", "face traction"],
            "connection": ["disc", "rigid elements"],
        },
    ),
    Rule("a thrown body has time to fly", {"load": ["thrown"], "procedure": SLOW}),
    Rule(
        "a velocity given at the start does not change",
        {"load": ["thrown"], "sequence": ["rest", "on and off", "removed", "two loads"]},
    ),
    Rule(
        "a velocity given at the start has no amplitude",
        {"load": ["thrown"], "amplitude": but("amplitude", "none")},
    ),
    Rule(
        "velocities go on: they are no loads that come and go",
        {
            "load": ["velocity", "acceleration"],
            "sequence": ["on and off", "rest", "hold", "two loads"],
        },
    ),
    Rule(
        "these schemes are made of the energy-momentum scheme",
        {"procedure": ["ss22"], "form": ["slowly"]},
    ),
    Rule(
        "a slow motion is compared with a static step",
        {"form": ["slowly"], "procedure": but("procedure", *STATIC)},
    ),
    Rule(
        "a slow motion has no inertia of its own",
        {
            "form": ["slowly"],
            "load": ["gravity", "centrifugal", "thrown", "velocity", "acceleration", "heat"],
        },
    ),
    Rule(
        "a slow motion has another rate of slip",
        {"form": ["slowly"], "interaction": ["table", "decay"]},
    ),
    Rule(
        "a slow motion follows one path", {"form": ["slowly"], "sequence": but("sequence", "one")}
    ),
    Rule(
        "a section closes over the whole step",
        {"form": ["halves"], "connection": ["pre-tension"]},
    ),
    Rule(
        "increments that follow their passes are others where passes are",
        {"form": ["solved otherwise"], "procedure": ["static", "quasi-static"]},
    ),
    Rule(
        "an overlap is pressed out in the whole step",
        {"form": ["halves"], "contact": ["interference"]},
    ),
    Rule("a body that is held is not thrown", {"load": ["thrown"], "contact": ["none"]}),
    Rule(
        "a step is cut into halves where it is alone",
        {"form": ["halves"], "sequence": but("sequence", "one")},
    ),
    Rule(
        "an amplitude of a step would begin anew",
        {"form": ["halves"], "amplitude": but("amplitude", "none", "total time")},
    ),
    Rule(
        "a step is halved where its increments are its own",
        {"form": ["halves"], "procedure": ["automatic", "static", "quasi-static"]},
    ),
    Rule("a velocity given at the start acts once", {"form": ["halves"], "load": ["acceleration"]}),
    Rule(
        "there is a load to remove",
        {"form": ["removed as zero"], "sequence": but("sequence", "removed")},
    ),
    Rule("a removed support is not one of value 0", {"form": ["removed as zero"], "load": DRIVEN}),
    Rule(
        "a velocity given at the start is not removed",
        {"form": ["removed as zero"], "load": ["thrown"]},
    ),
    Rule(
        "a fit is pressed together in a step, from which no load is removed",
        {"form": ["removed as zero"], "contact": ["interference"]},
    ),
    Rule("a restart needs a second step", {"form": ["restarted"], "sequence": ["one"]}),
    Rule(
        "both orders are exchanged",
        {"form": ["exchanged"], "contact": but("contact", "both orders", "both orders s2s")},
    ),
    Rule(
        "a flat deck is not written otherwise", {"form": ["otherwise written"], "written": ["flat"]}
    ),
    Rule("impacts of meshes that differ differ", {"form": ["finer family"], "procedure": FAST}),
    Rule("a thrown body has impacts", {"form": ["finer family"], "load": ["thrown"]}),
    Rule(
        "a finer family ends elsewhere after its load",
        {"form": ["finer family"], "sequence": but("sequence", "one", "hold")},
    ),
    Rule("a finer family yields elsewhere", {"form": ["finer family"], "material": INELASTIC}),
]


def forbidding(choice: Mapping[str, str]) -> Rule | None:
    """The rule that forbids a choice, whole or in part."""
    for rule in RULES:
        if all(choice.get(factor) in levels for factor, levels in rule.levels.items()):
            return rule
    return None


def allows(choice: Mapping[str, str]) -> bool:
    """Whether levels may stand together."""
    return forbidding(choice) is None


SIMPLEST = {
    "written": "flat",
    "output": "default",
    "amplitude": "none",
    "material": "svk",
    "family": "CPE4",
    "connection": "none",
    "load": "force",
    "sequence": "one",
    "interaction": "frictionless",
    "contact": "none",
    "procedure": "static",
    "form": "moved",
    "reader": "h5py",
}
"""Levels that a failing deck is shrunk to, where it goes on failing."""


@dataclass(frozen=True)
class Known:
    """A failure that is documented, with its reason."""

    oracle: str
    reason: str
    levels: Mapping[str, list[str]]


KNOWN: list[Known] = [
    Known(
        "holds",
        "a back strain of another direction leaves the stress of an increment in the frame of its start: an error of the increment, "
        "of first order in its length",
        {"material": ["kinematic metal"]},
    ),
]


def known(oracle: str, choice: Mapping[str, str]) -> str:
    """Why a failure is none of the program, or documented; empty where it is neither."""
    for one in KNOWN:
        fits = all(choice[factor] in levels for factor, levels in one.levels.items())
        if one.oracle == oracle and fits:
            return one.reason
    return ""


ELSEWHERE = {
    "RESTART": "the form `restarted`",
    "NO ANALYSIS": "nothing is solved",
    "SURFACE SMOOTHING": "its faces are flat: tests/decks/circles_of_a_pair.inp",
    "SURFACE PROPERTY ASSIGNMENT": "its faces are flat: tests/decks/circles_in_general.inp",
}
"""Keywords that no level has, with the reason."""
