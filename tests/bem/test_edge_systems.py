"""Resolvent and kernel of graded layers in the factored equation."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import quad

from bem.kernels.of_layer import surface_kernel
from bem.layer_equation.any_layer import relative_panels as panels_module
from bem.layer_equation.any_layer.edge_systems import EdgeSystems
from bem.layer_equation.any_layer.point_kernel import PointKernel
from bem.layer_equation.any_layer.relative_panels import RelativePanels, relative_panels
from contact import (
    ElasticBase,
    ExponentialDepth,
    GradedLayer,
    Paraboloid,
    PowerLawDepth,
    TruncatedCone,
)

PARABOLOID = Paraboloid(radius_of_curvature=1.0)
CONE = TruncatedCone(flat_radius=0.5, slope=0.1)
EXPONENTIAL = GradedLayer(thickness=1.0, youngs_modulus=ExponentialDepth(surface=1.0, base=4.0), poissons_ratio=0.3)
LAYERS = {
    "exponential": EXPONENTIAL,
    "steep": EXPONENTIAL.replace(youngs_modulus=ExponentialDepth(surface=1.0, base=100.0)),
    "softer below, elastic base": EXPONENTIAL.replace(
        youngs_modulus=ExponentialDepth(surface=1.0, base=0.1),
        support=ElasticBase(youngs_modulus=0.5, poissons_ratio=0.3),
    ),
    "incompressible": EXPONENTIAL.replace(poissons_ratio=0.5),
    "unbonded": EXPONENTIAL.replace(support="unbonded"),
    "power law": EXPONENTIAL.replace(youngs_modulus=PowerLawDepth(surface=1.0, reference_depth=0.1, exponent=1.0)),
}
QUANTITIES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")


@pytest.mark.parametrize("x", [0.3, 1.99, 3.9])
def test_what_is_left_of_the_resolvent_starts_from_an_exact_integral(x):
    """Of two kernels' product, by adaptive quadrature. The layer's images are closest where x is two thicknesses."""
    systems = EdgeSystems(PointKernel.of_surface(surface_kernel(LAYERS["softer below, elastic base"])), 12)
    t = np.array([0.01, 0.4, 0.97]) * x

    def product(s: float, at: float) -> float:
        N = systems.kernel
        left, right = N(np.array([abs(at - s)])) + N(np.array([at + s])), N(np.array([x - s])) + N(np.array([x + s]))
        return float((left * right)[0]) / np.pi**2

    expected = [
        sum(quad(product, a, b, args=(at,), epsabs=1e-12, epsrel=1e-12, limit=200)[0] for a, b in ((0, at), (at, x)))
        for at in t
    ]
    np.testing.assert_allclose(systems._iterated(x, t), expected, rtol=0, atol=1e-10)


@pytest.mark.parametrize("x", [0.01, 2.4])
def test_the_kernel_goes_on_like_its_logarithm(x):
    """Held constant below 2^-40 thicknesses it left 4e-12 out of this integral, whatever the panels."""
    kernel = PointKernel.of_surface(surface_kernel(LAYERS["power law"]))
    found = float(EdgeSystems(kernel, 16).matrix(x, relative_panels(16, 2))[-1].sum())
    assert found == pytest.approx(float(kernel.integral(np.array([2 * x]))[0]) / np.pi, rel=0, abs=2e-13)


def test_the_rule_beside_a_target_has_nodes_enough(monkeypatch):
    """With 20 nodes the edge value was 6e-12 off: polynomials in s = v^6 are of degree 66 in v."""
    kernel, ends = PointKernel.of_surface(surface_kernel(LAYERS["incompressible"])), relative_panels(12, 2).ends
    found = EdgeSystems(kernel, 12).at(4.0).edge_density
    monkeypatch.setattr(panels_module, "SINGULAR_NODES", 48)
    monkeypatch.setattr(EdgeSystems, "panels", lambda self, x: RelativePanels(ends, 12))
    assert found == pytest.approx(EdgeSystems(kernel, 12).at(4.0).edge_density, rel=1e-12, abs=0)


def test_the_kernel_keeps_its_digits_at_the_ends_of_octaves():
    """Seen to fail: 1.7e-12 off at four thicknesses, by 18 nodes on octaves beside which an image lies."""
    kernel = PointKernel.of_surface(surface_kernel(LAYERS["incompressible"]))
    s = 2.0 ** np.arange(-3.0, 5.0)
    np.testing.assert_allclose(kernel(s), kernel.exponentials(s), rtol=0, atol=3e-14)
