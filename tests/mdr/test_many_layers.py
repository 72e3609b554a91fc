"""One indenter on many layers at once gives what its scenes give one by one."""

import numpy as np
import pytest

from bem.equation import USUAL
from bem.flat_punch import IntegralEquation
from contact import (
    ContactRadii,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Scene,
    Sphere,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr import Mdr
from mdr.batches import equilibria
from mdr.many_layers import equilibria_on_layers

PUNCH = IntegralEquation()
NAMES = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
INDENTERS = (
    TruncatedCone(flat_radius=5e-4, slope=0.1),
    TruncatedCone(flat_radius=5e-9, slope=0.1),
    TruncatedParaboloid(flat_radius=3e-4, radius_of_curvature=1e-2),
    Sphere(radius=2e-3),
    Tabulated(radii=[0.0, 1e-3, 2e-3], heights=[0.0, 1e-4, 4e-4]),
)
LOADINGS = (
    lambda share: ContactRadii([1e-3 * (1.0 + share)]),
    lambda share: IndentationDepths([5e-5 * (1.0 + share)]),
    lambda share: NormalForces([0.05 * (1.0 + share)]),
)


def scenes(indenter, loading, thickest=1e-2, count=7, **layer):
    shares = np.linspace(0.0, 0.4, count)
    return [
        Scene(
            layer=Layer(thickness=float(h), youngs_modulus=1e6 * (1.0 + share), **layer),
            indenter=indenter,
            loading=loading(share),
        )
        for h, share in zip(np.geomspace(1e-4, thickest, count), shares, strict=True)
    ]


@pytest.mark.first(11)
@pytest.mark.parametrize("loading", LOADINGS)
@pytest.mark.parametrize("indenter", INDENTERS)
@pytest.mark.parametrize(("nu", "support"), [(0.5, "bonded"), (0.3, "unbonded")])
def test_together_is_alone(indenter, loading, nu, support):
    alike = scenes(indenter, loading, poissons_ratio=nu, support=support)
    found = equilibria_on_layers(alike, USUAL)
    assert np.isfinite(found).all()
    for scene, together in list(zip(alike, found.T, strict=True))[::3]:
        alone = Mdr(flat_punch=PUNCH).solve(scene)
        np.testing.assert_allclose(together, [getattr(alone, name)[0] for name in NAMES], rtol=2e-13, atol=0.0)


def test_beyond_the_indenter_is_refused():
    beyond = scenes(INDENTERS[4], lambda share: IndentationDepths([1e-2]), poissons_ratio=0.45)
    with pytest.raises(InvalidInput, match="indenter ends"):
        equilibria(beyond, PUNCH)
