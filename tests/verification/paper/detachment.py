"""Section 4.2: adhesive detachment of a flat punch."""

from collections.abc import Iterator
from functools import cache, partial

import numpy as np

from contact import DetachmentPath, Layer
from docs.gallery._parts import UNBONDED, layer, name_of
from docs.gallery.figure_08 import detached, elongation, reversals
from tests.verification.paper.statement import Statement, above, below, reads

HALF_UNIT = 0.005
RATIOS = (0.3, 1.0, 2.0, 4.0)


@cache
def pulled(ratio: float, control: str) -> DetachmentPath:
    """Detachment of a punch of radius one from a bonded incompressible layer of thickness 1/ratio."""
    return detached(layer(0.5).replace(thickness=1 / ratio), 1.0, control)


def first_reversal(one: Layer) -> float:
    """a/h of the maximum of Eq. (42)."""
    return reversals(one)[0][1]


def number_of_reversals(one: Layer) -> float:
    """How often the elongation stops to grow or to fall."""
    return float(len(reversals(one)))


def smallest_growth(one: Layer) -> float:
    """Smallest slope of ln(elongation) over ln(a/h), a/h from 0.01 to 100."""
    ratios = np.geomspace(1e-2, 100.0, 400)
    return float(np.min(np.diff(np.log(elongation(one, ratios))) / np.diff(np.log(ratios))))


def adhesion_force(ratio: float) -> float:
    """Largest tension over that of the half-space."""
    path = pulled(ratio, "force")
    return -path.pull_off_force / 2


def first_depth(ratio: float) -> float:
    """Depth at which detachment begins, over that of the half-space."""
    path = pulled(ratio, "displacement")
    start = next(point for point in path.critical_points if point.kind == "start")
    return -start.indentation_depth


def last_radius(ratio: float) -> float:
    """Contact radius over the thickness where contact is lost at prescribed depth."""
    return pulled(ratio, "displacement").pull_off_contact_radius * ratio


def radius_under_load(ratio: float) -> float:
    """Contact radius over that of the punch where contact is lost under a load."""
    return pulled(ratio, "force").pull_off_contact_radius


def statements() -> Iterator[Statement]:
    """The statements of this section."""
    yield from maxima_of_the_elongation()
    yield from abrupt_and_stable()
    yield from force_of_adhesion()


def maxima_of_the_elongation() -> Iterator[Statement]:
    """Where the critical elongation has a maximum."""
    for nu, printed in ((0.5, 0.46), (0.4, 0.92)):
        yield Statement(
            f"nu = {nu:g}: the elongation has its maximum here",
            partial(first_reversal, layer(nu)),
            reads(printed, HALF_UNIT),
        )
    yield Statement(
        "nu = 0.45: the maximum lies in this range",
        partial(first_reversal, layer(0.45)),
        lambda value: 0.46 <= value <= 0.92,
    )
    for one in (UNBONDED, layer(0.0), layer(0.3)):
        yield Statement(
            f"{name_of(one)}: the elongation grows monotonically with a/h",
            partial(smallest_growth, one),
            lambda value: value >= 0,
        )
    for nu in (0.365, 0.38):
        yield Statement(
            f"a maximum belongs to nu >= 0.4, none to nu <= 0.3; nu = {nu:g} lies between",
            partial(number_of_reversals, layer(nu)),
            lambda value: value == 0,
        )


def abrupt_and_stable() -> Iterator[Statement]:
    """How contacts are lost."""
    yield Statement(
        "Webber et al. (2003) found this threshold in experiments, nu = 0.5",
        partial(first_reversal, layer(0.5)),
        reads(0.45, HALF_UNIT),
    )
    yield Statement(
        "below a* = 0.46 h detachment is abrupt at prescribed depth (a* = 0.3 h)",
        partial(last_radius, 0.3),
        lambda value: abs(value - 0.3) < 1e-6,
    )
    for ratio in RATIOS[1:]:
        yield Statement(
            f"a* = {ratio:g} h: the contact shrinks stably at prescribed depth down to this radius",
            partial(last_radius, ratio),
            reads(0.46, HALF_UNIT),
        )
    for ratio in RATIOS:
        yield Statement(
            f"a* = {ratio:g} h: under a load detachment is always abrupt",
            partial(radius_under_load, ratio),
            lambda value: abs(value - 1) < 1e-6,
        )


def force_of_adhesion() -> Iterator[Statement]:
    """The force of adhesion against confinement."""
    for low, high in ((0.3, 1.0), (1.0, 2.0), (2.0, 4.0)):
        yield Statement(
            f"the force of adhesion grows from a*/h = {low:g} to {high:g}",
            partial(adhesion_force, high),
            above(partial(adhesion_force, low)),
        )
        yield Statement(
            f"the depth at which detachment begins falls from a*/h = {low:g} to {high:g}",
            partial(first_depth, high),
            below(partial(first_depth, low)),
        )
