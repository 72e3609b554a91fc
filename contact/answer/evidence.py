"""Arrays of an answer with their stated errors. Non-finite numbers are refused."""

from __future__ import annotations

import typing
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from contact.answer.one_thread import one_thread
from contact.answer.stages import Cost, StageRecord
from contact.records.errors import InvalidInput, NotConvergedError
from contact.records.validation import FloatArray
from contact.scene.scene import Scene

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


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class Evidence:
    """Numbers of an answer with scene, method, settings, stated errors and cost.

    Subclasses annotate their arrays and numbers with a `Quantity`.
    """

    ARRAYS: ClassVar[tuple[str, ...]] = ()
    """Fields with one value per state, shape (n,)."""
    SCALARS: ClassVar[tuple[str, ...]] = ()
    """Fields with one value per answer."""

    scene: Scene
    method: str
    settings: Mapping[str, Setting]
    error_estimate: Mapping[str, FloatArray]
    cost: Cost
    stages: tuple[StageRecord, ...] = ()
    notes: tuple[str, ...] = ()

    def __init_subclass__(cls) -> None:
        """Register the annotated arrays and numbers of the subclass with their symbols and units."""
        for name, hint in cls.__annotations__.items():
            if isinstance(quantity := (*getattr(hint, "__metadata__", ()), None)[0], Quantity):
                UNITS[name] = quantity.unit
                if typing.get_args(hint)[0] is float:
                    cls.SCALARS += (name,)
                else:
                    cls.ARRAYS += (name,)
                    SYMBOLS[name] = quantity.symbol

    def __post_init__(self) -> None:
        """Freeze the arrays; refuse non-finite numbers and unequal lengths."""
        for name in self.ARRAYS:
            object.__setattr__(self, name, finite(name, getattr(self, name), self.method))
        lengths = {name: len(getattr(self, name)) for name in self.ARRAYS}
        if len(set(lengths.values())) > 1:
            raise InvalidInput(f"{type(self).__name__}: all arrays need one length, got {lengths}")
        for name in self.SCALARS:
            finite(name, getattr(self, name), self.method)
        object.__setattr__(self, "error_estimate", StatedErrors(self.error_estimate, self.method))

    def __len__(self) -> int:
        """Number of states."""
        return len(getattr(self, self.ARRAYS[0]))

    def scale(self, quantity: str) -> FloatArray:
        """Magnitude to which a relative error of this quantity refers, shape (n,): the largest |q| along the path.

        The scale of a residual in `error_estimate`, which is no quantity of the answer, is one.
        """
        values = self._magnitude(quantity)
        return np.full(values.shape, values.max(initial=0.0))

    def _magnitude(self, quantity: str) -> FloatArray:
        """|q|, shape (n,); one, shape (1,), if the answer has no quantity of this name."""
        return np.abs(np.atleast_1d(np.asarray(getattr(self, quantity, 1.0), dtype=np.float64)))

    def uncertainty(self, quantity: str) -> FloatArray:
        """Absolute stated error of a quantity in its SI unit, shape (n,).

        Raises:
            InvalidInput: If the method states no error for this quantity.
        """
        if quantity not in self.error_estimate:
            known = ", ".join(sorted(self.error_estimate)) or "none"
            raise InvalidInput(f"{self.method} states no error of {quantity!r}; it does for: {known}")
        return self.error_estimate[quantity] * self.scale(quantity)

    def refuse_step(self, step: int) -> None:
        """Refuse an index of a state that the answer does not have.

        Raises:
            InvalidInput: If the index is no whole number, or outside the states.
        """
        is_whole = isinstance(step, int | np.integer) and not isinstance(step, bool)
        if not (is_whole and -len(self) <= step < len(self)):
            raise InvalidInput(f"step = {step}: this path has steps 0 to {len(self) - 1}")


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
