"""Answers draw themselves, become tables, and show themselves in a notebook."""

import pydoc
import re
from importlib import import_module
from xml.etree import ElementTree

import numpy as np
import pytest

from contact import (
    Adhesion,
    ContactPath,
    Detachment,
    DetachmentPath,
    ForceHistory,
    HistoryPath,
    Impact,
    ImpactHistory,
    IndentationDepths,
    Layer,
    Paraboloid,
    PronySeries,
    Scene,
)
from mdr import Mdr

LAYER = Layer(thickness=1e-3, youngs_modulus=9e4, poissons_ratio=0.5)
BALL = Paraboloid(radius_of_curvature=2e-3)
RELAXING = (PronySeries(long_term_shear_modulus=2e4, shear_moduli=[1e4], relaxation_times=[1.0]),)
SCENES = {
    ContactPath: Scene(layer=LAYER, indenter=BALL, loading=IndentationDepths(np.linspace(1e-6, 2e-5, 8))),
    DetachmentPath: Scene(
        layer=LAYER, indenter=BALL, loading=Detachment(control="force"), effects=(Adhesion(work_of_adhesion=0.05),)
    ),
    HistoryPath: Scene(
        layer=LAYER, indenter=BALL, loading=ForceHistory(time=[0, 1, 2], force=[0, 1e-3, 1e-3]), effects=RELAXING
    ),
    ImpactHistory: Scene(layer=LAYER, indenter=BALL, loading=Impact(mass=1e-4, velocity=0.01)),
}
ANSWERS = {kind: Mdr().solve(scene) for kind, scene in SCENES.items()}
each_answer = pytest.mark.parametrize("answer", ANSWERS.values(), ids=lambda answer: type(answer).__name__)


@pytest.fixture(autouse=True)
def _no_windows():
    plt = pytest.importorskip("matplotlib.pyplot")
    plt.switch_backend("agg")
    yield
    plt.close("all")


@each_answer
def test_an_answer_draws_its_force_with_units_error_and_legend(answer):
    axes = answer.plot("normal_force")
    labels = axes.get_legend_handles_labels()[1]
    assert re.search(r" F \[.?N\]$", axes.get_ylabel())
    assert re.search(r" (δ|t) \[.?[ms]\]$", axes.get_xlabel())
    assert any(label.startswith("MDR") for label in labels)
    assert any(re.fullmatch("stated error, at most .* N", label) for label in labels) == (
        "normal_force" in answer.error_estimate
    )
    points = axes.lines[0].get_xydata()
    assert np.nanmax(points[:, 1]) * answer.normal_force.max() > 0


def test_values_on_the_axes_are_those_of_the_answer_in_the_unit_of_the_label():
    answer = ANSWERS[ContactPath]
    axes = answer.plot("contact_radius", "normal_force")
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("normal force F [µN]", "contact radius a [µm]")
    x, y = axes.lines[0].get_data()
    np.testing.assert_allclose(x, 1e6 * answer.normal_force)
    np.testing.assert_allclose(y, 1e6 * answer.contact_radius)


def test_where_the_force_is_prescribed_the_depth_is_drawn():
    assert ANSWERS[HistoryPath].plot().get_ylabel() == "indentation depth δ [µm]"


def test_a_second_answer_is_drawn_on_the_axes_of_the_first_and_a_wrong_array_is_named():
    axes = ANSWERS[ContactPath].plot()
    assert ANSWERS[ContactPath].plot(axes=axes) is axes
    assert len(axes.lines) == 2
    with pytest.raises(ValueError, match="has no array 'force'; it has contact_radius, "):
        ANSWERS[ContactPath].plot("force")


def test_a_detachment_shows_what_is_stable_and_where_contact_is_lost():
    answer = ANSWERS[DetachmentPath]
    axes = answer.plot()
    assert "MDR, stable under force control" in axes.get_legend_handles_labels()[1]
    loss = axes.lines[-1].get_xydata()[0]
    np.testing.assert_allclose(loss, [1e6 * answer.pull_off_depth, 1e6 * answer.force_at_loss])
    drawn = ~np.isnan(axes.lines[0].get_ydata())
    np.testing.assert_array_equal(drawn, answer.stable_force_control)


@each_answer
def test_html_has_every_quantity_with_its_unit_and_the_curve(answer):
    tree = ElementTree.fromstring(re.sub("<br>", "<br/>", answer._repr_html_()))
    rows = [[cell.text for cell in row.iter("td")] for row in tree.iter("tr")][1:]
    assert [row[0] for row in rows] == [name.replace("_", " ") for name in (*answer.ARRAYS, *answer.SCALARS)]
    assert all(re.search(r" (m|N|s|J|m/s|N/m)$", row[1]) for row in rows)
    assert len(list(tree.iter("{http://www.w3.org/2000/svg}svg"))) == 1


@each_answer
def test_tables_have_the_arrays_their_errors_and_units(answer):
    pytest.importorskip("pandas")
    frame = answer.to_dataframe()
    assert list(frame["normal_force"]) == answer.normal_force.tolist()
    assert frame.attrs["units"]["normal_force"] == "N"
    if "normal_force" in answer.error_estimate:
        assert list(frame["normal_force_uncertainty"]) == answer.uncertainty("normal_force").tolist()


@each_answer
def test_labelled_arrays_have_units(answer):
    pytest.importorskip("xarray")
    arrays = answer.to_xarray()
    assert arrays["normal_force"].dims == ("step",)
    assert arrays["normal_force"].attrs == {"units": "N"}
    assert all(float(arrays[name]) == getattr(answer, name) for name in answer.SCALARS)


def without(monkeypatch, missing):
    def refuse(name):
        if name.partition(".")[0] == {"matplotlib": "reports"}.get(missing, missing):
            raise ModuleNotFoundError(f"No module named {missing!r}", name=missing)
        return import_module(name)

    monkeypatch.setattr("contact.answer.solution.import_module", refuse)


@pytest.mark.parametrize(
    ("missing", "verb", "extra"),
    [("matplotlib", "plot", "report"), ("pandas", "to_dataframe", "tables"), ("xarray", "to_xarray", "tables")],
)
def test_a_missing_package_is_one_clear_error(monkeypatch, missing, verb, extra):
    without(monkeypatch, missing)
    with pytest.raises(ImportError) as error:
        getattr(ANSWERS[ContactPath], verb)()
    assert str(error.value) == f"{missing} is not installed: pip install 'contact-verification[{extra}]'"


def test_html_without_matplotlib_is_the_table_alone(monkeypatch):
    without(monkeypatch, "matplotlib")
    html = ANSWERS[ContactPath]._repr_html_()
    assert "<svg" not in html
    assert "<table>" in html


@pytest.mark.parametrize(
    ("shown", "line"),
    [
        (ContactPath, "normal_force: Normal force F_N [N], shape (n,)."),
        (DetachmentPath, "pull_off_depth: Depth delta [m] where contact is lost"),
        (HistoryPath, "time: Time t [s], shape (n,)."),
        (ImpactHistory, "peak_force: Largest force max F_N [N]"),
        (Layer, "youngs_modulus: Young's modulus E [Pa]"),
    ],
)
def test_help_shows_fields_with_units(shown, line):
    assert line in pydoc.plain(pydoc.render_doc(shown))


def test_a_small_path_of_one_state_has_no_curve():
    one = Mdr().solve(SCENES[ContactPath].replace(loading=IndentationDepths([1e-5])))
    assert "<svg" not in one._repr_html_()
