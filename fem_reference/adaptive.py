"""Settings for a requested accuracy: a first guess from measured error laws, refined until the estimate holds."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TypeVar

import numpy as np

from contact import HistoryPath, ImpactHistory, NotConvergedError
from fem_reference.discrete_layer.settings import Discretisation
from fem_reference.elastic.error_estimate import ContactAttempt, ContactWithErrors

# The error of P4P3 falls like this power of the growth on graded meshes: measured, the theoretical 2k = 8 less what
# irregular meshes lose.  It chooses the next mesh only; a wrong value costs attempts, no accuracy.
ERROR_ORDER = 7.0
# An error above all that were estimated for P4P3 at growth 1/2 on punches, cones and paraboloids (measured).  It
# chooses the first mesh only.
ERROR_AT_HALF = 8e-6

H = TypeVar("H", bound=HistoryPath | ImpactHistory)


def settings_for(accuracy: float) -> Discretisation:
    """A discretisation that usually meets ``accuracy`` (relative) at the first attempt."""
    # Beyond a growth of one a mesh has fewer than a hundred triangles, on which the errors of three degrees say little.
    growth = float(np.clip(0.5 * (accuracy / ERROR_AT_HALF) ** (1 / ERROR_ORDER), 0.05, 1.0))
    return Discretisation(
        order=4,
        growth=growth,
        edge_cell=float(np.clip(accuracy / 2, 1e-11, 1e-3)),
        # The outer edge shall add nothing to the other errors.
        truncation=float(np.clip(0.003 * accuracy, 1e-13, 1e-3)),
        half_space_thickness=float(np.clip(100 / accuracy, 1e3, 1e12)),
    )


def solve_to_accuracy(attempt: ContactAttempt, accuracy: float) -> ContactWithErrors:
    """Refine until the estimated errors of stiffness, depth and force are below ``accuracy``.

    Raises:
        NotConvergedError: six refinements did not suffice.
    """
    settings = settings_for(accuracy)
    for _ in range(6):
        contact = attempt(settings)
        worst = max(contact.error[name] for name in ("stiffness", "smooth_depth", "smooth_force"))
        if worst <= accuracy:
            return contact
        factor = np.clip(0.9 * (accuracy / worst) ** (1 / ERROR_ORDER), 0.5, 0.9)
        growth = float(max(settings.growth * factor, 0.02))
        settings = replace(
            settings,
            growth=growth,
            edge_cell=max(settings.edge_cell / 4, 1e-12),
            truncation=max(settings.truncation / 10, 1e-13),
        )
    raise NotConvergedError(f"accuracy {accuracy:g} was not reached", {"estimated_error": worst})


def solve_history_to_accuracy(attempt: Callable[[Discretisation], H], accuracy: float) -> H:
    """Halve cells and time steps until the estimated errors are below accuracy.

    An impact is judged by its restitution, peak force and peak depth, a history by depth and force.

    Raises:
        NotConvergedError: five attempts did not suffice.
    """
    settings = replace(settings_for(accuracy), growth=1.0)
    for _ in range(5):
        history = attempt(settings)
        names = ("coefficient_of_restitution", "peak_force", "peak_depth", "indentation_depth", "normal_force")
        judged = names[:3] if isinstance(history, ImpactHistory) else names[3:]
        worst = max(float(np.max(history.error_estimate[name])) for name in judged)
        if worst <= accuracy:
            return history
        settings = replace(settings, growth=settings.growth / 2)
    raise NotConvergedError(f"accuracy {accuracy:g} was not reached in time", {"estimated_error": worst})
