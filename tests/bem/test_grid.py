"""Operators on square grids against closed forms, and contacts of boundary elements against the integral equation."""

import sys

import numpy as np
import pytest

from bem import Bem
from bem.grid.discs import disc_of, punch
from bem.grid.influence import layer_influence, point_response
from bem.grid.operators import HALF_SPACE, grid_operator, pressed
from bem.kernels.of_layer import surface_kernel
from contact import (
    ContactRadii,
    ElasticBase,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    InvalidInput,
    Layer,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
    Tabulated,
    UnsupportedSceneError,
)

# k_bar of flat punches at a/h = 0.2 and 1: the integral equation solved to 1e-12.
PRINTED = {
    ("bonded", 0.3): (1.20655824090, 2.48352462914),
    ("bonded", 0.5): (1.28063660581, 3.61873584896),
    ("unbonded", 0.3): (1.17102775645, 2.19862136617),
}
STACK = LayerStack(
    sublayers=(
        Sublayer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3),
        Sublayer(thickness=3.0, youngs_modulus=10.0, poissons_ratio=0.4),
    ),
    interfaces=("bonded",),
    support=ElasticBase(youngs_modulus=0.1, poissons_ratio=0.3),
)
GRADED = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)


def layer(support="bonded", nu=0.3, thickness=1.0):
    return Layer(thickness=thickness, youngs_modulus=1.0 - nu**2, poissons_ratio=nu, support=support)


@pytest.mark.parametrize("material", [layer(), layer(nu=0.5), layer("unbonded"), STACK, GRADED])
def test_a_sinusoidal_load_has_its_closed_form(material):
    # Eqs. (27) and (32): u = 2 chi(k h)/(k E*) p, wavelength 8 and 12 thicknesses.
    cells, s = 48, 0.5
    x = s * (np.arange(cells // 2) + 0.5)
    kx, ky = 2.0 * np.pi * 3 / (cells * s), 2.0 * np.pi * 2 / (cells * s)
    p = np.cos(kx * x)[:, None] * np.cos(ky * x)
    k = np.hypot(kx, ky)
    answer = grid_operator(material, s, cells, "periodic").displacement(p) * s
    exact = 2.0 * surface_kernel(material).chi(np.array([k]))[0] / k * p
    np.testing.assert_allclose(answer, exact, atol=1e-8 * np.abs(exact).max(), rtol=0.0)


@pytest.mark.parametrize(("support", "nu", "finite"), [("unbonded", 0.3, 0.5), ("bonded", 0.3, 0.4 / (2 * 0.7**2))])
def test_a_uniform_pressure_compresses_a_layer_by_its_finite_mean_mode(support, nu, finite):
    operator = grid_operator(layer(support, nu), 0.5, 32, "periodic")
    np.testing.assert_allclose(operator.displacement(np.ones((16, 16))) * 0.5, 2.0 * finite, rtol=1e-12)


@pytest.mark.parametrize("material", [HALF_SPACE, layer(), STACK])
def test_free_space_is_the_sum_over_all_cells(material):
    cells, s, m = 16, 0.3, 8
    p = np.random.default_rng(1).random((m, m))
    influence = layer_influence(cells, material, s)
    whole = np.block([[p[::-1, ::-1], p[::-1]], [p[:, ::-1], p]])
    i = np.arange(cells)
    offset = np.abs(i[:, None] - i)
    direct = np.einsum("ikjl,kl->ij", influence[offset[:, :, None, None], offset[None, None]], whole)
    np.testing.assert_allclose(grid_operator(material, s, cells).displacement(p), direct[m:, m:], rtol=1e-12)


def test_a_cell_under_its_own_pressure_sinks_by_the_closed_form():
    # Love (1929): 4 ln(1 + sqrt 2)/pi at the centre of a square of side 1, E* = 1.
    assert layer_influence(2, HALF_SPACE, 1.0)[0, 0] == pytest.approx(
        4 * np.log(1 + np.sqrt(2)) / np.pi, rel=1e-13, abs=0.0
    )


@pytest.mark.parametrize("nu", [0.3, 0.5])
def test_the_response_of_a_layer_decays_exponentially(nu):
    response = point_response(surface_kernel(layer(nu=nu)))
    rho = np.array([4.0, 8.0, 12.0])
    far = np.abs(response(rho) * rho + 1.0)
    assert np.all(far[1:] < far[:-1] * np.exp(-0.6 * 4.0))


@pytest.mark.parametrize(("support", "nu"), PRINTED)
def test_printed_stiffness_is_met_on_a_grid_of_256(support, nu):
    for ratio, printed in zip((0.2, 1.0), PRINTED[support, nu], strict=True):
        assert punch(layer(support, nu), ratio, 256).growth == pytest.approx(printed, rel=2e-6, abs=0.0)


def test_discs_of_the_half_space_have_the_radius_of_their_stiffness():
    disc = disc_of(128)
    assert disc.radius == pytest.approx(0.97 * 64, rel=5e-3, abs=0.0)
    assert 4.0 * pressed(disc.operator, disc.contact, 1.0, 1e-8).sum() == pytest.approx(
        2.0 * disc.radius, rel=1e-7, abs=0.0
    )


def test_a_dent_in_which_cells_would_pull_is_refused_with_its_place():
    r = np.linspace(0.0, 1.1e-3, 23)
    rises = np.diff(r**2 / 0.02)
    rises[10:12] = 0.0
    dented = Tabulated(radii=r, heights=np.concatenate([[0.0], np.cumsum(rises)]))
    scene = Scene(layer=layer(nu=0.5, thickness=1e-3), indenter=dented, loading=IndentationDepths([2.5e-5]))
    with pytest.raises(UnsupportedSceneError, match=r"would be pulled at r = 0\.0004[89]\d* m.* no single circle"):
        Bem(points=256).solve(scene)


def test_every_answer_is_transformed_by_fftw(monkeypatch):
    monkeypatch.setattr("bem.grid.transforms._fftw", lambda: sys.modules["absent"])
    monkeypatch.setattr("bem.grid.discs.disc_of", disc_of.__wrapped__)
    monkeypatch.setattr("bem.grid.transforms._cached", lambda *given: (_ for _ in ()).throw(KeyError("absent")))
    scene = Scene(layer=layer(), indenter=FlatPunch(radius=0.123), loading=IndentationDepths([0.01]))
    with pytest.raises(KeyError, match="absent"):
        Bem(points=96).solve(scene)


def test_boundaries_that_do_not_fit_are_refused():
    scene = Scene(layer=layer(), indenter=Paraboloid(radius_of_curvature=1.0), loading=ContactRadii([1.0]))
    with pytest.raises(UnsupportedSceneError, match="too thick"):
        Bem(points=96, boundary="periodic").solve(scene)


@pytest.mark.parametrize(
    "bad", [{"points": 90}, {"points": 130}, {"boundary": "open"}, {"threads": 0}, {"adhesion": "glue"}]
)
def test_bad_settings_are_refused(bad):
    with pytest.raises(InvalidInput):
        Bem(**bad)
