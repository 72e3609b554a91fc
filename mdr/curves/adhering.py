"""Fits of curves with adhesion: the branch of equilibria on withdrawal, from many first guesses.

The data say which points are in contact: those from the jump at pull-off on. The model has no jump then.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import product
from typing import Final

import numpy as np

from contact import InvalidInput, NotConvergedError, Scene, UnsupportedSceneError
from contact.records.validation import BoolArray, FloatArray
from mdr.curves.adhesive_curve import adhesive_curve
from mdr.curves.models import Model, curve_to, is_modulus, modulus_of
from mdr.curves.result import correlated
from mdr.curves.search import Values, least_squares, rough_fit

# First guesses of the modulus over one without adhesion, and of the root of the work over the scene's.
_MODULI: Final = tuple(10.0 ** (k / 4) for k in range(-6, 9))
_ROOTS: Final = (0.0, *(10.0 ** (k / 6) for k in range(-12, 13)))
# The best guesses go on to least squares. With two some fits end beside the best place; with eight none improves.
_STARTS: Final = 4
# Depth of the dip over the scatter of its neighbours from which it is one. At half of it noise makes dips.
_DIP: Final = 6.0
# Share of the dip that the force at pull-off has: 5/9 under a paraboloid. Points above this share are not in contact.
_ATTACHED: Final = 0.3
# Residuals over the range of forces that are a misfit if they are not noise. Twice passes wrong ends, half fails tilts.
_MISFIT: Final = 0.02
# Relative difference of values in which two ends of least squares are the same one.
_SAME: Final = 1e-3


def fit_adhesive(scene: Scene, d: FloatArray, f: FloatArray, parameters: Sequence[str]) -> tuple[Model, Values, bool]:
    """The model and values of least squares of a curve of withdrawal, and whether the steps have converged.

    Raises:
        InvalidInput: If the scene has several moduli.
        NotConvergedError: If least squares from several guesses end in different places that fit equally well.
    """
    if any("." in name for name in parameters):
        raise InvalidInput("Adhesion: single moduli of a stack are fitted without adhesion only")
    ends: list[tuple[float, Model, Values, bool]] = []
    for attached in _hypotheses(d, f, parameters):
        model = _model(scene, d, f, parameters, attached)
        for start in _starts(model, f):
            values, squares, converged = least_squares(model.linearised, start, f, _bounds(start, d))
            if math.isfinite(squares):
                ends.append((squares, model, values, converged))
    if not ends:
        raise NotConvergedError("no first guess fits the curve; give the work of adhesion a first guess in the scene")
    ends.sort(key=lambda end: (end[0], not end[3]))
    _check_misfit(ends[0][1], ends[0][2], f)
    _check_one_place(ends, f)
    return ends[0][1:]


def _hypotheses(d: FloatArray, f: FloatArray, parameters: Sequence[str]) -> Iterator[BoolArray]:
    """Which points are in contact: from the jump at pull-off on; and all, where the curve may end before it."""
    order = np.argsort(d, kind="stable")
    force = f[order]
    least = int(np.argmin(force))
    before = force[: max(least // 2, 1)]
    level = float(np.median(before)) if "baseline" in parameters else 0.0
    scatter = 1.48 * float(np.median(np.abs(np.diff(before)))) if before.size > 2 else 0.0
    dip = level - float(force[least])
    if float(force[-1]) < level - 0.9 * dip and dip > _DIP * scatter:
        raise NotConvergedError("the withdrawal starts too close to pull-off for a modulus; press deeper before it")
    if dip > max(_DIP * scatter, 1e-9 * float(np.ptp(f))):
        apart = np.flatnonzero(force[: least + 1] > level - _ATTACHED * dip)
        attached = np.zeros(d.size, dtype=bool)
        attached[order[(apart[-1] + 1 if apart.size else 0) :]] = True
        yield attached
        if apart.size > 3:
            return
    else:
        yield d >= d.max() - 1.2 * rough_fit(d, f, parameters)[0]
    yield np.ones(d.size, dtype=bool)


def _model(scene: Scene, d: FloatArray, f: FloatArray, parameters: Sequence[str], attached: BoolArray) -> Model:
    """The model whose table reaches four times the way in contact, or as far as the indenter."""
    reach = 4.0 * max(float(np.ptp(d[attached])), 1e-3 * float(np.ptp(d)))
    if "contact_point" not in parameters:
        reach = max(reach, 2.0 * float(d.max()))
    for _ in range(20):
        try:
            adhesive_curve(curve_to(scene, reach).scene)
        except (InvalidInput, UnsupportedSceneError):
            reach /= 1.5
        else:
            break
    return Model(scene, d, parameters, reach, attached)


def _starts(model: Model, force: FloatArray) -> list[Values]:
    """The best first guesses of a grid of moduli and works; the contact point puts the deepest point on the branch."""
    work, names = model.work or 0.0, model.parameters
    shallow = force[~model.attached] if model.attached is not None else force[:0]
    level = float(np.median(shallow)) if shallow.size and "baseline" in names else 0.0
    deep = int(np.argmax(model.depth))
    guess = _elastic_modulus(model, force - level)
    roots = [math.sqrt(work) * r for r in _ROOTS] if "work_of_adhesion" in names else [math.sqrt(work)]
    rated: list[tuple[float, Values]] = []
    for factor, root in product(_MODULI, roots):
        modulus = guess * factor
        depths, forces = adhesive_curve(model.curve({}).scene).branch(modulus, root**2)
        rising = int(np.argmin(forces))
        point = float(model.depth[deep] - np.interp(force[deep] - level, forces[rising:], depths[rising:]))
        known = {"youngs_modulus": modulus, "contact_point": point, "baseline": level, "tilt": 0.0}
        known |= {"work_of_adhesion": root, "thickness": model.scene.layer.thickness}
        start = {name: known[name] for name in names}
        misfit = float(np.sum((force - model.force(start)) ** 2))
        if math.isfinite(misfit):
            rated.append((misfit, start))
    return [start for _, start in sorted(rated, key=lambda one: one[0])[:_STARTS]]


def _elastic_modulus(model: Model, force: FloatArray) -> float:
    """E [Pa] that presses the whole way in contact to the range of forces without adhesion."""
    way = (
        float(np.ptp(model.depth[model.attached])) if "contact_point" in model.parameters else float(model.depth.max())
    )
    phi = float(model.curve({}).per_modulus(min(way, model.reach)))
    return float(np.ptp(force)) / phi if phi > 0.0 else modulus_of(model.scene, "youngs_modulus")


def _bounds(start: Values, d: FloatArray) -> dict[str, tuple[float, float]]:
    bounds = {
        "work_of_adhesion": (0.0, math.inf),
        "contact_point": (float(d.min() - 2 * np.ptp(d)), float(d.max() + np.ptp(d))),
    }
    for name, value in start.items():
        if is_modulus(name):
            bounds[name] = (1e-4 * value, 1e4 * value)
        elif name == "thickness":
            bounds[name] = (value / 10, value * 10)
    return bounds


def _check_misfit(model: Model, values: Values, force: FloatArray) -> None:
    """Refuse values whose residuals are large and not noise: least squares have ended beside the curve."""
    order = np.argsort(model.depth, kind="stable")
    residual = (force - model.force(values))[order]
    if float(np.std(residual)) > _MISFIT * float(np.ptp(force)) and correlated(residual) > 1.0:
        raise NotConvergedError(
            "no values were found that describe the curve of withdrawal; press deeper (the force has to rise above "
            "its minimum), or change the first guesses in the scene"
        )


def _check_one_place(ends: Sequence[tuple[float, Model, Values, bool]], force: FloatArray) -> None:
    """Refuse fits whose squares are as small in another place."""
    least, _, best, _ = ends[0]
    limit = least * (1 + 3 / force.size) + 1e-12 * float(force @ force)
    for squares, model, values, converged in ends[1:]:
        if squares <= limit and converged:
            _, jacobian = model.linearised(best)
            change = np.array([values[name] - best[name] for name in best])
            far = abs(values["youngs_modulus"] / best["youngs_modulus"] - 1) > 10 * _SAME
            if far and float(np.sum((jacobian @ change) ** 2)) > 9 * limit:
                raise NotConvergedError(
                    "two sets of values fit this curve equally well "
                    f"(E = {best['youngs_modulus']:.4g} and {values['youngs_modulus']:.4g} Pa); include the baseline "
                    "before pull-off, or fix the work of adhesion or the contact point"
                )
