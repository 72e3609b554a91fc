"""Fits whose tip or layer is known to a tolerance: the interval is as wide as that makes it, and covers."""

import numpy as np
import pytest

from cases.uncertain_fit import fit_uncertain
from contact import IndentationDepths, InvalidInput, Layer, Paraboloid, Scene
from mdr.curves import ForceCurve
from reports.command_line import run

R = 1e-5
HALF_SPACE = Layer(thickness=np.inf, youngs_modulus=1e3, poissons_ratio=0.5)
GEL = Layer(thickness=5e-6, youngs_modulus=1e3, poissons_ratio=0.5)
DEPTH = np.linspace(-0.2e-6, 1.5e-6, 80)


def scene(layer=GEL, radius=R):
    return Scene(layer=layer, indenter=Paraboloid(radius_of_curvature=radius), loading=IndentationDepths([3e-6]))


def test_on_a_half_space_the_radius_counts_half():
    """F = 4/3 E*/... sqrt(R) d^1.5: six per cent of R are three of E, in quadrature with the scatter."""
    force = 5 * ForceCurve(scene(HALF_SPACE))(DEPTH)
    force = force + 1e-3 * force.max() * np.random.default_rng(1).standard_normal(force.size)
    found = fit_uncertain(scene(HALF_SPACE), DEPTH, force, "radius_of_curvature=6%")
    fit = found.fit
    assert found.changes["youngs_modulus"]["radius_of_curvature"] == pytest.approx(
        -0.03 * fit.youngs_modulus, rel=5e-3, abs=0.0
    )
    low, high = fit.interval("youngs_modulus")
    both = np.hypot(fit.standard_error["youngs_modulus"], 0.03 * fit.youngs_modulus)
    assert (high - low) / 2 == pytest.approx(fit.quantile * both, rel=5e-3, abs=0.0)


def test_two_inputs_that_vary_together_add_up_or_cancel():
    force = 5 * ForceCurve(scene())(DEPTH)
    text = "radius_of_curvature=5%, thickness=5%"
    apart, with_, against = (
        fit_uncertain(scene(), DEPTH, force, text + more).fit.input_error["youngs_modulus"]
        for more in ("", ", radius_of_curvature~thickness=1", ", radius_of_curvature~thickness=-1")
    )
    parts = fit_uncertain(scene(), DEPTH, force, text).changes["youngs_modulus"]
    radius, thickness = parts["radius_of_curvature"], parts["thickness"]
    assert radius < 0.0 < thickness
    assert apart == pytest.approx(np.hypot(radius, thickness), rel=1e-9, abs=0.0)
    assert with_ == pytest.approx(abs(radius + thickness), rel=1e-9, abs=0.0)
    assert against == pytest.approx(thickness - radius, rel=1e-9, abs=0.0)


@pytest.mark.slow
def test_intervals_cover_the_modulus_behind_curves_of_unknown_tips():
    """True radius and thickness are drawn; the fit knows the nominal ones. 200 curves, seed 2126."""
    draw, inside = np.random.default_rng(2126), []
    for _ in range(200):
        radius, thickness = (1 + 0.05 * draw.standard_normal(2)) * (R, 5e-6)
        true = ForceCurve(scene(GEL.replace(thickness=thickness), radius))
        force = true(DEPTH, 5e3)
        force = force + 5e-3 * force.max() * draw.standard_normal(force.size)
        found = fit_uncertain(scene(), DEPTH, force, "radius_of_curvature=5%, thickness=5%")
        low, high = found.fit.interval("youngs_modulus")
        inside.append(low <= 5e3 <= high)
    assert 0.91 <= np.mean(inside) <= 0.99


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("youngs_modulus=3%", "the fit finds it"),
        ("layer.youngs_modulus=3%", "the fit finds it"),
        ("colour=3%", "colour"),
        ("thickness", "percentage|write"),
    ],
)
def test_what_is_no_uncertain_input_of_a_fit_is_refused(text, message):
    force = ForceCurve(scene())(DEPTH)
    with pytest.raises(InvalidInput, match=message):
        fit_uncertain(scene(), DEPTH, force, text)


def test_the_command_prints_what_each_input_does(tmp_path, capsys):
    (tmp_path / "gel.toml").write_text(
        "layer = {thickness = 5e-6, youngs_modulus = 1e3, poissons_ratio = 0.5}\n"
        'indenter = {kind = "paraboloid", radius_of_curvature = 1e-5}\n'
        'loading = {kind = "indentation_depths", values = [1e-6]}\n'
    )
    force = ForceCurve(scene())(DEPTH)
    lines = [f"{d!r},{f!r}" for d, f in zip(DEPTH.tolist(), force.tolist(), strict=True)]
    (tmp_path / "curve.csv").write_text("depth [m],force [N]\n" + "\n".join(lines) + "\n")
    files = [str(tmp_path / "curve.csv"), str(tmp_path / "gel.toml")]
    assert run(["fit", *files, "--uncertain", "radius_of_curvature=5%"]) == 0
    assert "radius_of_curvature (5 %)" in " ".join(capsys.readouterr().out.split())
    assert run(["fit", *files, "--map", "--uncertain", "radius_of_curvature=5%"]) != 0
    assert "single curves" in " ".join(capsys.readouterr().err.split())
