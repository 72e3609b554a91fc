"""What several cases share: the layers of the paper, names of scenes, exact twins of a scene."""

import dataclasses
from collections.abc import Iterable

import numpy as np

from contact import (
    ContactRadii,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    Profile,
    Scene,
)
from contact.records.validation import FloatArray

THICKNESS = 1e-3  # m
YOUNGS_MODULUS = 1e6  # Pa

LAYERS: dict[str, tuple[str, float]] = {
    "unbonded": ("unbonded", 0.3),
    "bonded nu=0.3": ("bonded", 0.3),
    "bonded nu=0.45": ("bonded", 0.45),
    "bonded nu=0.5": ("bonded", 0.5),
}


def layer(label: str) -> Layer:
    """Return the layer called ``label``: its support and, when bonded, its Poisson's ratio."""
    support, poissons_ratio = LAYERS[label]
    return layer_of(poissons_ratio, support)


def layer_of(poissons_ratio: float, support: str = "bonded") -> Layer:
    """Return a layer of the usual thickness and modulus."""
    return Layer(
        thickness=THICKNESS,
        youngs_modulus=YOUNGS_MODULUS,
        poissons_ratio=poissons_ratio,
        support="unbonded" if support == "unbonded" else "bonded",
    )


def half_space(poissons_ratio: float = 0.3) -> Layer:
    """Return a half-space of the usual modulus."""
    return Layer.half_space(youngs_modulus=YOUNGS_MODULUS, poissons_ratio=poissons_ratio)


def contact_modulus(layer: Layer) -> float:
    """E* = E / (1 - nu^2) [Pa] for expected numbers, which must not share a mistake with `Layer.contact_modulus`."""
    return layer.youngs_modulus / (1 - layer.poissons_ratio**2)


def confined_modulus(layer: Layer) -> float:
    """E (1 - nu) / ((1 + nu) (1 - 2 nu)) [Pa] for expected numbers, written out for the same reason."""
    nu = layer.poissons_ratio
    return layer.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu))


def scene_name(label: str, ratio: float) -> str:
    """Return the name of a scene: the layer and its confinement ratio."""
    return f"{label} a/h={ratio:g}"


def doubled_modulus(scene: Scene) -> Scene:
    """Return the scene with twice Young's modulus: at given radii depth stays and force doubles."""
    return scene.replace(layer=scene.layer.replace(youngs_modulus=2 * scene.layer.youngs_modulus))


def other_poissons_ratio(scene: Scene) -> Scene:
    """Return the scene with nu = 0.1 at the same E*: an unbonded layer must not see the difference."""
    nu = 0.1
    modulus = contact_modulus(scene.layer) * (1 - nu**2)
    return scene.replace(layer=scene.layer.replace(poissons_ratio=nu, youngs_modulus=modulus))


def in_millimetres(scene: Scene) -> Scene:
    """Return the same contact written in another consistent system: lengths in mm and stresses in MPa.

    With the force in N, lengths are 1000 times and stresses 1e-6 times the SI numbers; forces keep their numbers.
    """
    return scene.replace(
        layer=scene.layer.replace(
            thickness=1e3 * scene.layer.thickness, youngs_modulus=1e-6 * scene.layer.youngs_modulus
        ),
        indenter=_scaled_profile(scene.indenter, 1e3),
        loading=_scaled_loading(scene, 1e3),
    )


def _scaled_profile(profile: Profile, factor: float) -> Profile:
    """Scale the lengths of a profile; slopes have no unit."""
    lengths = {"radius", "flat_radius", "radius_of_curvature"}
    own = {field.name for field in dataclasses.fields(profile)}
    return profile.replace(**{name: factor * getattr(profile, name) for name in own & lengths})


def _scaled_loading(scene: Scene, factor: float) -> ContactRadii | IndentationDepths | NormalForces:
    match scene.loading:
        case ContactRadii(values=values):
            return ContactRadii(values=factor * values)
        case IndentationDepths(values=values):
            return IndentationDepths(values=factor * values)
        case NormalForces():
            return scene.loading
        case other:
            raise InvalidInput(f"loading = {type(other).__name__}: no unit change is written for it")


def prescribed_radii(scene: Scene) -> FloatArray:
    """Return the contact radii [m] that ``scene`` prescribes."""
    if not isinstance(scene.loading, ContactRadii):
        raise InvalidInput(f"loading = {type(scene.loading).__name__}: this closed form takes contact radii")
    return scene.loading.values


def thinness(scene: Scene) -> float:
    """h/a at the first prescribed radius."""
    return scene.layer.thickness / float(prescribed_radii(scene)[0])


def edges(contact_radius: float, fractions: Iterable[float]) -> tuple[float, ...]:
    """Return ring edges [m] at fractions of the contact radius."""
    return tuple(float(x) for x in contact_radius * np.asarray(tuple(fractions)))
