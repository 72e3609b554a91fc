"""Random stacks, graded layers and contacts with them, by seed."""

from __future__ import annotations

from typing import Any

import numpy as np

from contact import (
    ContactRadii,
    ElasticBase,
    ElasticLayer,
    FlatPunch,
    IndentationDepths,
    LayerStack,
    Paraboloid,
    Profile,
    Scene,
    Sublayer,
    TruncatedCone,
)

RATIOS = (0.0, 0.2, 0.3, 0.45, 0.49, 0.5)


def random_stack(rng: np.random.Generator, contrast: float = 100.0) -> LayerStack:
    """One to four sublayers of total thickness 1 on a rigid or elastic base, with some sliding faces."""
    below = str(rng.choice(["bonded", "unbonded", "elastic"], p=[0.4, 0.2, 0.4]))
    count = int(rng.integers(1 if below == "elastic" else 2, 5))
    shares = np.exp(rng.uniform(np.log(0.1), 0.0, count))
    sublayers = tuple(
        Sublayer(thickness=float(h), youngs_modulus=_modulus(rng, contrast), poissons_ratio=float(rng.choice(RATIOS)))
        for h in shares / shares.sum()
    )
    faces = tuple(str(face) for face in rng.choice(["bonded", "unbonded"], count - 1, p=[0.75, 0.25]))
    support = below if below != "elastic" else _base(rng, contrast)
    return LayerStack(sublayers=sublayers, interfaces=faces, support=support)


def _modulus(rng: np.random.Generator, contrast: float) -> float:
    return float(np.exp(rng.uniform(-0.5, 0.5) * np.log(contrast)))


def _base(rng: np.random.Generator, contrast: float) -> ElasticBase:
    interface = "unbonded" if rng.random() < 0.25 else "bonded"
    ratio = float(rng.choice(RATIOS))
    return ElasticBase(youngs_modulus=_modulus(rng, contrast), poissons_ratio=ratio, interface=interface)


def stiff_on_soft(rng: np.random.Generator) -> LayerStack:
    """A film on a half-space or on a layer, three to ten thousand times as stiff as what is below."""
    thickness, ratio = float(np.exp(rng.uniform(np.log(0.03), np.log(0.5)))), float(10 ** rng.uniform(0.5, 4.0))
    film = Sublayer(thickness=thickness, youngs_modulus=ratio, poissons_ratio=float(rng.choice(RATIOS)))
    nu = float(rng.choice(RATIOS))
    if rng.random() < 0.5:
        return LayerStack(sublayers=(film,), support=ElasticBase(youngs_modulus=1.0, poissons_ratio=nu))
    soft = Sublayer(thickness=1 - thickness, youngs_modulus=1.0, poissons_ratio=nu)
    return LayerStack(sublayers=(film, soft), interfaces=("bonded",))


def scene(layer: ElasticLayer, kind: str, radius: float) -> Scene[Any, Any]:
    """A contact of a radius with a body of thickness 1: a flat punch, a paraboloid, or a truncated cone."""
    indenter: Profile = {
        "flat punch": FlatPunch(radius=radius),
        "paraboloid": Paraboloid(radius_of_curvature=10.0),
        "truncated cone": TruncatedCone(flat_radius=radius / 2, slope=0.1),
    }[kind]
    loading = IndentationDepths([0.01 * radius]) if kind == "flat punch" else ContactRadii([radius])
    return Scene(layer=layer, indenter=indenter, loading=loading, beyond_small_strains=True)
