"""Section 4.1 of Forsbach (2023): a truncated cone indents bonded and unbonded layers of any thickness."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from cases.declare.case import Case, CaseScene
from cases.declare.task import Answers, Sampling
from cases.judgement.claims.declared import Reason
from cases.judgement.claims.exact import Exact
from cases.judgement.claims.field_agreement import FieldAgreement
from cases.judgement.claims.incremental_stiffness import IncrementalStiffness, chebyshev_radii
from cases.judgement.claims.order import Order
from cases.judgement.claims.residual import Residual
from cases.judgement.claims.scaling_law import Twin
from cases.library._compared import (
    BEM_TOLERANCE,
    EQUATION,
    EVERY,
    FINITE_ELEMENTS,
    MDR,
    PUBLISHED_ROUTE,
    QUICK_FEM,
    TABLE_TOLERANCES,
    agreements,
    with_reason,
)
from cases.library._figures import paper_figure
from cases.library._layers import (
    LAYERS,
    THICKNESS,
    contact_modulus,
    doubled_modulus,
    edges,
    half_space,
    in_millimetres,
    layer,
    other_poissons_ratio,
    prescribed_radii,
    scene_name,
)
from cases.measurements.advice.effects import AblationStudy
from cases.measurements.cost.settings import elastic_costs
from cases.results.records import Figure, Origin, SceneRun, Series
from contact import ContactRadii, Scene, TruncatedCone

SLOPE = 0.1
FLAT_FRACTION = 0.5  # b/a
RATIOS = (0.1, 1.0, 2.0, 5.0, 20.0)
HALF_SPACE_FLATS = (0.25, 0.5, 0.75, 0.9)
RINGS = (0.0, 0.4, FLAT_FRACTION, 0.6, 0.8, 1.0)

TEXT = """
A rigid cone with a flat end of radius b, f(r) = (r - b) tan(theta) for r >= b, Eq. (35), presses on a layer of
thickness h. The contact radius a is prescribed with b/a = 0.5, for an unbonded layer and bonded layers with nu = 0.3,
0.45 and 0.5, from almost a half-space (a/h = 0.1) to a thin layer (a/h = 20).

On the half-space the answer is known in closed form,
delta = a tan(theta) arccos(b/a),  F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)].

MDR, Eqs. (4) and (8), starts from flat-punch data of the layer kernel, Eqs. (29)-(31). The finite element model meshes
the section and never sees that kernel; the two share no input. Depth, force and contact stiffness must agree within
3e-6. The pressure has a logarithmic singularity at r = b, so it is compared in the 2 pi r weighted L2 norm and by the
loads of rings with an edge at r = b, never by its maximum.
"""


def cone_scene(label: str, ratio: float) -> CaseScene:
    """Return the scene at a/h = ``ratio``."""
    a = ratio * THICKNESS
    cone = TruncatedCone(flat_radius=FLAT_FRACTION * a, slope=SLOPE)
    return CaseScene(
        name=scene_name(label, ratio),
        parameters={"layer": label, "a_over_h": ratio, "b_over_a": FLAT_FRACTION},
        scene=Scene(layer=layer(label), indenter=cone, loading=ContactRadii(values=np.array([a]))),
        sampling=Sampling(ring_edges=edges(a, RINGS)),
    )


def half_space_scene(flat: float) -> CaseScene:
    """Return the scene on the half-space with b/a = ``flat``."""
    a = THICKNESS
    cone = TruncatedCone(flat_radius=flat * a, slope=SLOPE)
    return CaseScene(
        name=f"half-space b/a={flat:g}",
        parameters={"layer": "half-space", "a_over_h": 0.0, "b_over_a": flat},
        scene=Scene(layer=half_space(), indenter=cone, loading=ContactRadii(values=np.array([a]))),
    )


def path_scene(label: str, ratio: float) -> CaseScene:
    """Return the path over contact radii from 0.75 a to a, away from the kink at 0.5 a."""
    base = cone_scene(label, ratio)
    loading = ContactRadii(values=ratio * THICKNESS * chebyshev_radii(0.75, 1.0, 16))
    path = replace(base, name=f"{base.name}, path", scene=base.scene.replace(loading=loading))
    return replace(path, methods=(MDR, EQUATION) if ratio == 1.0 else (MDR,))


LAYER_SCENES = tuple(cone_scene(label, ratio) for label in LAYERS for ratio in RATIOS)
RESOLVED = tuple(s for s in LAYER_SCENES if float(s.parameters["a_over_h"]) <= 2)
THIN = tuple(s for s in LAYER_SCENES if float(s.parameters["a_over_h"]) > 2)
PATH_SCENES = tuple(path_scene(label, ratio) for label in LAYERS for ratio in (0.3, 1.0, 3.0, 10.0))
HALF_SPACE_SCENES = tuple(half_space_scene(flat) for flat in HALF_SPACE_FLATS)
ON_LAYERS = tuple(scene.name for scene in LAYER_SCENES)
ON_PATHS = tuple(scene.name for scene in PATH_SCENES)
ON_HALF_SPACE = tuple(scene.name for scene in HALF_SPACE_SCENES)

# -- Fig. 7: g(x; h) is the relation of depth and contact radius, so finite elements can draw it too ------------------

FIGURE_LAYERS = ("unbonded", "bonded nu=0.45", "bonded nu=0.5")
SYMBOL_RADII = np.array([0.65, 0.9])


def profile_scene(label: str, ratio: float) -> CaseScene:
    """Return a scene that walks the contact radius from b to a."""
    base = cone_scene(label, ratio)
    scene = base.scene.replace(loading=ContactRadii(values=ratio * THICKNESS * SYMBOL_RADII))
    return CaseScene(name=f"{base.name}, symbols", parameters=base.parameters, scene=scene, methods=(QUICK_FEM,))


FIGURE_SCENES = tuple(profile_scene(label, ratio) for label in FIGURE_LAYERS for ratio in RATIOS)


def figure_7(case: Case, answers: Answers) -> Iterator[Figure]:
    """Fig. 7 from both methods: g/f(a) over x/a and p/p_mean over r/a, one row of panels a layer."""
    symbols = (_profile_symbols, _pressure_symbols)
    yield paper_figure(7, *(own(case, answers, label) for label in FIGURE_LAYERS for own in symbols))


def _profile_symbols(case: Case, answers: Answers, label: str) -> list[Series]:
    scenes = {ratio: case.scene(f"{scene_name(label, ratio)}, symbols") for ratio in RATIOS}
    runs = {ratio: answers.of(case.task(scene, scene.methods[0])) for ratio, scene in scenes.items()}
    return [_profile(run, ratio, SYMBOL_RADII) for ratio, run in runs.items() if run.solved]


def _profile(run: SceneRun, ratio: float, radii: NDArray[np.float64]) -> Series:
    depth = np.array(run.quantity("indentation_depth").values)
    height = SLOPE * (1 - FLAT_FRACTION) * ratio * THICKNESS  # f(a)
    return Series(
        label=f"{run.method} a/h={ratio:g}",
        method=run.method,
        group=f"a/h={ratio:g}",
        x=tuple(radii.tolist()),
        y=tuple((depth / height).tolist()),
    )


def _pressure_symbols(case: Case, answers: Answers, label: str) -> list[Series]:
    series = []
    for ratio in RATIOS:
        scene = case.scene(scene_name(label, ratio))
        for use in case.methods_of(scene):
            run = answers.of(case.task(scene, use))
            series += [_pressure(run, ratio)] if run.solved and run.curves and not use.label.startswith("mdr") else []
    return series


def _pressure(run: SceneRun, ratio: float) -> Series:
    a = ratio * THICKNESS
    mean = run.quantity("normal_force").values[-1] / (np.pi * a**2)
    curve = run.curve("pressure")
    return Series(
        label=f"{run.method} a/h={ratio:g}",
        method=run.method,
        group=f"a/h={ratio:g}",
        x=tuple(r / a for r in curve.x[::3]),
        y=tuple(p / mean for p in curve.y[::3]),
    )


# -- claims ------------------------------------------------------------------------------------------------------------


def half_space_depth(scene: Scene) -> list[float]:
    """delta = a tan(theta) arccos(b/a)."""
    a, b = _radii(scene)
    return [a * SLOPE * float(np.arccos(b / a))]


def half_space_force(scene: Scene) -> list[float]:
    """F = E* a^2 tan(theta) [arccos(b/a) + (b/a) sqrt(1 - b^2/a^2)]."""
    a, b = _radii(scene)
    shape = np.arccos(b / a) + b / a * np.sqrt(1 - (b / a) ** 2)
    return [contact_modulus(scene.layer) * a**2 * SLOPE * float(shape)]


def _radii(scene: Scene) -> tuple[float, float]:
    return float(prescribed_radii(scene)[-1]), scene.indenter.flat_radius


TABULATED: dict[tuple[str, float], tuple[float, float]] = {  # delta/(a tan), F/(E* a^2 tan)
    ("bonded nu=0.5", 0.1): (0.964788, 1.481398),
    ("bonded nu=0.5", 1.0): (0.556930, 2.096970),
    ("bonded nu=0.5", 2.0): (0.440614, 3.911228),
    ("bonded nu=0.5", 5.0): (0.333939, 15.328170),
    ("bonded nu=0.45", 1.0): (0.596365, 2.007889),
    ("bonded nu=0.45", 2.0): (0.502610, 3.420101),
    ("bonded nu=0.45", 5.0): (0.454734, 9.592890),
    ("unbonded", 1.0): (0.684694, 1.755223),
    ("unbonded", 2.0): (0.592168, 2.498001),
    ("unbonded", 5.0): (0.535528, 5.162418),
}


def tabulated_depths() -> dict[str, tuple[float, ...]]:
    """Return the tabulated depths [m] by scene."""
    return {scene_name(*key): (row[0] * key[1] * THICKNESS * SLOPE,) for key, row in TABULATED.items()}


def tabulated_forces() -> dict[str, tuple[float, ...]]:
    """Return the tabulated forces [N] by scene."""
    return {
        scene_name(label, ratio): (row[1] * contact_modulus(layer(label)) * (ratio * THICKNESS) ** 2 * SLOPE,)
        for (label, ratio), row in TABULATED.items()
    }


SNEDDON = Reason(
    because="linear elasticity on the half-space, solved by Sneddon",
    derived_from="MDR: quadrature to 1e-12 with two digits to spare; FEM: what it states, 1e-6, three times; boundary "
    "elements three times what they state beside a rim, 1e-3",
    origin=Origin.CLOSED_FORM,
    source="Popov, Hess, Willert: Handbook of Contact Mechanics (2019), truncated cone",
)
DIRECT_SOLUTION = Reason(
    because="the same Fredholm equation, solved radius by radius for the profile instead of factorised",
    derived_from="half a unit of the sixth decimal over the smallest value, 0.33; FEM adds what it states, 1e-6, three "
    "times; boundary elements and table what they state up to a/h = 5, 2e-3 and 1e-2",
    origin=Origin.INDEPENDENT_METHOD,
    source="direct Nystrom solution with the rule split at r = b, twelve digits stable over the node count",
)
FINITE_ELEMENT_FIELDS = with_reason(
    FINITE_ELEMENTS,
    "the logarithmic singularity at r = b and the root at r = a limit finite elements to about 2e-5, ten times",
)
COARSE_TABLE = with_reason(
    PUBLISHED_ROUTE,
    "three times what it states at a/h = 20, where a cell is a third of the thickness: depth 1e-2, force 3.5e-2, "
    "stiffness 5e-3",
)
THIN_TABLE = {"indentation_depth": 3e-2, "normal_force": 1e-1, "contact_stiffness": 1.5e-2}
LINEARITY = Reason(
    because="the layer is linear elastic and the indenter rigid",
    derived_from="round-off; the modulus only scales the answer",
    origin=Origin.CLOSED_FORM,
    source="linearity",
)
DIMENSIONS = Reason(
    because="mechanics knows no metre",
    derived_from="round-off of a factor that is no power of two, magnified where meshes are made; what iterations "
    "leave, 1e-7",
    origin=Origin.CLOSED_FORM,
    source="dimensional analysis",
)
UNBONDED_KERNEL = Reason(
    because="at given E* the kernel of the unbonded layer has no nu",
    derived_from="MDR: the same equation; FEM: another problem with another nu, three times what it states, 1e-6",
    origin=Origin.CLOSED_FORM,
    source="Eq. (29)",
)
ONE_OF_EACH = tuple(scene_name(label, 1.0) for label in LAYERS)

EXACT = (
    Exact(
        name="half-space depth",
        quantity="indentation_depth",
        scenes=ON_HALF_SPACE,
        expected=half_space_depth,
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 3e-3},
        reason=SNEDDON,
    ),
    Exact(
        name="half-space force",
        quantity="normal_force",
        scenes=ON_HALF_SPACE,
        expected=half_space_force,
        tolerance=1e-10,
        tolerances={"fem": 3e-6, "bem": 3e-3},
        reason=SNEDDON,
    ),
    Exact(
        name="layer depth",
        quantity="indentation_depth",
        expected=tabulated_depths(),
        tolerance=1.6e-6,
        tolerances={"fem": 5e-6, "bem": 2e-3, "mdr_table": 1e-2},
        reason=DIRECT_SOLUTION,
    ),
    Exact(
        name="layer force",
        quantity="normal_force",
        expected=tabulated_forces(),
        tolerance=1.6e-6,
        tolerances={"fem": 5e-6, "bem": 2e-3, "mdr_table": 1e-2},
        reason=DIRECT_SOLUTION,
    ),
)

AGREEMENTS = (
    *agreements(LAYER_SCENES, {"fem": 3e-6, "bem": BEM_TOLERANCE, "integral_equation": 1e-9}),
    *agreements(RESOLVED, {"mdr_table": TABLE_TOLERANCES}),
    *agreements(THIN, {"mdr_table": THIN_TABLE}, reason=COARSE_TABLE, suffix=", thin layers"),
    FieldAgreement(
        name="pressure agrees",
        quantity="pressure",
        norm="weighted L2",
        scenes=ON_LAYERS,
        fast="mdr",
        reference="fem",
        refined=("mdr",),
        tolerance=2e-4,
        reason=FINITE_ELEMENT_FIELDS,
    ),
    FieldAgreement(
        name="ring loads agree",
        quantity="pressure",
        norm="ring loads",
        scenes=ON_LAYERS,
        fast="mdr",
        reference="fem",
        refined=("mdr",),
        tolerance=2e-4,
        reason=FINITE_ELEMENT_FIELDS,
    ),
)
ENERGY = Reason(
    because="twice the stored energy is force times depth, whether summed over cells or over reactions",
    derived_from="the residual that linear solves are held to; rounding alone gives 1e-12",
    origin=Origin.CLOSED_FORM,
    source="Clapeyron's theorem",
)
SPRING_STIFFNESS = Reason(
    because="the springs of MDR are the derivative of flat-punch stiffness, so dF = k_N d(delta) for every profile",
    derived_from="round-off of twelve digits, magnified a hundredfold by differentiating over 16 radii",
    origin=Origin.CLOSED_FORM,
    source="Eq. (10): c_bar = d(xi k_bar)/dxi",
)
PATCH = Reason(
    because="a constant strain leaves every inner node of any mesh in equilibrium",
    derived_from="rounding of the assembly",
    origin=Origin.CLOSED_FORM,
    source="Taylor, Simo, Zienkiewicz, Chan (1986), form A",
)

INVARIANTS = (
    IncrementalStiffness(
        name="dF/d(delta) is the stiffness of the flat punch",
        quantity="contact_stiffness",
        scenes=ON_PATHS,
        tolerance=1e-9,
        reason=SPRING_STIFFNESS,
    ),
    Residual(
        name="energy stiffness equals reaction stiffness",
        quantity="energy_defect",
        scenes=(*ON_LAYERS, *ON_HALF_SPACE),
        methods=("fem",),
        tolerance=1e-8,
        reason=ENERGY,
    ),
    Residual(
        name="patch test",
        quantity="patch_defect",
        scenes=(*ON_LAYERS, *ON_HALF_SPACE),
        methods=("fem",),
        tolerance=1e-12,
        reason=PATCH,
    ),
    Twin(
        name="doubling E doubles F",
        quantity="normal_force",
        scenes=ONE_OF_EACH,
        change=doubled_modulus,
        factors={"indentation_depth": 1.0, "normal_force": 2.0, "contact_stiffness": 2.0},
        tolerance=1e-12,
        reason=LINEARITY,
    ),
    Twin(
        name="the unit system does not matter",
        quantity="normal_force",
        scenes=ONE_OF_EACH,
        change=in_millimetres,
        factors={"indentation_depth": 1e3, "normal_force": 1.0, "contact_stiffness": 1e-3},
        tolerance=1e-9,
        tolerances={"bem": 1e-7},
        reason=DIMENSIONS,
    ),
    Twin(
        name="unbonded layers do not see nu",
        quantity="normal_force",
        scenes=tuple(scene_name("unbonded", ratio) for ratio in (1.0, 5.0)),
        change=other_poissons_ratio,
        factors={"indentation_depth": 1.0, "normal_force": 1.0, "contact_stiffness": 1.0},
        tolerance=1e-12,
        tolerances={"fem": 3e-6, "bem": 1e-7},
        reason=UNBONDED_KERNEL,
    ),
)

EDGE_CELL = Reason(
    because="the root of the pressure is not resolved inside the cell at the contact edge, which acts like a contact "
    "smaller by a fraction of that cell",
    derived_from="accepted band [p_f - 0.2, p_f + 0.5]",
    origin=Origin.CLOSED_FORM,
    source="interpolation of (a - r)^(1/2) on one cell",
)
GAUSS_PANELS = Reason(
    because="the kernel of the integral equation is analytic, so Gauss panels converge exponentially",
    derived_from="four nodes more on panels as wide as the layer shrink the error at least tenfold",
    origin=Origin.CLOSED_FORM,
    source="kernel analytic within 2 h of the real axis; errors against 24 nodes",
)

ORDERS = (
    Order(
        name="finite elements: first order in the edge cell",
        quantity="normal_force",
        scenes=(scene_name("bonded nu=0.5", 1.0), scene_name("unbonded", 1.0)),
        method="fem",
        ladder=tuple(
            {"order": 3, "growth": 0.35, "edge_cell": 0.1 / 2**level, "truncation": 1e-7} for level in range(4)
        ),
        formal_order=1.0,
        mesh_family="cell at the contact edge halved, the rest fixed",
        tolerance=0.2,
        reason=EDGE_CELL,
    ),
    Order(
        name="MDR: exponential in the Gauss nodes",
        quantity="normal_force",
        scenes=(scene_name("bonded nu=0.5", 5.0), scene_name("unbonded", 5.0)),
        method="mdr",
        ladder=tuple({"nodes": nodes} for nodes in (8, 12, 16, 24)),
        least_digits=1.0,
        mesh_family="Gauss nodes on panels as wide as the layer",
        floor=1e-13,
        tolerance=1.0,
        reason=GAUSS_PANELS,
    ),
)

CASE = Case(
    name="truncated_cone",
    title="Indentation by a truncated cone",
    question="Do MDR and finite elements agree on a profile with a kink, from the half-space to the thin layer?",
    equations=("Eq. (4)", "Eq. (8)", "Eq. (9)", "Eq. (35)", "Fig. 7"),
    text=TEXT.strip(),
    suites=("ci", "nightly"),
    scenes=(*LAYER_SCENES, *PATH_SCENES, *HALF_SPACE_SCENES, *FIGURE_SCENES),
    methods=EVERY,
    claims=(*EXACT, *AGREEMENTS, *INVARIANTS, *ORDERS),
    ablations=(AblationStudy(scene=scene_name("bonded nu=0.45", 2.0), nightly=("fem",)),),
    work=elastic_costs(scene_name("bonded nu=0.45", 2.0), in_ci=True),
    figures=(figure_7,),
)
