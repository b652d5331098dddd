"""Checks of every increment, from the histories of the file."""

import numpy as np

from stickslip.arrays import Array, Flags, Integers
from stickslip.certificate.check import Check, Checks
from stickslip.result import Result

EPS = float(np.finfo(np.float64).eps)

OWN = {
    "residual": 1e-8,
    "overlap": 1e-8,
    "gap": 1e-8,
    "slip": 1e-8,
    "cone": 1e-9,
    "impulse_cone": 1e-9,
    "balance": 1e-8,
    "surface_work": 1e-10,
    "momentum": 1e-9,
}
"""What the program has measured itself, with bounds."""

SUMS = ("normal_work", "friction_dissipation", "landing_return", "release_loss")
"""Accounts of the contacts; those of the whole model have other names in part."""

WHOLE = {"normal_work": "normal_contact_work"}

IMPULSES = (
    "impulse",
    "normal_impulse",
    "tangential_impulse",
    "impact_normal_impulse",
    "impact_tangential_impulse",
    "return_impulse",
)

CONE = 1e-9
"""Forces outside of the cone by this part of the normal force are round-off."""

BALANCE = 1e-8
"""Largest balance of the ledger, as a part of the largest energy; the program warns above it."""

ROUND_OFF = 1e-11
"""Sums of the file that must agree, as a part of their largest value."""

MOMENTUM = 1e-9
"""Change of momentum that no impulse accounts for, as a part of the largest momentum."""


def check_histories(result: Result, checks: Checks) -> None:
    """All checks of the histories."""
    _time(result, checks["time"])
    _own(result, checks)
    _ledger(result, checks)
    _contacts(result, checks)
    _bodies(result, checks["accounts"])
    _body_forces(result, checks["accounts"])
    _momenta(result, checks["momentum"])


def _time(result: Result, check: Check) -> None:
    """Checks that increments follow each other and have converged."""
    time, dt = result.history["time"], result.history["dt"]
    size = np.abs(time).max() + dt.max()
    if len(time) > 1:
        check.add(np.abs(np.diff(time) - dt[1:]) / size, 8 * EPS, "increment {}")
        check.add(-dt[1:] / size, 0.0, "increment {}")
        check.add(result.history.solver["converged"] != 1, 0.0, "increment {}")


def _own(result: Result, checks: Checks) -> None:
    """Checks the values that the program has measured in every increment."""
    for name, bound in OWN.items():
        if name in result.history.certificate:
            checks["law"].add(result.history.certificate[name], bound, f"{name}, increment {{}}")


def _ledger(result: Result, checks: Checks) -> None:
    """Checks the energy balance, recomputed from its accounts, eq. (9.6), and the signs of dissipated energies."""
    energy = result.history.energy
    # what round-off makes of an account is within the bound of the balance
    scale = max(energy.largest, energy.noise / BALANCE)
    if scale == 0.0:
        checks["balance"].skip("nothing moves")
        return
    total = energy["kinetic"] + energy["strain"]
    balance = total - total[0] - energy["external_work"] - energy["normal_contact_work"]
    if "thermal_work" in energy:
        balance = balance - energy["thermal_work"]
    for name in (
        "friction_dissipation",
        "impact_loss",
        "release_loss",
        "damping",
        "material_dissipation",
        "numerical_dissipation",
    ):
        balance = balance + energy[name]
    balance = balance - energy["landing_return"]
    checks["balance"].add(np.abs(balance) / scale, BALANCE, "increment {}")
    stored = np.abs(balance - energy["balance"]) / scale
    checks["balance"].add(stored, ROUND_OFF, "account energy/balance, increment {}")
    for name in ("impact_loss", "release_loss", "damping", "material_dissipation"):
        checks["signs"].add(-np.diff(energy[name]) / scale, ROUND_OFF, name + ", increment {}+1")
    if "returns" not in result.file["history"]:
        name = "friction_dissipation"
        noise = _slip_noise(result) / scale
        checks["signs"].add(-np.diff(energy[name]) / scale, ROUND_OFF + noise, name + ", increment {}+1")
    for name in SUMS:
        parts = sum(contact[name] for contact in result.contact.values())
        if len(result.contact):
            whole = energy[WHOLE.get(name, name)]
            checks["accounts"].add(
                np.abs(parts - whole) / scale, ROUND_OFF, name + " of contacts, increment {}"
            )


def _slip_noise(result: Result) -> float:
    """Work that the largest contact force does over the round-off of positions."""
    force = max((float(contact["normal"].max(initial=0.0)) for contact in result.contact.values()), default=0.0)
    return EPS * force * float(np.abs(result.coordinates).max(initial=0.0))


def _contacts(result: Result, checks: Checks) -> None:
    """Checks that resultants of contacts lie in Coulomb's cone, and checks the sums of impulses."""
    cone = checks["cone"]
    for name, contact in result.contact.items():
        friction = _friction(result, name)
        normal, impulse = contact["normal"], contact["normal_impulse"]
        scale = max(float(normal.max(initial=0.0)), 1e-300)
        cone.add(-normal / scale, CONE, f"normal force of {name}, increment {{}}")
        cone.add(contact["cone_violation"], CONE, f"{name}, increment {{}}")
        cone.add(contact["impulse_cone_violation"], CONE, f"impulses of {name}, increment {{}}")
        closed = (contact["closed"] == 0) & (np.abs(contact["force"]).max(axis=1) > 0.0)
        checks["complementarity"].add(
            closed, 0.0, f"force of {name} without contact, increment {{}}"
        )
        if friction is None:
            cone.skip("the file has no coefficients of friction")
        else:
            tangential = np.abs(contact["tangential"]) - friction * normal
            cone.add(tangential / scale, CONE, f"sum of {name}, increment {{}}")
            total = np.abs(contact["tangential_impulse"]) - friction * impulse
            scale = max(float(np.abs(impulse).max(initial=0.0)), 1e-300)
            if "returns" not in result.file["history"]:
                cone.add(total / scale, CONE, f"impulses of {name}, increment {{}}")
        for one in IMPULSES:
            sums = contact[f"{one}_sum"]
            size = max(float(np.abs(sums).max(initial=0.0)), 1e-300)
            error = np.abs(np.cumsum(contact[one], axis=0) - sums) / size
            error = error.reshape(len(error), -1).max(axis=1)
            bound = ROUND_OFF * max(1.0, len(error) * 1e-3)
            checks["accounts"].add(error, bound, f"{one} of {name}, increment {{}}")


def _bodies(result: Result, check: Check) -> None:
    """Checks energies of the bodies, or of rigid bodies alone, against the energies of the model."""
    energy, bodies, groups = result.history.energy, result.history.bodies, result.file["history"]
    scale = max(energy.largest, energy.noise / BALANCE)
    if scale == 0.0:
        return
    sums = {}
    if "connectors" not in groups and "rotary_connectors" not in groups:
        sums["strain"] = bodies["strain"].sum(axis=1)
    rigid = result.history.rigid.values() if "rigid" in groups else ()
    moving = [each["kinetic"] for each in rigid if "kinetic" in each]
    if not moving:
        sums["kinetic"] = bodies["kinetic"].sum(axis=1)
    elif not result.cells:
        sums["kinetic"] = sum(moving)
    for name, total in sums.items():
        error = np.abs(total - energy[name]) / scale
        check.add(error, ROUND_OFF, f"{name} energy of bodies, increment {{}}")


def _body_forces(result: Result, check: Check) -> None:
    """Checks contact forces on the bodies against the forces of the contacts."""
    if "contacts" not in result.file["model"]:
        return
    stored = result.history.bodies["contact_force"]
    of_node = result.read("model/bodies/node")
    told, total = _shares(result, of_node, stored.shape[1], "force")
    total[..., 0] *= not result.is_axisymmetric
    size = max((float(c["normal"].max(initial=0.0)) for c in result.contact.values()), default=0.0)
    size = max(size, float(np.abs(stored).max(initial=0.0)), 1e-300)
    error = np.where(told, np.abs(total - stored).max(axis=2), 0.0).max(axis=1, initial=0.0) / size
    check.add(error, ROUND_OFF, "contact force on bodies, increment {}")


def _friction(result: Result, contact: str) -> float | None:
    """The largest coefficient of friction of a contact."""
    path = f"model/contacts/{contact}/friction"
    return float(result.read(path).max()) if path in result.file else None


def _momenta(result: Result, check: Check) -> None:
    """Checks that the momenta of free bodies change by the impulses of their contacts, and that the momentum of all
    bodies is constant if nothing else acts."""
    if "contacts" not in result.file["model"]:
        check.skip("the file has no data of the model")
        return
    mass = result.read("model/bodies/mass")
    of_node = result.read("model/bodies/node")
    held = np.concatenate(
        [result.read(f"model/{kind}_nodes") for kind in ("supported", "constrained")]
    )
    loaded = result.read("model/loaded_nodes")
    body_of_element = result.read("model/bodies/element")
    under_weight = body_of_element[result.read("model/load_groups") >= 0]
    alpha = result.read("model/materials/alpha")
    damped = body_of_element[alpha[result.read("model/element_materials")] != 0.0]
    nodes = of_node[np.concatenate([held, loaded])]
    bound = np.unique(np.concatenate([nodes[nodes >= 0], under_weight, damped]))
    free = np.setdiff1d(np.arange(len(mass)), bound)
    if result.history["dt"].size < 2:
        check.skip("there is no increment")
        return
    velocity = result.history.bodies["velocity"]
    momentum = mass[:, None] * velocity
    # of a body that turns or vibrates about a centre at rest only round-off is left of the momentum
    kinetic = np.maximum(result.history.bodies["kinetic"], 0.0)
    scale = float(np.sqrt(2.0 * mass * kinetic).sum(axis=1).max(initial=0.0))
    if scale == 0.0:
        check.skip("nothing moves")
        return
    whole = result.history.momentum["linear"]
    if "rigid" not in result.file["history"] or not len(result.file["history/rigid"]):
        error = np.abs(whole - momentum.sum(axis=1)).max(axis=1) / scale
        check.add(error, 1e-11, "sum over the bodies, increment {}")
    if len(free) == len(mass) and not len(held) and not len(loaded):
        error = np.abs(whole - whole[0]).max(axis=1) / scale
        check.add(error, MOMENTUM, "drift, increment {}")
        if (result.read("model/steps/scheme") == 1).all():
            angular = result.history.momentum["angular"]
            size = np.abs(result.history.bodies["center"]).max() + np.ptp(result.coordinates)
            check.add(
                np.abs(angular - angular[0]) / (scale * size),
                MOMENTUM,
                "angular momentum, increment {}",
            )
    told, gained = _shares(result, of_node, len(mass), "impulse")
    gained[..., 0] *= not result.is_axisymmetric
    for body in free:
        change = np.diff(momentum[:, body], axis=0) - gained[1:, body]
        error = np.abs(change).max(axis=1)[told[1:, body]] / scale
        check.add(error, MOMENTUM, f"body {body}, {{}} of the increments that tell")
    if not len(free):
        check.skip("no body is free")


def _shares(result: Result, of_node: Integers, bodies: int, quantity: str) -> tuple[Flags, Array]:
    """Force or impulse of all contacts on each body [I, B, 2], and whether the file determines this value [I, B]."""
    dt = result.history["dt"]
    told = np.ones((len(dt), bodies), np.bool_)
    total = np.zeros((len(dt), bodies, 2))
    for name, contact in result.contact.items():
        at = f"model/contacts/{name}"
        sides = (result.read(f"{at}/slaves"), result.read(f"{at}/segments").ravel())
        touched = [np.unique(of_node[side]) for side in sides]
        if all(len(side) == 1 for side in touched) and touched[0][0] != touched[1][0]:
            for side, sign in zip(touched, (1.0, -1.0)):
                if side[0] >= 0:
                    total[:, side[0]] += sign * contact[quantity]
            continue
        involved = np.unique(np.concatenate(touched))
        involved = involved[involved >= 0]
        if "body_force" in contact:
            force = contact["body_force"]
            total += force if quantity == "force" else dt[:, None, None] * force
            more = (contact["impact_normal_impulse"] != 0.0) | (contact["return_impulse"] != 0.0)
            if quantity == "impulse":
                told[np.ix_(more, involved)] = False
        else:
            told[:, involved] = False
    return told, total
