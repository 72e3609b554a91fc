"""Pyramids, ellipses and square punches.

Question: What is a contact that is nearly round, and how wrong is the equivalent cone?
Source: Hertz 1882; Popov 2022.

Contacts that are nearly round: ellipses, squares and pyramids, by the expansion of MDR and by cells of any outline. MDR
expands about the mean profile: the outline to first order in the deviation from a circle, force and stiffness to second
order. Boundary elements press cells and assume no circle; only the layer kernel is shared. Hertz' ellipse and the
elliptic punch are known in closed form, the square punch by its capacity, and elliptic punches on thin incompressible
layers by Poisson's equation. Microscopes replace a pyramid by the cone of equal cross-sections: cells and MDR say what
that costs. The cone is solved by finite elements as well, so that the kernel is checked independently.
"""

import numpy as np
from scipy.optimize import brentq
from scipy.special import ellipe, ellipk

from cases.case import CaseScene
from cases.declare.methods import MethodUse
from cases.library import _common as c
from contact import EllipticParaboloid, EllipticPunch, IndentationDepths, Layer, PolygonalPunch, Profile, Pyramid

WHY = c.reasons("nearly_round")
BEM = MethodUse(label="bem", settings={"points": 128})
DEPTH = 0.02 * c.THICKNESS
TIP = EllipticParaboloid(first_radius=10 * c.THICKNESS, second_radius=12 * c.THICKNESS)
PUNCH = EllipticPunch(first_half_axis=1.1 * c.THICKNESS, second_half_axis=0.9 * c.THICKNESS)
SQUARE = PolygonalPunch(inscribed_radius=c.THICKNESS)
PYRAMID, CONE = Pyramid(slope=0.05), Pyramid(slope=0.05).substitute
LABELS = ("bonded nu=0.3", "bonded nu=0.5")
SQUEEZED = c.layer("bonded nu=0.5")


def pressed(name: str, body: Layer, indenter: Profile, depth: float = DEPTH, *methods: MethodUse) -> CaseScene:
    """Return an indenter at a depth [m]."""
    return c.scene(name, body, indenter, IndentationDepths([depth]), methods=methods or (c.MDR, BEM), steep=True)


def on_layers(name: str, tip: Profile, *methods: MethodUse) -> tuple[CaseScene, ...]:
    """Return a tip at two depths on two layers."""
    return tuple(
        pressed(f"{name}, {label}, depth={depth:g} h", c.layer(label), tip, depth * c.THICKNESS, *methods)
        for label in LABELS
        for depth in (0.02, 0.05)
    )


def hertz(scene: c.AnyScene) -> float:
    """F = 2 pi E* a depth/(3 K) with A a^2 = depth (K - E)/(m K), B/A = [E/q^2 - K]/(K - E), q = b/a, m = 1 - q^2."""
    depth, tip = float(scene.loading.values[0]), TIP

    def mismatch(q: float) -> float:
        K, E = ellipk(1 - q * q), ellipe(1 - q * q)
        return float((E / q**2 - K) / (K - E) - tip.second_radius / tip.first_radius)

    m = 1 - brentq(mismatch, 0.1, 1 - 1e-9) ** 2
    a = np.sqrt(depth * (ellipk(m) - ellipe(m)) / (m * ellipk(m)) * 2 * tip.second_radius)
    return float(c.contact_modulus(scene.layer) * 2 * np.pi * a * depth / (3 * ellipk(m)))


def stiffness(scene: c.AnyScene) -> float:
    """k_N = pi E* A/K(e) on the half-space, (pi E/(4 h^3)) A^3 B^3/(A^2 + B^2) on a thin incompressible layer.

    A square of side s has k_N = pi E* C, with the capacity C = 0.36679 s.
    """
    if isinstance(scene.indenter, PolygonalPunch):
        return float(np.pi * 0.73358 * c.contact_modulus(scene.layer) * scene.indenter.inscribed_radius)
    A, B = PUNCH.first_half_axis, PUNCH.second_half_axis
    if scene.layer.is_half_space:
        return float(np.pi * c.contact_modulus(scene.layer) * A / ellipk(1 - (B / A) ** 2))
    squeezed = (A * B) ** 3 / (A * A + B * B)
    return float(np.pi * scene.layer.youngs_modulus / (4 * scene.layer.thickness**3) * squeezed)


def on_cone(scene: c.AnyScene) -> c.AnyScene:
    """Return the scene with the equivalent cone."""
    return scene.replace(indenter=CONE)


ELLIPSE = pressed("elliptic paraboloid, half-space", c.half_space(), TIP)
PUNCHES = pressed("elliptic punch, half-space", c.half_space(), PUNCH)
SQUARES = pressed("square punch, half-space", c.half_space(), SQUARE)
LAYERS = tuple(pressed(f"square punch, {label}", c.layer(label), SQUARE) for label in LABELS)
PYRAMIDS, CONES = on_layers("pyramid", PYRAMID), on_layers("equivalent cone", CONE, c.MDR, c.QUICK_FEM)
SLENDER = tuple(
    pressed(f"elliptic punch a/h={ratio:g}", SQUEEZED.replace(thickness=c.THICKNESS / ratio), PUNCH, 1e-6, c.MDR)
    for ratio in (75.0, 150.0)
)
STIFFNESS = "contact_stiffness"
BY_MDR: c.Words = {"tolerance": 1e-12, "methods": ("mdr",)}
CLAIMS = (
    c.equal("force on an ellipse", "normal_force", hertz, [ELLIPSE], WHY["Hertz"], tolerance=1e-4, bem=1e-3),
    c.equal("stiffness", STIFFNESS, stiffness, [PUNCHES], WHY["elliptic punch"], tolerance=1e-4, bem=1e-3),
    c.equal("square punch", STIFFNESS, stiffness, [SQUARES], WHY["capacity"], tolerance=3e-3),
    *c.agreements((*LAYERS, *PYRAMIDS), {"bem": 5e-2}, c.PATH[1:], why=WHY["cells"]),
    *c.agreements(CONES, {"fem": 3e-4}, ("normal_force",), derived_from=WHY["cone"].tolerance),
    c.bound("a pyramid is stiffer than its cone", "normal_force", PYRAMIDS, on_cone, WHY["cone"], **BY_MDR),
    c.approach("thin layer", STIFFNESS, SLENDER, stiffness, WHY["squeezed"], largest=0.1),
)
CASE = c.paper(
    __name__,
    __doc__,
    (ELLIPSE, PUNCHES, SQUARES, *LAYERS, *PYRAMIDS, *CONES, *SLENDER),
    (c.MDR, c.QUICK_FEM, BEM),
    CLAIMS,
)
