"""From a geometry to a picture: a rubber ring drops on a bump, meshed by Gmsh.

Needs the packages gmsh and matplotlib. Run it in a checkout with `scripts/venv docs/tutorial_gmsh.py`.
"""

import gmsh
from stickslip import Deck, run
from stickslip.mesh import Mesh
from stickslip.plot import style
from stickslip.plot.motion import Look, panels

# The geometry: a ring, and a block with a round bump on its upper side. Units: N, mm, t, s.
gmsh.initialize(interruptible=False)
gmsh.option.setNumber("General.Terminal", 0)
shapes = gmsh.model.occ
ring, _ = shapes.cut(
    [(2, shapes.addDisk(0, 16.5, 0, 6, 6))], [(2, shapes.addDisk(0, 16.5, 0, 4, 4))]
)
block = [(2, shapes.addRectangle(-15, 0, 0, 30, 6))]
block, _ = shapes.fuse(block, [(2, shapes.addDisk(3, 5, 0, 4, 4))])
shapes.synchronize()

# Names: groups of surfaces become element sets, groups of curves surfaces and node sets.
gmsh.model.addPhysicalGroup(2, [tag for _, tag in ring], name="RING")
gmsh.model.addPhysicalGroup(2, [tag for _, tag in block], name="BLOCK")
floor = gmsh.model.getEntitiesInBoundingBox(-16, -1, -1, 16, 0.1, 1, dim=1)
gmsh.model.addPhysicalGroup(1, [tag for _, tag in floor], name="FLOOR")
gmsh.option.setNumber("Mesh.MeshSizeMax", 1.0)
gmsh.option.setNumber("Mesh.RecombineAll", 1)
gmsh.model.mesh.generate(2)
mesh = Mesh.from_gmsh(gmsh.model)
gmsh.finalize()

# The deck: rubber ring, stiffer block, general contact with friction, one step of 40 ms.
deck = Deck.titled("rubber ring on a bump")
deck.add_mesh(mesh, plane="strain")
deck.neo_hooke("RUBBER", c10=0.25, d1=0.4, density=1.1e-9)
deck.elastic("PLASTIC", young=500.0, poisson=0.35, density=1.2e-9)
deck.section("RING", "RUBBER", thickness=10.0).section("BLOCK", "PLASTIC", thickness=10.0)
deck.general_contact(friction=0.4)
deck.support("FLOOR")
deck.velocity("RING", 0.0, -1500.0)
with deck.step(dt=5e-5, duration=0.02):
    deck.gravity("RING", 9810.0)
    deck.history("RING")

# The run, and what it tells.
result = run(deck, "results", job="tutorial_gmsh", progress=True, frames=40)
contact = result.contact["ALL_EXTERIOR"]
energy = result.history.energy
print(f"{len(mesh.points)} nodes, {len(mesh.elements)} elements, {result.rows - 1} increments")
print(f"most nodes in contact at a time: {contact.closed.max()}")
print(f"energy that friction took: {energy.friction_dissipation[-1] / energy.kinetic[0]:.3f}")
print(f"largest von Mises stress in the last frame: {result.frames[-1]['MISES'].max():.3g} MPa")

# The picture: six times, coloured by the von Mises stress.
frames = [(result, result.frame(time).index) for time in (0.0, 0.002, 0.004, 0.007, 0.011, 0.02)]
style.save(panels([frames], Look("von-mises")), "results/tutorial_gmsh.png")
