"""What grid codes of others need to know of a scene: how large the grid is, and how high the indenter stands there."""

import numpy as np

from contact import FlatPunch, Loading, Scene, Shape, not_round, other_layer
from contact.scene.extent import radius_of_load

# A repeated layer reaches so many thicknesses beyond the contact on each side: what neighbours feel of one another
# falls like exp(-2.1 r/h) on unbonded and faster on bonded layers (first root of their kernels), to 5e-8 over eight.
BESIDE = 4.0
# Side of a half-space's grid, which is not repeated, over the diameter it must hold: of n points n/22 stay free on each
# side of a flat punch, three of 64, and more around curved indenters, whose contact is smaller than that diameter.
RIM = 1.1
# Height in sides of the grid above which points never touch: those beyond the edge of the indenter.
FAR = 1e3


def refusal(scene: Scene, code: str, loadings: tuple[type[Loading], ...]) -> str:
    """Why a grid code does not model a scene, empty where it may."""
    other = not_round(code, scene) if isinstance(scene.indenter, Shape) else other_layer(code, scene.layer)
    reasons = {
        "" if other is None else other.reason: other is not None,
        "elastic contact only": bool(scene.effects),
        f"takes {' and '.join(kind.__name__ for kind in loadings)} only": not isinstance(scene.loading, loadings),
    }
    return next((reason for reason, there in reasons.items() if there), "")


def box(scene: Scene, depth: float) -> float:
    """Length of the grid's sides [m] for depths up to ``depth``.

    No half-space is touched where the profile stands higher than the depth, no layer where it stands twice as high
    (thin incompressible layers pile up to that).
    """
    if isinstance(scene.indenter, FlatPunch):
        reach = scene.indenter.radius
    else:
        reach = _where_high(scene, depth if scene.layer.is_half_space else 2.0 * depth)
    return 2.0 * (RIM * reach if scene.layer.is_half_space else reach + BESIDE * scene.layer.thickness)


def deepest(scene: Scene, force: float, modulus: float) -> float:
    """A depth [m] that a force [N] on a half-space of this E* [Pa] does not exceed."""
    load, indenter = force / modulus, scene.indenter
    return load / (indenter.radius if isinstance(indenter, FlatPunch) else radius_of_load(indenter, load / 2.0))


def surface(scene: Scene, points: int, size: float) -> list[list[float]]:
    """Heights of the indenter [m] at the points of a square grid, downwards from its apex in the middle."""
    x = (np.arange(points) - points / 2 + 0.5) * size / points
    heights = -np.minimum(scene.indenter.height(np.hypot(x[:, None], x[None, :])), FAR * size)
    return heights.tolist()  # type: ignore[no-any-return]


def _where_high(scene: Scene, height: float) -> float:
    """Radius [m] at which the profile has a height, within a thousandth."""
    low = high = max(scene.indenter.flat_radius, height)
    while float(scene.indenter.height(high)) < height:
        low, high = high, 2.0 * high
    while high - low > 1e-3 * high:
        middle = (low + high) / 2.0
        low, high = (middle, high) if float(scene.indenter.height(middle)) < height else (low, middle)
    return high
