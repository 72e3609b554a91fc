"""Numbers with units are read wherever records are made, not in files alone."""

import pytest

from contact import IndentationDepths, InvalidInput, Layer


def test_a_record_takes_texts_with_units():
    layer = Layer(thickness="1 mm", youngs_modulus="2 kPa", poissons_ratio=0.3)
    assert layer == Layer(thickness=1e-3, youngs_modulus=2e3, poissons_ratio=0.3)
    assert IndentationDepths(["1 um", "2 um"]) == IndentationDepths([1e-6, 2e-6])


def test_a_unit_of_another_kind_is_refused():
    with pytest.raises(InvalidInput, match=r"Layer\.thickness = '1 kPa': must be a length; write a number in m"):
        Layer(thickness="1 kPa", youngs_modulus=1e6, poissons_ratio=0.3)
