"""Solvers that know a force at depths become methods: inverted, differentiated, with or without a radius."""

import numpy as np
import pytest

from cases.referees.from_depth import Response, answer_from_depths, inverted
from contact import (
    ContactPath,
    ContactRadii,
    ForcePath,
    IndentationDepths,
    InvalidInput,
    Layer,
    NormalForces,
    NotConvergedError,
    Paraboloid,
    Scene,
    StageLog,
    UnsupportedSceneError,
)

R, MODULUS = 1e-2, 1e6 / (1 - 0.3**2)


def scene(loading):
    layer = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=R), loading=loading)


def hertz(depths, *, radius=True):
    force = 4 / 3 * MODULUS * np.sqrt(R) * depths**1.5
    return Response(normal_force=force, contact_radius=np.sqrt(R * depths) if radius else None)


DEPTHS = np.array([1e-5, 3e-5, 1e-4])


@pytest.mark.parametrize(
    "loading",
    [
        IndentationDepths(values=DEPTHS),
        NormalForces(values=hertz(DEPTHS).normal_force),
        ContactRadii(values=np.sqrt(R * DEPTHS)),
    ],
    ids=["depths", "forces", "radii"],
)
def test_whatever_is_prescribed_the_state_is_found(loading):
    path = answer_from_depths(scene(loading), hertz, StageLog(), method="hertz")
    assert isinstance(path, ContactPath)
    assert path.indentation_depth == pytest.approx(DEPTHS, rel=1e-9, abs=0.0)
    assert path.normal_force == pytest.approx(hertz(DEPTHS).normal_force, rel=1e-9, abs=0.0)
    assert path.contact_stiffness == pytest.approx(2 * MODULUS * np.sqrt(R * DEPTHS), rel=1e-8, abs=0.0)


def test_a_solver_without_radii_answers_a_curve_of_forces():
    curve = answer_from_depths(
        scene(IndentationDepths(values=DEPTHS)), lambda depths: hertz(depths, radius=False), StageLog(), method="hertz"
    )
    assert isinstance(curve, ForcePath)
    assert "contact_radius" not in curve.ARRAYS
    with pytest.raises(InvalidInput, match="states no error"):
        curve.uncertainty("normal_force")
    with pytest.raises(UnsupportedSceneError, match="no contact radius"):
        answer_from_depths(
            scene(ContactRadii(values=np.array([1e-3]))),
            lambda depths: hertz(depths, radius=False),
            StageLog(),
            method="hertz",
        )


def test_what_no_argument_gives_is_said():
    with pytest.raises(NotConvergedError, match="no argument gives 5"):
        inverted(lambda x: np.minimum(x, 2.0), np.array([5.0]), np.array([1.0]))


@pytest.mark.parametrize("power", [1.0, 1.5, 2.0, 4.0])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_a_stiffness_by_differences_states_their_error(power, noise):
    random, depths = np.random.default_rng(17), np.geomspace(1e-7, 1e-4, 200)

    def respond(at):
        return Response(normal_force=at**power * (1.0 + noise * random.standard_normal(at.size)))

    curve = answer_from_depths(scene(IndentationDepths(values=depths)), respond, StageLog(), method="power law")
    error = np.abs(curve.contact_stiffness - power * depths ** (power - 1.0))
    stated = curve.uncertainty("contact_stiffness")
    assert np.mean(error <= stated) >= 0.95
    if noise or power % 1.0:
        assert np.median(stated / error) <= 100.0 if noise else 10.0


def test_the_solver_s_own_error_of_the_stiffness_is_kept():
    depths = IndentationDepths(values=DEPTHS)
    plain, own = (
        answer_from_depths(
            scene(depths), lambda d: hertz(d, radius=False), StageLog(), method="hertz", error_estimate=errors
        )
        for errors in ({}, {"contact_stiffness": np.full(3, 1e-3)})
    )
    more = own.error_estimate["contact_stiffness"] - plain.error_estimate["contact_stiffness"]
    assert more == pytest.approx(np.full(3, 1e-3), rel=1e-12, abs=0.0)
