"""Equations that other sections leave out, (13), (20), (23), (25), (39), (53), (54), and a bound of section 3.2."""

from collections.abc import Iterator
from functools import partial

import numpy as np
from numpy.polynomial.chebyshev import Chebyshev
from numpy.polynomial.legendre import leggauss

from cases.library.coated_pair import pair
from cases.library.sphere_impact import (
    LONG_TERM_MODULUS,
    MASS,
    MAXWELL_MODULUS,
    RADIUS_OF_CURVATURE,
    RELAXATION_TIME,
    VELOCITY,
    impact,
)
from contact import CoatedPair, ContactRadii, FlatPunch, IndentationDepths, Layer, Paraboloid, PowerLaw, Profile, Scene
from docs.gallery._parts import SOURCE, UNBONDED, layer, name_of, punch
from docs.gallery._thin_layers import thin_cone_pressure, thin_profile
from docs.gallery.figure_07 import pressed
from mdr.equilibria import solve_elastic
from mdr.impact.solver import solve_impact
from tests.coated_pairs import mean_thickness_error
from tests.verification.paper.profiles import cone
from tests.verification.paper.statement import GOOD, SAME, Statement, deviation, reads, within

# Gauss nodes on the contact, and degree of the polynomial through g at these.
NODES = 16
CURVATURE = 1e3
PROFILES: dict[str, Profile] = {
    "paraboloid": Paraboloid(radius_of_curvature=CURVATURE),
    "r^4": PowerLaw(exponent=4.0, reference_radius=1e2, reference_height=1.0),
    "truncated cone": cone(100.0),
}


def displacement_by_punches(one: Layer, place: float) -> float:
    """Eq. (13) at r = place a, a = h: flat punches put on top of each other, over the solved displacement."""
    ball = Paraboloid(radius_of_curvature=CURVATURE)
    nodes, weights = leggauss(NODES)
    x = (nodes + 1) / 2
    path = solve_elastic(Scene(layer=one, indenter=ball, loading=ContactRadii(values=np.append(x, 1.0))), SOURCE, {})
    depth = path.indentation_depth
    # w_1D = delta - g, so that -w_1D' = g', and w_1D vanishes at the end of the contact.
    slope = Chebyshev.fit(x, depth[:-1], NODES - 1, domain=[0.0, 1.0]).deriv()(x)
    beside = np.array([_beside_punch(one, float(radius), place) for radius in x])
    summed = float(np.sum(weights / 2 * slope * beside))
    return deviation(summed, float(path.surface_displacement([place], NODES)[0]))


def _beside_punch(one: Layer, radius: float, place: float) -> float:
    loading = IndentationDepths([1e-3])
    path = solve_elastic(Scene(layer=one, indenter=FlatPunch(radius=radius), loading=loading), SOURCE, {})
    return float(path.surface_displacement([place], 0)[0]) / 1e-3


def thin_depth(profile: Profile) -> float:
    """Eq. (20)'s profile, the mean height over the contact, over the depth at a/h = 100, nu = 1/2."""
    path = pressed(layer(0.5), profile, 100.0)
    limit = float(thin_profile(layer(0.5), profile, np.array([100.0]))[0])
    return deviation(limit, float(path.indentation_depth[0]))


def unequal_radii() -> float:
    """Force of bodies with radii R and 2 R over that of two with R at one contact radius; curvatures 3/(2 R), 2/R."""
    radius, h = 1e-2, 1e-3
    first, second = (solve_elastic(pair(radius, n * radius, (h, h), h), SOURCE, {}) for n in (2.0, 1.0))
    return deviation(float(first.normal_force[0] / second.normal_force[0]), 0.75)


def mean_thickness(poissons_ratio: float, ratio: float) -> float:
    """Force of Eq. (25) over that of coatings of 0.9 h and 1.1 h as they are."""
    bodies = CoatedPair(
        first_radius=1e-2,
        second_radius=2e-2,
        first_thickness=0.9e-3,
        second_thickness=1.1e-3,
        youngs_modulus=1e6,
        poissons_ratio=poissons_ratio,
        support="bonded",
        loading=ContactRadii([ratio * 1e-3]),
    )
    return float(mean_thickness_error(bodies, ratio * 1e-3).normal_force[0])


def thin_pressure(ratio: float) -> float:
    """Eq. (39) in the middle over the solved pressure, nu = 1/2, b/a = 0.5."""
    one = layer(0.5)
    path = pressed(one, cone(ratio), ratio)
    solved = float(path.pressure(np.array([0.0]))[0])
    return deviation(float(thin_cone_pressure(one, cone(ratio), ratio, np.array([0.0]))[0]), solved)


def impact_number() -> float:
    """chi_HS of the data of Fig. 12, Eq. (53)."""
    viscosity = MAXWELL_MODULUS * RELAXATION_TIME
    inner = RADIUS_OF_CURVATURE * VELOCITY / (MASS**2 * LONG_TERM_MODULUS**3)
    return viscosity * inner**0.2


def same_thin_impact(support: str) -> float:
    """Restitution with twice the thickness at one chi_TL, Eq. (54), over the original one; a/h is about 80."""
    pairs = {"bonded": 2.0**1.5, "unbonded": 2.0}
    runs = [_thin_impact(support, thickness, speed) for thickness, speed in ((1.0, 1.0), (2.0, pairs[support]))]
    return deviation(runs[1], runs[0])


def _thin_impact(support: str, thickness: float, speed: float) -> float:
    """On a layer of so many micrometres, at so many times the usual velocity."""
    scene = impact(1e-3).scene
    thin = scene.layer.replace(thickness=1e-6 * thickness, support=support)
    loading = scene.loading.replace(velocity=speed * 1e-3 * VELOCITY)
    return float(solve_impact(scene.replace(layer=thin, loading=loading), SOURCE, {}).coefficient_of_restitution)


def largest_difference() -> tuple[float, float]:
    """a/h where unbonded and bonded nu = 0 differ most, and by how much."""
    ratios = np.geomspace(0.3, 2.0, 400)
    loose, bonded = (punch(one).normalized_contact_stiffness(ratios) for one in (UNBONDED, layer(0.0)))
    off = np.asarray(bonded / loose - 1)
    worst = int(np.argmax(np.abs(off)))
    return float(ratios[worst]), float(off[worst])


def statements() -> Iterator[Statement]:
    """The statements of these equations."""
    for section in (_superposition, _thin_profiles, _pairs, _thin_pressures, _impacts, _likeness):
        yield from section()


def _superposition() -> Iterator[Statement]:
    """Eq. (13): displacements outside."""
    for one in (UNBONDED, layer(0.5)):
        for place in (1.2, 2.0):
            yield Statement(
                f"{name_of(one)}, r = {place:g} a: displacements outside follow from flat punches",
                partial(displacement_by_punches, one, place),
                within(1e-6),
            )


def _thin_profiles() -> Iterator[Statement]:
    """Eq. (20): thin layers by the closed form."""
    for name, profile in PROFILES.items():
        yield Statement(
            f"{name}: the closed-form MDR of bonded incompressible thin layers",
            partial(thin_depth, profile),
            within(GOOD),
        )


def _pairs() -> Iterator[Statement]:
    """Eqs. (23) and (25): two bodies, two coatings."""
    yield Statement("bodies of radii R and 2 R: curvatures add", unequal_radii, within(1e-9))
    for nu, ratio in ((0.3, 0.5), (0.3, 5.0), (0.5, 0.5), (0.5, 5.0)):
        yield Statement(
            f"nu = {nu:g}, a/h = {ratio:g}: coatings of 0.9 h and 1.1 h are well replaced by h",
            partial(mean_thickness, nu, ratio),
            within(GOOD),
        )


def _thin_pressures() -> Iterator[Statement]:
    """Eq. (39): pressures on thin layers."""
    for ratio in (20.0, 100.0):
        yield Statement(
            f"the asymptotic pressure of a truncated cone, a/h = {ratio:g}", partial(thin_pressure, ratio), within(GOOD)
        )


def _impacts() -> Iterator[Statement]:
    """Eqs. (53) and (54): numbers of impacts."""
    yield Statement("chi_HS of the data of Fig. 12", impact_number, reads(2.65, 0.005))
    for support in ("unbonded", "bonded"):
        yield Statement(
            f"{support}: chi_TL and G_inf/G_1 define impacts on thin layers",
            partial(same_thin_impact, support),
            within(SAME),
        )


def _likeness() -> Iterator[Statement]:
    """Section 3.2: unbonded layers and bonded ones with nu = 0."""
    yield Statement(
        "unbonded and bonded with nu = 0 give almost the same, wherever they differ most",
        lambda: largest_difference()[1],
        within(SAME),
    )
    yield Statement(
        "unbonded and bonded with nu = 0: the difference is largest here",
        lambda: largest_difference()[0],
        lambda value: value > 0.0,
    )
