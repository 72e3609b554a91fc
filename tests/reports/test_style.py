"""Figures on a page: places are rounded, words are not."""

from xml.etree import ElementTree

import numpy as np
from matplotlib.figure import Figure

from reports.style import figure_style, svg_text


def test_a_label_keeps_its_digits():
    with figure_style():
        drawn = Figure()
        drawn.subplots().set_title("nu=0.4999999")
        text = svg_text(drawn, key="k")
    assert ">nu=0.4999999<" in text


def test_a_bar_of_colours_with_a_pointed_end_stays_well_formed():
    with figure_style():
        drawn = Figure()
        axes = drawn.subplots()
        drawn.colorbar(axes.pcolormesh(np.eye(2), rasterized=True), extend="max")
        text = svg_text(drawn, key="k")
    assert ElementTree.fromstring(text).tag.endswith("svg")
