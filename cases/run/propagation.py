"""Uncertain inputs carried through a method to every quantity of its answer.

By differences: with D the change of a quantity per standard deviation of each input and R the correlation of the
inputs, u^2 = D R D^T (the law of propagation, GUM 5.2). Each input is moved by one deviation to either side; where
the two sides differ much the quantity bends, and samples are the better answer: they take its whole distribution.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from cases.answers import Values
from cases.case import Sampling
from cases.declare.uncertain_inputs import UncertainInputs, read_inputs
from cases.recording import quantities
from contact import UNITS, DetachmentPath, InvalidInput, Method, Scene, Solution
from contact.records.validation import FloatArray

# Quantities by name.
Named: TypeAlias = tuple[tuple[str, Values], ...]
# The seed of the samples: an answer repeats digit by digit.
SEED = 20261122
# Share of the change beyond which a difference of the two sides is noted; samples are then more accurate.
BENT = 0.1
# Fewer samples give standard deviations with errors of more than 20 %.
FEWEST_SAMPLES = 16


@dataclass(frozen=True, kw_only=True)
class PropagatedQuantity:
    """A quantity of the answer with both of its uncertainties, along its steps.

    Attributes:
        name: of the quantity.
        unit: SI.
        values: at the middle of the inputs, shape (n,).
        numerical: error that the method states, absolute, shape (n,); None where it states none.
        inputs: standard uncertainty by the inputs, absolute, shape (n,).
        by_input: change per standard deviation of each input, absolute, by its name; empty for samples.
        bends: whether moving an input up and down changes it by different amounts; never for samples.
    """

    name: str
    unit: str
    values: FloatArray
    numerical: FloatArray | None
    inputs: FloatArray
    by_input: dict[str, FloatArray]
    bends: bool


@dataclass(frozen=True, kw_only=True)
class Propagated:
    """An answer at the middle of uncertain inputs, and the uncertainty that they cause.

    Attributes:
        scene: with the inputs at their middle.
        answer: of this scene.
        quantities: each with its uncertainties.
        correlation: of the last steps of the quantities, in their order; zero where a quantity does not vary.
        solved: number of scenes.
    """

    scene: Scene
    answer: Solution
    quantities: tuple[PropagatedQuantity, ...]
    correlation: FloatArray
    solved: int

    def quantity(self, name: str) -> PropagatedQuantity:
        """The quantity called ``name``.

        Raises:
            InvalidInput: if the answer has none.
        """
        for one in self.quantities:
            if one.name == name:
                return one
        raise InvalidInput(f"no quantity {name!r}; there are {', '.join(one.name for one in self.quantities)}")


def propagate(
    scene: Scene, uncertain: str | UncertainInputs, *, method: Method | None = None, samples: int = 0
) -> Propagated:
    """Propagates the standard uncertainties of inputs to every quantity of the answer.

    By differences (GUM 5.2), two solutions per input, or by the scatter of quantities over scenes drawn at random.

    Args:
        scene: its uncertain inputs are replaced by the middles of their ranges.
        uncertain: inputs as text, e.g. "radius=5%", or as returned by `read_inputs`.
        method: solves the scenes; MDR by default.
        samples: number of scenes drawn at random; differences for zero.

    Raises:
        InvalidInput: an input that the scene does not have, or fewer than `FEWEST_SAMPLES` samples.
        UnsupportedSceneError, NotConvergedError: as the method raises them.
    """
    if samples and samples < FEWEST_SAMPLES:
        raise InvalidInput(f"samples = {samples}: take at least {FEWEST_SAMPLES}, or none for differences")
    inputs = read_inputs(uncertain, scene) if isinstance(uncertain, str) else uncertain
    solver = method or _mdr()

    def solved(numbers: FloatArray) -> Named:
        return _physical(solver.solve(inputs.moved(scene, numbers, drawn=bool(samples))))

    middle = inputs.moved(scene, np.zeros(len(inputs.inputs)))
    answer = solver.solve(middle)
    at_middle = _physical(answer)
    found, factors = (_sampled if samples else _differences)(inputs, at_middle, solved, samples)
    return Propagated(
        scene=middle,
        answer=answer,
        quantities=found,
        correlation=_correlation(factors),
        solved=1 + (samples or 2 * len(inputs.inputs)),
    )


def _physical(answer: Solution) -> Named:
    """Quantities with a unit. Of a detachment only its scalars: the number of states varies."""
    left = answer.SCALARS if isinstance(answer, DetachmentPath) else tuple(UNITS)
    return tuple((name, q) for name, q in quantities(answer, Sampling()).items() if name in left)


Solve = Callable[[FloatArray], Named]
Found = tuple[tuple[PropagatedQuantity, ...], FloatArray]


def _differences(inputs: UncertainInputs, middle: Named, solved: Solve, _: int) -> Found:
    """Uncertainties by central differences, and independent contributions to the last steps, each in a row."""
    units = np.eye(len(inputs.inputs))
    above, below = ([_values(solved(sign * unit), middle) for unit in units] for sign in (1.0, -1.0))
    root = _root(inputs.correlation)
    found, last = [], []
    for number, (name, quantity) in enumerate(middle):
        changes = np.array([(up[number] - down[number]) / 2 for up, down in zip(above, below, strict=True)])
        curvature = np.array(
            [up[number] + down[number] - 2 * np.array(quantity.values) for up, down in zip(above, below, strict=True)]
        )
        shares = root.T @ changes
        spread = np.sqrt(np.sum(shares**2, axis=0))
        inputs_named = [entry.name for entry in inputs.inputs]
        bends = bool(np.any(np.abs(curvature).max(axis=0) / 2 > BENT * spread + 1e-9 * quantity.scale))
        found.append(_quantity(name, quantity, spread, dict(zip(inputs_named, changes, strict=True)), bends=bends))
        last.append(shares[:, -1])
    return tuple(found), np.array(last).T


def _sampled(inputs: UncertainInputs, middle: Named, solved: Solve, count: int) -> Found:
    """By samples; rows of the second result are the last steps of each sample, without their mean."""
    normal = np.random.default_rng(SEED).standard_normal((count, len(inputs.inputs)))
    drawn = [_values(solved(row), middle) for row in normal @ _root(inputs.correlation).T]
    found, last = [], []
    for number, (name, one) in enumerate(middle):
        values = np.array([sample[number] for sample in drawn])
        found.append(_quantity(name, one, np.std(values, axis=0, ddof=1), {}, bends=False))
        last.append(values[:, -1] - values[:, -1].mean())
    return tuple(found), np.array(last).T


def _values(found: Named, middle: Named) -> list[FloatArray]:
    """Values of each quantity along the steps.

    Raises:
        InvalidInput: if the number of steps changes with the inputs.
    """
    for (name, one), (_, other) in zip(found, middle, strict=True):
        if len(one.values) != len(other.values):
            raise InvalidInput(
                f"{name} has {len(one.values)} steps in place of {len(other.values)}: its instants follow the "
                "inputs; prescribe the states, or an impact"
            )
    return [np.array(one.values) for _, one in found]


def _quantity(
    name: str, one: Values, spread: FloatArray, by_input: dict[str, FloatArray], *, bends: bool
) -> PropagatedQuantity:
    return PropagatedQuantity(
        name=name,
        unit=one.unit,
        values=np.array(one.values),
        numerical=np.array(one.error) if one.error else None,
        inputs=spread,
        by_input=by_input,
        bends=bends,
    )


def _root(correlation: FloatArray) -> FloatArray:
    """A matrix whose product with its transpose is the correlation; inputs may be fully correlated."""
    values, vectors = np.linalg.eigh(correlation)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _correlation(factors: FloatArray) -> FloatArray:
    lengths = np.sqrt(np.sum(factors**2, axis=0))
    size = np.where(lengths > 0, lengths, 1.0)
    return np.asarray(factors.T @ factors / np.outer(size, size))


def _mdr() -> Method:
    # A method is imported where it is used.
    from mdr import Mdr  # noqa: PLC0415

    return Mdr()
