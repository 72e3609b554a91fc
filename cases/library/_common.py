"""What cases share: layers, scenes, methods, reasons, requirements, reference numbers, and the claims that most make.

A requirement is a tolerance that is fixed beforehand. No method sets its own: stated errors are shown with the
verdict. A method that is too coarse is INCONCLUSIVE; one that misses it by more than its stated error disagrees.
"""

import re
import tomllib
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import fields, replace
from fnmatch import fnmatchcase
from functools import partial
from pathlib import Path
from typing import Any, TypeAlias, TypeVar

import numpy as np
from numpy.polynomial import chebyshev

from cases.answers import Answer
from cases.case import USUAL_SUITES, Case, CaseScene, Sampling
from cases.claims import Agree, Approach, Bound, Claim, Equal, Expected, Law, Norm, Numbers, Study, Zero
from cases.declare.methods import MethodUse
from cases.units import Units, in_units
from cases.verdicts import Origin, Why
from contact import ContactRadii, ElasticLayer, InvalidInput, Layer, Loading, Profile, Scene
from contact.records.validation import FloatArray

# A scene on any layer, under any loading.
AnyScene: TypeAlias = Scene[Any, Any]
Scenes: TypeAlias = Iterable[CaseScene]
# Named arguments that several calls share.
Words: TypeAlias = dict[str, Any]
Points: TypeAlias = tuple[tuple[float, float], ...]
Ratios: TypeAlias = tuple[float, ...] | list[float] | FloatArray


def table(name: str) -> dict[str, Any]:
    """Return a table of numbers or words of this folder."""
    return tomllib.loads(Path(__file__).with_name(name).read_text(encoding="utf-8"))


# Reference numbers of `benchmarks.references`, by kind and name; what each list holds stands in its ``table``.
NUMBERS: dict[str, dict[str, list[float]]] = table("reference_numbers.toml")
# kbar of the bonded layer by a/h as Hayes et al. (1972) printed it, by label of the layer.
HAYES: dict[str, dict[float, float]] = {
    label: dict(zip(column["a_over_h"], column["kbar"], strict=True)) for label, column in table("hayes.toml").items()
}

# Fits as printed, and loads that are prescribed.
FURTHER = table("further_numbers.toml")
# Scenes that the suite ci solves, by case and method.
IN_CI: dict[str, dict[str, list[str]]] = table("suite_ci.toml")

# -- papers -----------------------------------------------------------------------------------------------------------
HEAD = re.compile(
    r"(?P<title>.+?)\.\n\nQuestion: (?P<question>.+?)\nSource: (?P<source>.+?)\.\n\n(?P<text>.+)", re.DOTALL
)


def paper(
    module: str,
    text: str | None,
    scenes: Iterable[CaseScene],
    methods: tuple[MethodUse, ...],
    claims: Iterable[Study],
    *,
    suites: tuple[str, ...] = USUAL_SUITES,
) -> Case:
    """Return the case of a module, whose docstring is a title, a question, its source (equations) and the text.

    Args:
        module: Name of the module, which is that of the case.
        text: Docstring of the module.
        scenes: Scenes that are solved.
        methods: Methods that solve each scene without methods of its own.
        claims: Claims about the answers, and studies.
        suites: Suites that the case belongs to.

    Raises:
        InvalidInput: If the docstring lacks the question or the source.
    """
    name = module.rpartition(".")[2]
    if (head := HEAD.fullmatch((text or "").strip())) is None:
        raise InvalidInput(f"{name}.py: a docstring is title, 'Question: ..?', 'Source: ..; ...', text")
    title, question, source = (" ".join(head[part].split()) for part in ("title", "question", "source"))

    def in_suites(scene: CaseScene) -> CaseScene:
        labels = [use.label for use in scene.methods or methods]
        return replace(scene, nightly=tuple(label for label in labels if not _in_ci(name, label, scene.name)))

    return Case(
        name=name,
        title=title,
        question=question,
        equations=tuple(source.split("; ")),
        text=head["text"],
        suites=suites,
        scenes=tuple(map(in_suites, scenes)),
        methods=methods,
        claims=tuple(claims),
    )


def _in_ci(case: str, label: str, scene: str) -> bool:
    """Whether the suite ci solves a scene by a method."""
    lists = (IN_CI.get(case, {}).get(key) for key in ("*", label))
    return all(any(fnmatchcase(scene, pattern) for pattern in names) for names in lists if names is not None)


# -- reasons ----------------------------------------------------------------------------------------------------------
# Why claims hold, by case and name.
REASONS = table("reasons.toml")


def reasons(case: str) -> dict[str, Why]:
    """Return the reasons of a case (or those that several share) by name.

    Raises:
        InvalidInput: For an entry without one of the fields.
    """
    return {name: _reason(f"{case}.{name}", entry) for name, entry in REASONS[case].items()}


def _reason(place: str, entry: Mapping[str, str]) -> Why:
    """Return the reason of an entry; missing fields are those of the entry that its ``like`` names."""
    case, _, name = entry.get("like", "").partition(".")
    whole = {**REASONS[case][name], **entry} if name else entry
    try:
        return Why(Origin(whole["origin"]), whole["source"], whole["because"], whole["tolerance"])
    except KeyError as error:
        raise InvalidInput(f"reasons.toml: {place} has no entry {error}; add it") from None


SHARED = reasons("shared")

# -- layers and scenes ------------------------------------------------------------------------------------------------
THICKNESS = 1e-3  # m
YOUNGS_MODULUS = 1e6  # Pa
LAYERS: dict[str, tuple[str, float]] = {
    "unbonded": ("unbonded", 0.3),
    "bonded nu=0.3": ("bonded", 0.3),
    "bonded nu=0.45": ("bonded", 0.45),
    "bonded nu=0.5": ("bonded", 0.5),
}


def layer(label: str) -> Layer:
    """Return the layer called ``label``: its support and, when bonded, its Poisson's ratio; or the half-space."""
    if label == "half-space":
        return half_space()
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


def contact_modulus(layer: Any) -> float:
    """E* = E / (1 - nu^2) [Pa] for expected numbers, which must not share a mistake with `Layer.contact_modulus`."""
    return float(layer.youngs_modulus / (1 - layer.poissons_ratio**2))


def confined_modulus(layer: Layer) -> float:
    """E (1 - nu) / ((1 + nu) (1 - 2 nu)) [Pa] for expected numbers, written out for the same reason."""
    nu = layer.poissons_ratio
    return layer.youngs_modulus * (1 - nu) / ((1 + nu) * (1 - 2 * nu))


def scene_name(label: str, ratio: float) -> str:
    """Return the name of a scene: the layer and its confinement ratio."""
    return f"{label} a/h={ratio:g}"


def scene(
    name: str,
    layer: ElasticLayer,
    indenter: Profile,
    loading: Loading,
    /,
    *,
    effects: tuple[Any, ...] = (),
    steep: bool = False,
    sampling: Sampling | None = None,
    methods: tuple[MethodUse, ...] = (),
    **parameters: bool | float | str,
) -> CaseScene:
    """Return a scene of a case.

    Args:
        name: Name, unique within the case.
        layer: Layer, stack or graded layer.
        indenter: Profile of the indenter.
        loading: Prescribed radii, depths, forces or history.
        effects: Effects in addition to elasticity.
        steep: Whether strains may be large; the scene is solved all the same.
        sampling: Fields recorded from each answer.
        methods: Methods that solve the scene; empty for those of the case.
        parameters: Parameters that distinguish the scene.
    """
    problem: AnyScene = Scene(
        layer=layer, indenter=indenter, loading=loading, effects=effects, beyond_small_strains=steep
    )
    sampling = Sampling() if sampling is None else sampling
    return CaseScene(name=name, parameters=parameters, scene=problem, sampling=sampling, methods=methods)


def rings(contact_radius: float, *fractions: float) -> Sampling:
    """Return the sampling of the pressure on rings between fractions of the contact radius [m]."""
    return Sampling(ring_edges=tuple(float(x) for x in contact_radius * np.asarray(fractions)))


def names_of(scenes: Scenes) -> tuple[str, ...]:
    """Return the names of scenes."""
    return tuple(scene.name for scene in scenes)


def having(scenes: Scenes, **wanted: float | str) -> tuple[CaseScene, ...]:
    """Return the scenes with these parameters."""
    return tuple(s for s in scenes if all(s.parameters.get(name) == value for name, value in wanted.items()))


def radius(scene: AnyScene) -> float:
    """Return the last prescribed contact radius a [m], or that of a flat punch."""
    return float(scene.loading.values[-1] if isinstance(scene.loading, ContactRadii) else scene.indenter.flat_radius)


def thinness(scene: AnyScene) -> float:
    """h/a."""
    return float(scene.layer.thickness) / radius(scene)


def half_space_stiffness(scene: AnyScene) -> float:
    """2 E* a [N/m], the unit of stiffnesses."""
    return 2 * contact_modulus(scene.layer) * radius(scene)


def reference_numbers(
    kind: str,
    scenes: Scenes,
    unit: Callable[[AnyScene], Mapping[str, float]],
    name: Callable[[str], str] = str,
) -> dict[str, dict[str, float]]:
    """Return reference numbers of a kind by scene and quantity.

    Args:
        kind: Key of ``NUMBERS``.
        scenes: Scenes; those without numbers are left out.
        unit: Function that returns the unit of each number of a scene in SI, by quantity, in the order of the numbers.
        name: Function that returns the name of the numbers for the name of a scene.
    """
    rows = {s.name: (NUMBERS[kind].get(name(s.name)), unit(s.scene)) for s in scenes}
    return {
        place: {quantity: number * size for number, (quantity, size) in zip(row, units.items(), strict=False)}
        for place, (row, units) in rows.items()
        if row
    }


def reference_stiffness(scenes: Scenes) -> dict[str, dict[str, float]]:
    """Return the reference stiffness k_N [N/m] of flat punches by scene."""
    return reference_numbers("stiffness", scenes, lambda scene: {"contact_stiffness": half_space_stiffness(scene)})


# Changed scenes whose answers follow exactly from those of the original.
def doubled_modulus(scene: AnyScene) -> AnyScene:
    """Return the scene with twice Young's modulus: at given radii depth stays and force doubles."""
    return scene.replace(layer=scene.layer.replace(youngs_modulus=2 * scene.layer.youngs_modulus))


def other_poissons_ratio(scene: AnyScene) -> AnyScene:
    """Return the scene with nu = 0.1 at the same E*: the answer of an unbonded layer is the same."""
    modulus = contact_modulus(scene.layer) * (1 - 0.1**2)
    return scene.replace(layer=scene.layer.replace(poissons_ratio=0.1, youngs_modulus=modulus))


def in_millimetres(scene: AnyScene) -> AnyScene:
    """Return the same contact with lengths in mm and stresses in MPa, so that forces keep their numbers."""
    return in_units(scene, Units(length=1e3, stress=1e-6))


# -- methods ----------------------------------------------------------------------------------------------------------
# A method that does not model a scene answers with its reason.
MDR = MethodUse(label="mdr")
FEM = MethodUse(label="fem", settings={"order": 4, "growth": 0.33, "edge_cell": 1e-7, "truncation": 1e-10})
PLAIN_FEM = MethodUse(label="fem")
QUICK_FEM = MethodUse(label="fem", settings={"accuracy": 1e-4})
DETACHING_FEM = MethodUse(label="fem", settings={"accuracy": 1e-3})
BEM = MethodUse(label="bem", settings={"points": 256})
DETACHING_BEM = MethodUse(label="bem", settings={"points": 128})
EQUATION = MethodUse(label="integral_equation")
TABLE = MethodUse(label="mdr_table", settings={"cells": 128, "ratios": 60, "radii": 200})
EVERY = (MDR, FEM, BEM, EQUATION, TABLE)

# -- requirements -----------------------------------------------------------------------------------------------------
PATH = ("indentation_depth", "normal_force", "contact_stiffness")
# By resolution: on layers that grids resolve ("usual"), or where a cell is some share of the thickness.
WITHIN: dict[str, dict[str, dict[str, float]]] = table("requirements.toml")


def required(*labels: str) -> dict[str, dict[str, float]]:
    """Return the requirements of methods by quantity, on layers that grids resolve."""
    return {label: WITHIN["usual"][label] for label in labels}


# -- claims -----------------------------------------------------------------------------------------------------------
C = TypeVar("C", bound=Claim)


def claim(kind: type[C], name: str, quantity: str, scenes: Scenes, why: Why, /, **words: Any) -> C:
    """Return a claim.

    Args:
        kind: Class of the claim.
        name: Name of the claim.
        quantity: Quantity that is compared.
        scenes: Scenes on which it is judged; empty for all, or for those that have an expected number.
        why: Origin of the expected number and reason of the tolerance.
        words: Other fields of the class. Any other name is the label of a method, and its value the tolerance.
    """
    field_names = {field.name for field in fields(kind)}
    tolerances = {label: words.pop(label) for label in tuple(words) if label not in field_names}
    return kind(name=name, quantity=quantity, scenes=names_of(scenes), why=why, tolerances=tolerances, **words)


def equal(name: str, quantity: str, to: Expected, scenes: Scenes, why: Why, /, **words: Any) -> Equal:
    """Return the claim that a quantity equals expected numbers; other arguments as of `claim`."""
    return claim(Equal, name, quantity, scenes, why, to=to, **words)


def equals(names: Mapping[str, str], to: Expected, scenes: Scenes, why: Why, /, **words: Any) -> Iterator[Equal]:
    """Yield one claim per name and its quantity; other arguments as of `equal`."""
    return (equal(name, quantity, to, scenes, why, **words) for name, quantity in names.items())


def depth_and_force(prefix: str) -> dict[str, str]:
    """Return the names of claims about depth and force, for `equals`."""
    return {f"{prefix} depth": "indentation_depth", f"{prefix} force": "normal_force"}


def zero(name: str, quantity: str, scenes: Scenes, why: Why, /, **words: Any) -> Zero:
    """Return the claim that a residual vanishes; arguments as of `claim`."""
    return claim(Zero, name, quantity, scenes, why, **words)


def bound(
    name: str, quantity: str, scenes: Scenes, change: Callable[[AnyScene], AnyScene], why: Why, /, **words: Any
) -> Bound:
    """Return the claim that a quantity is at least that of the changed scene; other arguments as of `claim`."""
    return claim(Bound, name, quantity, scenes, why, change=change, **words)


def approach(
    name: str, quantity: str, scenes: Scenes, limit: Callable[[AnyScene], Numbers], why: Why, /, **words: Any
) -> Approach:
    """Return the claim that a quantity approaches a closed form as a parameter, h/a by default, falls."""
    return claim(Approach, name, quantity, scenes, why, limit=limit, **{"parameter": thinness, **words})


def agreements(
    scenes: Scenes,
    tolerances: Mapping[str, float | Mapping[str, float]],
    quantities: Iterable[str] = PATH,
    *,
    why: Why | None = None,
    derived_from: str = "",
    fast: str = "mdr",
    name: str = "",
    suffix: str = "",
    **words: Any,
) -> Iterator[Agree]:
    """Yield the agreement of ``fast`` with each method of ``tolerances`` in each of the quantities.

    Args:
        scenes: Scenes on which the methods are compared.
        tolerances: Tolerances by label, or by label and quantity.
        quantities: Quantities that are compared.
        why: Reason in place of the usual one of the method, which holds for ``PATH``.
        derived_from: Choice of the tolerances, if it is not that of the reason.
        fast: Label of the method under test.
        name: Name of the claims, with {} for the quantity.
        suffix: Suffix of the usual names of the claims.
        words: Other fields of `Agree`.
    """
    for label, tolerance in tolerances.items():
        whole = why or SHARED[label]
        whole = replace(whole, tolerance=derived_from) if derived_from else whole
        for quantity in tuple(quantities):
            claim_name = (name or f"{{}}: MDR and {label}{suffix}").format(quantity.replace("_", " "))
            permitted = tolerance[quantity] if isinstance(tolerance, Mapping) else tolerance
            more: Words = {"fast": fast, "reference": label, "tolerance": permitted, **words}
            yield claim(Agree, claim_name, quantity, scenes, whole, **more)


def pressure_agreements(scenes: Scenes, norms: Mapping[str, Norm], limit: str) -> Iterator[Agree]:
    """Yield the agreement of the pressures of MDR and finite elements, one claim for each name and norm of ``norms``.

    ``limit`` is what limits finite elements to about 2e-5, far inside the requirement.
    """
    words: Words = {"derived_from": f"a requirement: 2e-4; {limit} finite elements to about 2e-5", "refined": ("mdr",)}
    for name, norm in norms.items():
        yield from agreements(scenes, required("fem"), ("pressure",), name=name, norm=norm, **words)


def carried_force(name: str, scenes: Scenes, method: str) -> Zero:
    """Return the claim that sampled pressures add up to the force; the rings must reach the contact's edge."""
    words: Words = {"tolerance": 1e-3, "methods": (method,), "derive": force_residual}
    return zero(name, "pressure", scenes, SHARED["equilibrium"], **words)


def force_residual(scene: CaseScene, answer: Answer) -> list[float]:
    """Return (sum of ring loads)/F_N - 1 of the last step."""
    load = float(np.sum(scene.sampling.rings.loads(np.array(answer.quantities["pressure"].values))))
    return [load / answer.quantities["normal_force"].values[-1] - 1]


def incremental_stiffness(scene: CaseScene, answer: Answer) -> FloatArray:
    """Return dF/(k_N d delta) - 1 along a loading path: one more step presses like a flat punch, whatever the profile.

    With F = int c (g(a) - g(x)) dx and k_N the stiffness of the flat punch of radius a, this vanishes exactly where the
    spring stiffness is the derivative c = dk_N/da, Eq. (10), which for the data of a layer reads
    c_bar = d(xi k_bar)/dxi. The radii of the path are `chebyshev_radii`.
    """
    a, depth, force, stiffness = (np.array(answer.quantities[name].values) for name in ("contact_radius", *PATH))
    fit = partial(chebyshev.Chebyshev.fit, a, deg=len(a) - 1)
    return np.asarray(fit(force).deriv()(a) / (stiffness * fit(depth).deriv()(a)) - 1)


def chebyshev_radii(lowest: float, highest: float, count: int) -> FloatArray:
    """Increasing Chebyshev-Lobatto points of [lowest, highest], where a polynomial through smooth values converges."""
    return lowest + (highest - lowest) * np.sin(np.linspace(0, np.pi / 2, count)) ** 2


def energy_balance(scenes: Scenes, time_steps: int, **tolerances: Any) -> Zero:
    """Return the claim that the energies of an impact add up; finite elements take ``time_steps`` steps."""
    steps = f"finite elements: 1e-5 by {time_steps} time steps, ten times"
    why = replace(SHARED["energy balance"], tolerance=f"MDR: tolerance of its time integration; {steps}")
    return zero("energy balance", "energy_residual", scenes, why, tolerance=1e-7, **tolerances)


def scaling_law(
    name: str,
    scenes: Scenes,
    change: Callable[[AnyScene], AnyScene],
    factors: tuple[float, ...],
    why: Why,
    /,
    **words: Any,
) -> Law:
    """Return the claim that a changed scene gives known multiples of depth, force and (if named) stiffness.

    ``factors`` are those of ``PATH``, the last may be left out; other arguments as of `claim`.
    """
    by_name = dict(zip(PATH, factors, strict=False))
    words = {"tolerance": 1e-12, **words}
    return claim(Law, name, "normal_force", scenes, why, change=change, factors=by_name, **words)


def same_in_millimetres(scenes: Scenes, factors: tuple[float, ...] = (1e3, 1.0, 1e-3)) -> Law:
    """Return the claim that the unit system does not matter; ``factors`` as of `scaling_law`."""
    return scaling_law(
        "the unit system does not matter", scenes, in_millimetres, factors, SHARED["units"], tolerance=1e-9, bem=1e-7
    )
