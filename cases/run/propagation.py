"""Propagation of uncertain inputs through a method to every quantity of its answer.

By differences: with D the change of a quantity per standard deviation of each input and R the correlation of the
inputs, u^2 = D R D^T (the law of propagation, GUM 5.2). Each input is changed by one deviation up and down. Where both
changes differ much the quantity is nonlinear, and samples, which use the whole distribution, are more accurate.
"""

import math
from dataclasses import dataclass, field, replace
from typing import TypeAlias

import numpy as np

from cases.answers import Values
from cases.declare.uncertain_inputs import UncertainInputs, read_inputs
from cases.recording import quantities as quantities_of
from contact import UNITS, DetachmentPath, InvalidInput, Method, Scene, Solution
from contact.records.validation import FloatArray
from mdr import Mdr

# The seed of the samples: an answer repeats digit by digit.
SEED = 20261122
# Curvature over the uncertainty beyond which a quantity counts as nonlinear; samples are then more accurate.
NONLINEAR = 0.1
# Fewer samples give standard deviations with errors of more than 20 %.
FEWEST_SAMPLES = 16


@dataclass(frozen=True, kw_only=True)
class PropagatedQuantity:
    """A quantity of the answer with both of its uncertainties, along its steps.

    Attributes:
        name: Name of the quantity.
        unit: SI unit.
        values: Values at the middle of the inputs, shape (n,).
        numerical: Error that the method states, absolute, shape (n,); None where it states none.
        inputs: Standard uncertainty by the inputs, absolute, shape (n,).
        by_input: Change per standard deviation of each input, absolute, by its name; empty for samples.
        is_nonlinear: Whether changes of an input up and down cause different changes; always False for samples.
    """

    name: str
    unit: str
    values: FloatArray
    numerical: FloatArray | None
    inputs: FloatArray
    by_input: dict[str, FloatArray] = field(default_factory=dict)
    is_nonlinear: bool = False


@dataclass(frozen=True, kw_only=True)
class Propagated:
    """An answer at the middle of uncertain inputs, and the uncertainty that they cause.

    Attributes:
        scene: Scene with the inputs at their middle.
        answer: Answer to this scene.
        quantities: Quantities with their uncertainties.
        correlation: Correlation of the last steps of the quantities, in their order; zero if one does not vary.
        solved: Number of scenes solved.
    """

    scene: Scene
    answer: Solution
    quantities: tuple[PropagatedQuantity, ...]
    correlation: FloatArray
    solved: int

    def quantity(self, name: str) -> PropagatedQuantity:
        """The quantity called ``name``.

        Raises:
            InvalidInput: If the answer has none.
        """
        for q in self.quantities:
            if q.name == name:
                return q
        raise InvalidInput(f"no quantity {name!r}; there are {', '.join(q.name for q in self.quantities)}")


def propagate(
    scene: Scene, uncertain: str | UncertainInputs, *, method: Method | None = None, samples: int = 0
) -> Propagated:
    """Propagates the standard uncertainties of inputs to every quantity of the answer.

    By differences (GUM 5.2), two solutions per input, or by the scatter of quantities over scenes drawn at random.

    Args:
        scene: Scene whose uncertain inputs are replaced by the middles of their ranges.
        uncertain: Inputs as text, e.g. "radius=5%", or as returned by `read_inputs`.
        method: Solves the scenes; MDR by default.
        samples: Number of scenes drawn at random; differences for zero.

    Raises:
        InvalidInput: An input that the scene does not have, or fewer than `FEWEST_SAMPLES` samples.
        UnsupportedSceneError, NotConvergedError: As the method raises them.
    """
    if samples and samples < FEWEST_SAMPLES:
        raise InvalidInput(f"samples = {samples}: take at least {FEWEST_SAMPLES}, or none for differences")
    inputs = read_inputs(uncertain, scene) if isinstance(uncertain, str) else uncertain
    solver, count = method or Mdr(), len(inputs.inputs)
    root = _root(inputs.correlation)
    middle = inputs.scene_at(scene, np.zeros(count))
    answer = solver.solve(middle)
    at_middle = _physical(answer)
    if samples:
        deviations = np.random.default_rng(SEED).standard_normal((samples, count)) @ root.T
    else:
        deviations = np.concatenate([np.eye(count), -np.eye(count)])
    scenes = (inputs.scene_at(scene, numbers, drawn=bool(samples)) for numbers in deviations)
    solved = [_values(_physical(solver.solve(changed_scene)), at_middle) for changed_scene in scenes]
    quantities, factors = [], []
    for name, values in at_middle.items():
        changed = np.array([numbers[name] for numbers in solved])
        quantity, factor = _sampled(name, values, changed) if samples else _differences(name, values, changed, inputs)
        quantities.append(quantity)
        factors.append(factor[:, -1])
    return Propagated(
        scene=middle,
        answer=answer,
        quantities=tuple(quantities),
        correlation=_correlation(np.array(factors).T),
        solved=1 + len(deviations),
    )


def _physical(answer: Solution) -> dict[str, Values]:
    """Quantities with a unit. Of a detachment only its scalars: the number of states varies."""
    names = answer.SCALARS if isinstance(answer, DetachmentPath) else tuple(UNITS)
    return {name: values for name, values in quantities_of(answer).items() if name in names}


def _values(answer: dict[str, Values], middle: dict[str, Values]) -> dict[str, FloatArray]:
    """Values of each quantity along the steps.

    Raises:
        InvalidInput: If the number of steps changes with the inputs.
    """
    for name, q in middle.items():
        if len(answer[name].values) != len(q.values):
            raise InvalidInput(
                f"{name} has {len(answer[name].values)} steps in place of {len(q.values)}: its instants follow the "
                "inputs; prescribe the states, or an impact"
            )
    return {name: np.array(answer[name].values) for name in middle}


# A quantity, and independent contributions to its variance, the squares of rows of shape (inputs or samples, steps).
Contributions: TypeAlias = tuple[PropagatedQuantity, FloatArray]


def _differences(name: str, middle: Values, changed: FloatArray, inputs: UncertainInputs) -> Contributions:
    """Uncertainty by central differences, from solutions above and then below the middle of each input."""
    above, below = np.split(changed, 2)
    changes, curvature = (above - below) / 2, (above + below) / 2 - np.array(middle.values)
    factors = _root(inputs.correlation).T @ changes
    quantity = _quantity(name, middle, factors)
    nonlinear = np.any(np.abs(curvature).max(axis=0) > NONLINEAR * quantity.inputs + 5e-10 * middle.scale)
    by_input = dict(zip((entry.name for entry in inputs.inputs), changes, strict=True))
    return replace(quantity, by_input=by_input, is_nonlinear=bool(nonlinear)), factors


def _sampled(name: str, middle: Values, changed: FloatArray) -> Contributions:
    """Standard deviation of samples."""
    # Differences from one sample are exactly zero for a quantity that does not vary.
    differences = changed - changed[0]
    factors = (differences - differences.mean(axis=0)) / math.sqrt(len(changed) - 1)
    return _quantity(name, middle, factors), factors


def _quantity(name: str, middle: Values, factors: FloatArray) -> PropagatedQuantity:
    """The quantity with its values at the middle, and the uncertainty by the factors of its variance."""
    return PropagatedQuantity(
        name=name,
        unit=middle.unit,
        values=np.array(middle.values),
        numerical=np.array(middle.error) if middle.error else None,
        inputs=np.sqrt(np.sum(factors**2, axis=0)),
    )


def _root(correlation: FloatArray) -> FloatArray:
    """A matrix whose product with its transpose is the correlation; inputs may be fully correlated."""
    values, vectors = np.linalg.eigh(correlation)
    return np.asarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _correlation(factors: FloatArray) -> FloatArray:
    """Correlation of quantities by their contributions, shape (inputs or samples, quantities)."""
    lengths = np.sqrt(np.sum(factors**2, axis=0))
    size = np.where(lengths > 0, lengths, 1.0)
    return np.asarray(factors.T @ factors / np.outer(size, size))
