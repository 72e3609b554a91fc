"""The text of sealed files is, byte for byte, what the standard library writes with an indentation."""

import json

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cases.results.canonical import indented
from cases.results.sealed import digest_of, sealed_text

ATOMS = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False) | st.text()
TREES = st.recursive(
    ATOMS, lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4), max_leaves=20
)


def standard(tree):
    return json.dumps(tree, sort_keys=True, indent=1, allow_nan=False)


@settings(max_examples=200)
@given(TREES)
def test_any_tree_is_written_as_the_standard_library_does(tree):
    assert indented(tree) == standard(tree)


@given(st.dictionaries(st.text().filter(lambda name: name != "digest"), TREES, max_size=4), TREES)
def test_the_seal_is_that_of_the_same_text(content, tree):
    whole = {**content, "digest": digest_of(standard(content) + "\n")}
    assert sealed_text(content) == standard(whole) + "\n"
    covered = {"entry": tree, "digest": digest_of(standard(tree) + "\n")}
    assert sealed_text({"entry": tree}, covered="entry") == standard(covered) + "\n"


@pytest.mark.parametrize("tree", [(1, (2.5, "ä\n")), {1: [2], 0: None}, {None: [1]}, {"\n ": ["\n "]}, [[], {}, ()]])
def test_rare_values_are_written_as_the_standard_library_does(tree):
    assert indented(tree) == standard(tree)


@pytest.mark.parametrize("tree", [float("nan"), [float("inf")], {"a": [1, [-float("inf")]]}, [[1], float("nan")]])
def test_numbers_that_are_not_finite_are_refused(tree):
    with pytest.raises(ValueError, match="JSON compliant"):
        indented(tree)


@pytest.mark.parametrize("tree", [{1}, [object()], [[1], b"2"], {"a": {(1, 2): [3]}}])
def test_what_json_has_not_is_refused(tree):
    with pytest.raises(TypeError):
        indented(tree)
