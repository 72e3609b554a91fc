"""Adhesive branches made of closed forms: what is interpolated between solved radii, and what pull-offs state."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest

from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Layer,
    Paraboloid,
    Profile,
    Scene,
    Spheroconical,
    StageLog,
    Tabulated,
    TruncatedCone,
)
from contact.records.validation import FloatArray
from fem_reference import Fem
from fem_reference.adhesion.branch import BranchPiece, InterpolatedBranch, chebyshev_points
from fem_reference.adhesion.equilibria import branch_of
from fem_reference.adhesion.superposed import superposed
from fem_reference.prescribed_contact import solve_contact
from fem_reference.profiles import ScaledIndenter
from mdr import Mdr
from tests.drawn_scenes import scene_of

RADII = np.array([0.3, 0.7, 1.3])
WORK = 1e-3


def cone_beyond(flat: float) -> tuple[FloatArray, FloatArray]:
    """Depth and half force at depth zero of a cone of slope one beyond a flat end (Ejike 1969)."""
    share = np.minimum(flat / RADII, 1.0)
    return RADII * np.arccos(share), RADII**2 / 2 * (np.arccos(share) - share * np.sqrt(1 - share**2))


@pytest.mark.parametrize(
    ("profile", "expected"),
    [
        (Cone(slope=1.0), (np.pi * RADII / 2, np.pi * RADII**2 / 4)),
        (Paraboloid(radius_of_curvature=1.0), (RADII**2, RADII**3 / 3)),
        (TruncatedCone(flat_radius=0.5, slope=1.0), cone_beyond(0.5)),
    ],
)
def test_depth_and_force_of_a_half_space(profile: Profile, expected: tuple[FloatArray, FloatArray]) -> None:
    for found, value in zip(half_space_parts(profile, RADII), expected, strict=True):
        assert found == pytest.approx(value, rel=1e-13, abs=1e-15)


def half_space_parts(profile: Profile, radius: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Depth and half force at depth zero of a half-space, whose flat punches press with 1 / (pi c)."""
    depth, force = superposed(profile, radius, np.full((1, len(radius)), 1 / np.pi), np.zeros((1, len(radius))))
    return depth, -force / 2


def test_superposed_depths_and_forces_are_one_energy() -> None:
    """``k_N' delta_0 = -dF_2 / da``, beside a breakpoint and for pressures that change with the radius."""
    profile = Spheroconical(radius=0.4, slope=0.6)
    share, power = np.array([0.3, 0.1, -0.05, 0.01])[:, None], np.array([0.0, 0.5, 1.0, -1.0])[:, None]

    def parts(radius: FloatArray) -> tuple[FloatArray, FloatArray]:
        return superposed(profile, radius, share * radius**power, power * share * radius**power)

    radius, step = np.array([0.1, 0.2, 0.21, 0.3, 1.0]), 1e-4
    force_slope = (parts(radius + step)[1] - parts(radius - step)[1]) / (2 * step)
    assert -2 * parts(radius)[0] == pytest.approx(force_slope, rel=3e-6, abs=0.0)


class PunchOfHalfSpace:
    """The pressure of a flat punch as `punch_pressure` asks for it."""

    degree = 4

    def gauss(self, points: int) -> tuple[FloatArray, FloatArray]:
        c, weight = np.polynomial.legendre.leggauss(2 * points + 20)
        c = (1 + c) / 2
        return np.sqrt(1 - c**2), np.pi * c * weight

    def evaluate(self, values: FloatArray, radius: FloatArray) -> FloatArray:
        return np.asarray(1 / (np.pi * np.sqrt(1 - radius**2)))


def made_up(profile: Profile, radii: FloatArray) -> BranchPiece:
    """A piece of a half-space's branch."""
    contacts = [
        SimpleNamespace(
            stiffness=2.0,
            stiffness_slope=2.0,
            smooth_depth=delta / a,
            profile_force=-2.0 * half / a**2,
            contact_trace=PunchOfHalfSpace(),
            pressures=np.zeros((1, 2)),
            indenter=ScaledIndenter(profile, a),
            contact_radius=a,
        )
        for a, delta, half in zip(radii, *half_space_parts(profile, radii), strict=True)
    ]
    return BranchPiece(radii[0], radii[-1], graded=False, contacts=cast(Any, tuple(contacts)))


def nodes(count: int) -> FloatArray:
    return np.asarray(0.1 * 6.0 ** chebyshev_points(count))


@pytest.mark.parametrize(
    "profile",
    [
        Spheroconical(radius=0.4, slope=0.6),
        Tabulated(radii=np.linspace(0.0, 1.0, 8), heights=np.array([0.0, 0.02, 0.1, 0.2, 0.5, 0.6, 1.0, 1.5])),
    ],
)
def test_breakpoints_between_solved_radii_cost_nothing_on_a_half_space(profile: Profile) -> None:
    """Polynomials through solved radii missed 2.8e-3 of a depth between them (2.2e-4 stated), and 0.3 of it here."""
    branch = InterpolatedBranch((made_up(profile, nodes(11)),), WORK)
    radius = np.linspace(0.11, 0.59, 40)
    depth, half_force = half_space_parts(profile, radius)
    smooth = branch.depth(radius) + branch.elongation(radius)
    assert smooth == pytest.approx(depth, rel=1e-12, abs=0.0)
    assert branch.force(radius) == pytest.approx(2 * (radius * branch.depth(radius) - half_force), rel=0.0, abs=1e-12)


def test_breakpoints_between_solved_radii_cost_nothing_on_a_layer() -> None:
    """Depth and force were 5.7e-4 and 7.9e-4 off between solved radii, at these 2.9e-5 and 4.7e-5."""
    scene, settings, log = (
        scene_of(6101, 5, "adhering_table", (0.1, 5.0)),
        Fem(accuracy=1e-4).discretisation,
        StageLog(),
    )
    branch = branch_of(scene, None, lambda radius: solve_contact(scene, radius, settings, log), 0.5, span=5.9)
    solved = branch.pieces[-1].radii
    between = np.sqrt(solved[1:] * solved[:-1])
    errors = []
    for radius in (solved, between):
        exact = Mdr().solve(scene.replace(loading=ContactRadii(radius)))
        depth, force = exact.indentation_depth, exact.normal_force / scene.layer.contact_modulus
        off = np.array([branch.depth(radius) - depth, branch.force(radius) - force]) / np.array(
            [[np.abs(depth).max()], [np.abs(force).max()]]
        )
        errors.append(np.sqrt(np.mean(off**2, axis=1)))
    assert np.all(errors[1] < 2.0 * errors[0])


@pytest.mark.slow
def test_a_measured_profile_states_what_its_force_misses_between_solved_radii() -> None:
    """Errors of the depth, of the force at depth zero and of the slope of k_N were added: 333 times the true error."""
    scene = scene_of(1401, 6, "adhering_table", (0.1, 5.0))
    path, exact = Fem(accuracy=1e-2).solve(scene), Mdr().solve(scene)
    for name in ("pull_off_force", "pull_off_depth", "pull_off_contact_radius", "force_at_loss"):
        error = abs(getattr(path, name) / getattr(exact, name) - 1)
        assert error < path.error_estimate[name][0], name


@pytest.mark.parametrize(
    ("layer", "indenter"),
    [
        (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.4), Paraboloid(radius_of_curvature=3.0)),
        (Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=0.5), TruncatedCone(flat_radius=0.3, slope=0.2)),
    ],
)
def test_the_surface_beside_an_adhering_contact_keeps_its_stated_error(layer: Layer, indenter: Profile) -> None:
    """Close to the edge, too, where it rises like a root; no error of its own was stated once."""
    scene = Scene(
        layer=layer,
        indenter=indenter,
        loading=ContactRadii(values=np.array([0.4, 2.0])),
        effects=(Adhesion(work_of_adhesion=1e-3),),
    )
    answer, exact = Fem(accuracy=1e-2).solve(scene), Mdr().solve(scene)
    stated = answer.uncertainty("surface_displacement")
    for step, a in enumerate(answer.contact_radius):
        radii = a * np.array([1.0 + 1e-9, 1.0 + 1e-6, 1.0001, 1.001, 1.01, 1.1, 2.0, 5.0])
        error = np.abs(answer.surface_displacement(radii, step) - exact.surface_displacement(radii, step))
        assert error.max() < stated[step], (a, error, stated[step])
