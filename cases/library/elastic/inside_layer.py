"""The layer inside: displacement, stress, hydrostatic pressure and its gradient by two methods without common code.

Under a paraboloid and a truncated cone, on bonded layers with nu = 0.3, 0.45 and 0.5 and on an unbonded one, MDR makes
the fields inside from the density of its pressure, closed forms of the half-space and an integral over wavenumbers;
finite elements recover them from their own solution. At twelve points away from rims they agree: displacements in
the fifth digit of the depth, stresses in the third of the mean pressure, and the hydrostatic pressure at nu = 1/2 as
well as at 0.3, where it no longer follows from the strain. Each answer also obeys the laws of elastic bodies: the force
passes every depth, volume changes with the pressure, the gradient adds up to the pressure, the base holds, and just
below the surface the pressure of the contact comes back. In a thin incompressible layer the pressure reaches from top
to base as in a lubricating film: 3 G a^4/(32 R h^3) in the middle.
"""

import numpy as np

from cases.declare.case import Case, CaseScene, text_of
from cases.declare.methods import MethodUse
from cases.declare.task import Sampling
from cases.judgement.claims.approach import Approach
from cases.judgement.claims.field_agreement import FieldAgreement, Norm
from cases.judgement.claims.residual import Residual
from cases.library._layers import LAYERS, THICKNESS, layer, scene_name
from cases.library._methods import MDR
from cases.library._reasons import reasons
from contact import ContactRadii, Paraboloid, Profile, Scene, TruncatedCone

WHY = reasons("inside_layer")

RADIUS_OF_CURVATURE = 1e-2  # m
SLOPE = 0.1
RATIOS = (0.5, 1.0, 5.0)
THIN_RATIOS = (25.0, 50.0)
# r over the contact radius and z over the smaller of contact radius and thickness; the last is in the middle.
POINTS = (*((r, z) for r in (0.0, 0.3, 0.8, 1.25) for z in (0.3, 0.6, 1.0)), (0.0, 0.5))
# Finite elements solve these in the suite ci, all in the nightly one.
QUICK = ("paraboloid, bonded nu=0.5 a/h=1",)
# The laws of a body take many points where a layer is thin: one scene of each profile is enough for the suite ci.
SLOW = tuple(
    f"{kind}, {label} a/h=5"
    for kind in ("paraboloid", "truncated cone")
    for label in LAYERS
    if label != "bonded nu=0.5"
)
MESH = MethodUse(label="fem", settings={"growth": 0.18, "truncation": 1e-10})


def pressed(kind: str, label: str, ratio: float) -> CaseScene:
    """Return a profile pressed to a contact radius of ``ratio`` h."""
    a = ratio * THICKNESS
    profile: Profile = Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE)
    if kind == "truncated cone":
        profile = TruncatedCone(flat_radius=a / 2, slope=SLOPE)
    name = f"{kind}, {scene_name(label, ratio)}"
    return CaseScene(
        name=name,
        parameters={"profile": kind, "layer": label, "a_over_h": ratio},
        scene=Scene(layer=layer(label), indenter=profile, loading=ContactRadii(values=np.array([a]))),
        sampling=Sampling(inside=POINTS),
        nightly=() if name in QUICK else ("mdr", "fem") if name in SLOW else ("fem",),
    )


COMPARED = tuple(
    pressed(kind, label, ratio) for kind in ("paraboloid", "truncated cone") for label in LAYERS for ratio in RATIOS
)
THIN = tuple(
    CaseScene(
        name=pressed("paraboloid", "bonded nu=0.5", ratio).name,
        parameters={"profile": "paraboloid", "layer": "bonded nu=0.5", "a_over_h": ratio},
        scene=pressed("paraboloid", "bonded nu=0.5", ratio).scene,
        sampling=Sampling(inside=((0.0, 0.5),), laws=False),
        methods=(MDR,),
    )
    for ratio in THIN_RATIOS
)


def film_pressure(scene: Scene) -> float:
    """-3 G a^4/(32 R h^3): Reynolds' equation between a slipping and a sticking wall, G = E/3."""
    a, h = float(scene.loading.values[0]), scene.layer.thickness  # type: ignore[attr-defined]
    return -scene.layer.youngs_modulus * a**4 / (32 * RADIUS_OF_CURVATURE * h**3)


def thinness(scene: Scene) -> float:
    """h/a."""
    return scene.layer.thickness / float(scene.loading.values[0])  # type: ignore[attr-defined]


FIELDS: dict[str, tuple[Norm, float]] = {
    "displacement_inside": ("largest", 1e-5),
    "stress_inside": ("largest", 1e-3),
    "pressure_inside": ("root mean square", 1e-3),
    "gradient_inside": ("root mean square", 2e-2),
}
LAWS = {
    "the force passes every depth": ("force_balance_inside", 1e-4),
    "volume changes with the pressure": ("dilatation_inside", 1e-5),
    "the gradient adds up to the pressure": ("gradient_law_inside", 1e-4),
    "the base holds": ("base_inside", 1e-4),
    "the pressure comes back below the surface": ("surface_inside", 1e-3),
}

CASE = Case(
    name="inside_layer",
    title="Inside the layer",
    question="Do two methods agree on displacement, stress and pressure inside, and do both obey the laws?",
    equations=("Eq. (9)", "Eq. (14)"),
    text=text_of(__doc__),
    scenes=(*COMPARED, *THIN),
    methods=(MDR, MESH),
    claims=(
        *(
            FieldAgreement(
                name=f"{quantity.replace('_', ' ')}: MDR and fem",
                quantity=quantity,
                scenes=tuple(scene.name for scene in COMPARED),
                norm=norm,
                fast="mdr",
                reference="fem",
                tolerance=tolerance,
                reason=WHY["two methods"],
            )
            for quantity, (norm, tolerance) in FIELDS.items()
        ),
        *(
            Residual(
                name=name,
                quantity=quantity,
                scenes=tuple(scene.name for scene in COMPARED),
                tolerance=2e-10,
                tolerances={"fem": tolerance},
                reason=WHY["laws"],
            )
            for name, (quantity, tolerance) in LAWS.items()
        ),
        Approach(
            name="thin limit of the pressure inside",
            quantity="axial_stress_inside",
            scenes=tuple(scene.name for scene in THIN),
            methods=("mdr",),
            parameter=thinness,
            limit=film_pressure,
            largest=0.15,
            reason=WHY["film"],
        ),
    ),
)
