"""Methods of installed packages. Every error inside one becomes an error with the method's name."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Final, Self, TypeVar

import numpy as np

from cases.declare.methods import BUILT_IN, build
from contact import (
    ContactError,
    ContactRadii,
    Cost,
    IndentationDepths,
    InvalidInput,
    Method,
    NormalForces,
    NotConvergedError,
    Scene,
    Solution,
    Supported,
    Unsupported,
    UnsupportedSceneError,
)
from contact.answer.small_strains import with_depth_note
from contact.records.errors import shown

# Relative difference from a prescribed quantity beyond which an answer belongs to another scene.
PRESCRIBED_TOLERANCE: Final = 1e-2

PRESCRIBED: Final = {
    ContactRadii: "contact_radius",
    IndentationDepths: "indentation_depth",
    NormalForces: "normal_force",
}


class BrokenMethodError(ContactError):
    """A method of an installed package crashed or returned an invalid answer; the message names the method."""


# Errors are raised again as one of these classes: subclasses by other packages may need other arguments.
KINDS: Final = (BrokenMethodError, InvalidInput, UnsupportedSceneError, NotConvergedError, ContactError)

T = TypeVar("T")


@dataclass(frozen=True)
class GuardedMethod:
    """A method of another package under its registered name; its support of a scene and its answers are checked.

    Raises:
        BrokenMethodError: If the method crashes or answers nonsense.
        ContactError: If the method raises it, under its name.
    """

    name: str
    method: Method

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the method models the scene."""
        support = _blamed(self.name, "supports", lambda: self.method.supports(scene))
        if support:
            return Supported()
        return Unsupported(str(getattr(support, "reason", "it gives no reason")))

    def solve(self, scene: Scene) -> Solution:
        """The method's answer, checked against the scene."""
        support = self.supports(scene)
        if isinstance(support, Unsupported):
            raise UnsupportedSceneError(f"method {self.name!r} does not model this scene: {support.reason}")
        answer = _blamed(self.name, "solve", lambda: self.method.solve(scene))
        fault = _blamed(self.name, "its answer", lambda: "".join(_faults(answer, scene)[:1]))
        if fault:
            raise BrokenMethodError(f"method {self.name!r} gives no answer: {fault}; tell the authors of its package")
        noted: Solution = with_depth_note(answer)
        return noted

    def refined(self) -> Self:
        """A copy with half the discretisation length."""
        return type(self)(self.name, _blamed(self.name, "refined", self.method.refined))


def build_guarded(name: str, settings: dict[str, Any]) -> Method:
    """The method of this name; one of another package is guarded.

    Raises:
        InvalidInput: If there is none, or if what is registered is no method.
        BrokenMethodError: If it cannot be built.
    """
    if name in BUILT_IN:
        return build(name, settings)
    guarded: Method = GuardedMethod(name, _blamed(name, "its constructor", lambda: build(name, settings)))  # type: ignore[assignment]  # its name is a field
    return guarded


def _blamed(name: str, place: str, call: Callable[[], T]) -> T:
    """Result of a call into another package; its errors are raised with the method's name."""
    try:
        return call()
    except ContactError as error:
        message = str(error)
        kind = next(kind for kind in KINDS if isinstance(error, kind))
        raise kind(message if repr(name) in message else f"method {name!r}: {message}") from None
    except (Exception, SystemExit) as error:
        message = f"method {name!r} crashed in {place}: {type(error).__name__}: {error!s:.300}"
        raise BrokenMethodError(f"{message}; tell the authors of its package") from error


def _faults(answer: object, scene: Scene) -> list[str]:
    """Reasons why an answer does not belong to this scene."""
    if not isinstance(answer, Solution):
        return [f"{shown(answer)} is no Solution"]
    prescribed = PRESCRIBED.get(type(scene.loading), "")
    required = getattr(scene.loading, "values", np.empty(0))
    reached = np.asarray(getattr(answer, prescribed, required), dtype=np.float64)
    conditions = {
        "it belongs to another scene": answer.scene != scene,
        "its cost is no Cost": not isinstance(answer.cost, Cost),
        f"{len(required)} values are prescribed, it has {reached.size}": prescribed and reached.shape != required.shape,
    }
    faults = [fault for fault, is_wrong in conditions.items() if is_wrong]
    if not faults and prescribed and not np.allclose(reached, required, rtol=PRESCRIBED_TOLERANCE, atol=0.0):
        faults.append(f"its {prescribed} is {shown(reached)}, prescribed is {shown(required)}")
    faults += [f"it states a negative error of {name}" for name, e in answer.error_estimate.items() if np.min(e) < 0]
    radius = getattr(answer, "contact_radius", np.zeros(1))
    return faults + ["a contact radius is negative"] * bool(np.min(radius) < 0)
