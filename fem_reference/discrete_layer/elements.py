"""The element pairs: displacement of degree k, pressure of degree k - 1, or displacement alone."""

from __future__ import annotations

from dataclasses import dataclass

from skfem.element import Element, ElementTriP0, ElementTriP1, ElementTriP2, ElementTriP3, ElementTriP4

from contact.records.errors import InvalidInput


@dataclass(frozen=True)
class ElementPair:
    """Displacement and pressure elements of one formulation.

    Attributes:
        name: e.g. "P3P2".
        degree: polynomial degree of the displacement.
        displacement: scalar element of each displacement component.
        pressure: element of the pressure, None for a displacement formulation.
        inf_sup_stable: whether the pair satisfies the inf-sup condition (True for a displacement formulation,
            which has none, but locks as nu -> 1/2).
    """

    name: str
    degree: int
    displacement: Element
    pressure: Element | None = None
    inf_sup_stable: bool = True

    @property
    def is_mixed(self) -> bool:
        """Whether the pressure is an unknown of its own."""
        return self.pressure is not None


# All element pairs by name: the stable ones, displacement formulations, and two unstable pairs for tests.
PAIRS = {
    pair.name: pair
    for pair in (
        ElementPair("P2P1", 2, ElementTriP2(), ElementTriP1()),
        ElementPair("P3P2", 3, ElementTriP3(), ElementTriP2()),
        ElementPair("P4P3", 4, ElementTriP4(), ElementTriP3()),
        ElementPair("P2", 2, ElementTriP2()),
        ElementPair("P3", 3, ElementTriP3()),
        ElementPair("P4", 4, ElementTriP4()),
        ElementPair("P1P1", 1, ElementTriP1(), ElementTriP1(), inf_sup_stable=False),
        ElementPair("P1P0", 1, ElementTriP1(), ElementTriP0(), inf_sup_stable=False),
    )
}


def element_pair(name: str) -> ElementPair:
    """The pair of that name.

    Raises:
        InvalidInput: no such pair.
    """
    if name not in PAIRS:
        raise InvalidInput(f"element pair must be one of {', '.join(PAIRS)}, got {name!r}")
    return PAIRS[name]


def taylor_hood(degree: int) -> ElementPair:
    """P_k-P_(k-1): stable at every Poisson's ratio, 1/2 included."""
    return element_pair(f"P{degree}P{degree - 1}")
