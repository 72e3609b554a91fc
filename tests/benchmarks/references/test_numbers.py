"""Reference numbers are computed again on other nodes: what is written is what the formulas give, to its digits."""

import tomllib

import pytest
from mpmath import mp, mpf

from benchmarks.references.layer_equation import DIGITS, chi, first_order, gauss, stiffness, truncated_cone
from benchmarks.references.sphere_impact import SphereSprings, impact
from benchmarks.references.table import PLACE, computed, entries

TEXT = PLACE.read_text(encoding="utf-8")
WRITTEN = tomllib.loads(TEXT, parse_float=mpf)
ENTRIES = {f"{entry.kind}: {entry.name}": entry for entry in entries()}
QUICK = ("stiffness: bonded nu=0.5 a/h=1", "truncated_cone: unbonded a/h=1", "first_order: bonded nu=0.3")


def digits_agree(entry, more):
    """Whether a number computed on more nodes is the written one to its digits."""
    with mp.workdps(DIGITS):
        again, written = computed(entry, more), WRITTEN[entry.kind][entry.name]
        worst = max(abs(new / old - 1) for new, old in zip(again, written, strict=True))
    return worst < mpf(10) ** -entry.digits


def test_every_number_is_written_once_and_none_is_left_over():
    assert {f"{kind}: {name}" for kind, names in WRITTEN.items() for name in names} == set(ENTRIES)


@pytest.mark.first(1)
@pytest.mark.parametrize("name", QUICK)
def test_some_numbers_are_computed_again_on_more_nodes(name):
    assert digits_agree(ENTRIES[name], 2)


@pytest.mark.slow
@pytest.mark.parametrize("name", ENTRIES)
def test_all_numbers_are_computed_again_on_more_nodes(name):
    assert digits_agree(ENTRIES[name], 4)


def test_gauss_integrates_polynomials_of_twice_the_degree():
    with mp.workdps(30):
        nodes, weights = gauss(mpf(0), mpf(2), 6)
        assert abs(mp.fsum(w * x**11 for x, w in zip(nodes, weights, strict=True)) / (mpf(2) ** 12 / 12) - 1) < 1e-28


def test_kernel_has_the_limits_of_thin_and_thick_layers():
    with mp.workdps(40):
        q, nu = mpf("1e-6"), mpf("0.3")
        assert abs(chi(q, None) / (q / 2) - 1) < 1e-10
        assert abs(chi(q, nu) / (q * (1 - 2 * nu) / (2 * (1 - nu) ** 2)) - 1) < 1e-10
        assert abs(chi(q, mpf("0.5")) / (2 * q**3 / 3) - 1) < 1e-10
        assert abs(chi(mpf(30), nu) - 1) < 1e-20


def test_a_thick_layer_is_the_half_space_to_first_order():
    with mp.workdps(DIGITS):
        ratio = mpf("0.001")
        assert abs((stiffness(str(ratio), "0.5", 6) - 1) / ratio / first_order("0.5") - 1) < 2e-3


def test_a_cone_on_a_thick_layer_is_sneddon_s():
    with mp.workdps(DIGITS):
        depth, force = truncated_cone("0.001", None, 10)
        assert abs(depth / (mp.pi / 3) - 1) < 1e-3
        assert abs(force / (mp.pi / 3 + mp.sqrt(3) / 4) - 1) < 1e-3


@pytest.mark.slow
def test_the_time_steps_of_an_impact_converge():
    with mp.workdps(20):
        coarse, fine, finest = (impact(SphereSprings(), steps).restitution for steps in (50, 100, 200))
    assert abs(finest - fine) < abs(fine - coarse) / 4


def test_a_wrong_kernel_is_seen(monkeypatch):
    """kappa = 3 - 2 nu in place of 3 - 4 nu."""
    from benchmarks.references import layer_equation

    right = layer_equation.chi
    monkeypatch.setattr(layer_equation, "chi", lambda q, nu: right(q, None if nu is None else nu / 2))
    assert not digits_agree(ENTRIES["stiffness: bonded nu=0.3 a/h=1"], 0)
