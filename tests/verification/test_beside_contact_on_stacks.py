"""The MDR profile rises on stacks that stiffen downwards, so that none of their contacts is touched beside."""

from __future__ import annotations

import numpy as np
import pytest

from contact import Cone, ElasticBase, LayerStack, Paraboloid, Sublayer
from mdr.admissible import _stiffens_downwards
from mdr.radius_search import RadiusSearch, SeveralContacts
from mdr.spring_bed import Springs


def random_stack(rng):
    """One to four parts of any ratios, with shear and confined moduli sorted."""
    parts = []
    for _ in range(int(rng.integers(2, 5))):
        nu = float(rng.choice([0.0, 0.2, 0.3, 0.45, 0.49, 0.5]))
        parts.append((float(10 ** rng.uniform(-2, 2)), nu))
    E, nu = zip(*sorted(parts), strict=True)
    nu = sorted(nu)
    layers = tuple(
        Sublayer(thickness=float(np.exp(rng.uniform(-3, 0))), youngs_modulus=e, poissons_ratio=n)
        for e, n in zip(E[:-1], nu[:-1], strict=True)
    )
    base = ElasticBase(youngs_modulus=E[-1], poissons_ratio=nu[-1])
    faces = tuple(str(face) for face in rng.choice(["bonded", "unbonded"], len(layers) - 1))
    support = (base, "bonded", "unbonded")[int(rng.integers(3))]
    return LayerStack(sublayers=layers, interfaces=faces, support=support)


def profiles_that_fall(count, seed):
    """Layers on which the MDR profile of a cone or paraboloid falls somewhere."""
    rng, seen, fallen = np.random.default_rng(seed), 0, []
    while seen < count:
        layer = random_stack(rng)
        if not _stiffens_downwards(layer):
            continue
        seen += 1
        indenter = (Cone(slope=0.1), Paraboloid(radius_of_curvature=1.0))[int(rng.integers(2))]
        try:
            RadiusSearch(Springs.of(layer, indenter), may_fall=True).refuse_falls(4.0 * layer.surface.thickness)
        except SeveralContacts:
            fallen.append((layer, indenter))
    return fallen


def test_profiles_rise_where_moduli_rise_downwards():
    assert profiles_that_fall(6, 5) == []


@pytest.mark.slow
def test_profiles_rise_on_many_stacks():
    assert profiles_that_fall(200, 6) == []
