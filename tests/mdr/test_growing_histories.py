"""Forces that never fall, against matrix exponentials of 60 digits."""

import mpmath
import numpy as np
import pytest

from contact import (
    Cone,
    ForceHistory,
    InvalidInput,
    KelvinVoigt,
    Layer,
    NormalForces,
    Paraboloid,
    PronySeries,
    Scene,
    StandardSolid,
    Tabulated,
    TruncatedCone,
)
from contact.scene.effects import Relaxation
from mdr import Mdr
from mdr.history.spring_law import SpringLaw
from tests.mdr.test_recovery import SPECTRA

EPS = float(np.finfo(float).eps)
TIME = np.array([0.0, 1e-9, 0.3, 0.31, 4.0, 300.0])
FORCE = np.array([0.0, 0.2, 0.2, 0.5, 0.8, 1.0])
SOLID = StandardSolid(long_term_shear_modulus=0.25, maxwell_shear_modulus=0.75, viscosity=0.75)
LIQUID = PronySeries(long_term_shear_modulus=0.0, shear_moduli=[0.3, 0.7], relaxation_times=[0.1, 2.0])
DASHPOT = KelvinVoigt(shear_modulus=1.0, viscosity=0.5)
LAYER = Layer.incompressible(thickness=1.0, shear_modulus=1.0)
HALF_SPACE = Layer.half_space(youngs_modulus=3.0, poissons_ratio=0.5)


def exactly(spectrum, time, force):
    """The surface u of one spring under a force, by an exponential of 60 digits of u, q_j, the force and its rate."""
    long_term, viscosity, weights, rates = spectrum
    with mpmath.workdps(60):
        g, d = [mpmath.mpf(w) for w in weights], [mpmath.mpf(r) for r in rates]
        whole, n = mpmath.mpf(long_term) + mpmath.fsum(g), len(g)
        of_u = [w / whole for w in g]
        # A dashpot beside the springs holds them at the first instant.
        u, q, found = mpmath.mpf(0 if viscosity > 0.0 else force[0]) / whole, [mpmath.mpf(0)] * n, []
        for i in range(len(time)):
            if i:
                step, f = mpmath.mpf(time[i]) - mpmath.mpf(time[i - 1]), mpmath.mpf(force[i - 1])
                rate = (mpmath.mpf(force[i]) - f) / step
                if viscosity > 0.0:
                    first = [-whole / viscosity, *(w / viscosity for w in g), 1 / mpmath.mpf(viscosity), 0]
                    rest = [[d[k], *(-d[k] * (k == j) for j in range(n)), 0, 0] for k in range(n)]
                else:
                    first = [mpmath.mpf(0)] * (n + 3)
                    rest = [[0, *(d[k] * (of_u[j] - (k == j)) for j in range(n)), d[k] / whole, 0] for k in range(n)]
                last = [[0] * (n + 2) + [1], [0] * (n + 3)]
                moved = mpmath.expm(mpmath.matrix([first, *rest, *last]) * step) * mpmath.matrix([u, *q, f, rate])
                u, *q = list(moved)[: n + 1]
                if viscosity == 0.0:
                    u = mpmath.fsum(w * stretch for w, stretch in zip(of_u, q, strict=True)) + force[i] / whole
            found.append(float(u * whole))
    return np.array(found)


@pytest.mark.parametrize("start", [0.0, 0.2])
@pytest.mark.parametrize("name", SPECTRA)
def test_the_elastic_force_is_exact_for_any_spectrum(name, start):
    long_term, viscosity, weights, rates = SPECTRA[name]
    relaxation = Relaxation(
        long_term_modulus=long_term,
        moduli=np.array(weights)[::-1],
        times=1.0 / np.array(rates)[::-1],
        viscosity=viscosity,
    )
    force = np.maximum(FORCE, start)
    found = SpringLaw.of(relaxation).elastic_force(TIME, force)
    # Rates become times and rates again.
    expected = exactly((long_term, viscosity, weights, 1.0 / (1.0 / np.array(rates))), TIME, force)
    np.testing.assert_allclose(found, expected, rtol=EPS * (TIME.size + 4.0 * (len(rates) + 1)), atol=0.0)


COMPARED = ("indentation_depth", "contact_radius")


@pytest.mark.parametrize(
    ("layer", "indenter", "model"),
    [
        (LAYER, Paraboloid(radius_of_curvature=2.0), SOLID),
        (HALF_SPACE, Cone(slope=0.2), LIQUID),
        (LAYER, TruncatedCone(flat_radius=0.3, slope=0.2), DASHPOT),
    ],
)
def test_depths_under_a_force_that_never_falls_need_no_steps(layer, indenter, model):
    loading = ForceHistory(time=[0.0, 0.3, 3.0], force=[0.0, 0.02, 0.02])
    scene = Scene(layer=layer, indenter=indenter, loading=loading, effects=(model,))
    found = Mdr().solve(scene)
    for name in COMPARED:
        assert np.all(found.error_estimate[name] < 1e-12), name


def test_a_dashpot_beside_a_flat_end_is_answered():
    """Springs stepped in time stated 1.4e-5; asked for 1e-6 they did not resolve it, and it was refused."""
    scene = Scene(
        layer=LAYER,
        indenter=TruncatedCone(flat_radius=0.3, slope=0.2),
        loading=ForceHistory(time=[0.0, 0.0667, 0.1014, 1.0844], force=[0.0, 0.0, 0.0023, 0.02]),
        effects=(DASHPOT.replace(viscosity=0.014),),
    )
    answer = Mdr().solve(scene)
    assert np.all(answer.error_estimate["indentation_depth"] < 1e-12)
    assert answer.indentation_depth[1] == 0.0


def test_an_elastic_layer_knows_the_present_only():
    force = np.array([0.0, 0.02, 0.01, 0.0])
    scene = Scene(
        layer=LAYER,
        indenter=TruncatedCone(flat_radius=0.3, slope=0.2),
        loading=ForceHistory(time=np.arange(4.0), force=force),
    )
    answer, alone = Mdr().solve(scene), Mdr().solve(scene.replace(loading=NormalForces(force[1:3])))
    for name in ("indentation_depth", "contact_radius"):
        pressed = pytest.approx(getattr(alone, name), rel=1e-13, abs=0.0)
        assert getattr(answer, name)[1:3] == pressed
        assert getattr(answer, name)[[0, 3]].tolist() == [0.0, 0.0]


def test_a_force_beyond_the_rim_is_refused_by_its_name():
    scene = Scene(
        layer=LAYER,
        indenter=Tabulated(radii=[0.0, 0.1, 0.2], heights=[0.0, 0.01, 0.05]),
        loading=ForceHistory(time=[0.0, 1.0], force=[0.0, 5.0]),
        effects=(SOLID,),
    )
    with pytest.raises(InvalidInput, match=r"loading.force, as an elastic layer .* the indenter ends at a radius of"):
        Mdr().solve(scene)
