"""Methods by the names that readers know."""

import re
from collections.abc import Mapping

NAMES: Mapping[str, str] = {
    "mdr": "MDR",
    "fem": "FEM",
    "bem": "BEM",
    "integral_equation": "integral equation",
    "mdr_table": "MDR (FFT table)",
    "calculix": "CalculiX",
    "contact_mechanics": "ContactMechanics",
    "tamaas": "Tamaas",
}


def base_of(method: str) -> str:
    """The method of a label: "mdr" of "mdr", of "mdr fft" and of "mdr[fft]"."""
    return re.split(r"[\s\[(,:]", method, maxsplit=1)[0]


def display_name(method: str) -> str:
    """The label with its method as readers know it, "MDR fft"; a method from elsewhere keeps its own name."""
    base = base_of(method)
    return NAMES.get(base, base) + method[len(base) :]
