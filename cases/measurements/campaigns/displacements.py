"""Displacements beside random contacts on uniform, layered and graded bodies, alone and in a list.

- **displacement alone**: each radius asked for by itself against the same radius in a list that reaches further;
- **displacement**: distance from the direct integral equation, at its worst radius.

Radii are a rounding beyond those where a method may change its panels, a whole power of two of the contact's radius
from its edge, and random ones. Distances count relative to the depth.
"""

from functools import partial
from typing import Any, Final

import numpy as np

from bem.layer_equation.method import IntegralEquationMethod
from cases.measurements.campaigns.campaign import HUNDRED_ROUNDINGS
from cases.measurements.campaigns.random_scenes import log_uniform, poissons_ratio
from cases.measurements.driver import Judge, drawn_and_measured
from cases.measurements.measurement import Measurement
from contact import (
    Cone,
    ContactPath,
    ContactRadii,
    ElasticLayer,
    ExponentialDepth,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    Paraboloid,
    PowerLaw,
    Profile,
    Scene,
    Solution,
    Sublayer,
    TruncatedCone,
)
from contact.records.validation import FloatArray
from contact.scene.layer import Support

Draw = np.random.Generator

# Distances from the edge over the contact's radius. Close to the edge polynomials of few nodes end.
_DOUBLINGS: Final = 2.0 ** np.append([-12.0, -9.0, -6.0], np.arange(-4.0, 2.0))
# a/h on the layers of this campaign; graded ones take seconds beyond.
_RATIO: Final = (0.05, 3.0)


def _drawn(draw: Draw) -> tuple[Scene, Judge]:
    scene = random_body(draw)
    return scene, partial(_checks, distances=np.append(_DOUBLINGS, draw.uniform(0.01, 5.0, 3)))


displacement_campaign: Final = partial(drawn_and_measured, draw=_drawn, family="displacement")


def _checks(path: Solution, distances: FloatArray) -> tuple[Measurement, Measurement]:
    assert isinstance(path, ContactPath)
    return alone_check(path, distances), referee_check(path, distances)


def alone_check(path: ContactPath, distances: FloatArray) -> Measurement:
    """Single radii against the same in a list: nothing but the last digits may depend on the others."""
    radius = _beside(path, distances)
    listed = path.surface_displacement(np.append(radius, 2 * radius.max()))[:-1]
    alone = np.array([path.surface_displacement(radius[[n]])[0] for n in range(radius.size)])
    error = float(np.abs(alone - listed).max() / path.indentation_depth[0])
    return Measurement(
        method=path.method, quantity="displacement alone", error=error, stated=0.0, uncertainty=HUNDRED_ROUNDINGS
    )


def referee_check(path: ContactPath, distances: FloatArray) -> Measurement:
    """Against the direct integral equation at the same radius, which may miss by what it states of depth and force."""
    own, by_radius = path.scene.loading, ContactRadii(values=path.contact_radius)
    is_punch = isinstance(path.scene.indenter, FlatPunch)
    scene = path.scene.replace(loading=own if is_punch else by_radius, effects=())
    opinion = IntegralEquationMethod().solve(scene)
    radius = _beside(path, distances)
    off = np.abs(path.surface_displacement(radius) - opinion.surface_displacement(radius))
    stated, allowance = _stated(path), _stated(opinion) + HUNDRED_ROUNDINGS
    error = float(off.max() / path.indentation_depth[0])
    return Measurement(
        method=path.method,
        quantity="displacement",
        reference="integral_equation",
        error=error,
        stated=stated,
        uncertainty=allowance,
        sharpness=stated / error if error > allowance else None,
    )


def _beside(path: ContactPath, distances: FloatArray) -> FloatArray:
    """Radii [m], each a rounding further out than said."""
    return np.asarray(np.nextafter(float(path.contact_radius[0]) * (1 + distances), np.inf))


def _stated(path: ContactPath) -> float:
    """What is stated of the displacement, or else the largest of radius, depth, force and stiffness."""
    if "surface_displacement" in path.error_estimate:
        return float(np.max(path.error_estimate["surface_displacement"]))
    return max(float(np.max(path.error_estimate.get(name, 0.0))) for name in path.ARRAYS)


def random_body(draw: Draw) -> Scene:
    """A contact of given radius on a layer of one of three kinds."""
    a, slope = log_uniform(draw, *_RATIO), log_uniform(draw, 1e-3, 0.3)
    layer: Any = (_uniform, _stack, _graded)[draw.integers(3)](draw)
    indenter: Profile = (
        Paraboloid(radius_of_curvature=a / slope),
        Cone(slope=slope),
        PowerLaw(exponent=float(draw.uniform(1.2, 4.0)), reference_radius=a, reference_height=slope * a),
    )[draw.integers(3)]
    # One contact in four has a flat end, most of which it has outgrown.
    if draw.integers(4) == 0:
        flat = float(draw.uniform(0.1, 1.1))
        indenter = FlatPunch(radius=a) if flat > 1.0 else TruncatedCone(flat_radius=flat * a, slope=slope)
    is_punch = isinstance(indenter, FlatPunch)
    loading = IndentationDepths([slope * a]) if is_punch else ContactRadii([a])
    return Scene(layer=layer, indenter=indenter, loading=loading, beyond_small_strains=True)


def _uniform(draw: Draw) -> ElasticLayer:
    support: Support = ("bonded", "unbonded")[int(draw.choice(2))]
    return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio(draw), support=support)


def _stack(draw: Draw) -> ElasticLayer:
    """Two sublayers, the upper one the softer or little stiffer: stiff films may lift off."""
    upper = Sublayer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio(draw))
    modulus, thickness = log_uniform(draw, 0.5, 30.0), log_uniform(draw, 0.2, 5.0)
    lower = Sublayer(thickness=thickness, youngs_modulus=modulus, poissons_ratio=poissons_ratio(draw))
    return LayerStack(sublayers=(upper, lower), interfaces=("bonded",))


def _graded(draw: Draw) -> ElasticLayer:
    modulus = ExponentialDepth(surface=1.0, base=log_uniform(draw, 0.5, 8.0))
    return GradedLayer(thickness=1.0, youngs_modulus=modulus, poissons_ratio=float(draw.uniform(0.0, 0.49)))
