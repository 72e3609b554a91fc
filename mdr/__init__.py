"""The method of dimensionality reduction: layers and half-spaces as beds of independent springs.

Enters: a scene. Leaves: its answer, with stated errors. Read `method` first, then `dispatch`, `springs.assembly` and
`elastic`; coefficients of stated errors stand in `springs.error_model`.
"""

from mdr.method import Mdr
from mdr.springs.assembly import SeveralContacts, equivalent_system
from mdr.springs.equivalent_system import EquivalentSystem

__all__ = ["EquivalentSystem", "Mdr", "SeveralContacts", "equivalent_system"]
