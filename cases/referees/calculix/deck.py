"""The input of CalculiX as text: a layer whose surface is pushed down, once by one and once along a profile."""

from collections.abc import Iterable, Iterator

from cases.referees.calculix.mesh import Section
from contact import Layer
from contact.records.validation import FloatArray

# Numbers longer than twenty characters are cut by CalculiX.
NUMBER = "{:.12e}"
# From here on elements with four instead of nine points of integration, which do not lock: at nu = 0.49, bonded,
# a/h = 1, the stiffness on 32 cells is 6e-6 off, with nine points 1e-2.
NEARLY_INCOMPRESSIBLE = 0.45


def deck(mesh: Section, layer: Layer, contact_radius: float, heights: FloatArray) -> str:
    """Return the deck: axisymmetric 8-node elements, two steps, reactions of surface, base and contact edge.

    Args:
        mesh: of the section.
        layer: bonded or unbonded, nu < 1/2; close to 1/2 the elements are those that do not lock.
        contact_radius: a [m]; nodes out to it move with the indenter and slide freely along it.
        heights: of the profile at the mesh's radii [m].
    """
    touching = [i for i in range(mesh.radius.size) if mesh.radius[i] <= contact_radius * (1 + 1e-12)]
    contact = [int(mesh.surface[i]) for i in touching]
    element = "CAX8R" if layer.poissons_ratio > NEARLY_INCOMPRESSIBLE else "CAX8"
    held = [("BASE", 2), ("AXIS", 1), *([("BASE", 1)] if layer.support == "bonded" else [])]
    return "\n".join(
        [
            "** A layer under a rigid frictionless indenter, axisymmetric; forces are those of a wedge of 2 degrees.",
            "*NODE, NSET=ALL",
            *(f"{n},{NUMBER.format(r)},{NUMBER.format(z)}" for n, r, z in mesh.nodes()),
            f"*ELEMENT, TYPE={element}, ELSET=LAYER",
            *(",".join(map(str, (e, *nodes))) for e, nodes in enumerate(mesh.elements(), 1)),
            *_set("CONTACT", contact),
            *_set("BASE", (int(n) for n in mesh.base if n)),
            *_set("AXIS", (int(n) for n in mesh.axis if n)),
            *_set("EDGE", contact[-1:]),
            "*MATERIAL, NAME=LAYER",
            "*ELASTIC",
            f"{NUMBER.format(layer.youngs_modulus)},{NUMBER.format(layer.poissons_ratio)}",
            "*SOLID SECTION, ELSET=LAYER, MATERIAL=LAYER",
            "*BOUNDARY",
            *(f"{where},{direction},{direction}" for where, direction in held),
            *_step(contact, [-1.0] * len(contact)),
            *_step(contact, [-float(heights[i]) for i in touching]),
            "",
        ]
    )


def _set(name: str, nodes: Iterable[int]) -> Iterator[str]:
    yield f"*NSET, NSET={name}"
    yield from (f"{node}," for node in nodes)


def _step(nodes: list[int], displacements: list[float]) -> Iterator[str]:
    """Surface nodes held at given vertical displacements, and the reactions asked for."""
    yield from ("*STEP", "*STATIC", "*BOUNDARY")
    yield from (f"{node},2,2,{NUMBER.format(w)}" for node, w in zip(nodes, displacements, strict=True))
    for name, what in (("CONTACT", ", TOTALS=ONLY"), ("BASE", ", TOTALS=ONLY"), ("EDGE", ", TOTALS=ONLY")):
        yield from (f"*NODE PRINT, NSET={name}{what}", "RF")
    yield "*END STEP"
