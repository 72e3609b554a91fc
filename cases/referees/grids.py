"""Grid codes by other authors as methods: ContactMechanics and Tamaas, which use fast transforms.

ContactMechanics is driven by depths and Tamaas by forces. A scene that prescribes the other quantity is solved by a
search. Neither states errors.
"""

from dataclasses import dataclass, replace
from typing import Any, ClassVar, Self

import numpy as np

from cases.referees.from_depth import inverted
from cases.referees.process import insist, lacks, run_worker, support, version
from contact import (
    ContactPath,
    FlatPunch,
    IndentationDepths,
    NormalForces,
    Scene,
    Shape,
    StageLog,
    Supported,
    Unsupported,
    not_round,
    other_layer,
)
from contact.records.validation import FloatArray
from contact.scene.extent import radius_of_load

# Quantities by the loading that prescribes them.
PRESCRIBED = {IndentationDepths: "indentation_depth", NormalForces: "normal_force"}
# Margin of a periodic layer beyond the contact, in thicknesses. Between neighbours, twice as far, displacements fall
# like exp(-2.1 r/h) on unbonded and faster on bonded layers (first root of their kernels), to 5e-8.
LAYER_MARGIN = 4.0
# Side of a half-space's grid, which is not periodic, over the diameter of the largest contact: of n points n/22 stay
# free on each side of a flat punch, three of 64, and more around curved indenters, whose contact is smaller than that.
SIDE_OVER_CONTACT = 1.1
# Largest height in sides of the grid: points beyond the edge of the indenter, which never touch.
LARGEST_HEIGHT = 1e3


@dataclass(frozen=True, kw_only=True)
class GridCode:
    """An outside solver on a square grid, run in a process of its own.

    Attributes:
        points: Number of points of the grid, each way.
        tolerance: Tolerance of the solver's own iteration, relative.
    """

    name: ClassVar[str]
    package: ClassVar[str]
    # Quantity that the solver prescribes.
    driven_by: ClassVar[str]
    shared_inputs: ClassVar[tuple[str, ...]] = ()

    points: int = 64
    tolerance: float = 1e-9

    def supports(self, scene: Scene) -> Supported | Unsupported:
        """Whether the package is installed and models the scene."""
        is_shape, takes = isinstance(scene.indenter, Shape), isinstance(scene.loading, tuple(PRESCRIBED))
        return support(
            not_round(self.package, scene) if is_shape else other_layer(self.package, scene.layer),
            "elastic contact only" if scene.effects else "",
            "" if takes else "takes IndentationDepths and NormalForces only",
            self.lacks_layer(scene),
            lacks(self.package),
        )

    def lacks_layer(self, scene: Scene) -> str:
        """Reason why the package does not model the layer of a scene, empty where it does."""
        return "" if scene.layer.is_half_space else "it models half-spaces"

    def solve(self, scene: Scene) -> ContactPath:
        """The equilibria, without stated errors."""
        insist(self, scene)
        log, prescribed = StageLog(), PRESCRIBED[type(scene.loading)]
        values: FloatArray = scene.loading.values  # type: ignore[attr-defined]  # depths or forces
        with log.stage("grid"):
            # Depths or forces, as the solver prescribes them.
            loads = values
            if prescribed != self.driven_by:
                loads = inverted(
                    lambda loads: self._quantities(scene, loads)[prescribed], values, _first_loads(scene, values)
                )
            answer: dict[str, Any] = self._quantities(scene, loads, with_stiffness=True) | {self.driven_by: loads}
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={
                "points": self.points,
                "tolerance": self.tolerance,
                "package": f"{self.package} {version(self.package)}",
            },
            **answer,
            error_estimate={},
            cost=log.cost(unknowns=self.points**2),
            stages=log.records,
        )

    def refined(self) -> Self:
        """A copy with half the distance of points."""
        return replace(self, points=2 * self.points)

    def _quantities(self, scene: Scene, loads: FloatArray, *, with_stiffness: bool = False) -> dict[str, FloatArray]:
        """Quantities by name at each depth or force, shape (n,); the stiffness takes further solutions."""
        layer = scene.layer
        depths = scene.loading.values if isinstance(scene.loading, IndentationDepths) else loads
        is_depth = self.driven_by == "indentation_depth" or depths is not loads
        size = box(scene, float(depths.max()) if is_depth else _depth_of_force(scene, float(loads.max())))
        inputs = {
            "heights": heights(scene, self.points, size).tolist(),
            "size": size,
            "young": layer.youngs_modulus,
            "poisson": layer.poissons_ratio,
            "thickness": None if layer.is_half_space else layer.thickness,
            "tolerance": self.tolerance,
            "loads": loads.tolist(),
            "with_stiffness": with_stiffness,
        }
        return run_worker(f"{self.name}_grid", inputs)


class ContactMechanics(GridCode):
    """Constrained conjugate gradients: half-spaces, and bonded layers of nu < 1/2 on a periodic grid."""

    name = "contact_mechanics"
    package = "ContactMechanics"
    driven_by = "indentation_depth"

    def lacks_layer(self, scene: Scene) -> str:
        """Reason why the package does not model the layer of a scene, empty where it does."""
        layer = scene.layer
        modelled = layer.is_half_space or (layer.support == "bonded" and not layer.is_incompressible)
        return "" if modelled else "it models half-spaces, and bonded layers of nu < 1/2"


class Tamaas(GridCode):
    """The algorithm of Polonsky and Keer on half-spaces, with the operator of a grid that is not periodic."""

    name = "tamaas"
    package = "tamaas"
    driven_by = "normal_force"


def _first_loads(scene: Scene, values: FloatArray) -> FloatArray:
    """First guess of the search, by F = E* r delta: forces of prescribed depths, or depths of prescribed forces."""
    modulus, flat = scene.layer.contact_modulus, scene.indenter.flat_radius
    if isinstance(scene.loading, IndentationDepths):
        return np.asarray(modulus * (flat + values) * values)
    length = flat or float(np.sqrt(np.max(values) / modulus))
    return np.asarray(values / (2.0 * modulus * length))


def _depth_of_force(scene: Scene, force: float) -> float:
    """Upper bound of the depth [m] under a force [N] on a half-space."""
    load, indenter = force / scene.layer.contact_modulus, scene.indenter
    return load / (indenter.radius if isinstance(indenter, FlatPunch) else radius_of_load(indenter, load / 2.0))


def box(scene: Scene, depth: float) -> float:
    """Length of the grid's sides [m] for depths up to ``depth``.

    A half-space is not touched where the profile is higher than the depth, a layer where it is higher than twice the
    depth, since the surface of thin incompressible layers rises outside the contact.
    """
    layer, indenter = scene.layer, scene.indenter
    height = depth if layer.is_half_space else 2.0 * depth
    reach = indenter.radius if isinstance(indenter, FlatPunch) else _radius_of_height(scene, height)
    return 2.0 * (SIDE_OVER_CONTACT * reach if layer.is_half_space else reach + LAYER_MARGIN * layer.thickness)


def _radius_of_height(scene: Scene, height: float) -> float:
    """Radius [m] at which the profile has a height, within a thousandth: the size of a grid needs no more."""
    low = high = max(scene.indenter.flat_radius, height)
    while float(scene.indenter.height(high)) < height:
        low, high = high, 2.0 * high
    while high - low > 1e-3 * high:
        middle = (low + high) / 2.0
        low, high = (middle, high) if float(scene.indenter.height(middle)) < height else (low, middle)
    return high


def heights(scene: Scene, points: int, size: float) -> FloatArray:
    """Heights of the indenter [m] at the points of a square grid, downwards from its apex in the middle."""
    x = (np.arange(points) - points / 2 + 0.5) * size / points
    return np.asarray(-np.minimum(scene.indenter.height(np.hypot(x[:, None], x[None, :])), LARGEST_HEIGHT * size))
