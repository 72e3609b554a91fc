"""A second answer to elastic and adhesive contacts of given radius, for campaigns over thousands of scenes.

It is the direct integral equation (`bem.direct`) on more nodes than its method takes: one dense linear system for each
contact radius. It shares the layer's kernel with MDR and nothing else; the kernel is checked
against 40 digits and by finite elements.
"""

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from bem.direct import Density, Kernel, Sizes
from bem.direct_method import LARGEST_RATIO
from contact import (
    Adhesion,
    ContactPath,
    ContactRadii,
    FlatPunch,
    IndentationDepths,
    InvalidInput,
    Layer,
    Profile,
    Scene,
)
from contact.records.validation import FloatArray
from tests.layer_kernel import compliance_kernel

QUANTITIES: Final = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")

# More nodes and wave numbers than the method takes.
_SIZES: Final = Sizes(nodes=24, waves=46, reach=24.0, slopes=24)
# Share of a - b over which derivatives are taken; they only scale tiny corrections of the radius.
_STEP: Final = 1e-4
_EPS: Final = float(np.finfo(float).eps)


@dataclass(frozen=True, kw_only=True)
class SecondOpinion:
    """What a path should say.

    Attributes:
        values: By quantity, shape (n,).
        uncertainty: Relative rounding error of these values, shape (n,): machine precision times condition.
    """

    values: dict[str, FloatArray]
    uncertainty: FloatArray


@dataclass(frozen=True, kw_only=True)
class _State:
    """Depth [m], force [N] and stiffness [N/m] of one contact, and phi(a) of the flat punch pressed in by one unit."""

    depth: float
    force: float
    stiffness: float
    edge: float


def second_opinion(path: ContactPath) -> SecondOpinion:
    """The equilibria near the path's contact radii that carry the prescribed radii, depths or forces.

    Raises:
        InvalidInput: If a/h is beyond `LARGEST_RATIO`.
    """
    scene, given = path.scene, getattr(path.scene.loading, "values", path.contact_radius)
    rows = [_row(scene, float(value), float(a)) for value, a in zip(given, path.contact_radius, strict=True)]
    values = {name: np.array([row[i] for row in rows]) for i, name in enumerate(QUANTITIES)}
    radii = given if isinstance(scene.loading, ContactRadii) else path.contact_radius
    return SecondOpinion(values=values, uncertainty=_roundings(scene, radii))


def adhesive_states(scene: Scene, radii: FloatArray) -> SecondOpinion:
    """Depth and force of an adhering indenter in equilibrium at contact radii, Eqs. (40) and (41).

    The contact of radius a is pulled by dl = sqrt(2 pi Delta gamma a/c_N) from where it would touch without adhesion;
    c_N = E* phi_1(a)^2 is the edge value of the flat punch's density.

    Raises:
        InvalidInput: If a/h is beyond `LARGEST_RATIO`.
    """
    adhesion = scene.effect(Adhesion)
    work = 0.0 if adhesion is None else adhesion.work_of_adhesion
    # The end of a table may come out one rounding beyond.
    radii = np.minimum(radii, scene.indenter.max_radius)
    states = [_state(scene, float(a)) for a in radii]
    springs = scene.layer.contact_modulus * np.array([state.edge for state in states]) ** 2
    elongation = np.sqrt(2 * math.pi * work * radii / springs)  # Eq. (40)
    depth = np.array([state.depth for state in states]) - elongation
    force = np.array([state.force - state.stiffness * dl for state, dl in zip(states, elongation, strict=True)])
    values = {"indentation_depth": depth, "normal_force": force}
    return SecondOpinion(values=values, uncertainty=_roundings(scene, radii))


def direct_density(layer: Layer, indenter: Profile, a: float) -> Density:
    """The solution for one contact radius [m].

    Raises:
        InvalidInput: If a/h is beyond `LARGEST_RATIO`.
    """
    ratio = a / layer.thickness
    if ratio > LARGEST_RATIO:
        raise InvalidInput(f"a/h = {ratio:g}: the second opinion covers ratios up to {LARGEST_RATIO:g}")
    return Density(Kernel(layer, _SIZES), indenter, a)


def pressure_of(layer: Layer, indenter: Profile, a: float, depth: float | None, radius: FloatArray) -> FloatArray:
    """p [Pa] at radii r < a [m]; the depth [m] of a flat punch, None where phi(a) = 0 defines it."""
    density = direct_density(layer, indenter, a)
    p = density.pressure(radius, density.depth if depth is None else depth, is_singular=depth is not None)
    return np.asarray(layer.contact_modulus / math.pi * p)


def smallest_eigenvalue(layer: Layer, a: float) -> float:
    """chi(h/a), about the smallest eigenvalue of the equation under a contact of radius a [m]."""
    if layer.is_half_space:
        return 1.0
    k = np.array([min(1.0, layer.thickness / a)])
    return float(compliance_kernel(k, layer.support, layer.poissons_ratio)[0])


def _row(scene: Scene, given: float, a: float) -> tuple[float, float, float, float]:
    """Radius, depth, force, stiffness; the radius is corrected to first order to meet what is prescribed."""
    a = given if isinstance(scene.loading, ContactRadii) else a
    here = _state(scene, a)
    is_depth = isinstance(scene.loading, IndentationDepths)
    if isinstance(scene.indenter, FlatPunch):
        depth = given if is_depth else given / here.stiffness
        return a, depth, depth * here.stiffness, here.stiffness
    if isinstance(scene.loading, ContactRadii):
        return a, here.depth, here.force, here.stiffness
    # What is missing of the depth: dF = k_N d(delta).
    missing = given - here.depth if is_depth else (given - here.force) / here.stiffness
    before = _state(scene, a - _STEP * (a - scene.indenter.flat_radius))
    # The radius may equal b to the last bit.
    steps = missing / (here.depth - before.depth) if here.depth > before.depth else 0.0
    shift = steps * _STEP * (a - scene.indenter.flat_radius)
    stiffness = here.stiffness + (here.stiffness - before.stiffness) * steps
    return a + shift, here.depth + missing, here.force + here.stiffness * missing, stiffness


def _state(scene: Scene, a: float) -> _State:
    """Depth, force and stiffness at a contact radius a [m]."""
    density = direct_density(scene.layer, scene.indenter, a)
    stiffness, lacking = 2 * scene.layer.contact_modulus * density.integrals
    force = float(density.depth * stiffness - lacking)
    return _State(depth=density.depth, force=force, stiffness=float(stiffness), edge=float(density.edge[0]))


def _roundings(scene: Scene, radii: FloatArray) -> FloatArray:
    """Rounding errors grow with the inverse of the smallest eigenvalue and with 1/(1 - b/a)."""
    flat = 0.0 if isinstance(scene.indenter, FlatPunch) else scene.indenter.flat_radius
    smallest = np.array([smallest_eigenvalue(scene.layer, float(a)) for a in radii])
    return _EPS * (200 / smallest + 4 / np.maximum(1 - flat / radii, _EPS))
