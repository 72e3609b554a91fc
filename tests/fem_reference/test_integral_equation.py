"""The oracle itself, against the published values."""

from __future__ import annotations

import pytest

from tests.fem_reference.integral_equation import solve_contact, truncated_cone

# flat punch: k_N / (2 E* a), from the Abel-density equation solved to 1e-12
STIFFNESS = {
    ("bonded", 0.3): (1.20655824090, 2.48352462914, 4.35324429030),
    ("bonded", 0.4): (1.23225336443, 2.79376800243, 5.29854688001),
    ("bonded", 0.45): (1.25233991738, 3.09140806745, 6.42058801854),
    ("bonded", 0.5): (1.28063660581, 3.61873584896, 9.14945045204),
    # a/h = 1: the source prints ...617; 16 to 68 panels of the wavenumber rule all give ...567
    ("unbonded", 0.3): (1.17102775645, 2.19862136567, 3.72760647995),
}
# truncated cone b = a/2, nu = 1/2 bonded: delta / (a tan), F / (E* a^2 tan), to the printed digits
CONE = {0.1: (0.964788, 1.481398), 1: (0.556930, 2.096970), 5: (0.333939, 15.328170)}


@pytest.mark.parametrize(("support", "nu"), STIFFNESS)
def test_flat_punch(support, nu):
    computed = [solve_contact(a, support, nu).stiffness / (2 * a) for a in (0.2, 1.0, 2.0)]
    assert computed == pytest.approx(STIFFNESS[support, nu], abs=6e-12)


def test_stiffness_slope_is_the_derivative():
    step = 1e-3
    difference = (solve_contact(1 + step).stiffness - solve_contact(1 - step).stiffness) / (2 * step)
    assert solve_contact(1.0).stiffness_slope == pytest.approx(difference, rel=1e-6, abs=0.0)


@pytest.mark.parametrize("a", CONE)
def test_truncated_cone(a):
    contact = solve_contact(a, "bonded", 0.5, truncated_cone(a / 2), a / 2)
    assert (contact.depth / a, contact.force / a**2) == pytest.approx(CONE[a], abs=1e-6)
