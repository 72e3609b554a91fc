"""Surface compliance, node radii and profile moments on the contact strip, at the beginning of a history."""

from __future__ import annotations

from dataclasses import dataclass

from contact.records.validation import FloatArray
from fem_reference.in_time.top import Top


@dataclass(frozen=True)
class CondensedLayer:
    """A layer at rest and its indenter, condensed to the contact strip.

    Units: lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0, times in seconds.

    Attributes:
        surface: the layer; it has a memory, so a condensed layer serves one history.
        radii: vertices of the pressures, shape (n,); one entry for a flat punch.
        profile: moments ``int phi_i f 2 pi r dr`` of the indenter's profile, shape (n,).
        radius: L [m].
        unknowns: size of the condensed system.
    """

    surface: Top
    radii: FloatArray
    profile: FloatArray
    radius: float
    unknowns: int
