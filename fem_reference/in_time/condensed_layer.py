"""A layer at rest with the indenter before it, condensed to the contact: what histories play on."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fem_reference.in_time.surface_memory import ViscoelasticSurface

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Stage:
    """Lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0, times in seconds.

    Attributes:
        surface: the layer; it has a memory, so a stage serves one history.
        radii: vertices of the pressures, shape (n,); one entry for a flat punch.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        radius: L [m].
        unknowns: size of the condensed system.
    """

    surface: ViscoelasticSurface
    radii: Array
    profile: Array
    radius: float
    unknowns: int
