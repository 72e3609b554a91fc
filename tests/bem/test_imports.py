"""The package loads its parts on demand."""

import pytest

import bem


@pytest.mark.parametrize("name", bem.__all__)
def test_every_listed_name_exists(name):
    assert getattr(bem, name).__name__ == name


def test_an_unknown_name_says_what_there_is():
    with pytest.raises(AttributeError, match="IntegralEquation"):
        bem.Nonsense  # noqa: B018 - the access is the test
