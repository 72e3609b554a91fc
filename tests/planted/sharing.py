"""What methods share, each thing planted wrong by one per cent, and the checks that must notice it.

`python -m tests.planted.sharing_table` plants each in turn and writes `docs/shared.md`.
"""

import dataclasses
import functools
import importlib
from collections.abc import Callable
from dataclasses import dataclass

from cases.declare.registry import load_cases
from cases.declare.shared import EVERY, SHARED
from tests.planted.planting import override, swap

WRONG = 1.01


@dataclass(frozen=True)
class Probe:
    """Scenes of a library case and the methods that solve them: what a fault is looked at with."""

    case: str
    scenes: tuple[str, ...]
    methods: tuple[str, ...] = ("mdr", "fem", "integral_equation")

    def narrowed(self, case, methods, kinds):
        """The case with these scenes and the claims of some kinds that some methods answer."""
        left = case.only(lambda scene, use: scene.name in self.scenes and use.label in {*self.methods} & {*methods})
        claims = tuple(claim for claim in left.claims if getattr(claim, "kind", None) in kinds)
        return dataclasses.replace(left, claims=claims)


@dataclass(frozen=True)
class SharedFault:
    """A shared thing, one per cent wrong.

    Attributes:
        shared: its name in `cases/declare/shared.toml`.
        what: what is wrong, in words.
        plant: switches it on with a monkeypatch.
        probes: names of the probes it is looked at with.
        reloaded: case modules that compute with it when they are imported.
    """

    shared: str
    what: str
    plant: Callable
    probes: tuple[str, ...]
    reloaded: tuple[str, ...] = ()


PROBES = {
    "half-space": Probe("half_space_limits", ("half-space, paraboloid", "half-space, flat punch")),
    "cone": Probe("truncated_cone", ("bonded nu=0.45 a/h=1",)),
    "paraboloid": Probe("paraboloid", ("bonded nu=0.5 a/h=1", "bonded nu=0.5 a/h=1 by depth")),
    "grids": Probe("paraboloid", ("bonded nu=0.5 a/h=1",), ("mdr", "bem", "mdr_table", "integral_equation")),
    "table": Probe("measured_profile", ("nine points, bonded nu=0.5",)),
    "pair": Probe("coated_pair", ("equal bodies, bonded a/h=0.5",)),
    "punch impact": Probe("flat_punch_impact", ("bonded a/h=1 D_HS=0.3",), ("mdr", "fem")),
    "sphere impact": Probe("sphere_impact", ("bonded h=2 mm",), ("mdr", "fem")),
    "stack": Probe("two_layers", ("soft on stiff, paraboloid, a/H=1",)),
    "graded": Probe("graded_layer", ("E=4^z, paraboloid, a/H=1",)),
    "inside": Probe("inside_layer", ("paraboloid, bonded nu=0.5 a/h=1",)),
    "inside half-space": Probe("inside_half_space", ("paraboloid nu=0.3",), ("mdr", "fem")),
    "held": Probe("held_indentation", ("relaxing half-space",), ("mdr", "fem")),
    "pull-off": Probe("flat_punch_adhesion", ("half-space, force",), ("mdr", "bem")),
}
ELASTIC = ("half-space", "cone", "paraboloid")


def times(original):
    """The function, its answer one per cent too large; what hangs on it (such as `dispatch`) stays."""

    @functools.wraps(original)
    def wrong(*arguments, **named):
        return WRONG * original(*arguments, **named)

    return wrong


def scaled(factor=WRONG, *, fields):
    """A function whose answer, a record or a named tuple, has some fields times a factor."""

    def of(original):
        def wrong(*arguments):
            right = original(*arguments)
            other = {name: times_all(getattr(right, name), factor) for name in fields}
            return dataclasses.replace(right, **other) if dataclasses.is_dataclass(right) else right._replace(**other)

        return wrong

    return of


def times_all(values, factor):
    """A number, an array, or all numbers of a tuple times a factor."""
    return tuple(factor * value for value in values) if isinstance(values, tuple) else factor * values


def heavier(original):
    """Gauss weights one per cent too large."""

    def wrong(*arguments):
        nodes, weights = original(*arguments)
        return nodes, WRONG * weights

    return wrong


def steeper(made):
    """Pieces of a slope one per cent too large."""
    return lambda self, profile, knots, pieces: made(self, profile, knots, WRONG * pieces)


def too_large(*, of):
    """A field of a record, read one per cent too large."""
    module, _, name = of.rpartition(":")
    cls, _, field = name.partition(".")

    def plant(patch):
        owner = getattr(importlib.import_module(module), cls)
        read = property(
            lambda self: WRONG * self.__dict__[field], lambda self, value: self.__dict__.__setitem__(field, value)
        )
        patch.setattr(owner, field, read, raising=False)

    return plant


def too_large_once(*, of):
    """The same for a function of depth, which is copied in other units: the copy is one per cent too large, not two."""
    place, _, field = of.rpartition(".")

    def scaled_once(original):
        def wrong(self, length, value):
            copy = original(self, length, value)
            copy.__dict__[field] /= WRONG
            return copy

        return wrong

    return both(override(place, "scaled", scaled_once), too_large(of=of))


def wrong_property(place, name):
    """A property that is one per cent too large."""
    return override(place, name, lambda original: property(times(original)))


def wrong_method(place, name):
    """A method whose answer is one per cent too large."""
    return override(place, name, times)


def both(*plants):
    """Several mistakes at once."""

    def plant(patch):
        for one in plants:
            one(patch)

    return plant


def longer_relaxation(original):
    """Relaxation times one per cent too long."""
    return property(scaled(fields=("times", "viscosity"))(original))


def wrong_reduction(**change):
    """The scene of a coated pair with one number one per cent too large."""

    def wrong(original):
        def scene(self):
            right = original(self)
            part, field = next(iter(change.items()))
            record = getattr(right, part)
            return right.replace(**{part: record.replace(**{field: WRONG * getattr(record, field)})})

        return scene

    return override("contact.scene.coated_pair:CoatedPair", "scene", wrong)


def shrunk_points(original):
    """Fields inside, found one per cent closer to the surface and to the axis."""

    def wrong(path, sampling):
        points = tuple((r / WRONG, z / WRONG) for r, z in sampling.inside)
        return original(path, dataclasses.replace(sampling, inside=points))

    return wrong


LAYER, PROFILES, LOADING = "contact.scene.layer:Layer", "contact.scene.profiles", "contact.scene.loading"
NUMBERS = {
    "Young's modulus": (f"{LAYER}.youngs_modulus", ("half-space", "cone")),
    "Poisson's ratio": (f"{LAYER}.poissons_ratio", ("half-space", "cone")),
    "thickness": (f"{LAYER}.thickness", ("cone", "paraboloid")),
    "radius of curvature": (f"{PROFILES}:Paraboloid.radius_of_curvature", ("half-space", "paraboloid")),
    "slope of the cone": (f"{PROFILES}:TruncatedCone.slope", ("cone",)),
    "radius of the flat end": (f"{PROFILES}:TruncatedCone.flat_radius", ("cone",)),
    "radius of the punch": (f"{PROFILES}:FlatPunch.radius", ("half-space", "punch impact")),
    "prescribed contact radius": (f"{LOADING}:ContactRadii.values", ("cone", "paraboloid")),
    "prescribed depth": (f"{LOADING}:IndentationDepths.values", ("half-space", "paraboloid")),
    "mass": (f"{LOADING}:Impact.mass", ("punch impact",)),
    "velocity": (f"{LOADING}:Impact.velocity", ("punch impact", "sphere impact")),
    "viscosity": ("contact.scene.effects:KelvinVoigt.viscosity", ("punch impact",)),
    "modulus of sublayers": ("contact.scene.layer:Sublayer.youngs_modulus", ("stack",)),
    "Poisson's ratio of sublayers": ("contact.scene.layer:Sublayer.poissons_ratio", ("stack",)),
    "thickness of sublayers": ("contact.scene.layer:Sublayer.thickness", ("stack",)),
    "history of the depth": (f"{LOADING}:DepthHistory.depth", ("held",)),
    "work of adhesion": ("contact.scene.effects:Adhesion.work_of_adhesion", ("pull-off",)),
}
HEIGHTS = both(
    *(
        wrong_method(f"{PROFILES}:{name}", "height")
        for name in ("Paraboloid", "TruncatedCone", "PowerLaw", "Tabulated")
    ),
)

CHI = "bem.kernels.stack:StackKernel", "one_minus_chi"
PAIR = ("pair",), ("cases.library.coated_pair",)
SLOPES = both(
    HEIGHTS,
    wrong_method(f"{PROFILES}:Tabulated", "slope_at"),
    override("mdr.profiles:PiecewiseTip", "__init__", steeper),
)
IMPACT, IMPACTS = "contact.answer.paths:ImpactHistory", ("punch impact", "sphere impact")
MODULI = "contact.scene.graded_layer:ExponentialDepth"
# By the shared thing and what is wrong with it: the fault, the probes and the modules to import again.
PLANTED = {
    "layer kernel": {"1 - chi": (wrong_method(*CHI), ("cone", "paraboloid"))},
    "kernel of stacks": {"1 - chi": (wrong_method(*CHI), ("stack",))},
    "kernel of graded layers": {
        "1 - chi": (wrong_method("bem.kernels.graded:GradedKernel", "one_minus_chi"), ("graded",))
    },
    "moduli over depth": {"E(z)": (wrong_method(MODULI, "at"), ("graded",))},
    "fields inside from the contact's density": {
        "fields of the half-space's part": (
            wrong_method("mdr.inside:Body", "_half_space"),
            ("inside", "inside half-space"),
        )
    },
    "von Mises stress": {
        "the stress": (wrong_property("contact.answer.inside:InsideFields", "von_mises"), ("inside half-space",))
    },
    "laws and points of fields inside": {
        "points": (swap("cases.recording:fields_at", shrunk_points), ("inside half-space",)),
        "weights of the laws": (swap("cases.inside_laws:_disc", heavier), ("inside half-space",)),
    },
    "contact modulus": {
        "E* of boundary elements and MDR": (swap("bem.kernels.moduli:contact_modulus", times), ELASTIC)
    },
    "springs and profile of MDR": {
        "MDR profile": (override("mdr.spring_bed:Springs", "at", scaled(fields=("g",))), ELASTIC)
    },
    "boundary elements on a grid": {
        "influence of a loaded rectangle": (swap("bem.grid.influence:rectangle_influence", times), ("grids",))
    },
    "heights of profiles": {"heights": (HEIGHTS, ("grids",))},
    "interpolation of tabulated profiles": {"slopes between the points": (SLOPES, ("table",))},
    "relaxation functions": {
        f"{name}: times and viscosities": (
            override(f"contact.scene.effects:{name}", "relaxation", longer_relaxation),
            (probe,),
        )
        for name, probe in (("KelvinVoigt", "punch impact"), ("StandardSolid", "sphere impact"))
    },
    "restitution and duration of an impact": {
        "restitution": (wrong_property(IMPACT, "coefficient_of_restitution"), IMPACTS),
        "duration": (wrong_property(IMPACT, "contact_time"), IMPACTS),
    },
    "reduction of two coated bodies, Eqs. (23)-(25)": {
        "curvature, Eq. (23)": (wrong_reduction(indenter="radius_of_curvature"), *PAIR),
        "modulus, Eq. (24)": (wrong_reduction(layer="youngs_modulus"), *PAIR),
        "thickness, Eq. (25)": (wrong_reduction(layer="thickness"), *PAIR),
    },
    "numbers of the scene": {
        **{what: (too_large(of=of), probes) for what, (of, probes) in NUMBERS.items()},
        **{f"modulus at the {end}": (too_large_once(of=f"{MODULI}.{end}"), ("graded",)) for end in ("surface", "base")},
    },
    "record of an answer": {"values": (swap("cases.recording:_quantity", scaled(fields=("values",))), ELASTIC)},
    "rings on which pressures are compared": {
        "places of the samples": (swap("cases.norms:ring_quadrature", scaled(1 / WRONG, fields=("radius",))), ("cone",))
    },
}
FAULTS = tuple(SharedFault(shared, what, *fault) for shared, group in PLANTED.items() for what, fault in group.items())
# Shared by nobody, but planted as well: the same mistake in the other method.
OWN = SharedFault(
    "nothing: modulus of finite elements",
    "G of finite elements",
    swap("fem_reference.materials:shear_modulus", times),
    ELASTIC,
)


def shared_by_all(fault):
    """Whether MDR and finite elements share the faulty thing, so that their agreement cannot notice it."""
    return any(one.name == fault.shared and one.methods == EVERY for one in SHARED)


def cases_under(fault):
    """The library with the fault in it, for faults that act when a case is imported."""
    for module in fault.reloaded:
        importlib.reload(importlib.import_module(module))
    return load_cases()
