"""The method of dimensionality reduction: layers and half-spaces as beds of independent springs."""

from mdr.assembly import equivalent_system
from mdr.equivalent_system import EquivalentSystem

__all__ = ["EquivalentSystem", "equivalent_system"]
