"""Stability map of flat-punch detachment by finite elements alone: where peeling from a bonded layer is stable.

Run ``python -m benchmarks.fem_stability_map``; about half a minute for each Poisson's ratio.
"""

from __future__ import annotations

import sys

from benchmarks.stability_map import Reversal, reversals
from contact import FlatPunch, IndentationDepths, Layer, Scene, StageLog
from fem_reference import Fem

POISSONS_RATIOS = (0.3, 0.36, 0.365, 0.37, 0.4, 0.42, 0.45, 0.48, 0.49, 0.499, 0.5)
# (a/h, elongation) of the maxima, and the minimum at nu = 0.365, from a separate solution of the integral equation
PUBLISHED = {
    0.365: ((1.91953, None), (5.08912, None)),
    0.37: ((1.613309, 0.458732),),
    0.4: ((0.914054, 0.442014),),
    0.42: ((0.741939, 0.431958),),
    0.45: ((0.600217, 0.417261),),
    0.48: ((0.509380, 0.402391),),
    0.49: ((0.484694, 0.397331),),
    0.499: ((0.464108, 0.392719),),
    0.5: ((0.461904, 0.392203),),
}


def reversals_at(poissons_ratio: float, method: Fem | None = None) -> tuple[Reversal, ...]:
    """Changes of stability on a bonded layer of unit thickness and contact modulus."""
    layer = Layer(thickness=1.0, youngs_modulus=1 - poissons_ratio**2, poissons_ratio=poissons_ratio)
    scene = Scene(
        layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([1.0]), beyond_small_strains=True
    )
    solver = method or Fem(edge_cell=1e-8, truncation=1e-9)
    log = StageLog()
    return reversals(layer, lambda radius: solver.solve_contact(_of_radius(scene, radius), radius, log))


def _of_radius(scene: Scene, radius: float) -> Scene:
    return scene.replace(indenter=FlatPunch(radius=radius))


def main() -> None:
    """One line for each change of stability."""
    sys.stdout.write("nu      a/h               elongation         kind      a/h less published, relative\n")
    for nu in POISSONS_RATIOS:
        found = reversals_at(nu)
        if not found:
            sys.stdout.write(f"{nu:<7} none: detachment is abrupt from every punch with 0.1 < a/h < 12\n")
        for n, place in enumerate(found):
            expected = PUBLISHED.get(nu, ())
            gap = f"{place.ratio / expected[n][0] - 1:+.1e}" if n < len(expected) else ""
            ratio = f"{place.ratio:.6f}({place.ratio_error * place.ratio:.0e})"
            height = f"{place.elongation:.6f}({place.elongation_error * place.elongation:.0e})"
            sys.stdout.write(f"{nu:<7} {ratio:17} {height:18} {place.kind:9} {gap}\n")


if __name__ == "__main__":
    main()
