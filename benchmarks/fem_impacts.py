"""Impacts of Fig. 12 by finite elements: force history against MDR in full, and the trend with the bulk modulus.

Run ``python -m benchmarks.fem_impacts``; about half a minute.
"""

from __future__ import annotations

import sys

import numpy as np
from scipy.interpolate import CubicSpline

from bem.layer_equation.flat_punch_source import IntegralEquation
from contact import ImpactHistory, Layer, Scene
from fem_reference import Fem
from mdr.impact.solver import solve_impact
from tests.mdr.viscoelastic_scenes import figure_12

# Layer thicknesses of Fig. 12 [m].
THICKNESSES = (np.inf, 3e-3, 2e-3, 1e-3)
POISSONS_RATIOS = (0.3, 0.4, 0.49, 0.4999, 0.5)
CHANNELS = ("normal_force", "indentation_depth", "velocity", "contact_radius")
SCALARS = ("coefficient_of_restitution", "contact_time", "peak_force", "peak_depth", "peak_contact_radius")


def largest_difference(name: str, history: ImpactHistory, exact: ImpactHistory, until: float = 1.0) -> float:
    """Of a channel at the samples of ``history``, by the largest value of the exact one.

    Args:
        name: channel.
        history: what is judged.
        exact: smooth, so that splines between its samples add nothing.
        until: part of the contact time that is compared.
    """
    time, first = np.unique(exact.time, return_index=True)
    common = history.time <= until * exact.time[-1]
    truth = CubicSpline(time, getattr(exact, name)[first])(history.time[common])
    return float(np.abs(getattr(history, name)[common] - truth).max() / np.abs(truth).max())


def impact_of(method: Fem, scene: Scene) -> ImpactHistory:
    """Solve an impact."""
    history = method.solve(scene)
    if not isinstance(history, ImpactHistory):
        raise TypeError("an impact answers with a history")
    return history


def with_poissons_ratio(scene: Scene, poissons_ratio: float) -> Scene:
    """The same shear modulus with a finite bulk modulus."""
    young = 2 * (1 + poissons_ratio) * scene.layer.shear_modulus
    layer = Layer(thickness=scene.layer.thickness, youngs_modulus=young, poissons_ratio=poissons_ratio)
    return scene.replace(layer=layer)


def main() -> None:
    """Write both tables; stated errors in brackets."""
    for thickness in THICKNESSES:
        scene = figure_12(thickness)
        history = impact_of(Fem(), scene)
        exact = solve_impact(scene, IntegralEquation(), {"accuracy": 1e-11})
        sys.stdout.write(
            f"h = {1e3 * thickness:g} mm, {history.cost.cpu_seconds:.2f} s CPU: difference (stated error)\n"
        )
        for name in CHANNELS:
            gap = largest_difference(name, history, exact, 0.99 if name == "contact_radius" else 1.0)
            sys.stdout.write(f"  history of {name:18} {gap:.1e} ({history.error_estimate[name][0]:.1e})\n")
        for name in SCALARS:
            gap = getattr(history, name) / getattr(exact, name) - 1
            sys.stdout.write(f"  {name:29} {gap:+.1e} ({history.error_estimate[name][0]:.1e})\n")
    sys.stdout.write("h = 1 mm, constant bulk modulus\nnu       restitution    peak force [N]\n")
    for nu in POISSONS_RATIOS:
        history = impact_of(Fem(), with_poissons_ratio(figure_12(1e-3), nu))
        values = [
            f"{getattr(history, name):.5f}({history.uncertainty(name)[0]:.0e})"
            for name in ("coefficient_of_restitution", "peak_force")
        ]
        sys.stdout.write(f"{nu:<8} {values[0]:14} {values[1]}\n")


if __name__ == "__main__":
    main()
