import dataclasses
import json
import math

import jsonschema
import numpy as np
import pytest

from cases.results.files import from_json, json_schema, read_run, to_json, write_run
from cases.results.records.run import RunResult
from cases.results.strict_json import json_text
from contact import InvalidInput
from contact.files.storage import read_tree
from tests.cases.example_run import SCENE, example_run


def test_json_returns_the_same_run_bit_for_bit():
    run = example_run()
    assert from_json(to_json(run)) == run
    assert to_json(from_json(to_json(run))) == to_json(run)


def test_seventeen_digits_survive():
    awkward = (0.1 + 0.2, 1 / 3, math.nextafter(1.0, 2.0), 5e-324, 1.7976931348623157e308, -0.0)
    run = with_force_values(awkward)
    values = from_json(to_json(run)).cases[0].runs[0].quantity("normal_force").values
    assert [v.hex() for v in values] == [v.hex() for v in awkward]


def with_force_values(values) -> RunResult:
    run = example_run()
    case = run.cases[0]
    solved = case.runs[0]
    force = dataclasses.replace(solved.quantity("normal_force"), values=values, uncertainty=())
    solved = dataclasses.replace(solved, quantities=(force,))
    return dataclasses.replace(run, cases=(dataclasses.replace(case, runs=(solved,)),))


@pytest.mark.parametrize("word", ["NaN", "Infinity", "-Infinity"])
def test_a_non_finite_number_in_a_file_is_refused(word):
    text = to_json(example_run()).replace("1.02", word)
    assert word in text
    with pytest.raises(InvalidInput, match="non-finite"):
        from_json(text)


def rewritten(change):
    tree = json.loads(to_json(example_run()))
    change(tree)
    return json_text(tree)


def test_another_schema_version_is_refused_by_number():
    with pytest.raises(InvalidInput, match="99"):
        from_json(rewritten(lambda tree: tree.update(schema_version=99)))


def test_a_torn_file_is_refused():
    with pytest.raises(InvalidInput, match="not readable"):
        from_json(to_json(example_run())[:5000])


def test_an_unknown_field_is_refused_with_its_path():
    with pytest.raises(InvalidInput, match=r"cases\.0\.claims\.0\.colour"):
        from_json(rewritten(lambda tree: tree["cases"][0]["claims"][0].update(colour="red")))


def test_the_published_schema_describes_the_file():
    tree = json.loads(to_json(example_run()))
    assert jsonschema.Draft202012Validator(json_schema()).is_valid(tree)
    del tree["stamp"]
    assert not jsonschema.Draft202012Validator(json_schema()).is_valid(tree)


def test_directory_round_trip(tmp_path):
    run = example_run()
    write_run(run, tmp_path)
    assert read_run(tmp_path) == run
    assert sorted(p.name for p in tmp_path.iterdir()) == ["results.h5", "results.json"]


def test_arrays_are_stored_without_loss(tmp_path):
    run = example_run()
    write_run(run, tmp_path)
    tree = read_tree(tmp_path / "results.h5")
    stored = tree["example_cone"][SCENE.replace("/", " over ")]["fem"]
    fem = run.cases[0].runs[1]
    np.testing.assert_array_equal(stored["normal_force"]["values"], fem.quantity("normal_force").values)
    np.testing.assert_array_equal(stored["pressure curve"]["pressure"], fem.curve("pressure").y)


def test_a_missing_directory_is_one_clear_error(tmp_path):
    with pytest.raises(InvalidInput, match=r"no results\.json"):
        read_run(tmp_path / "nowhere")
