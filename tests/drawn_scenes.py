"""Seeded scenes over the whole range of every parameter: log-uniform where it has a scale, in random units.

A scene is drawn dimensionless (layer thickness, or on a half-space the contact radius, and contact modulus near one)
around a contact radius, so that every drawn scene is one a user could mean; then every number is put into random units.
"""

from collections.abc import Callable
from typing import Literal, TypeAlias, get_args

import numpy as np

from cases.units import Units, in_units
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    DepthHistory,
    Detachment,
    Effect,
    FlatPunch,
    ForceHistory,
    Impact,
    IndentationDepths,
    KelvinVoigt,
    Layer,
    Loading,
    NormalForces,
    Paraboloid,
    PowerLaw,
    Profile,
    PronySeries,
    Scene,
    Sphere,
    StandardSolid,
    Tabulated,
    TruncatedCone,
    TruncatedParaboloid,
)

Family: TypeAlias = Literal[
    "elastic", "many_loads", "adhesive", "adhering_table", "impact", "history", "creep", "growing", "reloading"
]
FAMILIES: tuple[Family, ...] = get_args(Family)

# Range of the contact radius over the thickness of the layer.
RATIO = (1e-3, 1e3)
# Range of the slope of the indenter at the contact's edge.
SLOPE = (1e-5, 1.0)
UNITS = {"length": (1e-9, 1e3), "stress": (1.0, 1e12), "time": (1e-9, 1e6)}

# Share of the elastic scenes whose profile falls here and there.
_FALLING = 1 / 12

Draw: TypeAlias = np.random.Generator


def random_scenes(seed: int, count: int, family: Family = "elastic", ratio: tuple[float, float] = RATIO) -> list[Scene]:
    """Draw `count` scenes; the n-th scene of a seed is the same however many are drawn.

    Args:
        seed: Any integer.
        count: How many.
        family: "elastic", "many_loads" (so many that a method may interpolate between them), "adhesive" (detachment),
            "adhering_table" (the same of measured profiles), "impact", "history" or "creep" (prescribed depth or force
            in time), "growing" (forces that mostly rise) or "reloading" (depths of several strokes), both on layers
            with extreme relaxation spectra.
        ratio: Range of contact radius over thickness.
    """
    return [scene_of(seed, n, family, ratio) for n in range(count)]


def scene_of(seed: int, number: int, family: Family = "elastic", ratio: tuple[float, float] = RATIO) -> Scene:
    """Draw one of the scenes of a seed alone."""
    return random_scene(np.random.default_rng([seed, number]), family, ratio)


def random_scene(draw: Draw, family: Family = "elastic", ratio: tuple[float, float] = RATIO) -> Scene:
    """Draw one scene of a family."""
    units = Units(**{name: log_uniform(draw, *limits) for name, limits in UNITS.items()})
    return in_units(_MAKERS[family](draw, ratio), units)


def log_uniform(draw: Draw, low: float, high: float) -> float:
    """A number between two positive bounds, every decade equally likely."""
    return float(np.exp(draw.uniform(np.log(low), np.log(high))))


def _contact_ratio(draw: Draw, low: float, high: float) -> float:
    """a/h: any, or as people choose it, a round number up to a rounding error or a small change."""
    ratio = log_uniform(draw, low, high)
    if draw.random() < 0.8 or ratio < 1.0:
        return ratio
    return float(np.round(ratio) * (1.0 + draw.choice([-1.0, 0.0, 1.0]) * log_uniform(draw, 1e-16, 1e-6)))


# -- layers ----------------------------------------------------------------------------------------------------------


def poissons_ratio(draw: Draw) -> float:
    """Uniform, exactly incompressible, close to it, or zero."""
    kind = draw.choice(4, p=[0.6, 0.2, 0.15, 0.05])
    close = 0.5 - log_uniform(draw, 1e-9, 1e-2)
    return float((draw.uniform(0.0, 0.5), 0.5, close, 0.0)[kind])


def _layer(draw: Draw, poissons_ratio: float) -> Layer:
    if draw.random() < 0.1:
        return Layer.half_space(youngs_modulus=1.0, poissons_ratio=poissons_ratio)
    support: Literal["bonded", "unbonded"] = "bonded" if draw.random() < 0.6 else "unbonded"
    return Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support=support)


# -- indenters, each meant for a contact radius a --------------------------------------------------------------------


def _flat_part(draw: Draw) -> float:
    """b/a of a truncated profile: anywhere, close to 0, or close to 1."""
    small = log_uniform(draw, 1e-6, 1.0)
    return float((draw.uniform(0.01, 0.99), small, 1.0 - 0.9 * small)[draw.integers(3)])


def tabulated(draw: Draw, a: float, slope: float) -> Tabulated:
    """A measured profile: convex on the whole, with a little noise in its increments."""
    size = int(draw.integers(4, 40))
    radii = a * np.concatenate([[0.0], np.cumsum(draw.uniform(0.2, 1.0, size))])
    radii *= draw.uniform(1.2, 3.0) * a / radii[-1]
    rises = np.diff((radii / a) ** draw.uniform(1.5, 3.0)) * draw.uniform(0.98, 1.02, size)
    return Tabulated(radii=radii, heights=slope * a * np.concatenate([[0.0], np.cumsum(rises)]))


def falling_table(draw: Draw, size: float) -> tuple[Tabulated, float]:
    """A measured profile of about this size that falls here and there, and a depth; it may touch in several places."""
    count = int(draw.integers(5, 12))
    radii = np.append(0.0, np.cumsum(draw.uniform(0.2, 1.0, count))) * 10 ** draw.uniform(-1.0, 0.5) * size / count
    rises = draw.uniform(-0.6, 1.0, count)
    rises[0], rises[-1] = abs(rises[0]) + 0.05, 3.0
    heights = 1e-2 * radii[-1] * np.append(0.0, np.cumsum(rises)) / count
    return Tabulated(radii=radii, heights=heights), 0.3 * float(draw.uniform(0.05, 0.9) * heights.max())


_INDENTERS: dict[type[Profile], Callable[[Draw, float, float], Profile]] = {
    Paraboloid: lambda _, a, slope: Paraboloid(radius_of_curvature=a / slope),
    Sphere: lambda draw, a, _: Sphere(radius=a * log_uniform(draw, 1.05, 1e4)),
    Cone: lambda _, __, slope: Cone(slope=slope),
    TruncatedCone: lambda draw, a, slope: TruncatedCone(flat_radius=a * _flat_part(draw), slope=slope),
    TruncatedParaboloid: lambda draw, a, slope: TruncatedParaboloid(
        flat_radius=a * _flat_part(draw), radius_of_curvature=a / slope
    ),
    PowerLaw: lambda draw, a, slope: PowerLaw(
        exponent=log_uniform(draw, 1.0, 12.0), reference_radius=a, reference_height=slope * a
    ),
    Tabulated: tabulated,
}


def _indenter(draw: Draw, a: float) -> Profile:
    slope = log_uniform(draw, *SLOPE)
    if draw.random() < 0.1:
        return FlatPunch(radius=a)
    kinds = list(_INDENTERS)
    return _INDENTERS[kinds[draw.integers(len(kinds))]](draw, a, slope)


def _typical_depth(indenter: Profile, a: float) -> float:
    """A depth of the size that brings the contact to about a."""
    if isinstance(indenter, FlatPunch):
        return 0.01 * a
    return float(indenter.height(a))


# -- families --------------------------------------------------------------------------------------------------------


def _stage(draw: Draw, ratio: tuple[float, float]) -> tuple[Layer, Profile, float]:
    a = _contact_ratio(draw, *ratio)
    return _layer(draw, poissons_ratio(draw)), _indenter(draw, a), a


def _elastic(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """One scene in twelve has a profile that may touch in several places, which methods must notice."""
    layer, indenter, a = _stage(draw, ratio)
    loading = _static_loading(draw, layer, indenter, a)
    if draw.random() < _FALLING:
        indenter, depth = falling_table(draw, a)
        loading = IndentationDepths([depth])
        if draw.random() < 1 / 3:
            loading = ContactRadii(values=draw.uniform(0.02, 0.9, 1) * indenter.max_radius)
    return Scene(layer=layer, indenter=indenter, loading=loading, beyond_small_strains=True)


def _static_loading(draw: Draw, layer: Layer, indenter: Profile, a: float) -> Loading:
    kind = draw.integers(1 if isinstance(indenter, FlatPunch) else 0, 3)
    steps = int(draw.integers(1, 5))
    if kind == 0:
        least = max(indenter.flat_radius * (1.0 + 1e-9), 1e-3 * a)
        inner = draw.uniform(least, a, steps - 1)
        return ContactRadii(values=np.unique([*inner, a]))
    depths = _typical_depth(indenter, a) * np.exp(draw.uniform(np.log(0.05), 0.0, steps))
    if kind == 1:
        return IndentationDepths(values=depths)
    return NormalForces(values=2.0 * layer.contact_modulus * min(a, 1e3) * depths)


def _many_loads(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """Twenty to forty depths or forces over up to two decades, none on a flat or nearly flat punch or a table."""
    layer, indenter, a = _stage(draw, ratio)
    while isinstance(indenter, FlatPunch | Tabulated) or indenter.flat_radius > 0.5 * a:
        indenter = _indenter(draw, a)
    largest = _typical_depth(indenter, a) * float(draw.uniform(0.3, 1.0))
    shares = np.geomspace(log_uniform(draw, 1e-2, 0.5), 1.0, int(draw.integers(20, 41)))
    if draw.random() < 0.5:
        return Scene(
            layer=layer,
            indenter=indenter,
            loading=IndentationDepths(values=largest * shares),
            beyond_small_strains=True,
        )
    forces = 2.0 * layer.contact_modulus * min(a, 1e3) * largest * shares
    return Scene(layer=layer, indenter=indenter, loading=NormalForces(values=forces), beyond_small_strains=True)


def _adhesive(draw: Draw, ratio: tuple[float, float]) -> Scene:
    return _detached(draw, *_stage(draw, ratio))


def _adhering_table(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """A measured profile is pulled off, between its breakpoints or at one of them."""
    a = _contact_ratio(draw, *ratio)
    return _detached(draw, _layer(draw, poissons_ratio(draw)), tabulated(draw, a, log_uniform(draw, *SLOPE)), a)


def _detached(draw: Draw, layer: Layer, indenter: Profile, a: float) -> Scene:
    """Critical elongation of the half-space between a hundredth of the typical depth and ten times it."""
    elongation = _typical_depth(indenter, a) * log_uniform(draw, 1e-2, 10.0)
    work = layer.contact_modulus * elongation**2 / (2.0 * np.pi * a)
    control: Literal["displacement", "force"] = "displacement" if draw.random() < 0.5 else "force"
    return Scene(
        layer=layer,
        indenter=indenter,
        loading=Detachment(control=control),
        effects=(Adhesion(work_of_adhesion=float(work)),),
        beyond_small_strains=True,
    )


def _viscoelasticity(draw: Draw, shear_modulus: float, duration: float) -> Effect:
    """One of the three models; relaxation between a thousandth and a thousand times the duration."""
    times = duration * np.exp(draw.uniform(np.log(1e-3), np.log(1e3), 3))
    kind = draw.integers(3)
    if kind == 0:
        return KelvinVoigt(shear_modulus=shear_modulus, viscosity=float(shear_modulus * times[0]))
    share = draw.dirichlet(np.ones(4)) * shear_modulus
    if kind == 1:
        rest = shear_modulus - float(share[0])
        return StandardSolid(
            long_term_shear_modulus=float(share[0]), maxwell_shear_modulus=rest, viscosity=float(rest * times[0])
        )
    return PronySeries(long_term_shear_modulus=float(share[0]), shear_moduli=share[1:], relaxation_times=times)


def _moving_stage(draw: Draw, ratio: tuple[float, float]) -> tuple[Layer, Profile, float, tuple[Effect, ...], float]:
    """An incompressible layer that may relax, and an indenter; the typical duration is one."""
    a = _contact_ratio(draw, *ratio)
    viscous = draw.random() < 0.7
    layer = _layer(draw, 0.5 if viscous else poissons_ratio(draw))
    effects = (_viscoelasticity(draw, layer.shear_modulus, 1.0),) if viscous else ()
    indenter = _indenter(draw, a)
    return layer, indenter, _typical_depth(indenter, a), effects, a


def _impact(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """Kinetic energy of the size that an elastic half-space needs to stop the body at the typical depth."""
    layer, indenter, depth, effects, a = _moving_stage(draw, ratio)
    velocity = depth
    mass = layer.contact_modulus * a * log_uniform(draw, 1e-2, 1.0)
    return Scene(
        layer=layer,
        indenter=indenter,
        loading=Impact(mass=mass, velocity=velocity),
        effects=effects,
        beyond_small_strains=True,
    )


def _history(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """The depth goes up, rests and goes down again."""
    layer, indenter, depth, effects, _ = _moving_stage(draw, ratio)
    time = np.concatenate([[0.0], np.cumsum(draw.uniform(0.1, 1.0, 3))])
    top = 0.5 * depth
    loading = DepthHistory(time=time, depth=np.array([0.0, top, top * draw.uniform(0.5, 1.0), 0.0]))
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=effects, beyond_small_strains=True)


def _creep(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """The force goes up, or is there at once, changes, and goes to zero or stays."""
    layer, indenter, depth, effects, a = _moving_stage(draw, ratio)
    time = np.concatenate([[0.0], np.cumsum(draw.uniform(0.1, 1.0, 3))])
    top = layer.contact_modulus * min(a, 1e3) * depth * float(draw.uniform(0.05, 0.5))
    begin, rest, end = draw.choice([0.0, 1.0]), draw.uniform(0.5, 1.0), draw.choice([0.0, draw.uniform(0.2, 1.0)])
    loading = ForceHistory(time=time, force=top * np.array([begin, 1.0, rest, end]))
    return Scene(layer=layer, indenter=indenter, loading=loading, effects=effects, beyond_small_strains=True)


def _spectrum(draw: Draw, shear_modulus: float) -> Effect:
    """Up to ten branches, relaxation times over twelve decades, weights over six; a third without long-term modulus."""
    kind = draw.choice(4, p=[1 / 3, 0.5, 0.1, 1 / 15])
    long_term = (0.0, log_uniform(draw, 1e-8, 0.9), 1.0, log_uniform(draw, 1e-2, 0.9))[kind] * shear_modulus
    if kind == 2:
        return KelvinVoigt(shear_modulus=shear_modulus, viscosity=shear_modulus * log_uniform(draw, 1e-3, 1e3))
    size = 1 if kind == 3 else int(draw.integers(1, 11))
    weights = np.exp(draw.uniform(np.log(1e-6), 0.0, size))
    moduli = (shear_modulus - long_term) * weights / weights.sum()
    times = np.exp(draw.uniform(np.log(1e-6), np.log(1e6), size))
    return PronySeries(long_term_shear_modulus=long_term, shear_moduli=moduli, relaxation_times=times)


def _growing(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """The force rises or rests, in every second scene falls once as well, so that the contact mostly grows."""
    a = _contact_ratio(draw, *ratio)
    layer, indenter = _layer(draw, 0.5), _indenter(draw, a)
    rises = np.append(draw.choice([0.0, 1.0]), draw.uniform(-0.5, 1.0, draw.integers(2, 6)).clip(0.0))
    force = np.cumsum(rises) + float(rises.sum() == 0.0)
    if draw.random() < 0.5:
        force[draw.integers(1, force.size)] *= draw.uniform(0.2, 1.0)
    top = layer.contact_modulus * min(a, 1e3) * _typical_depth(indenter, a) * log_uniform(draw, 1e-2, 0.3)
    time = np.concatenate([[0.0], np.cumsum(np.exp(draw.uniform(np.log(1e-2), np.log(10.0), force.size - 1)))])
    loading = ForceHistory(time=time, force=top * force / force.max())
    return Scene(
        layer=layer,
        indenter=indenter,
        loading=loading,
        effects=(_spectrum(draw, layer.shear_modulus),),
        beyond_small_strains=True,
    )


def _reloading(draw: Draw, ratio: tuple[float, float]) -> Scene:
    """Pressed, let go, pressed again, some rests between; depths are often met a second time to the last digit."""
    a = _contact_ratio(draw, *ratio)
    layer, indenter = _layer(draw, 0.5), _indenter(draw, a)
    strokes = [0.0, 1.0, draw.uniform(-0.5, 0.9), draw.uniform(0.3, 1.0), *draw.uniform(-0.3, 1.0, draw.integers(0, 4))]
    depths = [depth for stroke in strokes for depth in [stroke] * int(draw.integers(1, 3))]
    if draw.random() < 0.5:
        depths = [round(8.0 * depth) / 8.0 for depth in depths]
    durations = np.exp(draw.uniform(np.log(1e-2), np.log(10.0), len(depths) - 1))
    loading = DepthHistory(
        time=np.concatenate([[0.0], np.cumsum(durations)]), depth=0.5 * _typical_depth(indenter, a) * np.array(depths)
    )
    return Scene(
        layer=layer,
        indenter=indenter,
        loading=loading,
        effects=(_spectrum(draw, layer.shear_modulus),),
        beyond_small_strains=True,
    )


_MAKERS: dict[Family, Callable[[Draw, tuple[float, float]], Scene]] = {
    "elastic": _elastic,
    "many_loads": _many_loads,
    "adhesive": _adhesive,
    "adhering_table": _adhering_table,
    "impact": _impact,
    "history": _history,
    "creep": _creep,
    "growing": _growing,
    "reloading": _reloading,
}
