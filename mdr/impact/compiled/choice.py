"""Who integrates impacts: NumPy, or loops that numba compiles where that is asked for."""

from __future__ import annotations

from importlib.util import find_spec

from contact import InvalidInput
from mdr.impact import collocation
from mdr.impact.collocation import Integrate


def integrator(*, compiled: bool) -> Integrate:
    """The integration by NumPy or the compiled one, which is imported only now.

    Raises:
        InvalidInput: If compiled loops are asked for and numba is not installed.
    """
    if not compiled:
        return collocation.integrate
    if find_spec("numba") is None:
        raise InvalidInput("compiled = True: needs numba; install contact-verification[fast] or leave compiled out")
    from mdr.impact.compiled.integrate import integrate  # noqa: PLC0415  # loaded only when asked for

    return integrate
