"""Stacks, indenters, scenes and claims that the cases of stacks and graded layers share."""

import math
from collections.abc import Callable, Iterator, Mapping
from functools import partial

from cases.case import CaseScene
from cases.claims import Agree, Approach, Zero
from cases.library import _common as c
from cases.library._second_kernel import surface_compliance
from cases.library._shape_test import Compliance, unlike_shape
from contact import (
    ContactRadii,
    ElasticBase,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    LayerStack,
    Loading,
    Paraboloid,
    Profile,
    Sublayer,
    TruncatedCone,
)
from contact.scene.layer import Interface, Support

WHY = c.reasons("stacks")
METHODS = (c.MDR, c.EQUATION, c.FEM, c.BEM)
# Tolerance of MDR against each other method, a requirement.
REQUIRED = {"integral_equation": 1e-10, "fem": 1e-5, "bem": 1e-3}
RADIUS_OF_CURVATURE = 1e-2  # m
SLOPE = 0.05
DEPTH = 1e-5  # m
INDENTERS = ("paraboloid", "truncated cone", "flat punch")
FAST = ("mdr", "integral_equation")
# Rings halve towards the edge until the last is as narrow as the material at the surface is thick ..
HALVED = 0.5
# .. and, where the pressure of a graded layer has a logarithm, to 1e-4 of the contact.
SINGULAR_LEVELS = 13


def stack(
    *layers: tuple[float, float, float],
    interfaces: tuple[Interface, ...] = (),
    support: Support | ElasticBase = "bonded",
) -> LayerStack:
    """Return a stack from shares of the usual thickness, multiples of the usual modulus, and nu, top first."""
    sublayers = tuple(
        Sublayer(thickness=h * c.THICKNESS, youngs_modulus=E * c.YOUNGS_MODULUS, poissons_ratio=nu)
        for h, E, nu in layers
    )
    bonded: Interface = "bonded"
    return LayerStack(sublayers=sublayers, interfaces=interfaces or (bonded,) * (len(layers) - 1), support=support)


def base(modulus: float, poissons_ratio: float = 0.3, interface: Interface = "bonded") -> ElasticBase:
    """Return an elastic half-space with this multiple of the usual modulus."""
    return ElasticBase(youngs_modulus=modulus * c.YOUNGS_MODULUS, poissons_ratio=poissons_ratio, interface=interface)


def pressed(
    label: str,
    layer: ElasticLayer,
    ratio: float,
    indenter: str = "paraboloid",
    *,
    sampled: bool = True,
) -> CaseScene:
    """Return a scene at a/H = ``ratio``; the flat end of the truncated cone is half as wide as its contact."""
    a = ratio * c.THICKNESS
    kinds: dict[str, tuple[Profile, Loading]] = {
        "paraboloid": (Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE), ContactRadii([a])),
        "truncated cone": (TruncatedCone(flat_radius=a / 2, slope=SLOPE), ContactRadii([a])),
        "flat punch": (FlatPunch(radius=a), IndentationDepths([DEPTH])),
    }
    return c.scene(
        f"{label}, {indenter}, a/H={ratio:g}",
        layer,
        *kinds[indenter],
        steep=indenter != "flat punch",
        sampling=c.rings(a, *_rings(layer, a)) if sampled and indenter != "truncated cone" else None,
        layer=label,
        indenter=indenter,
        a_over_h=ratio,
    )


def _rings(layer: ElasticLayer, contact_radius: float) -> tuple[float, ...]:
    """Edges of rings as shares of the contact radius."""
    thin = contact_radius / layer.surface.thickness
    levels = SINGULAR_LEVELS if not layer.is_piecewise_uniform else max(2, math.ceil(math.log2(thin)))
    return (*(1 - HALVED**level for level in range(levels + 1)), 1.0)


def two_methods(scenes: c.Scenes, required: Mapping[str, float] = REQUIRED) -> Iterator[Agree]:
    """Yield the agreement of MDR with each other method."""
    scenes = tuple(scenes)
    for label, tolerance in required.items():
        yield from c.agreements(scenes, {label: tolerance}, why=WHY[f"MDR and {label}"])


def pressed_shape(scenes: c.Scenes, *, compliance: Compliance = surface_compliance, radial_waves: float = 0.0) -> Zero:
    """Return the shape test of scenes whose pressure is sampled."""
    on, test = (s for s in scenes if s.sampling.ring_edges), WHY["shape test"]
    derive = partial(unlike_shape, compliance=compliance, radial_waves=radial_waves)
    return c.zero("the pressure presses the shape", "pressure", on, test, tolerance=1e-9, methods=FAST, derive=derive)


def stiffness_limit(
    name: str,
    scenes: c.Scenes,
    limit: Callable[[c.AnyScene], float],
    why: str,
    *,
    largest: float,
    parameter: Callable[[c.AnyScene], float] = c.thinness,
) -> Approach:
    """Return the claim that the stiffness by both fast methods approaches a limit with first order, nightly."""
    more: c.Words = {"largest": largest, "parameter": parameter, "methods": FAST, "nightly": True}
    return c.approach(name, "contact_stiffness", scenes, limit, WHY[why], **more)
