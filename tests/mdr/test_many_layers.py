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


def test_a_thousand_truncated_cones_under_one_force():
    """Every hundredth radius is that of its scene alone."""
    alike = [
        Scene(
            layer=Layer(thickness=float(h), youngs_modulus=9e5, poissons_ratio=0.4),
            indenter=TruncatedCone(flat_radius=5e-4, slope=0.2),
            loading=NormalForces([0.2]),
            beyond_small_strains=True,
        )
        for h in np.geomspace(1e-4, 1e-2, 1000)
    ]
    together = equilibria(alike, PUNCH).contact_radius[::100]
    alone = [Mdr(flat_punch=PUNCH).solve(scene).contact_radius[0] for scene in alike[::100]]
    np.testing.assert_allclose(together, alone, rtol=2e-13, atol=0.0)


def test_a_contact_that_has_hardly_left_its_flat_end():
    """Values count relative to how far it has grown."""
    indenter = INDENTERS[0]
    alike = [
        Scene(
            layer=Layer(thickness=3e-4 * 1.2**n, youngs_modulus=1e6, poissons_ratio=0.45),
            indenter=indenter,
            loading=IndentationDepths([1e-10]),
        )
        for n in range(5)
    ]
    together = equilibria(alike, PUNCH)
    alone = [Mdr(flat_punch=PUNCH).solve(scene) for scene in alike]
    np.testing.assert_allclose(together.normal_force, [path.normal_force[0] for path in alone], rtol=2e-13)


def test_contacts_that_are_too_wide_are_left_out():
    """Beyond a/h = 1000 the answer of the scene alone says why there is none."""
    indenter = INDENTERS[2]
    mixed = scenes(indenter, LOADINGS[0], poissons_ratio=0.45)
    thin = mixed[0].replace(layer=Layer(thickness=5e-7, youngs_modulus=1e6, poissons_ratio=0.45))
    found = equilibria_on_layers([thin, *mixed], USUAL)
    assert np.isnan(found[:, 0]).all()
    assert np.isfinite(found[:, 1:]).all()


def test_a_truncated_cone_on_thin_layers_is_not_left_over():
    """Its excess is more than three times that on a half-space: at first such scenes were solved one by one."""
    scene = Scene(
        layer=Layer(thickness=2e-4, youngs_modulus=1e6, poissons_ratio=0.45),
        indenter=TruncatedCone(flat_radius=5e-4, slope=0.1),
        loading=IndentationDepths([5e-5]),
    )
    assert np.isfinite(equilibria_on_layers([scene] * 4, USUAL)).all()


def test_beyond_the_indenter_is_refused():
    beyond = scenes(INDENTERS[4], lambda share: IndentationDepths([1e-2]), poissons_ratio=0.45)
    with pytest.raises(InvalidInput, match="indenter ends"):
        equilibria(beyond, PUNCH)
