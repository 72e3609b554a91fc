"""Makes the coefficients of `compact`: ``python -m docs.formulas.fit_compact`` writes ``compact.toml``."""

from typing import Any

import numpy as np

from contact import ContactRadii, Layer, Paraboloid, Scene
from contact.records.validation import FloatArray
from docs.formulas.compact import PLACE, base, design
from mdr import Mdr

RATIOS = np.concatenate([np.geomspace(1e-3, 0.05, 8), np.geomspace(0.06, 10.0, 56)])
# Close to nu = 1/2 a layer changes where 1 - 2 nu is about (h/a)^2.
POISSONS_RATIOS = np.concatenate([np.linspace(0.0, 0.4, 13), 0.5 - np.geomspace(0.09, 1e-5, 30), [0.5]])
# Degrees and scales of each fit: the fewest coefficients that were seen to leave less than 0.1 %.  They were chosen by
# hand from more than a hundred combinations (2026-11-22): four forms of the thin layer, scales 0.5, 1 and 2, ``near``
# 0.003, 0.01 to 0.03, and some twenty pairs of degrees from 4 to 8 and 2 to 6.  Others may need fewer.
FITS: dict[str, dict[str, Any]] = {
    "punch, bonded": {"degrees": [6, 6], "scale": 2.0, "near": 0.02},
    "paraboloid, bonded": {"degrees": [8, 6], "scale": 1.0, "near": 0.02},
    "punch, unbonded": {"degrees": [6], "scale": 1.0},
    "paraboloid, unbonded": {"degrees": [6], "scale": 1.0},
}
REWEIGHTED = 40
HEAD = "# Coefficients of the compact fit, made by `python -m docs.formulas.fit_compact`; do not edit.\n"


def exact(nu: float, support: str, ratios: FloatArray = RATIOS) -> dict[str, tuple[FloatArray, FloatArray]]:
    """Return variable and factor by shape, at contact radii over thickness."""
    layer = Layer(
        thickness=1.0,
        youngs_modulus=(1 - nu) * (1 + nu),
        poissons_ratio=nu,
        support="bonded" if support == "bonded" else "unbonded",
    )
    scene = Scene(
        layer=layer,
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=ContactRadii(values=ratios),
        beyond_small_strains=True,
    )
    path = Mdr().solve(scene)
    hertz = 4 / 3 * path.indentation_depth**1.5
    return {
        "punch": (ratios, path.contact_stiffness / (2 * ratios)),
        "paraboloid": (np.sqrt(path.indentation_depth), path.normal_force / hertz),
    }


def fitted(name: str) -> dict[str, Any]:
    """Return one fit with its coefficients: the largest error made small by weights that grow with errors."""
    shape, support = name.split(", ")
    poissons = POISSONS_RATIOS if support == "bonded" else np.array([0.3])
    solved = [exact(float(nu), support)[shape] for nu in poissons]
    x, factor = np.concatenate([one[0] for one in solved]), np.concatenate([one[1] for one in solved])
    nu = np.repeat(poissons, RATIOS.size)
    fit = {**FITS[name], "largest": float(np.max(x / (x + FITS[name]["scale"])))}
    columns, wanted = design(x, nu, support, fit), np.log(factor / base(shape, x, nu, support))
    weights, best = np.ones(x.size), (np.inf, np.zeros(columns.shape[1]))
    for _ in range(REWEIGHTED):
        root = np.sqrt(weights)
        found = np.linalg.lstsq(columns * root[:, None], wanted * root, rcond=None)[0]
        errors = np.abs(columns @ found - wanted)
        best = min(best, (float(errors.max()), found), key=lambda pair: pair[0])
        weights *= errors + 1e-6
        weights /= weights.mean()
    return {**fit, "error": best[0], "coefficients": [float(f"{c:.9g}") for c in best[1]]}


def main() -> None:
    """Write every fit."""
    lines = [HEAD]
    for name in FITS:
        fit = fitted(name)
        lines += [f'\n["{name}"]\n', *(f"{key} = {value}\n" for key, value in fit.items())]
    PLACE.write_text("".join(lines), encoding="utf-8")


if __name__ == "__main__":
    main()
