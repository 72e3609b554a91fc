"""A case solved by fabricated methods; its expected numbers are Hertz's closed form."""

import dataclasses

from cases.case import Case, CaseScene, Sampling
from cases.claims import Agree, Equal, Law
from cases.convergence import Order
from cases.cost import Cost
from cases.declare.methods import MethodUse
from cases.verdicts import Origin, Why
from contact import ContactRadii, Layer, Paraboloid, Scene

RADII = (0.5e-3, 1e-3)
WHY = Why(Origin.CLOSED_FORM, "Hertz", "half-space", "round-off")
STATED = {"why": WHY}


def hertz_force(scene):
    a = scene.loading.values
    return 4 / 3 * scene.layer.contact_modulus * a**3 / scene.indenter.radius_of_curvature


def double_modulus(scene):
    layer = scene.layer.replace(youngs_modulus=2 * scene.layer.youngs_modulus)
    return scene.replace(layer=layer)


def scene_of(poissons_ratio):
    return Scene(
        layer=Layer.half_space(youngs_modulus=1e6, poissons_ratio=poissons_ratio),
        indenter=Paraboloid(radius_of_curvature=0.01),
        loading=ContactRadii(RADII),
    )


def case_scene(poissons_ratio):
    return CaseScene(
        name=f"half-space nu={poissons_ratio}",
        parameters={"poissons_ratio": poissons_ratio},
        scene=scene_of(poissons_ratio),
        sampling=Sampling(ring_edges=(0.0, 0.5e-3, 1e-3)),
    )


def use(label, **settings):
    return MethodUse(label=label, method="fake", settings=settings)


FAST = use("fast", stated=1e-12)
SLOW = use("slow", cell=1e-6, stated=2e-6)


def fake_case(*, fast=FAST, slow=SLOW, name="fake_hertz", ladder=None, work=False):
    ladder = ladder or {"cell": 0.1}
    force = {"quantity": "normal_force", **STATED}
    pressure = {"quantity": "pressure", "tolerance": 1e-5, "fast": "fast", "reference": "slow", **STATED}
    steps = tuple({**ladder, "cell": ladder["cell"] / 2**level} for level in range(4))
    grids = {"ladder": steps, "formal_order": 1.0, "mesh_family": "uniform", "tolerance": 0.2}
    twin = {"change": double_modulus, "factors": {"normal_force": 2.0}, "tolerance": 1e-12}
    claims = (
        Equal(name="closed form", methods=("fast",), to=hertz_force, tolerance=1e-10, **force),
        Agree(name="force agrees", fast="fast", reference="slow", tolerance=1e-5, **force),
        Agree(name="pressure agrees", norm="weighted L2", **pressure),
        Agree(name="ring loads agree", norm="ring loads", **pressure),
        Order(name="first order", method="slow", **grids, **force),
        Law(name="doubling E doubles F", **twin, **force),
    )
    return Case(
        name=name,
        title="Fabricated Hertz contact",
        question="Does the engine judge what it says it judges?",
        equations=("Hertz",),
        text="Fabricated.",
        suites=("ci",),
        scenes=(case_scene(0.3), case_scene(0.5)),
        methods=(fast, slow),
        claims=(*claims, cost_study()) if work else claims,
    )


def cost_study():
    ladder = tuple(MethodUse(label=f"cell {cell}", method="fake", settings={"cell": cell}) for cell in (1e-2, 1e-4))
    reference = MethodUse(label="reference", method="fake", settings={"stated": 1e-12})
    return Cost(name="cost", scene="half-space nu=0.3", quantity="normal_force", ladder=ladder, reference=reference)


def spoiled(method_use, **settings):
    return dataclasses.replace(method_use, settings={**method_use.settings, **settings})
