"""A paraboloid is pressed into a relaxing layer at constant speed and held: a prescribed history of the depth.

On an incompressible half-space the contact grows and then rests, so that the theory of Lee and Radok gives the force,
F = (16/3) sqrt(R) int G(t - s) d(delta^(3/2)), and under a force that rises and is held the depth,
delta^(3/2) = 3/(16 sqrt(R)) int J(t - s) dF with the compliance J that belongs to G. On a bonded layer MDR, in which
every spring relaxes by itself, is compared with finite elements, which solve a contact problem at every step. Compared
are force and depth at the end. Every relaxation function is pressed and loaded, by a ramp and by a jump at the first
instant; under a jump of the depth the force on a dashpot is infinite, and finite elements refuse it. The standard solid
is that of the impacts of Section 4.3. Where half of the force is taken away again MDR steps in time, and its depths
converge. The same history on an elastic layer has no error in time: it shows that of the cells alone.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import expm

from cases.case import Case, CaseScene, text_of
from cases.library._claims import agreements, exact
from cases.library._convergence import CELLS_AND_STEPS, FINEST_MDR, RECEDING_ACCURACY, studies
from cases.library._methods import MDR
from cases.library._reasons import reasons
from cases.library.in_time.sphere_impact import (
    FEM,
    LONG_TERM_MODULUS,
    MAXWELL_MODULUS,
    RADIUS_OF_CURVATURE,
    RELAXATION_TIME,
)
from contact import (
    DepthHistory,
    ForceHistory,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
    Viscoelasticity,
)

WHY = reasons("held_indentation")

DEPTH = 5e-5  # m
FORCE = 2.0  # N
# Pressing [s] takes as long as the solid takes to relax.
RAMP = 1e-3
END = 2 * RAMP
THICKNESS = 1e-3  # m
INSTANTANEOUS = LONG_TERM_MODULUS + MAXWELL_MODULUS
BRANCH_TIMES = (RELAXATION_TIME / 5, RELAXATION_TIME)  # of the Prony series
SOLID = StandardSolid(
    long_term_shear_modulus=LONG_TERM_MODULUS,
    maxwell_shear_modulus=MAXWELL_MODULUS,
    viscosity=MAXWELL_MODULUS * RELAXATION_TIME,
)
RELAXING = {
    "": SOLID,
    ", Kelvin-Voigt": KelvinVoigt(shear_modulus=LONG_TERM_MODULUS, viscosity=LONG_TERM_MODULUS * RELAXATION_TIME),
    ", Prony series": PronySeries(
        long_term_shear_modulus=LONG_TERM_MODULUS,
        shear_moduli=[MAXWELL_MODULUS / 2, MAXWELL_MODULUS / 2],
        relaxation_times=list(BRANCH_TIMES),
    ),
}

TIME = np.array([0.0, RAMP, END])
RISES, AT_ONCE = np.array([0.0, 1.0, 1.0]), np.ones(3)
PRESSED = DepthHistory(time=TIME, depth=DEPTH * RISES)
EASED = ForceHistory(time=TIME, force=np.array([0.0, FORCE, FORCE / 2]))
BEGINNINGS = {"": RISES, " at once": AT_ONCE}


def case_scene(
    name: str, body: str, effect: Viscoelasticity | None, loading: DepthHistory | ForceHistory = PRESSED
) -> CaseScene:
    """Return the history on a body, "half-space" or "bonded layer"."""
    modulus = LONG_TERM_MODULUS if isinstance(effect, KelvinVoigt) else INSTANTANEOUS
    scene = Scene(
        layer=Layer.incompressible(thickness=THICKNESS if body == "bonded layer" else np.inf, shear_modulus=modulus),
        indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
        loading=loading,
        effects=() if effect is None else (effect,),
    )
    return CaseScene(name=name, parameters={"layer": name}, scene=scene)


def under_dashpot(scene: CaseScene) -> bool:
    """Return whether the layer is of Kelvin-Voigt."""
    return isinstance(scene.scene.effects[0], KelvinVoigt)


def histories(verb: str, body: str) -> tuple[CaseScene, ...]:
    """Return the scenes of every relaxation function, by a ramp and at once: "relaxing" by depth, "creeping" by force.

    Finite elements search the depth of every force: nightly, but under Kelvin-Voigt, whose depth begins at zero.
    """
    scenes = []
    for begins, share in BEGINNINGS.items():
        loading = (
            DepthHistory(time=TIME, depth=DEPTH * share)
            if verb == "relaxing"
            else ForceHistory(time=TIME, force=FORCE * share)
        )
        for relaxes, effect in RELAXING.items():
            scene = case_scene(f"{verb} {body}{begins}{relaxes}", body, effect, loading)
            dashpot = under_dashpot(scene)
            infinite = dashpot and verb == "relaxing" and share is AT_ONCE
            usual = verb == "relaxing" and not begins and not relaxes
            nightly = () if dashpot or usual else ("fem",)
            scenes.append(replace(scene, methods=(MDR,) if infinite else (), nightly=nightly))
    return tuple(scenes)


RELAXING_HALF_SPACES, RELAXING_LAYERS = histories("relaxing", "half-space"), histories("relaxing", "bonded layer")
CREEPING_HALF_SPACES, CREEPING_LAYERS = histories("creeping", "half-space"), histories("creeping", "bonded layer")
ELASTIC = case_scene("elastic bonded layer", "bonded layer", None)
EASED_SCENES = tuple(
    replace(case_scene(f"eased {body}", body, SOLID, EASED), methods=(MDR,), nightly=("mdr",))
    for body in ("half-space", "bonded layer")
)


def moduli_and_times(scene: Scene) -> tuple[list[float], list[float]]:
    """Return the moduli [Pa] and times [s] of the Maxwell branches of a scene; none beside a dashpot."""
    (effect,) = scene.effects
    if isinstance(effect, KelvinVoigt):
        return [], []
    if isinstance(effect, PronySeries):
        return [MAXWELL_MODULUS / 2] * 2, list(BRANCH_TIMES)
    return [MAXWELL_MODULUS], [RELAXATION_TIME]


def relaxation(scene: Scene, time: float) -> float:
    """G(t) = G_inf + sum_j G_j exp(-t/tau_j) [Pa]; the dashpot adds nothing while the depth rests."""
    return float(
        LONG_TERM_MODULUS + sum(G * np.exp(-time / tau) for G, tau in zip(*moduli_and_times(scene), strict=True))
    )


def compliance(scene: Scene, time: float) -> float:
    """J(t) [1/Pa]: (1 - exp(-t/tau))/G of Kelvin-Voigt, else by the matrix exponential.

    Under unit stress G_0 J' = sum_j G_j q_j/tau_j, and the branches stretch by q_j' = J' - q_j/tau_j.
    """
    moduli, times = (np.array(values) for values in moduli_and_times(scene))
    if not times.size:
        return float(-np.expm1(-time / RELAXATION_TIME) / LONG_TERM_MODULUS)
    rates = np.zeros((times.size + 1, times.size + 1))
    rates[:, 1:] = moduli / times / INSTANTANEOUS
    rates[1:, 1:] -= np.diag(1 / times)
    return float(expm(rates * time)[0].sum() / INSTANTANEOUS)


def hereditary(kernel: Callable[[Scene, float], float], scene: Scene, power: float) -> float:
    """int K(END - s) d(x^power) at the end, x rising from 0 to 1 by the ramp, or 1 from the first instant on.

    With s = RAMP u^2 the integrand is smooth up to the start: d(x^power) = 2 power u^(2 power - 1) du.
    """
    loading = scene.loading
    assert isinstance(loading, DepthHistory | ForceHistory)
    if (loading.depth if isinstance(loading, DepthHistory) else loading.force)[0] > 0.0:
        return kernel(scene, END)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, weights = (nodes + 1) / 2, weights / 2
    kernels = np.array([kernel(scene, END - RAMP * share**2) for share in u])
    return float(kernels @ (weights * 2 * power * u ** (2 * power - 1)))


def lee_and_radok(scene: Scene) -> list[float]:
    """F [N] at the end."""
    modulus = hereditary(relaxation, scene, 1.5)
    return [16 / 3 * math.sqrt(RADIUS_OF_CURVATURE) * modulus * DEPTH**1.5]


def creep(scene: Scene) -> list[float]:
    """delta [m] at the end."""
    crept = FORCE * hereditary(compliance, scene, 1.0)
    return [float((3 / 16 * crept / math.sqrt(RADIUS_OF_CURVATURE)) ** (2 / 3))]


ORDERS = (
    *studies(EASED_SCENES, RECEDING_ACCURACY, ("indentation_depth",), against=FINEST_MDR, nightly=True),
    *studies((ELASTIC,), CELLS_AND_STEPS, {"normal_force": 2.0}, against=FINEST_MDR, nightly=True),
)

CASE = Case(
    name="held_indentation",
    title="Pressing and holding on a relaxing layer",
    question="Do MDR and finite elements follow a prescribed history, and with which orders?",
    equations=("Eq. (51)", "Eq. (52)"),
    text=text_of(__doc__),
    scenes=(
        *RELAXING_HALF_SPACES,
        *RELAXING_LAYERS,
        ELASTIC,
        *CREEPING_HALF_SPACES,
        *CREEPING_LAYERS,
        *EASED_SCENES,
    ),
    methods=(MDR, FEM),
    claims=(
        *exact(
            WHY["lee and radok"],
            {"force on the half-space": ("normal_force", lee_and_radok)},
            scenes=RELAXING_HALF_SPACES,
            tolerance=1e-8,
            tolerances={"fem": 2e-3},
        ),
        *exact(
            WHY["creep"],
            {"depth on the half-space": ("indentation_depth", creep)},
            scenes=CREEPING_HALF_SPACES,
            tolerance=1e-8,
            tolerances={"fem": 2e-3},
        ),
        *agreements(
            CREEPING_LAYERS,
            {"fem": 2e-3},
            ("indentation_depth",),
            derived_from="three times what finite elements state for 120 cells and 400 steps, 6.5e-4",
            suffix=", creep",
        ),
        *agreements(
            (*(scene for scene in RELAXING_LAYERS if not scene.methods and not under_dashpot(scene)), ELASTIC),
            {"fem": 2e-3},
            ("normal_force",),
            derived_from="three times what finite elements state for 120 cells and 400 steps, 6.5e-4",
        ),
        *agreements(
            [scene for scene in RELAXING_LAYERS if not scene.methods and under_dashpot(scene)],
            {"fem": 1e-2},
            ("normal_force",),
            derived_from="a requirement on a dashpot, whose force jumps with every cell that the contact reaches: 1 %",
            suffix=", dashpot",
        ),
        *ORDERS,
    ),
)
