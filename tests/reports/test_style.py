"""Figures on a page: places are rounded, words are not."""

from matplotlib.figure import Figure

from reports.figures.style import figure_style, svg_text


def test_a_label_keeps_its_digits():
    with figure_style():
        drawn = Figure()
        drawn.subplots().set_title("nu=0.4999999")
        text = svg_text(drawn, key="k")
    assert ">nu=0.4999999<" in text
