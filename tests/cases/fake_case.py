"""A case solved by fabricated methods; its expected numbers are Hertz's closed form."""

import dataclasses

import numpy as np

from cases.declare.case import Case, CaseScene
from cases.declare.methods import MethodUse
from cases.declare.task import Sampling
from cases.judgement.claims.agreement import Agreement
from cases.judgement.claims.changed_scenes import ScalingLaw
from cases.judgement.claims.declared import Reason
from cases.judgement.claims.exact import Exact
from cases.judgement.claims.field_agreement import FieldAgreement
from cases.judgement.claims.order import Order
from cases.measurements.cost.work_precision import WorkStudy
from cases.results.records.claim import Origin
from cases.results.records.figure import Figure, Panel, Series
from contact import ContactRadii, Layer, Paraboloid, Scene

RADII = (0.5e-3, 1e-3)
REASON = Reason(because="half-space", derived_from="round-off", origin=Origin.CLOSED_FORM, source="Hertz")
STATED = {"reason": REASON}


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


def figure(case, answers):
    runs = [answers.of(case.task(case.scenes[0], case.use(case.scenes[0], label))) for label in ("fast", "slow")]
    series = [
        Series(label=run.method, method=run.method, group="", x=RADII, y=run.quantity("normal_force").values)
        for run in runs
        if run.solved
    ]
    panel = Panel(title="force", x_label="$a$ [m]", y_label="$F$ [N]", series=tuple(series))
    yield Figure(name="force", title="force", caption="both methods", panels=(panel,))


def fake_case(*, fast=FAST, slow=SLOW, name="fake_hertz", ladder=None, work=False):
    ladder = ladder or {"cell": 0.1}
    force = {"quantity": "normal_force", **STATED}
    pressure = {"quantity": "pressure", "tolerance": 1e-5, "fast": "fast", "reference": "slow", **STATED}
    steps = tuple({**ladder, "cell": ladder["cell"] / 2**level} for level in range(4))
    grids = {"ladder": steps, "formal_order": 1.0, "mesh_family": "uniform", "tolerance": 0.2}
    twin = {"change": double_modulus, "factors": {"normal_force": 2.0}, "tolerance": 1e-12}
    claims = (
        Exact(name="closed form", methods=("fast",), expected=hertz_force, tolerance=1e-10, **force),
        Agreement(name="force agrees", fast="fast", reference="slow", tolerance=1e-5, **force),
        FieldAgreement(name="pressure agrees", norm="weighted L2", **pressure),
        FieldAgreement(name="ring loads agree", norm="ring loads", **pressure),
        Order(name="first order", method="slow", **grids, **force),
        ScalingLaw(name="doubling E doubles F", **twin, **force),
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
        claims=claims,
        work=(cost_study(),) if work else (),
        figures=(figure,),
    )


def cost_study():
    ladder = tuple(MethodUse(label=f"cell {cell}", method="fake", settings={"cell": cell}) for cell in (1e-2, 1e-4))
    reference = MethodUse(label="reference", method="fake", settings={"stated": 1e-12})
    return WorkStudy(
        scene="half-space nu=0.3",
        quantity="normal_force",
        ladder=ladder,
        reference=reference,
        fast_method="fake",
        baseline_method="fake",
    )


def spoiled(method_use, **settings):
    return dataclasses.replace(method_use, settings={**method_use.settings, **settings})


def all_finite(case_result):
    return all(np.isfinite(q.values).all() for run in case_result.runs for q in run.quantities)
