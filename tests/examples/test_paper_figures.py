"""The data behind the paper's figures: against closed forms, published tables and the statements in the captions."""

from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest

from docs.gallery import (
    figure_03,
    figure_04,
    figure_05,
    figure_07,
    figure_08,
    figure_09,
    figure_11,
    figure_12,
)
from docs.gallery._parts import UNBONDED, layer, paper_figure, show

NUMBERS = (3, 4, 5, 7, 8, 9, 11, 12)
made = cache(paper_figure)


def series(number, group, method="mdr", panel=0):
    lines = [s for s in made(number).panels[panel].series if s.style == "by method"]
    (found,) = (s for s in lines if s.group == group and s.method.partition(",")[0] == method)
    return np.array(found.x), np.array(found.y)


@pytest.mark.parametrize("number", NUMBERS)
def test_every_figure_has_finite_labelled_curves_with_errors(number):
    figure = made(number)
    assert figure.name == f"fig_{number}"
    assert len(figure.caption) > 60
    for panel in figure.panels:
        assert panel.x_label
        assert panel.y_label
        for one in panel.series:
            assert len(one.x) == len(one.y) > 1
            assert np.all(np.isfinite(one.x))
            assert np.all(np.isfinite(one.y))
            name, _, error = one.method.partition(", error below ")
            assert name in {"mdr", "thin layer", "half-space", "closed form"}
            if name == "mdr":
                assert max(one.half_width) <= float(error) * max(map(abs, one.y))
                assert len(one.half_width) == len(one.y)
                assert max(one.half_width) < 1e-5 * max(map(abs, one.y))


def test_figure_3_tends_to_its_limits_and_passes_through_known_values():
    ratio, stiffness = series(3, "bonded nu=0.5")
    # Fredholm equation solved to 1e-12: 3.61873584896 at a/h = 1
    assert np.interp(0.0, np.log(ratio), np.log(stiffness)) == pytest.approx(np.log(3.61873584896), abs=2e-3)
    thin_ratio, thin = series(3, "unbonded", "thin layer")
    assert thin[-1] == pytest.approx(0.5 * np.pi * thin_ratio[-1], rel=1e-12, abs=0.0)
    assert series(3, "unbonded")[1][-1] == pytest.approx(thin[-1], rel=0.02, abs=0.0)


def test_figure_4_pressures_carry_the_same_force():
    for ratio in figure_04.RATIOS:
        rho, pressure = series(4, f"a/h={ratio:g}")
        theta = np.arcsin(rho)  # p sin(theta) cos(theta) is smooth up to the edge
        load = np.trapezoid(pressure * np.sin(theta) * np.cos(theta), theta)
        assert load == pytest.approx(0.5, abs=0.01)
    assert figure_04.second_maximum() == pytest.approx(0.788, abs=1e-3)  # REFERENCES section 5


def test_figure_5_exponents_are_bounded_as_the_paper_says():
    for one, limit in ((UNBONDED, 1.0), (layer(0.3), 1.0), (layer(0.5), 3.0)):
        m, _ = figure_05.exponent(one, figure_05.RATIOS)
        assert m.min() > 0.0
        assert m.max() < 1.06 * limit
    for one, expected in ((UNBONDED, 0.483722), (layer(0.3), 0.544110), (layer(0.5), 0.787580)):  # THEORY section 2
        assert figure_05.exponent(one, np.array([0.5, 1.0]))[0][1] == pytest.approx(expected, abs=1e-6)


def test_figure_7_profiles_and_pressures():
    assert figure_07.depth_over_height(layer(0.5), 1.0) == pytest.approx(0.556930 / 0.5, abs=1e-6)  # REFERENCES 4
    assert figure_07.depth_over_height(layer(0.5), 2.0) == pytest.approx(0.440614 / 0.5, abs=1e-6)
    assert figure_07.depth_over_height(layer(0.45), 2.0) == pytest.approx(0.502610 / 0.5, abs=1e-6)
    for panel in made(7).panels[1::2]:
        for one in panel.series:
            r, p = np.array(one.x), np.array(one.y)
            assert np.trapezoid(2.0 * p * r, r) == pytest.approx(1.0, abs=0.05)  # over its mean; a ring is left out


def test_figure_8_reversals():
    found = figure_08.reversals(layer(0.365))
    assert [kind for kind, _, _ in found] == ["snap-in", "pull-off"]
    refined = figure_08.reversals(layer(0.365), figure_08.SOURCE.refined())
    np.testing.assert_allclose([f[1] for f in found], [f[1] for f in refined], rtol=1e-7)
    assert not figure_08.reversals(layer(0.36))
    ratio, elongation = series(8, "bonded nu=0.5")
    assert ratio[elongation.argmax()] == pytest.approx(0.4619, abs=0.02)
    assert elongation.max() == pytest.approx(0.392203, abs=1e-4)


def test_figure_9_starts_on_the_line_of_the_half_space_and_peels_only_when_thin():
    for ratio in figure_09.RATIOS:
        lines = [s for s in made(9).panels[0].series if s.group == f"a*/h = {ratio:g}"]
        assert len(lines) == (2 if ratio > 0.461904 else 1)
        depth, force = np.array(lines[0].x), np.array(lines[0].y)
        assert force[0] == 0.0
        np.testing.assert_allclose(force[1:] / depth[1:], force[-1] / depth[-1], rtol=1e-10)  # Eq. (43)
    depth, force = series(9, "a*/h = 0.1")
    assert depth[-1] == pytest.approx(-1.0, abs=0.12)
    assert force[-1] == pytest.approx(-1.0, abs=0.12)


def test_figure_11_is_the_closed_form_on_the_half_space():
    for damping, expected in ((0.05, 0.858758), (0.1, 0.744079), (0.3, 0.450975)):  # REFERENCES section 7
        value = figure_11.restitution(layer(0.5), damping, np.array([1e-6]))[0]
        assert value == pytest.approx(expected, abs=2e-6)
    _, line = series(11, "any thickness", "closed form")
    assert np.all(np.diff(line) < 0.0)


def test_figure_12_values_and_loop():
    assert "0.45457" in made(12).caption
    for number in ("0.52344", "0.55924", "0.64341", "1.099", "2.241"):  # independent integration, REFERENCES section 7
        assert number in made(12).caption
    time, _ = series(12, figure_12.kind_name("elastic"), panel=3)
    thickness, usual = series(12, figure_12.kind_name(2.65), panel=5)
    _, other = series(12, figure_12.kind_name(0.1), panel=5)
    assert time.size == thickness.size == other.size
    assert np.all(np.diff(usual) < 0.0)
    assert np.all(np.diff(other) > 0.0)  # the opposite trend
    depth, force = series(12, "h = 1 mm")
    assert abs(depth[0]) + abs(force[0]) < 1e-14
    assert np.sum(0.5 * (force[1:] + force[:-1]) * np.diff(depth)) > 0.0  # the loop takes energy
    assert figure_12.scene_of(1e-3).layer.shear_modulus == pytest.approx(7.5e6 * 10.0 / 9.0, rel=1e-12, abs=0.0)


def test_captions_give_the_numbers_behind_loose_statements():
    assert "12.6 %" in made(3).caption
    assert "8.0 %" in made(3).caption
    assert "-10.9 %" in made(3).caption
    for drift in ("-0.3 % at a/h = 1,", "-0.9 % at a/h = 2,", "-5.9 % at a/h = 8."):
        assert drift in made(3).caption
    assert "0.881" in made(7).caption
    assert "1.005" in made(7).caption
    assert figure_03.thin_layer_stiffness(layer(0.3), np.array(1.0)) == pytest.approx(
        0.5 * np.pi * 0.49 / 0.4, rel=1e-12, abs=0.0
    )


def test_a_figure_is_drawn_with_every_panel_and_its_caption(capsys):
    show(made(3))
    drawn = plt.gcf()
    assert len(drawn.axes) == len(made(3).panels)
    assert len(drawn.axes[0].lines) == len(made(3).panels[0].series)
    assert "thin-layer limits" in capsys.readouterr().out
    plt.close(drawn)
