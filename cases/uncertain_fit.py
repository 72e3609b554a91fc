"""A fit of a force curve with an uncertain tip or layer. Their effect is added to the confidence intervals.

The curve is fitted anew with each input one standard deviation up and down. With D the changes of a parameter and R the
correlation of the inputs its variance grows by D R D^T (the law of propagation, GUM 5.2).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from cases.declare.uncertain_inputs import UncertainInputs, read_inputs
from contact import InvalidInput, Scene
from contact.records.validation import FloatArray
from mdr.curves import CurveFit, fit_curve
from mdr.curves.fit import DEFAULT_PARAMETERS


@dataclass(frozen=True, kw_only=True)
class UncertainFit:
    """A fit with its uncertain inputs.

    Attributes:
        fit: Fit at the middle of the inputs; its intervals include scatter, numerical error and inputs.
        inputs: Uncertain inputs.
        changes: Change of each parameter per standard deviation of each input, [parameter][input].
    """

    fit: CurveFit
    inputs: UncertainInputs
    changes: dict[str, dict[str, float]]


def fit_uncertain(
    scene: Scene,
    depth: Sequence[float] | FloatArray,
    force: Sequence[float] | FloatArray,
    uncertain: str | UncertainInputs,
    *,
    parameters: Sequence[str] = DEFAULT_PARAMETERS,
    confidence: float = 0.95,
) -> UncertainFit:
    """Fit as `mdr.curves.fit_curve` does, with the effect of uncertain inputs added to the intervals.

    Args:
        scene: Tip and layer; uncertain ranges are replaced by their middles.
        depth: Measured depths [m], shape (n,).
        force: Measured forces [N], shape (n,).
        uncertain: Text as of `read_inputs`, such as "radius=5%, thickness=4e-6..6e-6", or what that gives.
        parameters: Fitted parameters, as `fit_curve` takes them.
        confidence: Confidence level of the intervals.

    Raises:
        InvalidInput: For what is no uncertain input of this scene, or is fitted; and as `fit_curve` does.
        NotConvergedError: If a fit does not converge.
    """
    inputs = read_inputs(uncertain, scene) if isinstance(uncertain, str) else uncertain
    fitted = {"youngs_modulus", *parameters} & {entry.name.rpartition(".")[2] for entry in inputs.inputs}
    if fitted:
        raise InvalidInput(f"uncertain {', '.join(sorted(fitted))}: the fit finds it; name what is held")

    def at(deviations: FloatArray) -> CurveFit:
        changed = inputs.scene_at(scene, deviations)
        return fit_curve(changed, depth, force, parameters=parameters, confidence=confidence)

    middle = at(np.zeros(len(inputs.inputs)))
    pairs = [(at(unit).values, at(-unit).values) for unit in np.eye(len(inputs.inputs))]
    changes = {name: np.array([(up[name] - down[name]) / 2 for up, down in pairs]) for name in middle.values}
    spread = {name: float(inputs.spread(d[:, None])[0]) for name, d in changes.items()}
    names = [entry.name for entry in inputs.inputs]
    return UncertainFit(
        fit=replace(middle, input_error=spread),
        inputs=inputs,
        changes={name: dict(zip(names, d.tolist(), strict=True)) for name, d in changes.items()},
    )
