"""A fit of a force curve with an uncertain tip or layer. Their effect is added to the confidence intervals.

The curve is fitted anew with each input one standard deviation up and down. With D the changes of a parameter and R the
correlation of the inputs its variance grows by D R D^T (the law of propagation, GUM 5.2).
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Unpack

import numpy as np

from cases.declare.uncertain_inputs import UncertainInputs, read_inputs
from contact import InvalidInput, Scene
from contact.records.validation import FloatArray
from mdr.curves import CurveFit, fit_curve
from mdr.curves.fit import Options


@dataclass(frozen=True, kw_only=True)
class UncertainFit:
    """A fit with its uncertain inputs.

    Attributes:
        fit: Fit at the middle of the inputs; its intervals include scatter, numerical error and inputs.
        inputs: The uncertain inputs.
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
    **options: Unpack[Options],
) -> UncertainFit:
    """Fit as `mdr.curves.fit_curve` does, with the effect of uncertain inputs added to the intervals.

    Args:
        scene: Tip and layer; uncertain ranges are replaced by their middles.
        depth: Measured depths [m], shape (n,).
        force: Measured forces [N], shape (n,).
        uncertain: Text as for `read_inputs`, such as "radius=5%, thickness=4e-6..6e-6", or the inputs read from it.
        options: Parameters, confidence and limit, as for `fit_curve`.

    Raises:
        InvalidInput: For inputs that the scene does not have or that are fitted, and as `fit_curve` does.
        NotConvergedError: If a fit does not converge.
    """
    inputs = read_inputs(uncertain, scene) if isinstance(uncertain, str) else uncertain
    names = [uncertain_input.name for uncertain_input in inputs.inputs]
    fitted = {"youngs_modulus", *options.get("parameters", ())} & {name.rpartition(".")[2] for name in names}
    if fitted:
        raise InvalidInput(f"uncertain {', '.join(sorted(fitted))}: the fit finds it; name inputs that are kept")

    def fit_at(deviations: FloatArray) -> CurveFit:
        return fit_curve(inputs.scene_at(scene, deviations), depth, force, **options)

    middle = fit_at(np.zeros(len(names)))
    pairs = [(fit_at(unit).values, fit_at(-unit).values) for unit in np.eye(len(names))]
    changes = {name: np.array([(up[name] - down[name]) / 2 for up, down in pairs]) for name in middle.values}
    spread = {name: float(inputs.spread(d[:, None])[0]) for name, d in changes.items()}
    return UncertainFit(
        fit=replace(middle, input_error=spread),
        inputs=inputs,
        changes={name: dict(zip(names, d.tolist(), strict=True)) for name, d in changes.items()},
    )
