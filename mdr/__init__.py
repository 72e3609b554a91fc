"""The method of dimensionality reduction: layers and half-spaces as beds of independent springs."""

from mdr.assembly import SeveralContacts, equivalent_system
from mdr.equivalent_system import EquivalentSystem
from mdr.method import Mdr

__all__ = ["EquivalentSystem", "Mdr", "SeveralContacts", "equivalent_system"]
