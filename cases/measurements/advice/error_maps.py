"""Signed errors over (a/h, nu): where each closed form for thin and thick layers is good, and what each method leaves.

Two quantities, as users prescribe them: the force of a paraboloid at a given depth, and its depth at a given force,
relative to the fast method's. The a/h of a map is that of the exact answer.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cache
from typing import Any, Final, Literal, TypeAlias

import numpy as np

from bem.polynomials.gauss import legendre_rule
from cases.declare.guarded_method import BrokenMethodError, build_guarded
from cases.declare.methods import check_known
from cases.measurements.study import Say, announced, silent, study_case, told
from cases.results.records.reliability import UNBONDED, ErrorMap
from cases.results.records.run import CaseResult
from contact import (
    ContactError,
    ContactPath,
    ContactRadii,
    ForcePath,
    IndentationDepths,
    InvalidInput,
    Layer,
    Loading,
    Method,
    NormalForces,
    Paraboloid,
    Scene,
)
from contact.records.validation import FloatArray

NAME: Final = "error_maps"
RATIOS: Final = tuple(np.geomspace(1e-3, 1e3, 37).tolist())
ROWS: Final = (UNBONDED, "0", "0.2", "0.3", "0.4", "0.45", "0.48", "0.49", "0.499", "0.5")
# Up to a/h = 15, as closed forms are mapped in the suites.
USUAL_RATIOS: Final = RATIOS[:26]
FEW_RATIOS: Final = tuple(np.geomspace(1e-2, 20.0, 12).tolist())
FEW_ROWS: Final = (UNBONDED, "0", "0.3", "0.45", "0.499", "0.5")
# Gauss nodes: the thin-layer forms are polynomials.
_NODES: Final = 32
# Radius of curvature over thickness.
_CURVATURE: Final = 1e3

Given: TypeAlias = Literal["depth", "force"]
# What is sought where depth or force is given.
SOUGHT: Final[Mapping[Given, str]] = {"depth": "normal_force", "force": "indentation_depth"}
WORDS: Final[Mapping[Given, str]] = {"depth": "force at given depth", "force": "depth at given force"}

TEXT: Final = """
A paraboloid presses a layer. Each map shows the signed relative error of the force at a given depth, or of the depth at
a given force, over a/h of the exact answer and Poisson's ratio; the unbonded layer, which does not see it, is a row of
its own. Closed forms: the half-space (Hertz) and the thin layer, a bed of springs, Eqs. (17) and (22), or the
incompressible film, Eq. (20). Methods: at coarse settings, so that their errors are seen. Frictionless in place
of friction: how much larger than the frictionless force, at most, that with dry friction of a coefficient is,
F_0/(1 - mu max |u_r1|) by reciprocity; no number where that says nothing. `advise` tells the same of one scene.
"""

# Forces at depths, or depths at forces, as the second argument says; NaN where there is no answer.
Answer = Callable[[Layer, Given, FloatArray], FloatArray]


@dataclass(frozen=True, kw_only=True)
class MapPlan:
    """The maps of one formula or method.

    Attributes:
        name: of the formula or method.
        title: for readers.
        answer: forces at depths, or depths at forces, on a layer; NaN where there is none.
        ratios: a/h.
        rows: Poisson's ratios as words, or "unbonded".
        given: what is prescribed, one map each.
    """

    name: str
    title: str
    answer: Answer
    ratios: tuple[float, ...] = RATIOS
    rows: tuple[str, ...] = ROWS
    given: tuple[Given, ...] = ("depth", "force")


def half_space(layer: Layer, given: Given, values: FloatArray) -> FloatArray:
    """F = (4/3) E* sqrt(R) delta^(3/2), Hertz, or its inverse."""
    stiffness = 4 / 3 * layer.contact_modulus * np.sqrt(_CURVATURE * layer.thickness)
    return np.asarray(stiffness * values**1.5 if given == "depth" else (values / stiffness) ** (2 / 3))


def thin_layer(layer: Layer, given: Given, values: FloatArray) -> FloatArray:
    """Depth and force of the thin layer are powers of the contact radius, so that each is a power of the other."""
    radii = layer.thickness * np.array([1.0, 2.0])
    depth, force = _thin_depth_and_force(layer, radii)
    known, sought = (depth, force) if given == "depth" else (force, depth)
    power = np.log(sought[1] / sought[0]) / np.log(known[1] / known[0])
    return np.asarray(sought[0] * (values / known[0]) ** power)


def _thin_depth_and_force(layer: Layer, radii: FloatArray) -> tuple[FloatArray, FloatArray]:
    """delta = g(a) and F = 2 int_0^a c_N (g(a) - g) dx with the thin layer's springs and profile, Eq. (4)."""
    from mdr.closed_forms.asymptotic import thin_profile, thin_spring_stiffness  # noqa: PLC0415 - a method is imported when used

    nodes, weights = legendre_rule(_NODES)
    x = radii[:, None] * (1 + nodes) / 2
    depth = thin_profile(layer, _indenter(layer), radii)
    rise = depth[:, None] - thin_profile(layer, _indenter(layer), x)
    return depth, radii * ((thin_spring_stiffness(layer, x) * rise) @ weights)


@dataclass(frozen=True)
class Solved:
    """Forces or depths by a method of the table."""

    method: str
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __call__(self, layer: Layer, given: Given, values: FloatArray) -> FloatArray:
        """Solve all in one scene, which shares what a method prepares; one by one where that is refused."""
        method = build_guarded(self.method, dict(self.settings))
        found = _solved(method, layer, given, values)
        if found is not None:
            return found
        each = [_solved(method, layer, given, values[i : i + 1]) for i in range(len(values))]
        return np.array([np.nan if one is None else one[0] for one in each])


def _solved(method: Method, layer: Layer, given: Given, values: FloatArray) -> FloatArray | None:
    """What is sought at these depths or forces; None where there is no answer."""
    loading = IndentationDepths(values) if given == "depth" else NormalForces(values)
    try:
        path = method.solve(_scene(layer, loading))
    except BrokenMethodError:
        raise
    except ContactError:
        return None
    return np.asarray(getattr(path, SOUGHT[given])) if isinstance(path, ContactPath | ForcePath) else None


@dataclass(frozen=True)
class MostFriction:
    """The largest force that dry friction allows, from the radial displacement u_r1 under the frictionless punch."""

    coefficient: float

    def __call__(self, layer: Layer, given: Given, values: FloatArray) -> FloatArray:
        """F_0/(1 - mu max |u_r1|) at depths; NaN where the bound is infinite."""
        from bem.kernels.of_layer import sticking_kernel  # noqa: PLC0415 - used here only
        from bem.layer_equation.stick.frictionless_slip import frictionless_punch  # noqa: PLC0415 - used here only

        path = _exact(layer, IndentationDepths(values))
        ratios = path.contact_radius / layer.thickness
        punches = [frictionless_punch(float(x), sticking_kernel(layer)) for x in ratios]
        slip = self.coefficient * np.array([punch.largest() for punch in punches])
        return np.asarray(np.divide(path.normal_force, 1.0 - slip, out=np.full_like(slip, np.nan), where=slip < 1.0))


FRICTION: Final = tuple(
    MapPlan(
        name=f"friction {mu:g}",
        title=f"Frictionless in place of friction {mu:g}",
        answer=MostFriction(mu),
        given=("depth",),
        ratios=FEW_RATIOS,
        rows=FEW_ROWS,
    )
    for mu in (0.1, 0.3)
)
FORMULAS: Final = (
    MapPlan(name="half-space", title="Half-space (Hertz)", answer=half_space),
    MapPlan(name="thin layer", title="Thin layer: bed, at nu = 0.5 film", answer=thin_layer),
)


def _as_it_comes(method: str) -> MapPlan:
    return MapPlan(name=method, title=method, answer=Solved(method), ratios=FEW_RATIOS, rows=FEW_ROWS)


METHODS: Final = tuple(
    replace(_as_it_comes(method), title=title, answer=Solved(method, settings))
    for method, title, settings in (
        ("mdr", "MDR, 12 nodes", {"nodes": 12}),
        ("mdr_table", "MDR on an FFT table, 64 cells", {"cells": 64, "ratios": 60, "radii": 100}),
        ("integral_equation", "Integral equation, 6 nodes", {"nodes": 6}),
        ("bem", "BEM, 128 cells", {"points": 128}),
        ("fem", "FEM, accuracy 1e-3", {"accuracy": 1e-3}),
    )
)


def plans_of(names: Collection[str], methods: Collection[str]) -> tuple[MapPlan, ...]:
    """Return the maps of these names and methods, all of the project if neither is given.

    Raises:
        InvalidInput: if there is no such map or method.
    """
    for method in methods:
        check_known(method)
    known = {plan.name: plan for plan in (*FORMULAS, *FRICTION, *METHODS)}
    for name in names:
        if name not in known:
            raise InvalidInput(f"no map of {name!r}; there are {', '.join(known)}")
    wanted = dict.fromkeys((*names, *methods)) or known
    return tuple(known.get(name) or _as_it_comes(name) for name in wanted)


def map_case(
    plans: Iterable[MapPlan] = (*FORMULAS, *FRICTION, *METHODS), progress: Say = silent, at_work: Say = silent
) -> CaseResult:
    """Draw up the maps; ``progress`` is told of each, ``at_work`` of every row before it is solved."""
    return study_case(
        NAME,
        "Where closed forms and methods are good",
        "Over which a/h and Poisson's ratios is each formula right to one percent, and what do methods leave?",
        TEXT,
        equations=("Eq. (17)", "Eq. (20)", "Eq. (22)"),
        maps=tuple(told((_map(plan, given, at_work) for plan in plans for given in plan.given), summary, progress)),
    )


def _map(plan: MapPlan, given: Given, at_work: Say) -> ErrorMap:
    title = f"{plan.title}: {WORDS[given]}"
    rows = announced(plan.rows, lambda row: f"{title}, Poisson's ratio {row}", at_work)
    return ErrorMap(
        name=f"{plan.name}, {WORDS[given]}",
        title=title,
        quantity=SOUGHT[given],
        reference="the fast method (24 nodes)",
        ratios=plan.ratios,
        rows=plan.rows,
        errors=tuple(errors_of(plan.answer, given, _layer(row), plan.ratios) for row in rows),
    )


def errors_of(answer: Answer, given: Given, layer: Layer, ratios: Sequence[float]) -> tuple[float | None, ...]:
    """Signed relative errors at the exact answers with these a/h; None where there is no answer."""
    known, expected = _exact_at(layer, tuple(ratios))
    if given == "force":
        known, expected = expected, known
    errors = answer(layer, given, known) / expected - 1.0
    return tuple(float(error) if np.isfinite(error) else None for error in errors)


@cache
def _exact_at(layer: Layer, ratios: tuple[float, ...]) -> tuple[FloatArray, FloatArray]:
    """Exact depths and forces at a/h: they serve every map of a layer, and films up to a/h = 1000 take seconds."""
    path = _exact(layer, ContactRadii(values=np.array(ratios) * layer.thickness))
    return path.indentation_depth, path.normal_force


def _exact(layer: Layer, loading: Loading) -> ContactPath:
    path = build_guarded("mdr", {}).solve(_scene(layer, loading))
    assert isinstance(path, ContactPath)
    return path


def summary(found: ErrorMap) -> str:
    """One line: the largest error, and the ranges that are good to one percent for the incompressible bonded layer."""
    known = [abs(error) for row in found.errors for error in row if error is not None]
    good = " and ".join(f"[{low:.3g}, {high:.3g}]" for low, high in found.good_ranges("0.5"))
    words = f"good to 1 % for a/h in {good}" if good else "nowhere good to 1 %"
    return f"{found.title}: errors up to {max(known, default=0.0):.1e}; bonded nu = 0.5 {words}"


def _layer(row: str) -> Layer:
    if row == UNBONDED:
        return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded")
    return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=float(row), support="bonded")


def _indenter(layer: Layer) -> Paraboloid:
    return Paraboloid(radius_of_curvature=_CURVATURE * layer.thickness)


def _scene(layer: Layer, loading: Loading) -> Scene:
    return Scene(layer=layer, indenter=_indenter(layer), loading=loading, beyond_small_strains=True)
