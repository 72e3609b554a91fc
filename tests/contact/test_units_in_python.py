"""Numbers with units are read wherever records are made, not in files alone."""

from contact import IndentationDepths, Layer


def test_a_record_takes_texts_with_units():
    layer = Layer(thickness="1 mm", youngs_modulus="2 kPa", poissons_ratio=0.3)
    assert layer == Layer(thickness=1e-3, youngs_modulus=2e3, poissons_ratio=0.3)
    assert IndentationDepths(["1 um", "2 um"]) == IndentationDepths([1e-6, 2e-6])
