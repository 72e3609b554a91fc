"""Synthetic curves of every kind: as many intervals hold the true number as they say, and none misleads in silence."""

from collections import Counter
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactError,
    DepthHistory,
    ElasticBase,
    FlatPunch,
    GradedLayer,
    IndentationDepths,
    Layer,
    LayerStack,
    LinearDepth,
    Paraboloid,
    Scene,
    Sphere,
    Spheroconical,
    StandardSolid,
    Sublayer,
    TruncatedCone,
    TruncatedParaboloid,
)
from mdr.curves import CurveFit, fit_curve, fit_history
from mdr.curves.adhesion import branch_of, table_of
from mdr.curves.force_curve import curve_to, longest_curve
from mdr.curves.histories import force_of_depth

HALF_SPACE = Layer.half_space(youngs_modulus=1e3, poissons_ratio=0.5)
THIN = Layer(thickness=5e-6, youngs_modulus=1e3, poissons_ratio=0.5)
GRADED = GradedLayer(thickness=8e-6, youngs_modulus=LinearDepth(surface=1e3, base=3e3), poissons_ratio=0.45)
PAIRS = (
    (HALF_SPACE, Paraboloid(radius_of_curvature=5e-6)),
    (HALF_SPACE, Cone(slope=0.5)),
    (THIN, Sphere(radius=1e-5)),
    (THIN, FlatPunch(radius=2e-6)),
    (THIN, Spheroconical(radius=1e-6, slope=0.7)),
    (THIN.replace(poissons_ratio=0.3), TruncatedCone(flat_radius=5e-7, slope=0.5)),
    (THIN.replace(poissons_ratio=0.4, support="unbonded"), Sphere(radius=1e-5)),
    (THIN, TruncatedParaboloid(flat_radius=1e-6, radius_of_curvature=5e-6)),
    (GRADED, Paraboloid(radius_of_curvature=5e-6)),
)
DEFAULT = ("youngs_modulus", "contact_point", "baseline", "tilt")
Draw = np.random.Generator


@dataclass(frozen=True)
class Curve:
    """A curve, what is fitted to it, and the true numbers whose intervals are counted."""

    fit: Callable[[], CurveFit]
    true: Mapping[str, float]


@dataclass
class Count:
    """Of one kind of curves: intervals that hold, refused curves, and those far outside without a warning."""

    held: int = 0
    intervals: int = 0
    refused: Counter[str] = field(default_factory=Counter)
    silent: list[str] = field(default_factory=list)

    def add(self, number: int, curve: Curve) -> None:
        """Fit the curve and count its intervals."""
        try:
            found = curve.fit()
        except ContactError as error:
            self.refused[str(error)[:60]] += 1
            return
        for name, true in curve.true.items():
            low, high = found.interval(name)
            self.held += low <= true <= high
            self.intervals += 1
            if abs(true - (low + high) / 2) > 3 * (high - low) / 2 and not found.warnings:
                self.silent.append(f"curve {number}: {name} = {low:.4g} to {high:.4g} in place of {true:.4g}")

    @property
    def coverage(self) -> float:
        """Share of intervals that hold the true number."""
        return self.held / self.intervals


def depths(draw: Draw, deepest: float) -> np.ndarray:
    """Depths [m] of a travel of which 0 to 99.5 % are before contact, with at least 12 points in contact."""
    n = int(draw.choice([200, 600, 2000]))
    part = 1.0 if draw.random() < 0.1 else max(10 ** draw.uniform(np.log10(0.005), 0), 12 / n)
    return np.linspace(deepest * (1 - 1 / part), deepest, n)


def recorded(draw: Draw, depth: np.ndarray, force: np.ndarray, scatter: float) -> tuple[np.ndarray, np.ndarray]:
    """Depth from another zero, and force with noise, offset and tilt."""
    peak, travel = np.ptp(force), np.ptp(depth)
    line = peak * (draw.uniform(-0.2, 0.2) + draw.uniform(-0.05, 0.05) * depth / travel)
    return depth + draw.uniform(-1, 1) * travel, force + line + scatter * peak * draw.standard_normal(depth.size)


def elastic(draw: Draw, *, background: bool = True, noise: Callable[..., np.ndarray] | None = None) -> Curve:
    layer, tip = PAIRS[draw.integers(len(PAIRS))]
    scene = Scene(layer=layer, indenter=tip, loading=IndentationDepths([1e-6]))
    modulus, depth = 10 ** draw.uniform(2, 6), depths(draw, 7e-7)
    force = modulus * curve_to(scene, 1e-6).extended(depth)
    scatter = 10 ** draw.uniform(-3, -1.3)
    if noise is not None:
        force, scatter = force + np.ptp(force) * noise(draw, depth, force, scatter), 3e-4
    depth, force = recorded(draw, depth, force, scatter)
    return Curve(lambda: fit_curve(scene, depth, force, formulas=False), {"youngs_modulus": modulus})


def filtered(draw, depth, force, scatter):
    window = np.ones(int(draw.integers(3, 12)))
    return scatter * np.convolve(draw.standard_normal(depth.size), window / window.size**0.5, "same")


def wave(draw, depth, force, scatter):
    """Interference of light: a sine over the whole travel."""
    return scatter * np.sin(draw.uniform(5, 60) * depth / np.ptp(depth) + draw.uniform(0, 6))


def larger_in_contact(draw, depth, force, scatter):
    return scatter * draw.standard_normal(depth.size) * np.sqrt(0.01 + np.clip(force, 0, None) / np.ptp(force))


def spikes(draw, depth, force, scatter):
    return 0.2 * scatter * draw.standard_normal(depth.size) + 5 * scatter * (draw.random(depth.size) < 0.02)


def steps(draw, depth, force, scatter):
    """Rounding to the steps of a converter."""
    share = force / np.ptp(force)
    return np.round(share / scatter) * scatter - share


def drift(draw, depth, force, scatter):
    """A bent baseline."""
    return scatter * (depth / np.ptp(depth)) ** 2 * draw.uniform(-3, 3)


def other_tip(draw, depth, force, scatter):
    """A tip that is 10 % blunter the deeper it is pressed."""
    return 0.1 * np.clip(force, 0, None) / np.ptp(force) * np.clip(depth / depth.max(), 0, None)


FILMS = tuple((h, e, base) for h in (1e-6, 3e-7) for e, base in ((2e9, 1e9), (1e8, 3e9)))


def film(draw: Draw) -> Curve:
    thickness, modulus, base = FILMS[draw.integers(len(FILMS))]

    def scene(of_film: float) -> Scene:
        one = Sublayer(thickness=thickness, youngs_modulus=of_film, poissons_ratio=0.3)
        stack = LayerStack(sublayers=[one], support=ElasticBase(youngs_modulus=base, poissons_ratio=0.3))
        return Scene(layer=stack, indenter=Paraboloid(radius_of_curvature=5e-6), loading=IndentationDepths([1e-7]))

    depth = depths(draw, 1e-7)
    force = modulus * curve_to(scene(modulus), 1e-7).extended(depth)
    depth, force = recorded(draw, depth, force, 10 ** draw.uniform(-3.5, -2))
    name = "layer[0].youngs_modulus"
    guess = scene(modulus * 2.0 ** draw.integers(-1, 2))
    return Curve(lambda: fit_curve(guess, depth, force, parameters=(name, *DEFAULT[1:])), {name: modulus})


def withdrawal(draw: Draw) -> Curve:
    layer, tip = PAIRS[2 * draw.integers(2)]
    modulus, work = 10 ** draw.uniform(3, 5), 10 ** draw.uniform(-5, -3)
    length = (work**2 * 5e-6 / (modulus / 0.75) ** 2) ** (1 / 3)
    deepest = 10 ** draw.uniform(0, 1.5) * length
    if not 2e-8 < deepest < 2e-6:
        return withdrawal(draw)
    effects = (Adhesion(work_of_adhesion=work),)
    scene = Scene(layer=layer, indenter=tip, loading=IndentationDepths([deepest]), effects=effects)
    depth = np.linspace(-(3 + 30 * draw.random()) * length, deepest, int(draw.choice([200, 600])))[::-1]
    reach = min(2.0 ** np.ceil(np.log2(4 * deepest + 20 * length)), 6e-6)
    table = table_of(longest_curve(scene, reach).scene)
    force = modulus * np.interp(depth, *branch_of(table, np.sqrt(work / modulus)), left=0.0)
    depth, force = recorded(draw, depth, force, 10 ** draw.uniform(-3, -1.7))
    guess = scene.replace(effects=(Adhesion(work_of_adhesion=work * 10 ** draw.uniform(-0.5, 0.5)),))
    return Curve(
        lambda: fit_curve(guess, depth, force, parameters=(*DEFAULT, "work_of_adhesion")),
        {"youngs_modulus": modulus, "work_of_adhesion": work},
    )


def relaxation(draw: Draw) -> Curve:
    long, branch, tau = 10 ** draw.uniform(3, 3.7), 10 ** draw.uniform(3, 3.7), 10 ** draw.uniform(-0.7, 0.5)
    solid = StandardSolid(long_term_shear_modulus=long, maxwell_shear_modulus=branch, viscosity=tau * branch)
    layer, tip = PAIRS[2 * draw.integers(2)]
    layer = layer.replace(youngs_modulus=3 * (long + branch))
    time = np.linspace(0, 10, 250)
    depth = 5e-7 * (np.clip(time / draw.uniform(0.3, 2), 0, 1) - 0.2 * draw.random())
    if draw.random() < 0.3:
        depth = depth - 1.2e-7 * np.clip(time - 8, 0, None)
    scene = Scene(
        layer=layer,
        indenter=tip,
        loading=DepthHistory(time=[0, 1], depth=[0, 1e-7]),
        effects=(solid,),
    )
    force = force_of_depth(longest_curve(scene, 1e-6), solid.relaxation, time, depth)
    force = force + np.ptp(force) * (draw.uniform(-0.1, 0.1) + 10 ** draw.uniform(-3, -2) * draw.standard_normal(250))
    point = draw.uniform(-1e-6, 1e-6)
    true = {"long_term_shear_modulus": long, "maxwell_shear_modulus": branch, "relaxation_time": tau}
    return Curve(lambda: fit_history(scene, time, depth + point, force), true)


# Kinds with white noise, and how many curves of each.
WHITE = {
    "elastic": (elastic, 1260),
    "film": (film, 60),
    "withdrawal": (withdrawal, 200),
    "relaxation": (relaxation, 60),
}
OTHER = {one.__name__: one for one in (filtered, wave, larger_in_contact, spikes, steps, drift, other_tip)}


def counted(draw_curve: Callable[..., Curve], count: int, seed: int, **options: object) -> Count:
    """The count of so many curves."""
    found = Count()
    for number in range(count):
        found.add(number, draw_curve(np.random.default_rng((seed, number)), **options))
    return found


@pytest.mark.slow
@pytest.mark.parametrize("kind", WHITE)
def test_intervals_hold_the_true_number_as_often_as_they_say_where_noise_is_white(kind):
    draw, count = WHITE[kind]
    found = counted(draw, count, seed=1)
    scatter = 3 * (0.95 * 0.05 / found.intervals) ** 0.5
    assert 0.92 - scatter < found.coverage < 0.98 + scatter
    assert not found.silent
    assert sum(found.refused.values()) < 0.1 * count


def test_a_pull_off_within_the_scatter_is_warned_of():
    """The work of adhesion of this curve is half as large as its interval says."""
    curve = withdrawal(np.random.default_rng((1, 168)))
    found = curve.fit()
    assert found.interval("work_of_adhesion")[0] > 1.4 * curve.true["work_of_adhesion"]
    assert any("the pull-off is hidden in the scatter" in line for line in found.warnings)


@pytest.mark.slow
@pytest.mark.parametrize("kind", OTHER)
def test_no_interval_misleads_in_silence_where_noise_is_not_white(kind):
    assert not counted(elastic, 60, seed=2, noise=OTHER[kind]).silent
