"""The package loads its parts on demand."""

import subprocess
import sys

import pytest

import bem


def loaded_after(statement):
    code = f"{statement}; import sys; print('bem.grid.transforms' in sys.modules, 'mdr' in sys.modules)"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout.split()


def test_the_integral_equation_loads_neither_fft_nor_mdr():
    assert loaded_after("from bem import IntegralEquation, IntegralEquationMethod") == ["False", "False"]


@pytest.mark.parametrize("name", bem.__all__)
def test_every_listed_name_exists(name):
    assert getattr(bem, name).__name__ == name


def test_an_unknown_name_says_what_there_is():
    with pytest.raises(AttributeError, match="IntegralEquation"):
        bem.Nonsense  # noqa: B018 - the access is the test
