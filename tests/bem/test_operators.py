import numpy as np
import pytest
from scipy.special import ellipe, ellipk

from bem.grid.influence import layer_influence
from bem.grid.operators import FreeSpaceOperator, PeriodicOperator
from contact import InvalidInput, Layer

RANDOM = np.random.default_rng(7)
HALF_SPACE = Layer.half_space(youngs_modulus=2.0, poissons_ratio=0.25)


def layer(support="bonded", nu=0.3, thickness=1.0):
    return Layer(thickness=thickness, youngs_modulus=1.0, poissons_ratio=nu, support=support)


def centres(cells, cell_size):
    return cell_size * (np.arange(cells) - (cells - 1) / 2)


@pytest.mark.parametrize(("support", "nu"), [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3)])
def test_sinusoidal_load_has_its_closed_form(support, nu):
    # Eq. (32): u = 2 chi(kh)/(k E*) p, chi as printed in Eqs. (29), (31)
    cells, box, h = 32, 4.0, 0.7
    k = 2.0 * np.pi * 3 / box
    x = centres(cells, box / cells)
    load = np.cos(k * x)[:, None] * np.ones(cells)
    q, kappa = k * h, 3.0 - 4.0 * nu
    chi = (
        2.0 * np.sinh(q) ** 2 / (2.0 * q + np.sinh(2.0 * q))
        if support == "unbonded"
        else (2 * kappa * np.sinh(2 * q) - 4 * q) / (1 + 4 * q**2 + kappa**2 + 2 * kappa * np.cosh(2 * q))
    )
    answer = PeriodicOperator(layer(support, nu, h), cell_size=box / cells, cells=cells).displacement(load)
    np.testing.assert_allclose(answer, 2.0 * chi * (1.0 - nu**2) / k * load, atol=1e-14)


@pytest.mark.parametrize(("support", "nu", "compliance"), [("unbonded", 0.3, 1.0), ("bonded", 0.25, 8 / 9)])
def test_uniform_pressure_compresses_a_layer_by_its_finite_mean_mode(support, nu, compliance):
    # uniaxial stress or strain: u = h p / E* (unbonded), h p (1+nu)(1-2nu)/((1-nu) E) (bonded; 8/9 h/E* at nu = 1/4)
    operator = PeriodicOperator(layer(support, nu, 2.0), cell_size=0.1, cells=8)
    expected = 2.0 * compliance * (1.0 - nu**2)
    np.testing.assert_allclose(operator.displacement(np.ones((8, 8))), expected, rtol=1e-13)


@pytest.mark.parametrize("material", [HALF_SPACE, layer(thickness=0.4), layer("unbonded", thickness=3.0)])
def test_free_space_operator_is_the_direct_sum(material):
    n, s = 14, 0.2
    p = RANDOM.random((n, n))
    influence = layer_influence(n, material.thickness / s, material.support, material.poissons_ratio)
    i, j = np.indices((n, n))
    direct = np.array([[np.sum(influence[abs(i - a), abs(j - b)] * p) for b in range(n)] for a in range(n)])
    operator = FreeSpaceOperator(material, cell_size=s, cells=n)
    np.testing.assert_allclose(operator.displacement(p), direct * s / material.contact_modulus, rtol=1e-12)


def uniform_disk_error(cells):
    """Largest error of the displacement under and around a uniformly loaded disk, Johnson (1985) Eqs. (3.28-29)."""
    s = 4.0 / cells
    x = centres(cells, s)
    r = np.hypot(x[:, None], x)
    exact = np.where(
        r < 1.0,
        4.0 / np.pi * ellipe(np.minimum(r, 1.0) ** 2),
        4.0 / np.pi * r * (ellipe(1 / np.maximum(r, 1.0) ** 2) - (1 - 1 / r**2) * ellipk(1 / np.maximum(r, 1.0) ** 2)),
    )
    fraction = disk_fraction(x, s)
    computed = FreeSpaceOperator(HALF_SPACE, cell_size=s, cells=cells).displacement(fraction)
    away = np.abs(r - 1.0) > 0.2
    return np.max(np.abs(computed * HALF_SPACE.contact_modulus - exact)[away])


def disk_fraction(x, s, parts=16):
    sub = s * ((np.arange(parts) + 0.5) / parts - 0.5)
    fine = (x[:, None] + sub).ravel()
    inside = np.hypot(fine[:, None], fine) < 1.0
    return inside.reshape(len(x), parts, len(x), parts).mean(axis=(1, 3))


def test_uniform_disk_converges_with_second_order():
    coarse, fine = uniform_disk_error(32), uniform_disk_error(128)
    assert np.log(coarse / fine) / np.log(4.0) > 1.8
    assert fine < 1e-3


def test_quarter_grid_gives_the_quadrant():
    n = 16
    for kind in (PeriodicOperator, FreeSpaceOperator):
        quadrant = RANDOM.random((n // 2, n // 2))
        half = np.concatenate([quadrant[::-1], quadrant])
        whole = np.concatenate([half[:, ::-1], half], axis=1)
        full = kind(layer(), cell_size=0.1, cells=n).displacement(whole)
        quarter = kind(layer(), cell_size=0.1, cells=n, quarter=True).displacement(quadrant)
        np.testing.assert_allclose(quarter, full[n // 2 :, n // 2 :], rtol=1e-12)


def test_operators_are_symmetric_and_positive():
    p, q = RANDOM.standard_normal((2, 20, 20))
    for kind in (PeriodicOperator, FreeSpaceOperator):
        operator = kind(layer(nu=0.5, thickness=0.5), cell_size=0.1, cells=20)
        assert np.vdot(q, operator.displacement(p)) == pytest.approx(
            np.vdot(p, operator.displacement(q)), rel=1e-12, abs=0.0
        )
        assert np.vdot(p, operator.displacement(p)) > 0.0


def test_a_shifted_load_shifts_the_displacement():
    p = np.zeros((24, 24))
    p[5:9, 6:8] = 1.0
    periodic = PeriodicOperator(layer(), cell_size=0.1, cells=24)
    shifted = periodic.displacement(np.roll(p, (7, -3), axis=(0, 1)))
    np.testing.assert_allclose(shifted, np.roll(periodic.displacement(p), (7, -3), axis=(0, 1)), rtol=1e-12)
    free = FreeSpaceOperator(layer(), cell_size=0.1, cells=24)
    moved = free.displacement(np.roll(p, (3, 2), axis=(0, 1)))
    np.testing.assert_allclose(moved[3:, 2:], free.displacement(p)[:-3, :-2], rtol=1e-10)


def test_other_units_give_the_same_answer():
    p = RANDOM.random((12, 12))
    metres = FreeSpaceOperator(layer(thickness=2e-3), cell_size=1e-4, cells=12).displacement(p)
    millimetres = FreeSpaceOperator(layer(thickness=2.0), cell_size=0.1, cells=12).displacement(p)
    np.testing.assert_allclose(1e3 * metres, millimetres, rtol=1e-12)


@pytest.mark.parametrize(("support", "nu"), [("bonded", 0.3), ("bonded", 0.5), ("unbonded", 0.3)])
def test_periodic_images_fade_exponentially_as_the_box_grows(support, nu):
    # a smooth load, so that both discretisations of it agree; images decay at least as exp(-0.739 r/h)
    h, s = 0.5, 0.125
    differences = []
    for cells in (32, 64, 128):
        x = centres(cells, s)
        r = np.hypot(x[:, None], x)
        load = np.exp(-((r / 0.6) ** 2))
        material = layer(support, nu, h)
        periodic = PeriodicOperator(material, cell_size=s, cells=cells).displacement(load)
        wide = PeriodicOperator(material, cell_size=s, cells=512)
        big = np.exp(-((np.hypot(centres(512, s)[:, None], centres(512, s)) / 0.6) ** 2))
        inner = slice(256 - cells // 2, 256 + cells // 2)
        differences.append(np.max(np.abs(periodic - wide.displacement(big)[inner, inner])) / periodic.max())
    assert differences[1] < 0.1 * differences[0]
    assert differences[2] < 1e-9 + 0.01 * differences[1]


def test_free_space_and_periodic_discretisations_agree_with_second_order():
    h, differences = 0.5, []
    for cells in (64, 128, 256):
        s = 8.0 / cells
        x = centres(cells, s)
        load = np.exp(-(np.hypot(x[:, None], x) ** 2))
        free = FreeSpaceOperator(layer(thickness=h), cell_size=s, cells=cells).displacement(load)
        periodic = PeriodicOperator(layer(thickness=h), cell_size=s, cells=cells).displacement(load)
        differences.append(np.max(np.abs(free - periodic)) / free.max())
    orders = np.log2(np.array(differences[:-1]) / differences[1:])
    np.testing.assert_allclose(orders, 2.0, atol=0.3)
    assert differences[-1] < 1e-3


def test_the_preconditioner_nearly_inverts():
    p = np.pad(RANDOM.random((16, 16)), 8)
    for kind in (PeriodicOperator, FreeSpaceOperator):
        operator = kind(layer(thickness=0.5), cell_size=0.1, cells=32)
        back = operator.precondition(operator.displacement(p))
        assert np.linalg.norm(back - p) < 0.5 * np.linalg.norm(p)


def test_mirror_symmetry_needs_an_even_grid():
    with pytest.raises(InvalidInput, match="even number"):
        FreeSpaceOperator(layer(), cell_size=0.1, cells=15, quarter=True)
