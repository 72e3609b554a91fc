"""Note of frictionless answers on thin incompressible layers: an upper bound of the force with dry friction."""

from __future__ import annotations

import numpy as np

from contact.records.validation import FloatArray
from contact.scene.layer import ElasticLayer, Layer, LayerStack

# From this Poisson's ratio and this a/h on, a coefficient of 0.1 may raise the force by 4 % or more.
_NEARLY_INCOMPRESSIBLE = 0.49
_THIN = 1.0
# Largest radial displacement under a frictionless unit punch, over a/h: 3/4 on a thin incompressible bonded layer, 1/2
# on an unbonded one (lubrication theory); less on every other layer from a/h = 0.5 on.
_SLIDES = {"bonded": 0.75, "unbonded": 0.5}
# Coefficient of friction of the note.
_COEFFICIENT = 0.1


def friction_notes(layer: ElasticLayer, radius: FloatArray) -> tuple[str, ...]:
    """Note on the force with friction, for frictionless contacts of these radii [m] on thin incompressible layers.

    With u_r1 the radial displacement under the frictionless unit punch, F <= F_0/(1 - mu max |u_r1|) by reciprocity. On
    several layers the slip depends on all of them and has no such bound. Other layers have no note.
    """
    ratio, nu = float(np.max(radius, initial=0.0)) / layer.surface.thickness, layer.surface.poissons_ratio
    if nu < _NEARLY_INCOMPRESSIBLE or ratio < _THIN or not isinstance(layer, Layer | LayerStack):
        return ()
    if isinstance(layer, LayerStack):
        place = f"at a/h = {ratio:.3g} of the surface layer and nu = {nu:g}"
        words = f"frictionless: {place} dry friction may raise the force, the more the stiffer what lies below"
        return (f"{words}; contact-verify solve --advise bounds it, Friction(coefficient=..) solves it",)
    slip = _COEFFICIENT * _SLIDES[layer.support] * ratio
    most = f"by up to {100.0 * slip / (1.0 - slip):.2g} %" if slip < 0.5 else "by more than half of it"
    words = f"at a/h = {ratio:.3g} and nu = {nu:g} dry friction of {_COEFFICIENT:g} may raise the force {most}"
    more = "contact-verify solve --advise bounds it more closely, Friction(coefficient=..) solves it"
    return (f"frictionless: {words}; {more}",)
