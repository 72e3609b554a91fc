"""Do the error bars of finite elements hold? Coverage and overestimate of every quantity over random scenes.

Prescribed contacts are compared with an integral equation of their own, impacts with springs (MDR), which are exact to
1e-9 there.  Run ``python -m benchmarks.fem_error_bars``; it takes some minutes.
"""

from __future__ import annotations

import sys
from collections.abc import Mapping
from itertools import chain

import numpy as np

from bem.layer_equation.flat_punch_source import IntegralEquation
from benchmarks.fem_impacts import SCALARS, largest_difference
from contact import (
    Cone,
    FlatPunch,
    Impact,
    ImpactHistory,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
    StageLog,
    TruncatedCone,
)
from fem_reference import Fem
from fem_reference.discrete_layer.indenter import ScaledIndenter
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.error_estimate import ContactWithErrors, solve_contact_with_errors
from mdr.impact.solver import solve_impact
from tests.fem_reference.integral_equation import solve_contact, truncated_cone

Ratios = dict[str, list[float]]

CHANNELS = ("indentation_depth", "velocity", "normal_force", "contact_radius", "kinetic_energy")


def random_contact(rng: np.random.Generator) -> tuple[ContactWithErrors, dict[str, float]]:
    """A prescribed contact and its true relative errors."""
    a = float(np.exp(rng.uniform(np.log(0.05), np.log(20))))
    nu = float(rng.choice([0, 0.2, 0.3, 0.45, 0.49, 0.5]))
    support = "unbonded" if rng.random() < 0.3 else "bonded"
    b = float(rng.uniform(0.2, 0.9)) * a
    settings = Discretisation(
        order=int(rng.choice([2, 3, 4], p=[0.25, 0.25, 0.5])),
        growth=float(rng.choice([0.4, 0.5, 0.7, 1.0])),
        edge_cell=float(10 ** rng.uniform(-7, -3)),
        truncation=float(10 ** rng.uniform(-9, -4)),
    )
    profile, exact = [
        (FlatPunch(radius=a), solve_contact(a, support, nu)),
        (Paraboloid(radius_of_curvature=1.0), solve_contact(a, support, nu)),
        (TruncatedCone(flat_radius=b, slope=1.0), solve_contact(a, support, nu, truncated_cone(b), b)),
    ][rng.integers(3)]
    layer = Layer(thickness=1.0, youngs_modulus=1 - nu**2, poissons_ratio=nu, support=support)
    contact = solve_contact_with_errors(layer, ScaledIndenter(profile, a), settings, "superlu", StageLog())
    answer = contact.answer
    errors = {
        "stiffness": answer.stiffness * a / exact.stiffness - 1,
        "stiffness_slope": answer.stiffness_slope / exact.stiffness_slope - 1,
    }
    if not isinstance(profile, FlatPunch):
        errors["smooth_depth"] = answer.smooth_depth * a / exact.depth - 1
        errors["smooth_force"] = answer.smooth_force * a**2 / exact.force - 1
    return contact, errors


def contacts(count: int, seed: int) -> Ratios:
    """Stated over true error of every quantity of so many prescribed contacts."""
    rng = np.random.default_rng(seed)
    ratios: Ratios = {}
    for _ in range(count):
        contact, errors = random_contact(rng)
        for name, error in errors.items():
            ratios.setdefault(name, []).append(contact.error[name] / abs(error))
    return ratios


def random_impact(rng: np.random.Generator) -> tuple[Scene, Fem]:
    """A body that loads its layer to some a/h between 0.2 and 4, and settings."""
    h, modulus = 1e-3, 1e6
    indenter = [
        Paraboloid(radius_of_curvature=1e-2),
        Cone(slope=0.1),
        TruncatedCone(flat_radius=float(rng.uniform(0.1, 1)) * h, slope=0.1),
        FlatPunch(radius=float(rng.uniform(0.3, 3)) * h),
    ][rng.integers(4)]
    speed = 0.1
    depth = float(rng.uniform(0.02, 0.15)) * h
    mass = float(modulus * h * depth**2 / speed**2 * rng.uniform(1, 20))
    share, time = float(rng.uniform(0.1, 0.9)), float(depth / speed * 10 ** rng.uniform(-1, 1))
    model = PronySeries(
        long_term_shear_modulus=share * modulus, shear_moduli=[(1 - share) * modulus], relaxation_times=[time]
    )
    layer = Layer.incompressible(
        thickness=h, shear_modulus=modulus, support="unbonded" if rng.random() < 0.3 else "bonded"
    )
    scene = Scene(layer=layer, indenter=indenter, loading=Impact(mass=mass, velocity=speed), effects=(model,))
    return scene, Fem(growth=float(rng.choice([0.4, 0.6, 1.0])), edge_cell=1e-7, truncation=1e-8)


def impacts(count: int, seed: int) -> Ratios:
    """Stated over true error of every quantity of so many impacts; exact quantities are left out."""
    rng = np.random.default_rng(seed)
    ratios: Ratios = {}
    for _ in range(count):
        scene, method = random_impact(rng)
        history = method.solve(scene)
        exact = solve_impact(scene, IntegralEquation(), {"accuracy": 1e-10})
        if not (isinstance(history, ImpactHistory) and isinstance(exact, ImpactHistory)):
            raise TypeError("an impact answers with a history")
        for name, error in _history_errors(history, exact).items():
            stated = float(history.error_estimate[name][0])
            if stated > 0:
                ratios.setdefault(name, []).append(stated / error)
    return ratios


def _history_errors(history: ImpactHistory, exact: ImpactHistory) -> dict[str, float]:
    """Relative errors, of channels by their largest value; their last hundredth, where radii end steeply, left out."""
    errors = {name: abs(getattr(history, name) / getattr(exact, name) - 1) for name in SCALARS}
    errors |= {name: largest_difference(name, history, exact, until=0.99) for name in CHANNELS}
    return {name: max(float(error), 1e-15) for name, error in errors.items()}


def table(ratios: Mapping[str, list[float]]) -> str:
    """One line for each quantity: how often covered, median overestimate."""
    lines = [
        f"{name:28} {len(r):5} {100 * np.mean(np.array(r) >= 1):6.1f} % {np.median(r):8.1f}"
        for name, r in [*ratios.items(), ("all", list(chain.from_iterable(ratios.values())))]
    ]
    return "\n".join([f"{'quantity':28} {'count':>5} {'covered':>8} {'median overestimate':>8}", *lines])


def main() -> None:
    """Write both tables."""
    sys.stdout.write(f"220 prescribed contacts\n{table(contacts(220, seed=5))}\n\n")
    sys.stdout.write(f"60 impacts\n{table(impacts(60, seed=7))}\n")


if __name__ == "__main__":
    main()
