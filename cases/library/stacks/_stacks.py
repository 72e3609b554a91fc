"""What the cases of layered bodies share: stacks from numbers, indenters, scenes, and claims that all of them make."""

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from functools import partial
from typing import Any

import numpy as np

from cases.case import CaseScene, Sampling
from cases.claims import Approach, Claim, Zero
from cases.library._claims import agreements
from cases.library._layers import THICKNESS, YOUNGS_MODULUS, edges
from cases.library._methods import BEM, EQUATION, FEM, MDR
from cases.library._reasons import reasons
from cases.library.stacks._second_kernel import surface_compliance
from cases.library.stacks._shape_test import Compliance, unlike_shape
from contact import (
    ContactRadii,
    ElasticBase,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    LayerStack,
    Paraboloid,
    Scene,
    Sublayer,
    TruncatedCone,
)
from contact.scene.layer import Interface, Support

WHY = reasons("stacks")

# A scene on any layer, under any loading.
AnyScene = Scene[Any, Any]

METHODS = (MDR, EQUATION, FEM, BEM)
# What two methods must agree within, whatever they state.
REQUIRED = {"integral_equation": 1e-10, "fem": 1e-5, "bem": 1e-3}
# The same on graded layers, whose kernel is like a logarithm.
REQUIRED_GRADED = {"integral_equation": 1e-8, "fem": 1e-4, "bem": 1e-3}

RADIUS_OF_CURVATURE = 1e-2  # m
SLOPE = 0.05
DEPTH = 1e-5  # m
INDENTERS = ("paraboloid", "truncated cone", "flat punch")
# Labels of scenes that no method solves in the suite ci.
NIGHTLY = ("mdr", "integral_equation", "fem", "bem")
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
        Sublayer(thickness=h * THICKNESS, youngs_modulus=E * YOUNGS_MODULUS, poissons_ratio=nu) for h, E, nu in layers
    )
    bonded: Interface = "bonded"
    return LayerStack(sublayers=sublayers, interfaces=interfaces or (bonded,) * (len(layers) - 1), support=support)


def base(modulus: float, poissons_ratio: float = 0.3, interface: Interface = "bonded") -> ElasticBase:
    """Return an elastic half-space with this multiple of the usual modulus."""
    return ElasticBase(youngs_modulus=modulus * YOUNGS_MODULUS, poissons_ratio=poissons_ratio, interface=interface)


def pressed(
    label: str,
    layer: ElasticLayer,
    ratio: float,
    indenter: str = "paraboloid",
    *,
    sampled: bool = True,
    nightly: tuple[str, ...] = NIGHTLY,
) -> CaseScene:
    """Return a scene at a/H = ``ratio``; the flat end of the truncated cone is half as wide as its contact."""
    a = ratio * THICKNESS
    rings = _rings(layer, a) if sampled and indenter != "truncated cone" else ()
    loading = ContactRadii(values=np.array([a]))
    scene: AnyScene
    match indenter:
        case "paraboloid":
            scene = Scene(
                layer=layer,
                indenter=Paraboloid(radius_of_curvature=RADIUS_OF_CURVATURE),
                loading=loading,
                beyond_small_strains=True,
            )
        case "truncated cone":
            scene = Scene(
                layer=layer,
                indenter=TruncatedCone(flat_radius=a / 2, slope=SLOPE),
                loading=loading,
                beyond_small_strains=True,
            )
        case _:
            depth = IndentationDepths(values=np.array([DEPTH]))
            scene = Scene(layer=layer, indenter=FlatPunch(radius=a), loading=depth)
    return CaseScene(
        name=f"{label}, {indenter}, a/H={ratio:g}",
        parameters={"layer": label, "indenter": indenter, "a_over_h": ratio},
        scene=scene,
        sampling=Sampling(ring_edges=edges(a, rings)),
        nightly=nightly,
    )


def _rings(layer: ElasticLayer, contact_radius: float) -> tuple[float, ...]:
    """Edges of rings as shares of the contact radius."""
    thin = contact_radius / layer.surface.thickness
    levels = SINGULAR_LEVELS if not layer.is_piecewise_uniform else max(2, math.ceil(math.log2(thin)))
    return (*(1 - HALVED**level for level in range(levels + 1)), 1.0)


def two_methods(scenes: Iterable[CaseScene], required: Mapping[str, float] = REQUIRED) -> Iterator[Claim]:
    """Yield the agreement of MDR with each other method."""
    scenes = tuple(scenes)
    for label, tolerance in required.items():
        yield from agreements(scenes, {label: tolerance}, why=WHY[f"MDR and {label}"])


def pressed_shape(
    scenes: Iterable[CaseScene],
    *,
    compliance: Compliance = surface_compliance,
    radial_waves: float = 0.0,
) -> Zero:
    """Return the shape test of scenes whose pressure is sampled."""
    return Zero(
        name="the pressure presses the shape",
        quantity="pressure",
        scenes=tuple(scene.name for scene in scenes if scene.sampling.ring_edges),
        methods=("mdr", "integral_equation"),
        tolerance=1e-9,
        why=WHY["shape test"],
        derive=partial(unlike_shape, compliance=compliance, radial_waves=radial_waves),
    )


def stiffness_limit(
    name: str,
    scenes: Iterable[CaseScene],
    parameter: Callable[[AnyScene], float],
    limit: Callable[[AnyScene], float],
    *,
    largest: float,
    why: str,
) -> Approach:
    """The stiffness of both fast methods approaches a limit with first order in a parameter, in the suite nightly."""
    return Approach(
        name=name,
        quantity="contact_stiffness",
        scenes=tuple(scene.name for scene in scenes),
        parameter=parameter,
        limit=limit,
        largest=largest,
        methods=("mdr", "integral_equation"),
        nightly=True,
        why=WHY[why],
    )
