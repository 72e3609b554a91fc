"""Pressing and holding on a relaxing layer.

Question: Do MDR and finite elements follow a prescribed history, and with which orders?
Source: Eq. (51); Eq. (52).

A paraboloid is pressed into a relaxing layer at constant speed and held: a prescribed history of the depth. On an
incompressible half-space the contact grows and then rests, so that the theory of Lee and Radok gives the force, F =
(16/3) sqrt(R) int G(t - s) d(delta^(3/2)), and under a force that rises and is held the depth, delta^(3/2) = 3/(16
sqrt(R)) int J(t - s) dF with the compliance J that belongs to G. On a bonded layer MDR, in which every spring relaxes
by itself, is compared with finite elements, which solve a contact problem at every step. Compared are force and depth
at the end. Every relaxation function is pressed and loaded, by a ramp and by a jump at the first instant; under a jump
of the depth the force on a dashpot is infinite, and finite elements refuse it. The standard solid is that of the
impacts of Section 4.3. Where half of the force is taken away again MDR steps in time, and its depths converge. The same
history on an elastic layer has no error in time: it shows that of the cells alone.
"""

import math
from collections.abc import Callable
from dataclasses import replace

import numpy as np
from scipy.linalg import expm

from cases.case import CaseScene
from cases.library import _common as c
from cases.library import _refinements as r
from cases.library import sphere_impact as impact
from contact import DepthHistory, ForceHistory, KelvinVoigt, Layer, Paraboloid, PronySeries
from contact.records.validation import FloatArray

WHY = c.reasons("held_indentation")
DEPTH = 5e-5  # m
FORCE = 2.0  # N
# Pressing [s] takes as long as the solid takes to relax.
RAMP = 1e-3
END = 2 * RAMP
TIME = np.array([0.0, RAMP, END])
LASTING, INSTANTANEOUS = impact.LONG_TERM_MODULUS, impact.LONG_TERM_MODULUS + impact.MAXWELL_MODULUS
# Moduli [Pa] and times [s] of the Maxwell branches; a dashpot has none.
HALVES = [impact.MAXWELL_MODULUS / 2] * 2, [impact.RELAXATION_TIME / 5, impact.RELAXATION_TIME]
BRANCHES = {
    "": ([impact.MAXWELL_MODULUS], [impact.RELAXATION_TIME]),
    ", Kelvin-Voigt": ([], []),
    ", Prony series": HALVES,
}
DASHPOT = KelvinVoigt(shear_modulus=LASTING, viscosity=LASTING * impact.RELAXATION_TIME)
SERIES = PronySeries(long_term_shear_modulus=LASTING, shear_moduli=HALVES[0], relaxation_times=HALVES[1])
RELAXING = dict(zip(BRANCHES, (impact.SOLID, DASHPOT, SERIES), strict=True))
BEGINNINGS = {"": np.array([0.0, 1.0, 1.0]), " at once": np.ones(3)}
BODIES = {"half-space": np.inf, "bonded layer": c.THICKNESS}


def held(name: str, body: str, loading: DepthHistory | ForceHistory, *effects: object) -> CaseScene:
    """Return the scene of a history on the half-space or the bonded layer."""
    layer = Layer.incompressible(thickness=BODIES[body], shear_modulus=LASTING if DASHPOT in effects else INSTANTANEOUS)
    tip = Paraboloid(radius_of_curvature=impact.RADIUS_OF_CURVATURE)
    return c.scene(name, layer, tip, loading, effects=effects, layer=name)


def histories(verb: str, body: str) -> tuple[CaseScene, ...]:
    """Return the scenes of every relaxation function, by a ramp and at once: "relaxing" by depth, "creeping" by force.

    Under a jump of the depth the force on a dashpot is infinite: MDR alone answers it.
    """
    scenes, by_depth = [], verb == "relaxing"
    for begins, share in BEGINNINGS.items():
        depth, force = DepthHistory(time=TIME, depth=DEPTH * share), ForceHistory(time=TIME, force=FORCE * share)
        for relaxes, effect in RELAXING.items():
            scene = held(f"{verb} {body}{begins}{relaxes}", body, depth if by_depth else force, effect)
            infinite = effect is DASHPOT and by_depth and begins
            scenes.append(replace(scene, methods=(c.MDR,) if infinite else ()))
    return tuple(scenes)


RELAXING_HALF_SPACES, RELAXING_LAYERS = (histories("relaxing", body) for body in BODIES)
CREEPING_HALF_SPACES, CREEPING_LAYERS = (histories("creeping", body) for body in BODIES)
ELASTIC = held("elastic bonded layer", "bonded layer", DepthHistory(time=TIME, depth=DEPTH * BEGINNINGS[""]))
HALVED = ForceHistory(time=TIME, force=np.array([0.0, FORCE, FORCE / 2]))
EASED = tuple(replace(held(f"eased {body}", body, HALVED, impact.SOLID), methods=(c.MDR,)) for body in BODIES)


def branches(scene: c.AnyScene) -> tuple[FloatArray, FloatArray]:
    """Return moduli and times of the branches of a scene."""
    (name,) = (name for name, effect in RELAXING.items() if effect == scene.effects[0])
    moduli, times = BRANCHES[name]
    return np.array(moduli), np.array(times)


def relaxation(scene: c.AnyScene, time: float) -> float:
    """G(t) = G_inf + sum_j G_j exp(-t/tau_j) [Pa]; the dashpot adds nothing while the depth rests."""
    moduli, times = branches(scene)
    return float(LASTING + moduli @ np.exp(-time / times))


def compliance(scene: c.AnyScene, time: float) -> float:
    """J(t) [1/Pa]: (1 - exp(-t/tau))/G of Kelvin-Voigt, else by the matrix exponential.

    Under unit stress G_0 J' = sum_j G_j q_j/tau_j, and the branches stretch by q_j' = J' - q_j/tau_j.
    """
    moduli, times = branches(scene)
    if not times.size:
        return float(-np.expm1(-time / impact.RELAXATION_TIME) / LASTING)
    rates = np.zeros((times.size + 1, times.size + 1))
    rates[:, 1:] = moduli / times / INSTANTANEOUS
    rates[1:, 1:] -= np.diag(1 / times)
    return float(expm(rates * time)[0].sum() / INSTANTANEOUS)


def hereditary(kernel: Callable[[c.AnyScene, float], float], scene: c.AnyScene, power: float) -> float:
    """int K(END - s) d(x^power) at the end, x rising from 0 to 1 by the ramp, or 1 from the first instant on.

    With s = RAMP u^2 the integrand is smooth up to the start: d(x^power) = 2 power u^(2 power - 1) du.
    """
    loading = scene.loading
    if (loading.depth if isinstance(loading, DepthHistory) else loading.force)[0] > 0.0:
        return kernel(scene, END)
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u, weights = (nodes + 1) / 2, weights / 2
    kernels = np.array([kernel(scene, END - RAMP * share**2) for share in u])
    return float(kernels @ (weights * 2 * power * u ** (2 * power - 1)))


def lee_and_radok(scene: c.AnyScene) -> float:
    """F [N] at the end of the hold: F = 16/3 sqrt R int G(END - s) d(delta^(3/2))."""
    return float(16 / 3 * math.sqrt(impact.RADIUS_OF_CURVATURE) * hereditary(relaxation, scene, 1.5) * DEPTH**1.5)


def creep(scene: c.AnyScene) -> float:
    """delta [m] at the end of the hold: delta^(3/2) = 3/(16 sqrt R) int J(END - s) dF."""
    crept = FORCE * hereditary(compliance, scene, 1.0)
    return float((3 / 16 * crept / math.sqrt(impact.RADIUS_OF_CURVATURE)) ** (2 / 3))


DASHPOTS = tuple(s for s in RELAXING_LAYERS if DASHPOT in s.scene.effects)
OTHERS = (*(s for s in RELAXING_LAYERS if s not in DASHPOTS), ELASTIC)
FINITE = tuple(s for s in DASHPOTS if not s.methods)
CLOSED: c.Words = {"tolerance": 1e-8, "fem": 2e-3}
BY_FORCE, BY_DEPTH, LAYERS = ("indentation_depth",), ("normal_force",), CREEPING_LAYERS
THREE_TIMES = "three times what finite elements state for 120 cells and 400 steps, 6.5e-4"
ONE_PERCENT = "a requirement on a dashpot, whose force jumps with every cell that the contact reaches: 1 %"
LATE: c.Words = {"against": r.FINEST_MDR, "nightly": True}
LEE_AND_RADOK = WHY["lee and radok"]
CLAIMS = (
    c.equal("force on the half-space", *BY_DEPTH, lee_and_radok, RELAXING_HALF_SPACES, LEE_AND_RADOK, **CLOSED),
    c.equal("depth on the half-space", *BY_FORCE, creep, CREEPING_HALF_SPACES, WHY["creep"], **CLOSED),
    *c.agreements(LAYERS, {"fem": 2e-3}, BY_FORCE, derived_from=THREE_TIMES, suffix=", creep"),
    *c.agreements(OTHERS, {"fem": 2e-3}, BY_DEPTH, derived_from=THREE_TIMES),
    *c.agreements(FINITE, {"fem": 1e-2}, BY_DEPTH, derived_from=ONE_PERCENT, suffix=", dashpot"),
    *r.studies(EASED, "accuracy of receding fronts", BY_FORCE, **LATE),
    *r.studies((ELASTIC,), "cells and time steps", {"normal_force": 2.0}, **LATE),
)
CASE = c.paper(
    __name__,
    __doc__,
    (*RELAXING_HALF_SPACES, *RELAXING_LAYERS, ELASTIC, *CREEPING_HALF_SPACES, *LAYERS, *EASED),
    (c.MDR, c.PLAIN_FEM),
    CLAIMS,
)
