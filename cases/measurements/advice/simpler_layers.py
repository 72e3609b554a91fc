"""What may be left out of a layered body: its elastic base, buried layers, slip, grading, and its finite thickness."""

from functools import partial
from itertools import pairwise

from contact import ElasticBase, ElasticLayer, GradedLayer, Layer, LayerStack

THICKNESS = "finite thickness"
ELASTIC_BASE = "elastic base (rigid instead)"
GRADING = "grading (the surface's material instead)"


def layer_parts(layer: ElasticLayer) -> tuple[str, ...]:
    """Names of what may be left out, the finite thickness last; none of a half-space."""
    if layer.is_half_space:
        return ()
    names = [ELASTIC_BASE] if layer.has_elastic_base else []
    if isinstance(layer, LayerStack):
        names += [_buried(n) for n, pair in enumerate(_pairs(layer)) if pair[0] != pair[1]]
        names += [_slip(n) for n, face in enumerate(layer.interfaces) if face == "unbonded"]
    if isinstance(layer, GradedLayer):
        names.append(GRADING)
    return (*names, THICKNESS)


def simpler(layer: ElasticLayer, part: str) -> ElasticLayer:
    """The layer without one part; parts that it does not have change nothing."""
    change = {THICKNESS: _half_space, ELASTIC_BASE: _on_rigid_base, GRADING: _ungraded}.get(part)
    if change is not None:
        return change(layer)
    if isinstance(layer, LayerStack):
        for n in range(len(layer.interfaces)):
            change = {_buried(n): partial(_as_above, number=n), _slip(n): partial(_bonded, number=n)}.get(part)
            layer = layer if change is None else change(layer)
    return layer


def _half_space(layer: ElasticLayer) -> ElasticLayer:
    """The half-space of the surface's material."""
    top = layer.surface
    return Layer.half_space(youngs_modulus=top.youngs_modulus, poissons_ratio=top.poissons_ratio)


def _on_rigid_base(layer: ElasticLayer) -> ElasticLayer:
    """The layer on a rigid base, with the interface of the elastic one."""
    if isinstance(layer, LayerStack | GradedLayer) and isinstance(layer.support, ElasticBase):
        return layer.replace(support=layer.support.interface)
    return layer


def _ungraded(layer: ElasticLayer) -> ElasticLayer:
    """The uniform layer of the surface's material."""
    if not isinstance(layer, GradedLayer):
        return layer
    return LayerStack(sublayers=(layer.surface,), support=layer.support).simplest()


def _as_above(layer: LayerStack, number: int) -> LayerStack:
    """The stack with the material of one sublayer in the next one."""
    above, below = layer.sublayers[number : number + 2]
    taken = above.replace(thickness=below.thickness)
    return layer.replace(sublayers=(*layer.sublayers[: number + 1], taken, *layer.sublayers[number + 2 :]))


def _bonded(layer: LayerStack, number: int) -> LayerStack:
    faces = (*layer.interfaces[:number], "bonded", *layer.interfaces[number + 1 :])
    return layer.replace(interfaces=faces)


def _pairs(layer: LayerStack) -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Materials of neighbours, from the top."""
    materials = [(one.youngs_modulus, one.poissons_ratio) for one in layer.sublayers]
    return list(pairwise(materials))


def _buried(number: int) -> str:
    return f"sublayer {number + 2} (the material above it instead)"


def _slip(number: int) -> str:
    return f"slip below sublayer {number + 1} (bonded instead)"
