"""Blunt tips r^n with any n: stated errors hold on the fewest nodes as on many."""

from __future__ import annotations

import numpy as np
import pytest

from bem.flat_punch import IntegralEquation
from contact import ContactPath, ContactRadii, IndentationDepths, Layer, NormalForces, PowerLaw, Scene
from mdr import Mdr
from mdr.batches import equilibria
from tests.referees.second_opinion import second_opinion

LAYER = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.3, support="bonded")


@pytest.mark.parametrize("nodes", [8, 12, *(pytest.param(n, marks=pytest.mark.slow) for n in (16, 24))])
def test_errors_of_power_laws_hold_on_narrow_and_wide_contacts(nodes: int) -> None:
    """Depth and force were off by up to 21 000 times the stated error where n is far from an integer."""
    for exponent in (1.09, 2.3, 3.49, 4.1, 6.3, 6.99, 8.35, 8.5, 12.2, 15.5, 15.9):
        tip = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=0.1)
        for a in (0.01, 0.5):
            scene = Scene(layer=LAYER, indenter=tip, loading=ContactRadii(values=np.array([0.5 * a, a])))
            path = Mdr(flat_punch=IntegralEquation(nodes=nodes)).solve(scene)
            assert isinstance(path, ContactPath)
            other = second_opinion(path)
            for name in ("indentation_depth", "normal_force"):
                error = np.abs(getattr(path, name) / other.values[name] - 1.0)
                assert np.all(error <= path.error_estimate[name] + other.uncertainty), (exponent, a, name)


@pytest.mark.parametrize("kind", [IndentationDepths, NormalForces])
def test_a_batch_answers_a_steep_tip_on_a_thick_layer_as_it_does_alone(
    kind: type[IndentationDepths | NormalForces],
) -> None:
    """In units of the batch the depth is 1e-30 of the radius, which no trial radius reached: "does not rise"."""
    law = PowerLaw(exponent=12.7, reference_radius=4.5e4, reference_height=260.0)
    layer = Layer(thickness=2e7, youngs_modulus=8e-9, poissons_ratio=0.5, support="bonded")
    scene = Scene(layer=layer, indenter=law, loading=kind([1190.0 if kind is IndentationDepths else 1e-9]))
    together, alone = equilibria([scene] * 3, IntegralEquation()), Mdr().solve(scene)
    for name in ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness"):
        np.testing.assert_allclose(getattr(together, name), getattr(alone, name)[0], rtol=1e-12)
