"""Sections 2.1, 2.2 and 4.1: paraboloids, truncated cones and coated pairs."""

from collections.abc import Iterator
from functools import partial

import numpy as np

from cases.library.coated_pair import RATIOS, one_body_on_its_plane, symmetric
from contact import Layer, Paraboloid, TruncatedCone
from docs.gallery._parts import SOURCE, UNBONDED, layer, name_of
from docs.gallery._thin_layers import thin_cone_force
from docs.gallery.figure_07 import depth_over_height, pressed
from mdr.equilibria import solve_elastic
from tests.verification.paper.statement import GOOD, Statement, deviation, within

FLAT = 0.5


def cone(ratio: float) -> TruncatedCone:
    """b/a = 0.5."""
    return TruncatedCone(flat_radius=FLAT * ratio, slope=0.01)


def depth_over_half_space(one: Layer, ratio: float) -> float:
    """Depth of the truncated cone over that of the half-space at the same contact radius."""
    path = pressed(one, cone(ratio), ratio)
    sneddon = ratio * 0.01 * np.arccos(FLAT)
    return deviation(float(path.indentation_depth[0]), float(sneddon))


def thin_force(one: Layer, ratio: float) -> float:
    """Eq. (36) or (38) over the force."""
    path = pressed(one, cone(ratio), ratio)
    limit = float(thin_cone_force(one, cone(ratio), ratio))
    return deviation(limit, float(path.normal_force[0]))


def thin_depth(one: Layer, ratio: float, share: float) -> float:
    """Table 1: depth a^2/(share R) of a paraboloid over the exact one."""
    path = pressed(one, Paraboloid(radius_of_curvature=1e3), ratio)
    return deviation(ratio**2 / (share * 1e3), float(path.indentation_depth[0]))


def pair_over_body(ratio: float) -> float:
    """Force of two equal coated bodies over that of one of them on a rigid plane."""
    scene = symmetric("bonded", ratio).scene
    both, alone = (solve_elastic(one, SOURCE, {}) for one in (scene, one_body_on_its_plane(scene)))
    return deviation(float(both.normal_force[0]), float(alone.normal_force[0]))


def statements() -> Iterator[Statement]:
    """The statements of these sections."""
    yield from thin_and_coated()
    yield from beside_the_half_space()


def thin_and_coated() -> Iterator[Statement]:
    """Thin layers and coated bodies."""
    for one, share in ((UNBONDED, 2.0), (layer(0.3), 2.0), (layer(0.45), 2.0), (layer(0.5), 4.0)):
        yield Statement(
            f"{name_of(one)}: depth of a paraboloid on a thin layer",
            partial(thin_depth, one, 100.0, share),
            within(GOOD),
        )
    for ratio in RATIOS:
        yield Statement(
            f"equal coated bodies, a/h = {ratio:g}: one indenter on one layer",
            partial(pair_over_body, ratio),
            within(1e-9),
        )


def beside_the_half_space() -> Iterator[Statement]:
    """Profiles on layers beside those on half-spaces."""
    for one in (layer(0.45), layer(0.5)):
        for ratio in (2.0, 5.0, 20.0):
            yield Statement(
                f"{name_of(one)}: for high Poisson's ratios and a/h >= 2 the surface rises beside the contact",
                partial(depth_over_height, one, ratio),
                lambda share: share < 1,  # g(a)/f(a): then the surface beside the contact has risen
            )
    for one in (UNBONDED, layer(0.45), layer(0.5)):
        for ratio in (0.1, 1.0, 5.0):
            yield Statement(
                f"{name_of(one)}, a/h = {ratio:g}: the contact is always larger than on the half-space at one depth",
                partial(depth_over_half_space, one, ratio),
                lambda value: value < 0,
            )
    for one in (UNBONDED, layer(0.45), layer(0.5)):
        yield Statement(
            f"{name_of(one)}: the asymptotic force is reached (a/h = 20 in Fig. 7)",
            partial(thin_force, one, 20.0),
            within(GOOD),
        )
