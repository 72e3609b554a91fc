"""Signed errors over (a/h, nu): where each closed form for thin and thick layers is good, and what each method leaves.

The quantity is the force of a paraboloid at a prescribed contact radius, relative to the fast method's.
"""

from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, Final

import numpy as np

from bem.polynomials.gauss import legendre_rule
from cases.declare.guarded_method import BrokenMethodError, build_guarded
from cases.declare.methods import check_known
from cases.measurements.study import Say, silent, study_case, told
from cases.results.records.reliability import UNBONDED, ErrorMap
from cases.results.records.run import CaseResult
from contact import ContactError, ContactPath, ContactRadii, InvalidInput, Layer, Method, Paraboloid, Scene
from contact.records.validation import FloatArray

NAME: Final = "error_maps"
RATIOS: Final = tuple(np.geomspace(1e-3, 1e3, 37).tolist())
ROWS: Final = (UNBONDED, "0", "0.2", "0.3", "0.4", "0.45", "0.48", "0.49", "0.499", "0.5")
FEW_RATIOS: Final = tuple(np.geomspace(1e-2, 20.0, 12).tolist())
FEW_ROWS: Final = (UNBONDED, "0", "0.3", "0.45", "0.499", "0.5")
_NODES: Final = 32  # Gauss nodes: the thin-layer forms are polynomials
_CURVATURE: Final = 1e3  # radius of curvature over thickness

TEXT: Final = """
A paraboloid touches a layer up to a prescribed radius a. Each map shows the signed relative error of the force over a/h
and Poisson's ratio; the unbonded layer, which does not see it, is a row of its own. Closed forms: the half-space
(Hertz) and the thin layer, a bed of springs, Eqs. (17) and (22), or the incompressible film, Eq. (20). Methods: at
coarse settings, so that their errors are seen. Friction: how much larger than the frictionless force, at most, that
with dry friction of a coefficient is at the same depth and radius, F_0/(1 - mu max |u_r1|) by reciprocity; no number
where that says nothing.
"""

Answer = Callable[[Layer, FloatArray], FloatArray]


@dataclass(frozen=True, kw_only=True)
class MapPlan:
    """One map.

    Attributes:
        name: of the formula or method.
        title: for readers.
        answer: forces at contact radii on a layer; NaN where there is none.
        ratios: a/h.
        rows: Poisson's ratios as words, or "unbonded".
    """

    name: str
    title: str
    answer: Answer
    ratios: tuple[float, ...] = RATIOS
    rows: tuple[str, ...] = ROWS


def half_space_force(layer: Layer, radii: FloatArray) -> FloatArray:
    """F = 4 E* a^3 / (3 R), Hertz."""
    force: FloatArray = 4 * layer.contact_modulus * radii**3 / (3 * _CURVATURE * layer.thickness)
    return force


def thin_layer_force(layer: Layer, radii: FloatArray) -> FloatArray:
    """F = 2 int_0^a c_N (g(a) - g) dx with the thin layer's springs and profile, Eq. (4)."""
    from mdr.closed_forms.asymptotic import thin_profile, thin_spring_stiffness  # noqa: PLC0415 - a method is imported when used

    nodes, weights = legendre_rule(_NODES)
    x = radii[:, None] * (1 + nodes) / 2
    rise = thin_profile(layer, _indenter(layer), radii)[:, None] - thin_profile(layer, _indenter(layer), x)
    force: FloatArray = radii * ((thin_spring_stiffness(layer, x) * rise) @ weights)
    return force


@dataclass(frozen=True)
class Solved:
    """Forces by a method of the table."""

    method: str
    settings: Mapping[str, Any] = field(default_factory=dict)

    def __call__(self, layer: Layer, radii: FloatArray) -> FloatArray:
        """Solve radius by radius, so that one refusal costs one number."""
        method = build_guarded(self.method, dict(self.settings))
        return np.array([_force(method, layer, a) for a in radii])


def _force(method: Method, layer: Layer, radius: float) -> float:
    try:
        path = method.solve(_scene(layer, [radius]))
    except BrokenMethodError:
        raise
    except ContactError:
        return float("nan")
    return float(path.normal_force[-1]) if isinstance(path, ContactPath) else float("nan")


@dataclass(frozen=True)
class MostFriction:
    """The largest force that dry friction allows, from the radial displacement u_r1 under the frictionless punch."""

    coefficient: float

    def __call__(self, layer: Layer, radii: FloatArray) -> FloatArray:
        """F_0/(1 - mu max |u_r1|); NaN where the bound is infinite."""
        from bem.layer_equation.stick.frictionless_slip import frictionless_punch  # noqa: PLC0415 - used here only

        ratios = radii / layer.thickness
        punches = [frictionless_punch(float(x), layer.support, layer.poissons_ratio) for x in ratios]
        slip = self.coefficient * np.array([punch.largest() for punch in punches])
        expected = np.asarray(build_guarded("mdr", {}).solve(_scene(layer, radii)).normal_force)  # type: ignore[attr-defined]
        return np.asarray(np.divide(expected, 1.0 - slip, out=np.full_like(slip, np.nan), where=slip < 1.0))


FRICTION: Final = tuple(
    MapPlan(
        name=f"friction {mu:g}",
        title=f"Friction of {mu:g} left out: at most",
        answer=MostFriction(mu),
        ratios=FEW_RATIOS,
        rows=FEW_ROWS,
    )
    for mu in (0.1, 0.3)
)
FORMULAS: Final = (
    MapPlan(name="half-space", title="Half-space (Hertz)", answer=half_space_force),
    MapPlan(name="thin layer", title="Thin layer: bed, at nu = 0.5 film", answer=thin_layer_force),
)
METHODS: Final = tuple(
    MapPlan(
        name=method,
        title=title,
        answer=Solved(method, settings),
        ratios=FEW_RATIOS,
        rows=FEW_ROWS,
    )
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


def _as_it_comes(method: str) -> MapPlan:
    return MapPlan(name=method, title=method, answer=Solved(method), ratios=FEW_RATIOS, rows=FEW_ROWS)


def map_case(plans: Iterable[MapPlan] = (*FORMULAS, *FRICTION, *METHODS), progress: Say = silent) -> CaseResult:
    """Draw up the maps; ``progress`` is told of each."""
    return study_case(
        NAME,
        "Where closed forms and methods are good",
        "Over which a/h and Poisson's ratios is each formula right to one percent, and what do methods leave?",
        TEXT,
        equations=("Eq. (17)", "Eq. (20)", "Eq. (22)"),
        maps=tuple(told(map(_map, plans), summary, progress)),
    )


def _map(plan: MapPlan) -> ErrorMap:
    return ErrorMap(
        name=plan.name,
        title=plan.title,
        quantity="normal_force",
        reference="the fast method (24 nodes)",
        ratios=plan.ratios,
        rows=plan.rows,
        errors=tuple(_row(plan, row) for row in plan.rows),
    )


def _row(plan: MapPlan, row: str) -> tuple[float | None, ...]:
    layer, radii = _layer(row), np.array(plan.ratios)
    expected = np.asarray(build_guarded("mdr", {}).solve(_scene(layer, radii)).normal_force)  # type: ignore[attr-defined]
    errors = plan.answer(layer, radii) / expected - 1.0
    return tuple(float(error) if np.isfinite(error) else None for error in errors)


def summary(found: ErrorMap) -> str:
    """One line: the largest error, and the range that is good to one percent for the incompressible bonded layer."""
    known = [abs(error) for row in found.errors for error in row if error is not None]
    good = found.good_range("0.5")
    words = "nowhere good to 1 %" if good is None else f"good to 1 % for a/h in [{good[0]:.3g}, {good[1]:.3g}]"
    return f"{found.title}: errors up to {max(known, default=0.0):.1e}; bonded nu = 0.5 {words}"


def _layer(row: str) -> Layer:
    if row == UNBONDED:
        return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="unbonded")
    return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=float(row), support="bonded")


def _indenter(layer: Layer) -> Paraboloid:
    return Paraboloid(radius_of_curvature=_CURVATURE * layer.thickness)


def _scene(layer: Layer, radii: Sequence[float] | FloatArray) -> Scene:
    return Scene(layer=layer, indenter=_indenter(layer), loading=ContactRadii(values=np.asarray(radii)))
