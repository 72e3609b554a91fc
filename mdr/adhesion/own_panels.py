"""One adhering state once more, on panels of the layer's equation that end at the contact's edge.

There the edge value of a density is an integral over Gauss nodes, not a polynomial between them, and all of depth and
force follow from two densities phi1 and phig, under W = 1 and W = g_hs:

    c_bar = phi1(a)^2,  k_bar = <1, phi1>/a,  delta = phig(a)/phi1(a) - dl,  F = 2 E* (delta <1, phi1> - <1, phig>)

The error on m nodes is about the square of that of polynomials through them, so the difference is these polynomials'.
"""

from __future__ import annotations

import numpy as np

from bem.layer_equation.contact_density import ContactDensity
from bem.layer_equation.error_model import FACTOR
from contact import ElasticLayer, FlatPunch, Profile
from contact.records.validation import FloatArray
from mdr.springs.assembly import contact_fields
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import EPS


def state_again(
    system: EquivalentSystem, layer: ElasticLayer, indenter: Profile, work_of_adhesion: float, excess: float
) -> FloatArray | None:
    """Depth [m] and force [N] of the equilibrium with this radius, shape (2,); None where no one equation gives them.

    Args:
        system: Springs and profile of the layer and the indenter.
        layer: The layer.
        indenter: The profile.
        work_of_adhesion: dgamma [J/m^2].
        excess: a - b [m] over the radius of the flat end; within it the indenter is a flat punch.
    """
    a, unit = system.flat_radius + excess, system.length_unit
    again = system.flat_punch.ending_at(a / unit)
    if again is None:
        return None
    punch = contact_fields(layer, FlatPunch(radius=a), again, excess=0.0, depth=unit, edge=True)
    edge, total = _edge_and_integral(punch.density, 1.0)
    rim = risen = 0.0
    if excess > 0.0 and not isinstance(indenter, FlatPunch):
        pressed = contact_fields(layer, indenter, again, excess=excess, depth=0.0, edge=True)
        height = float(pressed.profile(np.asarray(pressed.profile.grid.end)))
        rim, risen = (-value for value in _edge_and_integral(pressed.density, -height))
    modulus = system.contact_modulus
    depth = rim / edge - np.sqrt(2.0 * np.pi * work_of_adhesion * a / modulus) / (unit * edge)
    return np.array([depth * unit, 2.0 * modulus * unit**2 * (depth * total - risen)])


def rounding(system: EquivalentSystem, radius: FloatArray) -> FloatArray:
    """What roundings leave of the terms of such a state, relative, at each radius [m]."""
    stiffness = system.contact_stiffness(radius) / (2.0 * system.contact_modulus * radius)
    return np.asarray(EPS * (2.0 * FACTOR.rounded + FACTOR.spring_growth * stiffness))


def _edge_and_integral(density: object, load: float) -> tuple[float, float]:
    """phi(a) and <1, phi> under a load of this value at the edge."""
    assert isinstance(density, ContactDensity)
    phi = density.load + density.psi.node_values
    return load - float(density.outside(np.zeros(1))[0]), float(np.sum(phi * density.psi.grid.weights))
