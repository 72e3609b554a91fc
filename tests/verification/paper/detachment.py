"""Section 4.2: adhesive detachment of a flat punch."""

from collections.abc import Iterator
from functools import cache, partial

import numpy as np

from contact import DetachmentPath, Layer
from docs.gallery._parts import UNBONDED, layer, name_of
from docs.gallery.figure_08 import detached, elongation, reversals
from tests.verification.paper.statement import Measured, Statement, above, below, reads

HALF_UNIT = 0.005
RATIOS = (0.3, 1.0, 2.0, 4.0)


@cache
def pulled(ratio: float, control: str) -> DetachmentPath:
    """Detachment of a punch of radius one from a bonded incompressible layer of thickness 1/ratio."""
    return detached(layer(0.5).replace(thickness=1 / ratio), 1.0, control)


def first_reversal(one: Layer) -> Measured:
    """a/h of the maximum of Eq. (42)."""
    return Measured(reversals(one)[0][1], 1e-6)


def number_of_reversals(one: Layer) -> Measured:
    """How often the elongation stops to grow or to fall."""
    return Measured(float(len(reversals(one))))


def smallest_growth(one: Layer) -> Measured:
    """Smallest slope of ln(elongation) over ln(a/h), a/h from 0.01 to 100."""
    ratios = np.geomspace(1e-2, 100.0, 400)
    return Measured(float(np.min(np.diff(np.log(elongation(one, ratios))) / np.diff(np.log(ratios)))), 1e-7)


def adhesion_force(ratio: float) -> Measured:
    """Largest tension over that of the half-space."""
    path = pulled(ratio, "force")
    return Measured(
        -path.pull_off_force / 2, abs(path.pull_off_force) / 2 * float(path.error_estimate["normal_force"].max())
    )


def first_depth(ratio: float) -> Measured:
    """Depth at which detachment begins, over that of the half-space."""
    path = pulled(ratio, "displacement")
    start = next(point for point in path.critical_points if point.kind == "start")
    return Measured(-start.indentation_depth, 1e-8)


def last_radius(ratio: float) -> Measured:
    """Contact radius over the thickness where contact is lost at prescribed depth."""
    return Measured(pulled(ratio, "displacement").pull_off_contact_radius * ratio, 1e-6)


def radius_under_load(ratio: float) -> Measured:
    """Contact radius over that of the punch where contact is lost under a load."""
    return Measured(pulled(ratio, "force").pull_off_contact_radius, 1e-9)


def statements() -> Iterator[Statement]:
    """The statements of this section."""
    yield from maxima_of_the_elongation()
    yield from abrupt_and_stable()
    yield from force_of_adhesion()


def maxima_of_the_elongation() -> Iterator[Statement]:
    """Where the critical elongation has a maximum."""
    for nu, printed in ((0.5, 0.46), (0.4, 0.92)):
        yield Statement(
            "Section 4.2, Fig. 8",
            f"nu = {nu:g}: the elongation has its maximum here",
            f"a/h = {printed:g}",
            "a/h of the maximum",
            partial(first_reversal, layer(nu)),
            reads(printed, HALF_UNIT),
        )
    yield Statement(
        "Section 4.2, Fig. 8",
        "nu = 0.45: the maximum lies in this range",
        "a/h = 0.46 to 0.92",
        "a/h of the maximum",
        partial(first_reversal, layer(0.45)),
        lambda value: 0.46 <= value <= 0.92,
    )
    for one in (UNBONDED, layer(0.0), layer(0.3)):
        yield Statement(
            "Section 4.2, Fig. 8",
            f"{name_of(one)}: the elongation grows monotonically with a/h",
            "monotone",
            "smallest slope of ln(elongation) over ln(a/h)",
            partial(smallest_growth, one),
            lambda value: value >= 0,
        )
    for nu in (0.365, 0.38):
        yield Statement(
            "Section 4.2, Fig. 8",
            f"a maximum belongs to nu >= 0.4, none to nu <= 0.3; nu = {nu:g} lies between",
            "nu >= 0.4",
            "changes between growing and falling",
            partial(number_of_reversals, layer(nu)),
            lambda value: value == 0,
        )


def abrupt_and_stable() -> Iterator[Statement]:
    """How contacts are lost."""
    yield Statement(
        "Section 4.2",
        "Webber et al. (2003) found this threshold in experiments, nu = 0.5",
        "a = 0.45 h",
        "a/h of the maximum",
        partial(first_reversal, layer(0.5)),
        reads(0.45, HALF_UNIT),
    )
    yield Statement(
        "Section 4.2",
        "below a* = 0.46 h detachment is abrupt at prescribed depth (a* = 0.3 h)",
        "a = a*",
        "a/h where contact is lost",
        partial(last_radius, 0.3),
        lambda value: abs(value - 0.3) < 1e-6,
    )
    for ratio in RATIOS[1:]:
        yield Statement(
            "Section 4.2, Fig. 9",
            f"a* = {ratio:g} h: the contact shrinks stably at prescribed depth down to this radius",
            "a = 0.46 h",
            "a/h where contact is lost",
            partial(last_radius, ratio),
            reads(0.46, HALF_UNIT),
        )
    for ratio in RATIOS:
        yield Statement(
            "Section 4.2",
            f"a* = {ratio:g} h: under a load detachment is always abrupt",
            "a = a*",
            "contact radius over a* where contact is lost",
            partial(radius_under_load, ratio),
            lambda value: abs(value - 1) < 1e-6,
        )


def force_of_adhesion() -> Iterator[Statement]:
    """The force of adhesion against confinement."""
    for low, high in ((0.3, 1.0), (1.0, 2.0), (2.0, 4.0)):
        yield Statement(
            "Section 4.2, Fig. 9",
            f"the force of adhesion grows from a*/h = {low:g} to {high:g}",
            "increases",
            f"F_A over that of the half-space at a*/h = {high:g}",
            partial(adhesion_force, high),
            above(partial(adhesion_force, low)),
        )
        yield Statement(
            "Section 4.2, Fig. 9",
            f"the depth at which detachment begins falls from a*/h = {low:g} to {high:g}",
            "decreases",
            f"delta_c1 over that of the half-space at a*/h = {high:g}",
            partial(first_depth, high),
            below(partial(first_depth, low)),
        )
