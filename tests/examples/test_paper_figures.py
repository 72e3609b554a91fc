"""The data behind the paper's figures: against closed forms, published tables and the statements in the captions."""

from functools import cache

import matplotlib.pyplot as plt
import numpy as np
import pytest

from docs.gallery import figure_03
from docs.gallery._parts import layer, paper_figure, show

NUMBERS = (3, 4, 7, 9, 11, *(pytest.param(number, marks=pytest.mark.slow) for number in (5, 8, 12)))
made = cache(paper_figure)


@pytest.mark.first(1)
@pytest.mark.parametrize("number", NUMBERS)
def test_every_figure_has_finite_labelled_curves_with_errors(number):
    figure = made(number)
    assert figure.name == f"fig_{number}"
    assert len(figure.caption) > 60
    for panel in figure.panels:
        assert panel.x_label
        assert panel.y_label
        for one in panel.series:
            assert len(one.x) == len(one.y) > (0 if one.style == "symbols" else 1)
            assert np.all(np.isfinite(one.x))
            assert np.all(np.isfinite(one.y))
            name, _, error = one.method.partition(", error below ")
            assert name in {"mdr", "fem", "thin layer", "half-space", "closed form"}
            if name == "mdr":
                assert max(one.half_width) <= float(error) * max(map(abs, one.y))
                assert len(one.half_width) == len(one.y)
                assert max(one.half_width) < 1e-5 * max(map(abs, one.y))


@pytest.mark.first(1)
@pytest.mark.parametrize("number", [*(n for n in NUMBERS if isinstance(n, int) and n != 4), *NUMBERS[-3:]])
def test_symbols_of_finite_elements_lie_on_the_lines(number):
    shown = [(panel, one) for panel in made(number).panels for one in panel.series if one.style == "symbols"]
    assert shown
    for panel, one in shown:
        lines = [line for line in panel.series if line.style != "symbols" and len(line.x) > 5]
        for x, y in zip(one.x, one.y, strict=True):
            near = [np.interp(x, *sorted_by_x(line)) for line in lines if min(line.x) <= x <= max(line.x)]
            assert min(abs(value - y) for value in near) < 0.03 * max(map(abs, one.y)), (panel.title, one.label, x)


def sorted_by_x(line):
    order = np.argsort(line.x)
    return np.array(line.x)[order], np.array(line.y)[order]


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
    assert len(drawn.axes[0].get_legend().get_texts()) == 6  # one entry per layer
    assert len(drawn.axes[0].lines) == len(made(3).panels[0].series)
    assert "thin-layer limits" in capsys.readouterr().out
    plt.close(drawn)
