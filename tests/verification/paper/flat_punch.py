"""Sections 2.1, 3.1 and 3.2: kernel, stiffness and pressure of the flat punch, and their limits."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from cases.library._common import HAYES
from cases.library.flat_punch_stiffness import HAYES_RATIOS
from contact import Layer
from docs.gallery._parts import UNBONDED, layer, name_of, punch
from docs.gallery.figure_03 import thin_layer_stiffness
from docs.gallery.figure_04 import second_maximum
from docs.gallery.figure_05 import exponent
from tests.layer_kernel import compliance_kernel
from tests.verification.paper.statement import GOOD, SAME, Statement, above, deviation, reads, within

LAYERS = (UNBONDED, *(layer(nu) for nu in (0.0, 0.3, 0.4, 0.45, 0.5)))
NEAREST = 1e-3


def stiffness(one: Layer, ratio: float) -> float:
    """kbar."""
    return float(punch(one).normalized_contact_stiffness(np.array(ratio)))


def off_half_space(one: Layer, ratio: float) -> float:
    """Stiffness over that of the half-space."""
    return deviation(stiffness(one, ratio), 1.0)


def off_thin_layer(one: Layer, ratio: float) -> float:
    """The thin layer's stiffness over the exact one."""
    return deviation(float(thin_layer_stiffness(one, np.array(ratio))), stiffness(one, ratio))


def unbonded_over_bonded(ratio: float) -> float:
    """Unbonded stiffness over that of the bonded layer with nu = 0."""
    return deviation(stiffness(UNBONDED, ratio), stiffness(layer(0.0), ratio))


def kernel_limit(support: str, nu: float, q: float, limit: float) -> float:
    """chi over its limit."""
    value = float(compliance_kernel(q, "unbonded" if support == "unbonded" else "bonded", nu))
    return deviation(value, limit)


def exponent_at(one: Layer, ratio: float) -> float:
    """m of Eq. (34)."""
    return float(exponent(one, np.array([ratio]))[0][0])


def hayes(label: str) -> float:
    """Largest deviation of the table that Fig. 3 shows."""
    data = punch(layer(float(label.removeprefix("bonded nu="))))
    ours = data.normalized_contact_stiffness(np.array(HAYES_RATIOS))
    off = np.array([HAYES[label][ratio] for ratio in HAYES_RATIOS]) / ours - 1
    return float(off[np.argmax(abs(off))])


def pressure(ratio: float, place: float) -> float:
    """p/p_mean of a flat punch on the bonded incompressible layer; the smooth factor at the edge itself."""
    root = np.sqrt(1 - place**2) if place < 1 else 1.0
    return float(punch(layer(0.5)).smooth_pressure(np.array([place]), np.array([ratio]))[0]) / root


def growth(one: Layer) -> float:
    """Smallest change of ln kbar per change of ln(a/h) on 400 ratios from 0.001 to 100."""
    ratios = np.geomspace(1e-3, 100.0, 400)
    values = punch(one).normalized_contact_stiffness(ratios)
    return float(np.min(np.diff(np.log(values)) / np.diff(np.log(ratios))))


def statements() -> Iterator[Statement]:
    """The statements of these sections."""
    yield from kernel_limits()
    yield from limits_of_stiffness()
    yield from growth_of_stiffness()
    yield from shape_of_the_pressure()


def kernel_limits() -> Iterator[Statement]:
    """The kernel between thin layer and half-space."""
    for support, nu, limit in (
        ("unbonded", 0.3, 5e-4),
        ("bonded", 0.3, 4e-4 / (2 * 0.49)),
        ("bonded", 0.45, 1e-4 / (2 * 0.55**2)),
        ("bonded", 0.5, 2e-9 / 3),
    ):
        yield Statement(
            f"{support}, nu = {nu:g}: the kernel leads to the thin layer of Section 2.1",
            partial(kernel_limit, support, nu, NEAREST, limit),
            within(2e-3),
        )
        yield Statement(
            f"{support}, nu = {nu:g}: the kernel leads to the half-space",
            partial(kernel_limit, support, nu, 20.0, 1.0),
            within(1e-12),
        )


def limits_of_stiffness() -> Iterator[Statement]:
    """Where half-space and thin layer are good approximations."""
    for one in LAYERS:
        yield Statement(
            f"{name_of(one)}: for a/h < 0.1 the half-space is a good approximation",
            partial(off_half_space, one, 0.1),
            within(GOOD),
        )
    for one in LAYERS:
        yield Statement(
            f"{name_of(one)}: for a/h > 50 the thin layer is a good approximation",
            partial(off_thin_layer, one, 50.0),
            within(GOOD),
        )
    yield Statement(
        "bonded (nearly) incompressible layers approach slower",
        partial(off_thin_layer, layer(0.5), 100.0),
        lambda value: abs(value) > 0.02,
    )
    for ratio in (0.1, 0.2, 0.5, 1.0, 2.0, 5.0):
        yield Statement(
            f"a/h = {ratio:g}: unbonded and bonded with nu = 0 give almost the same",
            partial(unbonded_over_bonded, ratio),
            within(SAME),
        )


def growth_of_stiffness() -> Iterator[Statement]:
    """Stiffness against confinement, other authors and its exponent."""
    for one in (UNBONDED, layer(0.3), layer(0.5)):
        yield Statement(
            f"{name_of(one)}: the stiffness increases with the confinement",
            partial(growth, one),
            lambda value: value > 0,
        )
    for label in HAYES:
        yield Statement(
            f"{label}: agreement with Hayes et al. (1972) is very good", partial(hayes, label), within(0.01)
        )
    for one, ratio, m in (
        (UNBONDED, 0.01, 0.0),
        (UNBONDED, 100.0, 1.0),
        (layer(0.3), 100.0, 1.0),
        (layer(0.5), 100.0, 3.0),
    ):
        yield Statement(
            f"{name_of(one)}: m tends to {m:g} {'on thick' if m == 0 else 'on thin'} layers",
            partial(exponent_at, one, ratio),
            reads(m, GOOD * max(m, 1)),
        )


def shape_of_the_pressure() -> Iterator[Statement]:
    """Middle and edge of the pressure."""
    for low, high in ((0.5, 1.0), (1.0, 2.0), (2.0, 5.0)):
        yield Statement(
            f"the pressure in the middle grows from a/h = {low:g} to {high:g}",
            partial(pressure, high, 0.0),
            above(partial(pressure, low, 0.0)),
        )
    yield Statement(
        "in very confined situations the singularity at the edge disappears",
        partial(pressure, 50.0, 1.0),
        lambda value: value < GOOD / 2,
    )
    yield Statement("the second maximum in the centre develops for a/h >= 2", second_maximum, lambda value: value >= 2)
