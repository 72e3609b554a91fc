"""Prescribed depth histories against closed forms, and refusals."""

import numpy as np
import pytest
from scipy.special import hyp1f1

from contact import (
    ContactRadii,
    DepthHistory,
    FlatPunch,
    ForceHistory,
    IndentationDepths,
    InvalidInput,
    KelvinVoigt,
    Paraboloid,
    PowerLaw,
    PronySeries,
    Scene,
    StandardSolid,
    Tabulated,
    TruncatedCone,
    UnsupportedSceneError,
)
from mdr import Mdr
from tests.bed import bed_of
from tests.mdr.viscoelastic_scenes import GLASSY_BRANCH, LONG_TERM, RELAXATION_TIME, incompressible

TOTAL = GLASSY_BRANCH + LONG_TERM
CURVATURE = 0.01
STANDARD = StandardSolid(
    long_term_shear_modulus=LONG_TERM,
    maxwell_shear_modulus=GLASSY_BRANCH,
    viscosity=GLASSY_BRANCH * RELAXATION_TIME,
)
KELVIN_VOIGT = KelvinVoigt(shear_modulus=TOTAL, viscosity=TOTAL * RELAXATION_TIME)
LEGENDRE = np.polynomial.legendre.leggauss(32)


def solve(loading, *, thickness=np.inf, model=STANDARD, indenter=None):
    return Mdr().solve(
        Scene(
            layer=incompressible(thickness, TOTAL),
            indenter=indenter or Paraboloid(radius_of_curvature=CURVATURE),
            loading=loading,
            effects=(model,) if model else (),
        )
    )


def relaxation(t):
    return LONG_TERM + GLASSY_BRANCH * np.exp(-t / RELAXATION_TIME)


@pytest.mark.parametrize("exponent", [1.02, 2.5])
def test_ramps_of_tips_that_are_not_smooth(exponent):
    """Trapezoids between springs and splines of their profile left 7e-8 at the tip where 1e-8 was stated."""
    tip = PowerLaw(exponent=exponent, reference_radius=1.0, reference_height=1.0)
    ramp = DepthHistory(time=[0.0, 0.4, 1.0], depth=[0.0, 4e-4, 1e-3])
    answer = solve(
        ramp,
        model=PronySeries(long_term_shear_modulus=LONG_TERM, shear_moduli=[GLASSY_BRANCH], relaxation_times=[0.3]),
        indenter=tip,
    )
    # F_e = C delta^p: Lee and Radok's integral of a ramp is Kummer's function.
    p = 1.0 + 1.0 / exponent
    elastic = solve(IndentationDepths([1e-3]), model=None, indenter=tip).normal_force[0]
    faded = np.exp(-1.0 / 0.3) * hyp1f1(p, p + 1.0, 1.0 / 0.3)
    expected = elastic * (LONG_TERM + GLASSY_BRANCH * faded) / TOTAL
    assert answer.normal_force[-1] == pytest.approx(expected, rel=1e-13, abs=0.0)
    assert answer.error_estimate["normal_force"][-1] < 1e-11


@pytest.mark.parametrize("frequency", [160.0])
def test_flat_punch_oscillates_with_the_complex_modulus(frequency):
    """F = k_N/G_0 Im[G*(omega) exp(i omega t)] about a relaxed mean, once transients have died."""
    punch, omega, cycles = (
        FlatPunch(radius=1e-3),
        2.0 * np.pi * frequency,
        max(2, int(20.0 * RELAXATION_TIME * frequency)),
    )
    sway = np.linspace(0.0, cycles / frequency, 256 * cycles + 1)
    time = np.concatenate([[0.0], 100.0 * RELAXATION_TIME + sway])
    depth = 1e-5 + np.concatenate([[0.0], 1e-6 * np.sin(omega * sway)])
    answer = solve(DepthHistory(time=time, depth=depth), thickness=1e-3, indenter=punch)
    layer = incompressible(1e-3, TOTAL)
    stiffness = float(bed_of(layer, punch, Mdr().flat_punch).contact_stiffness(1e-3)) / TOTAL
    modulus = LONG_TERM + GLASSY_BRANCH * 1j * omega * RELAXATION_TIME / (1.0 + 1j * omega * RELAXATION_TIME)
    last = slice(-256, None)
    expected = stiffness * (1e-5 * LONG_TERM + 1e-6 * np.imag(modulus * np.exp(1j * omega * sway[last])))
    np.testing.assert_allclose(answer.normal_force[last], expected, atol=2e-4 * stiffness * 1e-6 * TOTAL)


def test_a_worn_cone_and_its_flat_end():
    time = np.linspace(0.0, 4e-3, 21)
    load = DepthHistory(time=time, depth=5e-5 * np.sin(np.pi * time / 4e-3) ** 2)
    answer = solve(load, indenter=TruncatedCone(flat_radius=5e-4, slope=0.1), thickness=1e-3)
    in_contact = answer.contact_radius > 0.0
    assert answer.contact_radius[in_contact].min() >= 5e-4
    assert not in_contact[-1]
    assert answer.normal_force[~in_contact].max(initial=0.0) == 0.0


@pytest.mark.parametrize("unit", [1e-9, 1e6])
@pytest.mark.parametrize("model", [None, STANDARD, KELVIN_VOIGT])
def test_a_measured_profile_of_any_size(unit, model):
    """Lee and Radok 1960 up to the turn. Springs had been shared out between breakpoints by numbers with units."""
    radii = np.array([0.0, 0.2, 0.45, 0.6, 0.9, 1.3, 1.5])
    heights = 0.05 * np.array([0.0, 0.03, 0.2, 0.4, 0.85, 1.8, 2.4])
    indenter, depth = Tabulated(radii=unit * radii, heights=unit * heights), 0.04 * unit
    time = np.linspace(0.0, 2e-3, 3)
    ramp = DepthHistory(time=time, depth=depth * np.array([0.0, 1.0, 0.8]))
    answer = solve(ramp, model=model, indenter=indenter)

    def elastic(loading):
        """On the half-space at unit shear modulus."""
        return Mdr().solve(Scene(layer=incompressible(np.inf, 1.0), indenter=indenter, loading=loading))

    speed, top = depth / time[1], elastic(IndentationDepths([depth]))
    if model is STANDARD:
        met = elastic(ContactRadii(indenter.radii[1:])).indentation_depth
        ends = np.concatenate([[0.0], met[met < depth], [depth]])
        x, weights = (1.0 + LEGENDRE[0]) / 2.0, LEGENDRE[1] / 2.0  # crowded towards the start of each piece
        depths = (ends[:-1, None] + np.diff(ends)[:, None] * x**4).ravel()
        shares = (np.diff(ends)[:, None] * 4.0 * x**3 * weights).ravel()
        expected = shares @ (
            relaxation(time[1] - depths / speed) * elastic(IndentationDepths(depths)).contact_stiffness
        )
    else:
        delayed = RELAXATION_TIME * speed * top.contact_stiffness[0] if model else 0.0
        expected = TOTAL * (top.normal_force[0] + delayed)
    error = float(answer.error_estimate["normal_force"][1])
    assert error < 1e-4
    assert answer.normal_force[1] == pytest.approx(expected, rel=error, abs=0.0)


def test_what_is_refused():
    with pytest.raises(InvalidInput, match="without adhesion nothing pulls"):
        solve(ForceHistory(time=[0.0, 1.0], force=[1.0, -1.0]))
    with pytest.raises(InvalidInput, match="never presses"):
        solve(DepthHistory(time=[0.0, 1.0], depth=[0.0, -1e-3]))
    compressible = Scene(
        layer=incompressible(1e-3, TOTAL).replace(poissons_ratio=0.45, youngs_modulus=2.9 * TOTAL),
        indenter=FlatPunch(radius=1e-3),
        loading=DepthHistory(time=[0.0, 1.0], depth=[0.0, 1e-3]),
        effects=(STANDARD,),
    )
    assert "incompressible layers only" in Mdr().supports(compressible).reason
    with pytest.raises(UnsupportedSceneError, match="poissons_ratio"):
        Mdr().solve(compressible)
