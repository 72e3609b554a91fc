"""Random scenes from the records of `contact` themselves: every kind of layer, indenter, loading and effect.

`drawn_record` walks the fields of a record. A `Literal` is drawn from its options, a record from its concrete
subclasses, and numbers by the rule of their class in `RULES`. A class without a rule, and a field that neither its
rule nor its type determines, raise `UnknownField` with their name: a new one cannot go undrawn.

Numbers are drawn around one contact (`Around`): its radius a, the thickness h, the slope at the edge, a duration.
"""

from __future__ import annotations

import dataclasses
import math
import types
import typing
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any, Final, Literal

import numpy as np

import contact
from contact import AnyScene, CoatedPair, ElasticBase, ElasticLayer, FlatPunch, Profile, Scene, TabulatedDepth
from contact.records.record import Record

Draw = np.random.Generator

# Ranges of dimensionless numbers, drawn by their logarithm.
RATIO: Final = (1e-3, 900.0)  # a/h
SLOPE: Final = (0.01, 100.0)  # of the indenter at the edge of contact
RAMP: Final = (1e-3, 1.0)  # one segment of a history over the longest
RELAXATION: Final = (1e-3, 1e3)  # relaxation time over duration
CONTRAST: Final = (1e-2, 1e2)  # modulus of a sublayer or base over that of the surface
# SI units of thickness, modulus and duration.
LENGTH, MODULUS, DURATION = (1e-8, 1e-1), (1e2, 1e11), (1e-4, 1e5)


class UnknownField(LookupError):
    """A class or a field of a record that the generator has no rule for."""


@dataclass
class Around:
    """The contact that a scene is drawn around, in SI units.

    Attributes:
        draw: Random numbers.
        ratio: a/h.
        slope: Of the indenter at a.
        wish: What is not left to chance: "incompressible", "half_space", "slides", "rigid" (base of a graded layer),
            "many" (loads), "pulls", "jump", "grows" (histories), "sticks", "measured" or "flows", each true or false,
            "control" (its name), "sublayers" (range of their number), "smallest" and "largest" values of a loading
            over the typical one.
        layer: Once it is drawn.
        indenter: Once it is drawn.
    """

    draw: Draw
    ratio: float
    slope: float
    wish: Mapping[str, Any] = field(default_factory=dict)
    layer: ElasticLayer | None = None
    indenter: Profile | None = None

    def __post_init__(self) -> None:
        self.h, self.modulus, self.duration = self.log(*LENGTH), self.log(*MODULUS), self.log(*DURATION)
        self.a = tidy(self.ratio * self.h)

    def log(self, low: float, high: float) -> float:
        """A number between two positive bounds, every decade equally likely."""
        return tidy(math.exp(self.draw.uniform(math.log(low), math.log(high))))

    def uniform(self, low: float, high: float) -> float:
        """A number between two bounds."""
        return tidy(self.draw.uniform(low, high))

    def chance(self, share: float, wish: str = "") -> bool:
        """What is wished, or true in this share of the draws."""
        drawn = bool(self.draw.random() < share)
        wished = self.wish.get(wish)
        return drawn if wished is None else wished

    @property
    def depth(self) -> float:
        """A depth of the size that brings the contact to about a [m]."""
        flat = isinstance(self.indenter, FlatPunch)
        return self.a * min(self.slope, 0.1) if flat else float(self.indenter.height(self.a))

    @property
    def force(self) -> float:
        """About the force [N] on the half-space at that depth."""
        return 2.0 * self.layer.contact_modulus * self.a * self.depth


def tidy(value: float) -> float:
    """The number with six significant digits."""
    return float(f"{value:.6g}")


def _tidied(values: Any) -> list[float]:
    return [tidy(float(value)) for value in values]


# -- layers ----------------------------------------------------------------------------------------------------------


def _ratio(s: Around) -> float:
    """nu: exactly 1/2, exactly 0, close to 1/2, or anything between."""
    kinds = (0.5, 0.0, tidy(0.5 - s.log(1e-6, 1e-2)), s.uniform(0.0, 0.49))
    drawn = float(kinds[s.draw.choice(4, p=(0.25, 0.1, 0.1, 0.55))])
    wished = s.wish.get("incompressible")
    return drawn if wished is None else 0.5 if wished else min(drawn, 0.3)


def _material(s: Around, thickness: float, modulus: float) -> dict[str, Any]:
    return {"thickness": thickness, "youngs_modulus": modulus, "poissons_ratio": _ratio(s)}


def _sublayer(s: Around) -> dict[str, Any]:
    """The first one drawn is the surface, of the thickness and modulus that the contact is drawn around."""
    contrast = 1.0 if s.chance(0.2) else s.log(*CONTRAST)
    return _material(s, tidy(s.h * s.log(0.05, 5.0)), tidy(s.modulus * contrast))


def _stack(s: Around) -> dict[str, Any]:
    count = int(s.draw.integers(*s.wish.get("sublayers", (1, 5))))
    surface = contact.Sublayer(**_material(s, s.h, s.modulus))
    below = (drawn_record(contact.Sublayer, s) for _ in range(count - 1))
    slides = s.chance(0.5, "slides")
    faces = ["unbonded" if slides and s.chance(0.5) else "bonded" for _ in range(count - 1)]
    if slides and faces:
        faces[s.draw.integers(len(faces))] = "unbonded"
    return {"sublayers": (surface, *below), "interfaces": tuple(faces)}


def _depths(s: Around) -> list[float]:
    steps = np.cumsum(s.draw.uniform(0.2, 1.0, s.draw.integers(1, 7)))
    return [0.0, *_tidied(s.h * steps / steps[-1])[:-1], s.h]


def _graded(s: Around) -> dict[str, Any]:
    ratio: Any = _ratio(s)
    if s.chance(0.25) and s.wish.get("incompressible") is None:
        depths = _depths(s)
        ratio = TabulatedDepth(depths=depths, values=_tidied(s.draw.uniform(0.0, 0.5, len(depths))))
    support = {"support": "bonded"} if s.wish.get("rigid") else {}
    return {"thickness": s.h, "poissons_ratio": ratio, **support}


def _faces(s: Around) -> dict[str, Any]:
    return {"surface": s.modulus, "base": tidy(s.modulus * s.log(0.1, 10.0))}


def _table_in_depth(s: Around) -> dict[str, Any]:
    depths = _depths(s)
    return {"depths": depths, "values": [s.modulus, *(tidy(s.modulus * s.log(0.2, 5.0)) for _ in depths[1:])]}


def _pair(s: Around) -> dict[str, Any]:
    curvature, share = s.slope / s.a, s.uniform(0.0, 0.9)
    radii = {"first_radius": tidy(1.0 / (curvature * (1.0 - share))), "second_radius": math.inf}
    if share > 0.1:
        radii["second_radius"] = tidy(1.0 / (curvature * share))
    thickness = {"first_thickness": s.h, "second_thickness": tidy(s.h * s.uniform(0.5, 2.0))}
    return radii | thickness | {"youngs_modulus": s.modulus, "poissons_ratio": _ratio(s)}


# -- indenters -------------------------------------------------------------------------------------------------------


def _flat(s: Around) -> float:
    """b of a truncated profile: anywhere below a, close to 0, or close to a."""
    share = s.log(1e-3, 1.0)
    return tidy(s.a * float((s.draw.uniform(0.05, 0.95), share, 1.0 - 0.9 * share)[s.draw.integers(3)]))


def _power(s: Around) -> dict[str, Any]:
    exponent = 1.0 if s.chance(0.1) else s.log(1.0, 12.0)
    return {"exponent": exponent, "reference_radius": s.a, "reference_height": tidy(s.slope * s.a / exponent)}


def _tip(s: Around) -> dict[str, Any]:
    """A measured tip that reaches beyond a: convex on the whole, with a little noise in its increments."""
    size = int(s.draw.integers(4, 20))
    radii = np.append(0.0, np.cumsum(s.draw.uniform(0.2, 1.0, size)))
    radii *= s.draw.uniform(1.5, 3.0) * s.a / radii[-1]
    rises = np.diff((radii / s.a) ** s.draw.uniform(1.5, 3.0)) * s.draw.uniform(0.98, 1.02, size)
    heights = np.append(0.0, np.cumsum(0.5 * s.slope * s.a * rises))
    return {"radii": _tidied(radii), "heights": _tidied(heights), "smoothing": None}


# -- loadings --------------------------------------------------------------------------------------------------------


def _several(s: Around, typical: float) -> list[float]:
    """One to four values up to a typical one, in one of twelve draws two dozen."""
    count = 24 if s.chance(1 / 12, "many") else int(s.draw.integers(1, 5))
    bounds = np.log([s.wish.get("smallest", 0.05), s.wish.get("largest", 1.0)])
    values = _tidied(typical * np.exp(s.draw.uniform(*bounds, count)))
    return [*values[:-1], -tidy(0.2 * values[-1])] if s.chance(0.0, "pulls") else values


def _radii(s: Around) -> dict[str, Any]:
    flat = s.indenter.flat_radius
    return {"values": sorted({tidy(flat + (s.a - flat) * abs(share)) for share in _several(s, 1.0)})}


def _detachment(s: Around) -> dict[str, Any]:
    control = s.wish.get("control", ("displacement", "force", "machine")[s.draw.integers(3)])
    stiffness = tidy(s.layer.contact_modulus * s.a * s.log(1e-2, 1e2))
    start = s.chance(0.3) and not isinstance(s.indenter, FlatPunch)
    return {
        "control": "force" if control == "force" else "displacement",
        "machine_stiffness": stiffness if control == "machine" else None,
        "initial_contact_radius": s.a if start else None,
    }


def _impact(s: Around) -> dict[str, Any]:
    """Kinetic energy of the size that an elastic half-space needs to stop the body at the typical depth."""
    mass = s.layer.contact_modulus * s.a * s.duration**2 * s.log(1e-2, 1.0)
    return {"mass": tidy(mass), "velocity": tidy(s.depth / s.duration)}


def _history(s: Around, name: str, typical: float) -> dict[str, Any]:
    """At once or by a ramp, then rests, rises or falls, in segments of very different length."""
    steps = np.array([s.log(*RAMP) for _ in range(s.draw.integers(1, 5))])
    time = _tidied(s.duration * np.append(0.0, np.cumsum(steps)) / steps.sum())
    start = [1.0] if s.chance(0.5, "jump") else [0.0, 1.0]
    later = [s.draw.choice([1.0, s.uniform(0.2, 1.0), 0.0], p=[0.3, 0.6, 0.1]) for _ in time]
    if s.wish.get("grows"):
        later = [1.0 + 0.2 * n for n in range(len(time))]
    values = typical * s.wish.get("largest", s.uniform(0.1, 1.0)) * np.array([*start, *later])[: len(time)]
    return {"time": time, name: _tidied(values)}


# -- effects ---------------------------------------------------------------------------------------------------------


def _adhesion(s: Around) -> dict[str, Any]:
    """Critical elongation of the half-space between a hundredth of the typical depth and thrice that."""
    elongation = s.depth * s.log(1e-2, 3.0)
    return {"work_of_adhesion": tidy(s.layer.contact_modulus * elongation**2 / (2.0 * math.pi * s.a))}


def _friction(s: Around) -> dict[str, Any]:
    return {"coefficient": math.inf if s.chance(0.4, "sticks") else s.log(1e-2, 3.0)}


def _kelvin_voigt(s: Around) -> dict[str, Any]:
    modulus = s.layer.shear_modulus
    return {"shear_modulus": modulus, "viscosity": modulus * s.duration * s.log(*RELAXATION)}


def _solid(s: Around) -> dict[str, Any]:
    share = 0.0 if s.chance(0.1, "flows") else s.uniform(0.05, 0.95)
    maxwell = (1.0 - share) * s.layer.shear_modulus
    return {
        "long_term_shear_modulus": share * s.layer.shear_modulus,
        "maxwell_shear_modulus": maxwell,
        "viscosity": maxwell * s.duration * s.log(*RELAXATION),
    }


def _prony(s: Around) -> dict[str, Any]:
    """One to three branches, or a measured table: eight to thirty relaxation times over many decades."""
    measured = s.chance(0.3, "measured")
    count = int(s.draw.integers(8, 31) if measured else s.draw.integers(1, 4))
    times = np.array([s.log(*RELAXATION) for _ in range(count)])
    if measured:
        times = np.geomspace(s.log(1e-6, 1e-3), s.log(1e1, 1e4), count)
    rest, *moduli = s.draw.dirichlet(np.ones(count + 1)) * s.layer.shear_modulus
    if s.chance(0.1, "flows"):
        rest, moduli[0] = 0.0, moduli[0] + rest
    return {
        "long_term_shear_modulus": float(rest),
        "shear_moduli": [float(modulus) for modulus in moduli],
        "relaxation_times": _tidied(s.duration * times),
    }


# -- rules and the walk ----------------------------------------------------------------------------------------------

RULES: Final[dict[str, Callable[[Around], dict[str, Any]]]] = {
    "Layer": lambda s: _material(s, math.inf if s.chance(0.15, "half_space") else s.h, s.modulus),
    "LayerStack": _stack,
    "Sublayer": _sublayer,
    "ElasticBase": lambda s: {"youngs_modulus": tidy(s.modulus * s.log(*CONTRAST)), "poissons_ratio": _ratio(s)},
    "GradedLayer": _graded,
    "ExponentialDepth": _faces,
    "LinearDepth": _faces,
    "PowerLawDepth": lambda s: {
        "surface": s.modulus,
        "reference_depth": tidy(s.h * s.log(0.1, 5.0)),
        "exponent": s.uniform(-1.5, 1.5),
    },
    "TabulatedDepth": _table_in_depth,
    "CoatedPair": _pair,
    "FlatPunch": lambda s: {"radius": s.a},
    "Paraboloid": lambda s: {"radius_of_curvature": tidy(s.a / s.slope)},
    "Sphere": lambda s: {"radius": tidy(s.a * math.hypot(1.0, 1.0 / s.slope))},
    "Cone": lambda s: {"slope": s.slope},
    "Spheroconical": lambda s: {"radius": tidy(_flat(s) * math.hypot(1.0, 1.0 / s.slope)), "slope": s.slope},
    "TruncatedCone": lambda s: {"flat_radius": _flat(s), "slope": s.slope},
    "TruncatedParaboloid": lambda s: {"flat_radius": _flat(s), "radius_of_curvature": tidy(s.a / s.slope)},
    "PowerLaw": _power,
    "Tabulated": _tip,
    "ContactRadii": _radii,
    "IndentationDepths": lambda s: {"values": _several(s, s.depth)},
    "NormalForces": lambda s: {"values": _several(s, s.force)},
    "Detachment": _detachment,
    "Impact": _impact,
    "DepthHistory": lambda s: _history(s, "depth", s.depth),
    "ForceHistory": lambda s: _history(s, "force", s.force),
    "Adhesion": _adhesion,
    "Friction": _friction,
    "KelvinVoigt": _kelvin_voigt,
    "StandardSolid": _solid,
    "PronySeries": _prony,
}


def concrete(base: type[Record]) -> list[type[Record]]:
    """The public records of `contact` that are of this kind, in the order of their names, without shapes.

    Shapes are drawn in tests/verification/test_shapes.py: few methods model them.
    """
    records = [value for _, value in sorted(vars(contact).items())]
    classes = [one for one in records if isinstance(one, type) and issubclass(one, base) and one is not base]
    classes = [one for one in classes if not issubclass(one, contact.Shape)]
    bases = {parent for one in classes for parent in one.__mro__[1:]}
    return [one for one in classes if one not in bases] or [base]


def drawn_record(base: type[Record], s: Around, **fixed: Any) -> Any:
    """A record of a class, or of one of its subclasses; fields in `fixed` are taken as they are.

    Raises:
        UnknownField: With the name of a class or field that has no rule.
    """
    kinds = concrete(base)
    cls = kinds[s.draw.integers(len(kinds))]
    if cls.__name__ not in RULES:
        raise UnknownField(f"{cls.__name__}: tests/random_scenes.py has no rule for this class")
    ruled = RULES[cls.__name__](s)
    hints = typing.get_type_hints(cls)
    names = [one.name for one in dataclasses.fields(cls)]
    walked = {name: _drawn(hints[name], s, f"{cls.__name__}.{name}") for name in names if name not in {*ruled, *fixed}}
    return cls(**{name: value for name, value in (ruled | walked | fixed).items() if name in names})


def _drawn(hint: Any, s: Around, place: str) -> Any:
    """A value of a field from its type: an option of a `Literal`, a record, or one of a union of these."""
    if typing.get_origin(hint) in (typing.Union, types.UnionType):
        options = typing.get_args(hint)
        return _drawn(options[s.draw.integers(len(options))], s, place)
    if typing.get_origin(hint) is Literal:
        options = typing.get_args(hint)
        return options[s.draw.integers(len(options))]
    if isinstance(hint, type) and issubclass(hint, Record):
        return drawn_record(hint, s)
    raise UnknownField(f"{place}: tests/random_scenes.py has no rule for this field")


# -- kinds -----------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Kind:
    """One kind of part of a scene.

    Attributes:
        base: Its class, or a base of several.
        fixed: Fields that make the kind; a class stands for a record that is drawn.
        wish: As in `Around`.
    """

    base: type[Record]
    fixed: Mapping[str, Any] = field(default_factory=dict)
    wish: Mapping[str, Any] = field(default_factory=dict)

    def drawn(self, s: Around, **more: Any) -> Any:
        """A record of this kind; its wishes hold for what is drawn later, too."""
        s.wish = {**s.wish, **self.wish}
        fixed = {n: drawn_record(v, s) if isinstance(v, type) else v for n, v in self.fixed.items()}
        return drawn_record(self.base, s, **fixed, **more)


GRADED: Final = {
    f"graded, {one.__name__}": Kind(contact.GradedLayer, {"youngs_modulus": one})
    for one in concrete(contact.DepthFunction)
}
LAYERS: Final[dict[str, Kind]] = {
    "half-space": Kind(contact.Layer, {"thickness": math.inf}),
    "bonded layer": Kind(contact.Layer, {"support": "bonded"}, {"half_space": False}),
    "unbonded layer": Kind(contact.Layer, {"support": "unbonded"}, {"half_space": False}),
    "bonded stack": Kind(contact.LayerStack, {"support": "bonded"}, {"slides": False, "sublayers": (2, 5)}),
    "sliding stack": Kind(contact.LayerStack, {"support": "unbonded"}, {"slides": True, "sublayers": (2, 5)}),
    "stack on elastic base": Kind(contact.LayerStack, {"support": ElasticBase}),
    **GRADED,
    "coated pair": Kind(CoatedPair),
}
INDENTERS: Final[dict[str, Kind]] = {one.__name__: Kind(one) for one in concrete(Profile)}
LOADINGS: Final[dict[str, Kind]] = {
    **{one.__name__: Kind(one) for one in concrete(contact.Loading) if "History" not in one.__name__},
    **{
        f"{one.__name__}, {begins}": Kind(one, wish={"jump": begins == "jump"})
        for one in concrete(contact.Loading)
        for begins in ("ramp", "jump")
        if "History" in one.__name__
    },
}
LOADINGS |= {
    f"Detachment, {control}": Kind(contact.Detachment, wish={"control": control})
    for control in ("displacement", "force", "machine")
}
del LOADINGS["Detachment"]
EFFECTS: Final[dict[str, tuple[Kind, ...]]] = {
    "no effect": (),
    **{one.__name__: (Kind(one),) for one in concrete(contact.Effect)},
    "PronySeries": (Kind(contact.PronySeries, wish={"measured": False}),),
    "PronySeries, measured": (Kind(contact.PronySeries, wish={"measured": True}),),
    "Friction": (Kind(contact.Friction, wish={"sticks": False}),),
    "Friction, full stick": (Kind(contact.Friction, wish={"sticks": True}),),
    "Adhesion and StandardSolid": (Kind(contact.Adhesion), Kind(contact.StandardSolid)),
}
PARTS: Final = {"layer": LAYERS, "indenter": INDENTERS, "loading": LOADINGS, "effect": EFFECTS}


def drawn_scene(
    draw: Draw,
    *,
    layer: str = "",
    indenter: str = "",
    loading: str = "",
    effect: str = "",
    ratio: tuple[float, float] = RATIO,
    slope: tuple[float, float] = SLOPE,
    **wish: Any,
) -> AnyScene:
    """One scene of these kinds, each a name of `LAYERS`, `INDENTERS`, `LOADINGS`, `EFFECTS`, or drawn where empty.

    Viscoelastic effects get an incompressible layer in nine of ten draws. A coated pair has its own indenter.

    Raises:
        InvalidInput: If no scene has this indenter, loading and effect together.
    """
    named = {"layer": layer, "indenter": indenter, "loading": loading, "effect": effect}
    chosen = {part: name or str(draw.choice(list(PARTS[part]))) for part, name in named.items()}
    low_high = (np.log(ratio), np.log(slope))
    s = Around(draw, *(tidy(math.exp(draw.uniform(*bounds))) for bounds in low_high), wish=wish)
    effects = EFFECTS[chosen["effect"]]
    relaxes = any(issubclass(kind.base, contact.Viscoelasticity) for kind in effects)
    if relaxes and "incompressible" not in s.wish:
        s.wish = {**s.wish, "incompressible": s.chance(0.9)}
    if chosen["layer"] == "coated pair":
        pair = LAYERS["coated pair"].drawn(s, loading=contact.ContactRadii([s.a]), effects=()).scene()
        s.layer, s.indenter = pair.layer, pair.indenter
    else:
        s.layer = LAYERS[chosen["layer"]].drawn(s).simplest()
        s.indenter = INDENTERS[chosen["indenter"]].drawn(s)
    s.wish = {**s.wish, "pulls": chosen["effect"] == "Adhesion" and s.chance(0.3)}
    drawn = LOADINGS[chosen["loading"]].drawn(s)
    effects = tuple(kind.drawn(s) for kind in effects)
    # Methods are compared on the linear problem, however deep the contact is.
    return Scene(layer=s.layer, indenter=s.indenter, loading=drawn, effects=effects, beyond_small_strains=True)
