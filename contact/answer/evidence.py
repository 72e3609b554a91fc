"""Quantities of answers with symbols and units, and stated errors. Non-finite numbers are refused."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.one_thread import one_thread
from contact.records.errors import NotConvergedError
from contact.records.validation import FloatArray

Setting: TypeAlias = bool | int | float | str | None
SYMBOLS: dict[str, str] = {}
"""Symbol of each array of an answer, by name."""
UNITS: dict[str, str] = {"pressure": "Pa", "surface_displacement": "m", "contact_time": "s"}
"""SI unit of each quantity of an answer, by name."""
UNITS["coefficient_of_restitution"] = "1"


@dataclass(frozen=True)
class Quantity:
    """Symbol and SI unit of a field of an answer."""

    symbol: str
    unit: str


Times: TypeAlias = Annotated[FloatArray, Quantity("t", "s")]
Radii: TypeAlias = Annotated[FloatArray, Quantity("a", "m")]
Depths: TypeAlias = Annotated[FloatArray, Quantity("δ", "m")]
Forces: TypeAlias = Annotated[FloatArray, Quantity("F", "N")]
Stiffnesses: TypeAlias = Annotated[FloatArray, Quantity("k_N", "N/m")]
Dissipation: TypeAlias = Annotated[FloatArray, Quantity("E_diss", "J")]
Length: TypeAlias = Annotated[float, Quantity("", "m")]
Force: TypeAlias = Annotated[float, Quantity("", "N")]


class StatedErrors(Mapping[str, FloatArray]):
    """Stated errors by quantity. Errors of surface fields may be functions, which are evaluated at the first access.

    Args:
        errors: Arrays, or functions without arguments that return them.
        method: Name of the method, for error messages.
    """

    def __init__(self, errors: Mapping[str, ArrayLike | Callable[[], FloatArray]], method: str) -> None:
        self._method = method
        entries: Any = errors._errors if isinstance(errors, StatedErrors) else errors
        self._errors: dict[str, Any] = dict(entries)
        for name in [name for name, error in self._errors.items() if not callable(error)]:
            self[name]

    @one_thread
    def __getitem__(self, name: str) -> FloatArray:
        """Stated relative error of one quantity, read-only.

        Raises:
            NotConvergedError: If the error is not finite.
        """
        error = self._errors[name]
        frozen = finite(f"error of {name}", error() if callable(error) else error, self._method)
        self._errors[name] = frozen
        return frozen

    def __iter__(self) -> Iterator[str]:
        return iter(self._errors)

    def __len__(self) -> int:
        return len(self._errors)

    def __repr__(self) -> str:
        return repr(dict(self))

    def __reduce__(self) -> tuple[type[StatedErrors], tuple[dict[str, FloatArray], str]]:
        """Pickle the computed values, since functions cannot be pickled."""
        return StatedErrors, (dict(self), self._method)


def finite(name: str, values: ArrayLike, method: str) -> FloatArray:
    """Read-only float64 copy of finite values.

    Raises:
        NotConvergedError: If an entry is not finite.
    """
    array = np.array(values, dtype=np.float64)
    if not np.isfinite(array).all():
        first = np.argwhere(~np.isfinite(array))[0]
        place = ", ".join(str(i) for i in first)
        raise NotConvergedError(f"{method}: {name} is {array[tuple(first)]} at entry ({place}); refused as an answer")
    array.setflags(write=False)
    return array
