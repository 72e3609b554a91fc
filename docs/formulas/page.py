"""The page of formulas, `docs/formulas.md`: ``python -m docs.formulas.page`` writes it anew."""

from collections.abc import Callable, Iterable, Iterator
from pathlib import Path

import numpy as np

from contact.records.validation import FloatArray
from docs.formulas import audit, cone, paraboloid, punch
from docs.formulas.audit import RATIOS, SHOWN, reference
from docs.formulas.table import FORMULAS, PublishedFormula

PLACE = Path(__file__).parents[1] / "formulas.md"
SHARES = (0.01, 0.05, 0.2)
# Errors beyond this are no use to anybody and are shown as such.
USELESS = 10.0
LAYERS = (("bonded", 0.0), ("bonded", 0.3), ("bonded", 0.45), ("bonded", 0.49), ("bonded", 0.5), ("unbonded", 0.3))
AT = [int(np.argmin(np.abs(RATIOS - ratio))) for ratio in SHOWN]

HEAD = """# Formulas in circulation, and where they are valid

Written by `python -m docs.formulas.page`; the formulas are plain functions in `docs/formulas/`.
The reference is MDR. It agrees with the same integral equation in extended precision to 1e-9 and with finite elements
to 3e-6. The model is linear, frictionless and axisymmetric, as the formulas assume. Variables:
x = sqrt(R delta)/h for a paraboloid, delta tan(alpha)/h for a cone of half angle alpha, t = a/h for a flat punch.
A formula is judged at the Poisson's ratios that it claims.

**Where the numbers come from.** No original paper was available in full. The column "checked against" names the
source used in its place. Public programs that cite the papers (AtomicJ; Python programs for force curves; a script
for Long; an R package and a Python program for Hayes' table) were compared digit by digit. Where several have a
number, they agree. AtomicJ is by the author of Hermanowicz 2021, whose abstract claims validity for any thickness.
Hertz, the cone and Clifford are those of nanite 4.2.3. Of Dimitriadis, of Gavara and Chadwick, and of Lin, Hui and
Conway only abstracts were found, without numbers. Limits of thick and thin layers are tests with MDR. The numbers of
the fit of Lin, Hui and Conway and the ranges of Dimitriadis, Garcia, Gavara and Managuli are quoted from memory. The
statements below are about these numbers. They apply to the authors' own formulas as far as the programs copied them
without error.

- **Error of the force**: formula over exact force at the same depth, minus one.
- **Error of the modulus**: Young's modulus that least squares find in an exact force curve from zero to the depth that
  belongs to a/h (points equally far apart in depth, contact point known), over the true one, minus one.
- **Valid to**: a/h up to which the error of the force is below the percentage; for limits of thin layers, a/h from
  which on. For paraboloids delta R/h^2 follows in brackets. We tested a/h from 0.005 to 20.
"""

LAST = """
## The compact fit

`docs/formulas/compact.py` gives `punch_factor(a/h, nu, support)`, that is k_N/(2 E* a), and
`paraboloid_factor(sqrt(R delta)/h, nu, support)`, that is F over Hertz's force, for a/h up to 10, any nu from 0 to 1/2
and both supports: half-space and thin layer, added, times the exponential of a polynomial. `fit_compact` makes the
coefficients (`compact.toml`). On random points outside the fitted ones the error is below 0.1 %
(`tests/examples/test_formulas.py` checks 10 000).
"""


def page() -> str:
    """Return the whole page."""
    parts = [HEAD, "\n## Where each is valid\n", _holding(), "\n## Error of the force\n", _errors(audit.force_errors)]
    parts += ["\n## Error of the fitted modulus\n", _errors(audit.modulus_errors), "\n## Remarks\n", *_facts()]
    parts += ["\n## Correct values\n", _values(), LAST]
    return "".join(parts)


def _table(heads: Iterable[str], rows: Iterable[Iterable[str]]) -> str:
    heads = tuple(heads)
    lines = [heads, ("---",) * len(heads), *map(tuple, rows)]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _holding() -> str:
    heads = (
        "formula",
        "layer",
        "source",
        "checked against",
        "claimed for",
        *(f"valid to {100 * share:g} %" for share in SHARES),
    )
    return _table(heads, (_held(formula, nu) for formula in FORMULAS for nu in formula.poissons_ratios))


def _held(formula: PublishedFormula, nu: float) -> Iterator[str]:
    cells = (formula.source, formula.checked, formula.claim)
    cells = cells if nu == formula.poissons_ratios[0] else ("",) * 3
    yield from (formula.name, f"{formula.support}, nu = {nu:g}", *cells)
    for share in SHARES:
        yield _range(formula, nu, audit.holds_to(formula, nu, share))


def _range(formula: PublishedFormula, nu: float, limit: float) -> str:
    if formula.thin:
        return f"from {_place(formula, nu, limit)}" if np.isfinite(limit) else "nowhere"
    if limit == 0.0:
        return "nowhere"
    return f"to {_place(formula, nu, limit)}" if np.isfinite(limit) else "everywhere"


def _place(formula: PublishedFormula, nu: float, limit: float) -> str:
    """a/h, and for a paraboloid delta R/h^2 in brackets."""
    if formula.shape != "paraboloid":
        return f"{limit:.2g}"
    x = reference(formula.shape, formula.support, nu).variable[int(np.argmin(np.abs(RATIOS - limit)))]
    return f"{limit:.2g} ({x**2:.2g})"


def _errors(errors: Callable[[PublishedFormula, float], FloatArray]) -> str:
    heads = ("formula", "nu", *(f"a/h = {ratio:g}" for ratio in SHOWN))
    judged = ((formula, nu) for formula in FORMULAS for nu in formula.poissons_ratios)
    return _table(heads, ((one.name, f"{nu:g}", *map(_per_cent, errors(one, nu)[AT])) for one, nu in judged))


def _per_cent(error: float) -> str:
    if not np.isfinite(error):
        return ""
    return f"{100 * error:+.2g} %" if abs(error) < USELESS else f"over {100 * USELESS:g} %"


def _facts() -> Iterator[str]:
    """Facts about formulas, each with the number that shows it."""
    one = np.array([1.0])
    printed, general = paraboloid.dimitriadis_bonded(one, 0.5)[0], paraboloid.dimitriadis_bonded_any_nu(one, 0.5)[0]
    yield (
        f"- The bonded series of Dimitriadis at nu = 1/2 ends in +0.0975 x^4; the general one gives -0.0975 x^4 there: "
        f"{printed:.3f} and {general:.3f} at x = 1. With either sign the series is below the exact force up to "
        f"a/h = 2.\n"
    )
    loose = [paraboloid.dimitriadis_not_bonded_any_nu(one, nu)[0] for nu in (0.3, 0.5)]
    yield (
        "- A layer on a frictionless base has one curve for every nu when forces are divided by E*. The not bonded "
        f"series of Dimitriadis has not: {loose[0]:.3f} at nu = 0.3 and {loose[1]:.3f} at nu = 1/2, x = 1. Its first "
        "coefficient is 0.884; the exact one is 0.743.\n"
    )
    yield (
        "- The cone of Gavara and Chadwick as three public programs have it has a first coefficient of "
        f"{2 * cone.BONDED / np.pi**2:.4f} and a second of {16 * cone.BONDED**2:.1f}; Garcia's and Managuli's are "
        f"0.721 and 0.650, twice the first, and {16 * cone.BONDED**2 / np.pi**4:.3f} is left of the second when it is "
        "divided by pi^4.\n"
    )
    wrong, right = (_shown("Hayes, column in circulation as nu = 0.5", nu, 1.0) for nu in (0.5, 0.48))
    yield (
        "- A column of Hayes' table in circulation under nu = 0.5 belongs to nu = 0.48: at a/h = 1 it is "
        f"{wrong} off for the one and {right} for the other.\n"
    )
    low, high = (_shown("Hayes 1972, quadratics", nu, 0.05) for nu in (0.3, 0.5))
    astray, own = (_shown("Hayes 1972, quadratics", nu, 2.0) for nu in (0.49, 0.5))
    yield (
        "- The quadratics fitted to Hayes' table for spheres end at 0.629 (nu = 0.3) and 0.688 (nu = 1/2) where a "
        f"half-space has 2/3: at a/h = 0.05 the force is {low} and {high} off. A Poisson's ratio that is none of the "
        f"five tabulated ones falls through to the numbers of nu = 1/2: nu = 0.49 is {astray} off at a/h = 2, nu = 1/2 "
        f"{own}.\n"
    )
    yield from _facts_of_limits()


def _facts_of_limits() -> Iterator[str]:
    """Where formulas end, and how slowly limits are approached."""
    negative = float(RATIOS[np.flatnonzero(punch.garcia(RATIOS, 0.5) < 0)[0]])
    yield f"- Garcia's punch ends in -0.291 t^4: its force turns negative near a/h = {negative:.2g}.\n"
    yield (
        "- The bed of springs for thin bonded layers divides by 1 - 2 nu: it has no value at nu = 1/2, and at "
        f"nu = 0.49 it is {_shown('thin layer, bed of springs (Johnson 1985)', 0.49, 10.0)} off "
        "at a/h = 10.\n"
    )
    yield (
        "- The thin incompressible layer is approached slowly: the force on a paraboloid is "
        f"{_shown('thin incompressible layer (Chadwick 2002)', 0.5, 10.0)} off at "
        "a/h = 10, the stiffness of a punch "
        f"{_shown('thin incompressible layer, punch', 0.5, 10.0)}.\n"
    )
    yield (
        "- Hayes' column for nu = 1/2 drifts below the exact stiffness with growing a/h: "
        f"{_shown('Hayes 1972, spline of the table', 0.5, 5.0)} at a/h = 5.\n"
    )
    yield (
        "- The fit of Lin, Hui and Conway, used for adhesive punches, overshoots beyond a/h = 1: "
        f"{_shown('Lin, Hui, Conway 2000; Shull 2002', 0.5, 2.0)} at a/h = 2.\n"
    )


def _shown(name: str, nu: float, ratio: float) -> str:
    """The error of the force of a formula at one a/h."""
    formula = next(formula for formula in FORMULAS if formula.name == name)
    return _per_cent(audit.force_errors(formula, nu)[AT[SHOWN.index(ratio)]])


def _values() -> str:
    """Numbers to compare with: stiffness of a punch; depth and force of a paraboloid; force of a cone."""
    heads = ("layer", "a/h", "k_N/(2 E* a)", "delta R/h^2", "F R/(E* h^3)", "cone: F over Sneddon's")
    rows = []
    for support, nu in LAYERS:
        stiffness, round_one, pointed = (
            reference(shape, support, nu) for shape in ("flat punch", "paraboloid", "cone")
        )
        for i in AT[1:]:
            depth, force = round_one.variable[i] ** 2, round_one.factor[i] * round_one.weight[i]
            numbers = (stiffness.factor[i], depth, force, pointed.factor[i])
            layer = support if support == "unbonded" else f"bonded, nu = {nu:g}"
            rows.append((layer, f"{RATIOS[i]:g}", *(f"{number:.7g}" for number in numbers)))
    return _table(heads, rows)


def main() -> None:
    """Write the page."""
    PLACE.write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main()
