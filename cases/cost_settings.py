"""Settings of each method from coarse to fine, as work studies try them, and the studies of the usual scenes.

Elastic scenes are measured against the direct integral equation, which uses no equivalent springs and no factor for all
radii; detachments and motions against the fast method at its finest, whose own error bar counts against every method.
"""

from collections.abc import Sequence
from typing import Final

from cases.cost import Cost
from cases.declare.methods import MethodUse


def _each(method: str, setting: str, values: Sequence[float], label: str, **fixed: float) -> tuple[MethodUse, ...]:
    """A method with each value of one setting, in this order."""
    return tuple(
        MethodUse(label=label.format(value), method=method, settings={setting: value, **fixed}) for value in values
    )


MDR: Final = _each("mdr", "nodes", (8, 12, 16, 24), "{} nodes")
MDR_IN_TIME: Final = _each("mdr", "accuracy", (1e-4, 1e-6, 1e-8, 1e-10), "accuracy {:g}")
EQUATION: Final = _each("integral_equation", "nodes", (6, 8, 10, 16), "{} nodes")
FEM: Final = (
    *(
        MethodUse(
            label=f"P{order}P{order - 1}, growth {growth:g}, edge {edge:g}",
            method="fem",
            settings={"order": order, "growth": growth, "edge_cell": edge, "truncation": 1e-10},
        )
        for order, growth, edge in ((2, 0.5, 1e-4), (3, 0.5, 1e-5), (3, 0.25, 1e-6), (4, 0.5, 1e-7), (4, 0.25, 1e-8))
    ),
    *_each("fem", "accuracy", (1e-2, 1e-4, 1e-6), "accuracy {:g}"),
)
# Solvers of others, each refined by its own grid or mesh.
OTHERS: Final = (
    *_each("calculix", "cells", (4, 6, 8, 16), "{} cells"),
    *_each("contact_mechanics", "points", (32, 64, 128, 256), "{} points"),
    *_each("tamaas", "points", (32, 64, 128, 256), "{} points"),
)
FEM_BESIDE_OTHERS: Final = _each("fem", "accuracy", (1e-2, 1e-3, 1e-4, 1e-5, 1e-6), "accuracy {:g}")
FEM_DETACHING: Final = _each("fem", "accuracy", (1e-2, 1e-3, 1e-4), "accuracy {:g}")
FEM_IN_TIME: Final = _each("fem", "growth", (1.0, 0.5, 0.25), "growth {:g}")
BEM: Final = _each("bem", "points", (128, 256, 512, 1024), "{} cells")
PERIODIC: Final = MethodUse(label="256 cells, periodic", method="bem", settings={"points": 256, "boundary": "periodic"})
TABLE: Final = _each("mdr_table", "cells", (64, 128), "{} cells", ratios=60, radii=200)
# The route of the paper: 400 rows of a/h, 500 radii.
PUBLISHED_TABLE: Final = MethodUse(
    label="256 cells, 400 x 500", method="mdr_table", settings={"cells": 256, "ratios": 400, "radii": 500}
)

FINEST_EQUATION: Final = MethodUse(label="24 nodes", method="integral_equation", settings={"nodes": 24})
FINEST_MDR: Final = MethodUse(label="32 nodes", method="mdr", settings={"nodes": 32})
FINEST_MDR_IN_TIME: Final = MethodUse(
    label="32 nodes, accuracy 1e-12", method="mdr", settings={"nodes": 32, "accuracy": 1e-12}
)


def elastic_costs(
    scene: str,
    quantities: Sequence[str] = ("indentation_depth", "normal_force"),
    *,
    in_ci: bool = False,
    periodic: bool = False,
    as_published: bool = False,
) -> tuple[Cost, ...]:
    """What depth and force cost on an elastic scene, with every method that solves it.

    Args:
        scene: its name within the case.
        quantities: whose error is measured; all share the same timed solutions.
        in_ci: whether the ci suite times finite elements too, and all settings of the fast method, not one alone.
        as_published: whether the table of the paper, 400 rows by 500 radii, is timed too; it takes many seconds.
        periodic: whether boundary elements are tried without padding too: the contact is as wide as the layer is thick.
    """
    cheap = (*MDR[1:], *FEM[5:7]) if in_ci else MDR[2:3]
    grids = (*BEM, PERIODIC) if periodic else BEM
    tables = (*TABLE, PUBLISHED_TABLE) if as_published else TABLE
    return _studies(scene, quantities, (*MDR, *EQUATION, *FEM, *grids, *tables), FINEST_EQUATION, cheap)


def costs_beside_others(scene: str) -> tuple[Cost, ...]:
    """What a force costs by our methods and by solvers of others; theirs run in a process whose start counts."""
    ladder = (*MDR, *FEM_BESIDE_OTHERS, *BEM[:4], *OTHERS)
    return _studies(scene, ("normal_force",), ladder, FINEST_EQUATION, MDR[2:3])


def inside_costs(scene: str) -> tuple[Cost, ...]:
    """What stresses inside cost at the last of a scene's points, with the fields at all of them in the time."""
    quantities = ("von_mises_inside", "axial_stress_inside")
    return _studies(scene, quantities, (*MDR, *FEM), FINEST_MDR, MDR[2:3])


def detachment_costs(scene: str) -> tuple[Cost, ...]:
    """What the pull-off costs."""
    # A branch by finite elements takes a second, ten times over.
    cheap = MDR[2:3]
    quantities = ("pull_off_force", "pull_off_depth")
    return _studies(scene, quantities, (*MDR, *FEM_DETACHING, *BEM[:2], *TABLE), FINEST_MDR, cheap)


def impact_costs(scene: str) -> tuple[Cost, ...]:
    """What restitution and peak force of an impact cost."""
    cheap = (*MDR_IN_TIME[1:3], FEM_IN_TIME[0])
    quantities = ("coefficient_of_restitution", "peak_force")
    return _studies(scene, quantities, (*MDR_IN_TIME, *FEM_IN_TIME, *TABLE), FINEST_MDR_IN_TIME, cheap)


def _studies(
    scene: str,
    quantities: Sequence[str],
    ladder: tuple[MethodUse, ...],
    reference: MethodUse,
    cheap: tuple[MethodUse, ...],
) -> tuple[Cost, ...]:
    return tuple(
        Cost(
            name=f"cost of {quantity}, {scene}",
            scene=scene,
            quantity=quantity,
            ladder=ladder,
            reference=reference,
            cheap=cheap,
        )
        for quantity in quantities
    )
