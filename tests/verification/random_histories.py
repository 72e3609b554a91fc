"""Random histories of depth or force on relaxing incompressible layers, and their solution by reduction to springs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from contact import (
    Cone,
    ContactRadii,
    DepthHistory,
    FlatPunch,
    ForceHistory,
    HistoryPath,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
    TruncatedCone,
    Viscoelasticity,
)
from mdr import Mdr

FloatArray = NDArray[np.float64]
RADIUS = 1e-3
SHEAR_MODULUS = 1e4
DURATION = 10.0
# Depths or forces over their largest, at instants over the duration; the first ramp is short in three of them.
SHAPES = ("ramp", "triangle", "cycles", "step")


@dataclass(frozen=True)
class Coverage:
    """True and stated errors of the response of one history, over the largest response, shape (n,)."""

    error: FloatArray
    stated: FloatArray

    @property
    def ratio(self) -> FloatArray:
        """True over stated error; zero where the true one is within rounding."""
        return np.where(self.error > 1e-12, self.error / np.maximum(self.stated, 1e-300), 0.0)

    @property
    def worst(self) -> float:
        """Largest true over stated error."""
        return float(self.ratio.max())


def random_history(number: int, *, seed: int = 20) -> Scene:
    """A history: relaxation by ``number``, ramp, tip, thickness and load at random."""
    rng = np.random.default_rng([seed, number])
    relaxation = _relaxation(number % 3, rng)
    tip = (
        Paraboloid(radius_of_curvature=20 * RADIUS),
        Cone(slope=0.05),
        TruncatedCone(flat_radius=rng.uniform(0.2, 0.8) * RADIUS, slope=0.05),
        FlatPunch(radius=RADIUS),
    )[rng.choice(4, p=(0.35, 0.3, 0.2, 0.15))]
    thickness = np.inf if rng.random() < 0.3 else RADIUS / 10 ** rng.uniform(-1, np.log10(3))
    layer = Layer.incompressible(thickness=thickness, shear_modulus=SHEAR_MODULUS)
    by_depth = rng.random() < 0.5
    time, share = _course(rng, may_step=not isinstance(relaxation, KelvinVoigt))
    reached = IndentationDepths([1e-5]) if isinstance(tip, FlatPunch) else ContactRadii([RADIUS])
    elastic = Mdr().solve(Scene(layer=layer, indenter=tip, loading=reached))
    depth = elastic.indentation_depth[0]
    force = elastic.normal_force[0] * relaxation.relaxation.long_term_modulus / SHEAR_MODULUS
    loading = DepthHistory(time=time, depth=depth * share) if by_depth else ForceHistory(time=time, force=force * share)
    return Scene(layer=layer, indenter=tip, loading=loading, effects=(relaxation,))


def _relaxation(kind: int, rng: np.random.Generator) -> Viscoelasticity:
    """Kelvin-Voigt, standard solid or Prony series of the instantaneous modulus `SHEAR_MODULUS`."""
    if kind == 0:
        tau = DURATION * 10 ** rng.uniform(-3, 0)
        return KelvinVoigt(shear_modulus=SHEAR_MODULUS, viscosity=tau * SHEAR_MODULUS)
    share = rng.uniform(0.1, 0.7)
    branch = (1 - share) * SHEAR_MODULUS
    if kind == 1:
        tau = DURATION * 10 ** rng.uniform(-3, 0.5)
        return StandardSolid(
            long_term_shear_modulus=share * SHEAR_MODULUS, maxwell_shear_modulus=branch, viscosity=tau * branch
        )
    count = rng.integers(2, 6)
    parts = rng.dirichlet(np.ones(count)) * branch
    times = DURATION * 10 ** np.sort(rng.uniform(-4, 0, count))
    return PronySeries(
        long_term_shear_modulus=share * SHEAR_MODULUS, shear_moduli=list(parts), relaxation_times=list(times)
    )


def _course(rng: np.random.Generator, *, may_step: bool) -> tuple[FloatArray, FloatArray]:
    """Instants [s] and loads over their largest."""
    ramp = 10 ** rng.uniform(-3, 0)
    match rng.choice(SHAPES, p=(0.55, 0.15, 0.15, 0.15)):
        case "triangle":
            time, share = [0.0, ramp / 2, max(ramp, 0.01), 1.0], [0.0, 1.0, rng.uniform(0.2, 0.6), 0.5]
        case "cycles":
            time, share = np.linspace(0, 1, 7), [0.0, 1.0, 0.4, 0.9, 0.3, 0.8, 0.2]
        case "step" if may_step:
            time, share = [0.0, ramp / 2, 1.0], [rng.uniform(0.3, 1.0), 1.0, 1.0]
        case _:
            time, share = [0.0, ramp, 1.0], [0.0, 1.0, 1.0]
    if time[-2] == 1.0:
        time, share = time[:-1], share[:-1]
    return DURATION * np.asarray(time), np.asarray(share)


def coverage(answer: HistoryPath, *, most: int | None = None) -> Coverage:
    """Compare the response with springs at the answer's instants, or at ``most`` of them and all given ones."""
    loading = answer.scene.loading
    assert isinstance(loading, DepthHistory | ForceHistory)
    chosen = np.arange(len(answer.time))
    if most is not None:
        spread = np.linspace(0, len(answer.time) - 1, most).astype(int)
        chosen = np.unique([*spread, *np.searchsorted(answer.time, loading.time)])
    time = answer.time[chosen]
    if isinstance(loading, DepthHistory):
        name, sampled = "normal_force", DepthHistory(time=time, depth=np.interp(time, loading.time, loading.depth))
    else:
        name, sampled = "indentation_depth", ForceHistory(time=time, force=np.interp(time, loading.time, loading.force))
    exact = Mdr().solve(answer.scene.replace(loading=sampled))
    error = np.maximum(np.abs(getattr(answer, name)[chosen] - getattr(exact, name)) - exact.uncertainty(name), 0.0)
    scale = np.abs(getattr(answer, name)).max()
    return Coverage(error / scale, answer.uncertainty(name)[chosen] / scale)
