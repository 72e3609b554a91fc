"""Answers from any solver that computes the force at given depths, by inversion and difference quotients."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from contact import (
    ContactPath,
    ContactRadii,
    ForcePath,
    IndentationDepths,
    NormalForces,
    NotConvergedError,
    Scene,
    StageLog,
    UnsupportedSceneError,
)
from contact.answer.solution import Setting
from contact.records.validation import FloatArray

# Relative step of depth in the difference quotient of the stiffness. Its error of fourth order is step^4/30 for a power
# law, 3e-10 for Hertz's.
STEP = 1e-2
# Weights of differences of fourth and of sixth order of forces at three steps on either side (Fornberg 1988).
FOURTH = np.array([0.0, 1.0, -8.0, 0.0, 8.0, -1.0, 0.0]) / 12.0
SIXTH = np.array([-1.0, 9.0, -45.0, 0.0, 45.0, -9.0, 1.0]) / 60.0
# Weights of the sixth difference, which is step^6 of smooth forces; the rest is noise of the solver.
NOISE = np.array([1.0, -6.0, 15.0, -20.0, 15.0, -6.0, 1.0])
# Quantities whose stated error is that of this module alone; the solver's own error comes from its refinement.
BY_DIFFERENCES = frozenset({"contact_stiffness"})
# Relative error of inverted forces and radii at which the search ends, and its most secant steps; few are needed.
TOLERANCE, MOST_STEPS = 1e-10, 40


@dataclass(frozen=True, kw_only=True)
class Response:
    """Values of a solver at depths, shape (n,); None for those that it does not compute.

    Attributes:
        normal_force: F_N [N].
        contact_radius: a [m].
        contact_stiffness: dF/d(delta) [N/m].
    """

    normal_force: FloatArray
    contact_radius: FloatArray | None = None
    contact_stiffness: FloatArray | None = None


Respond = Callable[[FloatArray], Response]


def answer_from_depths(
    scene: Scene,
    respond: Respond,
    log: StageLog,
    *,
    method: str,
    settings: Mapping[str, Setting] | None = None,
    unknowns: int = 1,
    **further: Any,
) -> ContactPath | ForcePath:
    """Return the equilibria that the scene prescribes, without radii where the solver computes none.

    A stiffness by difference quotients states their error, besides what ``error_estimate`` states of it.

    Args:
        scene: Scene with prescribed depths, forces, or (if the solver computes radii) contact radii.
        respond: Function that returns the solver's response at depths [m], shape (n,).
        log: Log of the solver's stages.
        method: Name of the solver.
        settings: Settings of the solver.
        unknowns: Number of unknowns of its largest system.
        further: Fields of the answer, such as ``error_estimate`` and ``notes``.

    Raises:
        UnsupportedSceneError: If radii are prescribed and the solver computes none, or for any other loading.
        NotConvergedError: If no depth gives the prescribed force or radius.
    """
    depths = _depths(scene, respond)
    response = respond(depths)
    stiffness, errors = response.contact_stiffness, dict(further.pop("error_estimate", {}))
    if stiffness is None:
        stiffness, quotient_error = _slope(respond, depths, response.normal_force)
        errors["contact_stiffness"] = errors.get("contact_stiffness", 0.0) + quotient_error
    radius = {} if response.contact_radius is None else {"contact_radius": response.contact_radius}
    answer: Any = ContactPath if radius else ForcePath
    path: ContactPath | ForcePath = answer(
        scene=scene,
        method=method,
        settings=dict(settings or {}),
        **radius,
        indentation_depth=depths,
        normal_force=response.normal_force,
        contact_stiffness=stiffness,
        error_estimate=errors,
        cost=log.cost(unknowns=unknowns),
        stages=log.records,
        **further,
    )
    return path


def inverted(function: Callable[[FloatArray], FloatArray], wanted: FloatArray, first: FloatArray) -> FloatArray:
    """Return where an increasing positive function has the wanted values: secant steps on the logarithms.

    Args:
        function: Function of arrays, shape (n,), entry by entry.
        wanted: Positive, shape (n,).
        first: First guess, shape (n,); any positive one.

    Raises:
        NotConvergedError: If no argument gives a wanted value.
    """
    # Logarithms of arguments and values, of the last step and (0) of the one before.
    x0, x = np.log(first), np.log(first) + np.log(2.0)
    target, y0, y = np.log(wanted), np.log(function(np.exp(x0))), np.log(function(np.exp(x)))
    for _ in range(MOST_STEPS):
        if np.max(np.abs(y - target)) <= TOLERANCE:
            return np.asarray(np.exp(x))
        slope = np.where(y == y0, 1.0, (y - y0) / np.where(x == x0, 1.0, x - x0))
        x0, x, y0 = x, x + np.clip((target - y) / np.where(slope > 0, slope, 1.0), -2.0, 2.0), y
        y = np.log(function(np.exp(x)))
    worst = float(wanted[np.argmax(np.abs(y - target))])
    raise NotConvergedError(f"no argument gives {worst:g}; the nearest misses it by {np.max(np.abs(y - target)):.0e}")


def _depths(scene: Scene, respond: Respond) -> FloatArray:
    """The prescribed depths, or those at which the solver gives the prescribed forces or radii."""
    match scene.loading:
        case IndentationDepths(values=values):
            return values
        case NormalForces(values=values):
            # The search steps in logarithms, so that any guess of the right order will do.
            modulus = scene.layer.contact_modulus
            length = scene.indenter.flat_radius or float(np.sqrt(np.max(values) / modulus))
            return inverted(lambda depths: respond(depths).normal_force, values, values / (2 * modulus * length))
        case ContactRadii(values=values):
            return inverted(lambda depths: _radius(respond(depths)), values, scene.indenter.height(values))
    raise UnsupportedSceneError(f"loading = {type(scene.loading).__name__}: a force at depths answers no such scene")


def _radius(response: Response) -> FloatArray:
    if response.contact_radius is None:
        raise UnsupportedSceneError("no contact radius in Response, which prescribed radii need")
    return response.contact_radius


def _slope(respond: Respond, depths: FloatArray, at_depths: FloatArray) -> tuple[FloatArray, FloatArray]:
    """dF/d(delta) by differences of fourth order, and its error, relative.

    The error is the distance to differences of sixth order, plus noise and rounding of the forces.
    """
    shifts = np.array([-3.0, -2.0, -1.0, 1.0, 2.0, 3.0]) * STEP
    around = respond((depths[:, None] * (1.0 + shifts)).ravel()).normal_force.reshape(depths.size, -1)
    forces = np.insert(around, 3, at_depths, axis=1)
    steps = STEP * depths
    slope = forces @ FOURTH / steps
    rounding = np.finfo(np.float64).eps * (np.abs(at_depths) + np.abs(slope * depths))
    noise = np.abs(forces @ NOISE) + rounding
    error = np.abs(forces @ SIXTH / steps - slope) + noise / steps
    return np.asarray(slope), np.asarray(error / np.where(slope == 0.0, 1.0, np.abs(slope)))
