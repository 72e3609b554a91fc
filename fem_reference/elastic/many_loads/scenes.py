"""Which scenes have many loads."""

from __future__ import annotations

from contact import FlatPunch, IndentationDepths, NormalForces, Scene

# Fewer loads are solved one by one.  Chosen: half as many radii as loads are solved at most, and seven, those of the
# first three curves, are the fewest that tell an error.
MANY = 20


def are_many(scene: Scene) -> bool:
    """Whether a scene asks for so many loads of one smooth contact that interpolation pays."""
    loading, layer, indenter = scene.loading, scene.layer, scene.indenter
    by_load = isinstance(loading, IndentationDepths | NormalForces) and len(loading.values) >= MANY
    smooth = layer.is_uniform and indenter.is_convex and not isinstance(indenter, FlatPunch)
    return by_load and smooth and not scene.effects
