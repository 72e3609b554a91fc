"""Uncertain inputs: what is read, and the uncertainty of answers whose dependence is known in closed form."""

import numpy as np
import pytest

from cases.declare.uncertain_inputs import read_inputs
from cases.run.propagation import propagate
from contact import (
    Adhesion,
    Cone,
    ContactRadii,
    Detachment,
    DetachmentPath,
    IndentationDepths,
    InvalidInput,
    Layer,
    Paraboloid,
    Scene,
)

HALF_SPACE = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
SPHERE = Paraboloid(radius_of_curvature=0.01)
HERTZ = Scene(layer=HALF_SPACE, indenter=SPHERE, loading=ContactRadii([0.5e-3, 1e-3]))
AT_DEPTH = Scene(layer=HALF_SPACE, indenter=SPHERE, loading=IndentationDepths([1e-4]))


def relative(found, name):
    one = found.quantity(name)
    return one.inputs / np.abs(one.values)


def test_hertz_force_is_known_as_well_as_the_modulus():
    found = propagate(HERTZ, "youngs_modulus=2%")
    np.testing.assert_allclose(relative(found, "normal_force"), 0.02, rtol=1e-9)
    np.testing.assert_allclose(found.quantity("indentation_depth").inputs, 0.0, atol=1e-15)
    assert found.solved == 3
    assert not any(quantity.is_nonlinear for quantity in found.quantities)


def test_the_numerical_error_stands_beside_it():
    force = propagate(HERTZ, "youngs_modulus=2%").quantity("normal_force")
    assert force.numerical is not None
    assert np.all(force.numerical < 1e-6 * force.inputs)
    np.testing.assert_allclose(force.by_input["youngs_modulus"], force.inputs, rtol=1e-12)


def test_independent_inputs_add_in_squares_and_correlated_ones_as_they_are_correlated():
    """F = (4/3) E* R^(1/2) delta^(3/2): 2 % of E and half of 4 % of R."""
    text = "youngs_modulus=2%, radius_of_curvature=4%"
    alone = relative(propagate(AT_DEPTH, text), "normal_force")[0]
    together = relative(propagate(AT_DEPTH, f"{text}, youngs_modulus~radius_of_curvature=1"), "normal_force")[0]
    against = relative(propagate(AT_DEPTH, f"{text}, youngs_modulus~radius_of_curvature=-1"), "normal_force")[0]
    assert alone == pytest.approx(np.hypot(0.02, 0.02), rel=1e-3, abs=0.0)
    assert together == pytest.approx(0.04, rel=1e-3, abs=0.0)
    assert against < 1e-4


def test_samples_agree_with_differences():
    text = "youngs_modulus=2%, radius_of_curvature=4%, youngs_modulus~radius_of_curvature=0.5"
    by_differences = relative(propagate(AT_DEPTH, text), "normal_force")[0]
    sampled = propagate(AT_DEPTH, text, samples=400)
    # The deviation of 400 samples is known to 1/sqrt(800), 3.5 %; three of these.
    assert relative(sampled, "normal_force")[0] == pytest.approx(by_differences, rel=0.11, abs=0.0)
    assert sampled.solved == 401
    few, again = (relative(propagate(AT_DEPTH, text, samples=20), "normal_force")[0] for _ in range(2))
    assert few == again


@pytest.mark.slow
def test_a_range_is_uniform_and_its_middle_is_solved():
    """E* = E/(1 - nu^2): over nu from 0.28 to 0.32 its standard deviation is 2 nu/(1 - nu^2) 0.04/sqrt(12)."""
    found = propagate(HERTZ.replace(layer=HALF_SPACE.replace(poissons_ratio=0.2)), "poissons_ratio=0.28..0.32")
    assert found.scene.layer.poissons_ratio == pytest.approx(0.3, rel=1e-15, abs=0.0)
    expected = 0.6 / 0.91 * 0.04 / np.sqrt(12)
    sampled = propagate(HERTZ, "poissons_ratio=0.28..0.32", samples=400)
    assert relative(sampled, "normal_force")[0] == pytest.approx(expected, rel=0.11, abs=0.0)
    assert relative(found, "normal_force")[0] == pytest.approx(expected, rel=1e-3, abs=0.0)


def test_quantities_that_follow_one_input_move_together():
    found = propagate(HERTZ, "youngs_modulus=2%")
    names = [one.name for one in found.quantities]
    i, j = names.index("normal_force"), names.index("contact_stiffness")
    assert found.correlation[i, j] == pytest.approx(1.0, rel=1e-9, abs=0.0)
    assert found.correlation[i, names.index("indentation_depth")] == pytest.approx(0.0, abs=1e-6)


def test_a_range_up_to_the_incompressible_layer_and_a_thickness():
    layer = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.5)
    found = propagate(HERTZ.replace(layer=layer), "thickness=3%, poissons_ratio=0.48..0.5")
    shares = found.quantity("normal_force").by_input
    assert shares["thickness"][-1] < 0 < shares["poissons_ratio"][-1]


def test_nonlinear_quantities_are_marked():
    found = propagate(HERTZ.replace(indenter=Cone(slope=0.1)), "slope=60%")
    assert not found.quantity("normal_force").is_nonlinear
    assert propagate(AT_DEPTH, "values=60%").quantity("normal_force").is_nonlinear


def test_effects_and_detachments():
    scene = Scene(layer=HALF_SPACE, indenter=SPHERE, loading=Detachment(), effects=(Adhesion(work_of_adhesion=0.05),))
    found = propagate(scene, "work_of_adhesion=5%")
    assert relative(found, "pull_off_force")[0] == pytest.approx(0.05, rel=1e-6, abs=0.0)
    assert {one.name for one in found.quantities} == set(DetachmentPath.SCALARS)


@pytest.mark.parametrize(
    "text",
    ["", "thickness", "thickness=3", "thickness=-3%", "thickness=3%,thickness=1%", "poissons_ratio=0.5..0.4", "a=nan%",
     "thickness=inf%", "thickness=3%,thickness~slope=0.5", "a=1%,b=1%,a~b=2", "poissons_ratio=0.4..",
     "a=1%,b=1%,c=1%,a~b=1,b~c=1,a~c=-1"],
)  # fmt: skip
def test_what_is_no_input_is_refused_with_an_example(text):
    with pytest.raises(InvalidInput, match="uncertain"):
        read_inputs(text)


@pytest.mark.parametrize("text", ["thickness=3%", "wrong=3%", "values=1..2", "poissons_ratio=0.4..0.6"])
def test_what_the_scene_does_not_have_is_refused(text):
    with pytest.raises(InvalidInput):
        propagate(HERTZ, text)


def test_too_few_samples_are_refused():
    with pytest.raises(InvalidInput, match="samples = 3"):
        propagate(HERTZ, "youngs_modulus=2%", samples=3)


def test_the_command_prints_both_uncertainties_and_correlations(tmp_path, capsys):
    from reports.commands.solve import solve

    scene = tmp_path / "scene.toml"
    scene.write_text(
        '[layer]\nthickness = 1e-3\nyoungs_modulus = 1e6\npoissons_ratio = 0.49\nsupport = "bonded"\n'
        '[indenter]\nkind = "paraboloid"\nradius_of_curvature = 1e-2\n'
        '[loading]\nkind = "indentation_depths"\nvalues = [5e-5]\n'
    )
    solve(scene, uncertain="thickness=3%,poissons_ratio=0.48..0.5")
    printed = " ".join(capsys.readouterr().out.split())
    for words in ("numerical error", "by inputs", "thickness", "poissons_ratio", "Correlated", "4.6 %"):
        assert words in printed
    with pytest.raises(InvalidInput, match="--samples"):
        solve(scene, samples=20)
