"""Displacements beside contacts: alone as in a list, and as the direct integral equation has them."""

import numpy as np
import pytest

from bem.polynomials.mapped import MappedFunction, MappedGrid
from cases.declare.methods import build
from cases.measurements.campaigns.displacements import displacement_campaign
from cases.results.status import Status
from mdr.springs import surface_fields

# Of the scenes with seed 1: layers, a stack, and a graded layer.
LAYERS, GRADED = (0, 1, 4), 5


def beyond(rows):
    assert all(row.status is not Status.FAIL for row in rows)
    return {row.quantity for row in rows if row.quantity and row.error > row.stated + row.uncertainty}


def test_displacements_keep_their_stated_errors():
    assert beyond(displacement_campaign(build("mdr", {}), seed=1, count=7, numbers=(*LAYERS, GRADED))) == set()
    direct = build("integral_equation", {})
    assert beyond(displacement_campaign(direct, seed=1, count=7, numbers=LAYERS)) == set()


def test_a_shell_that_ends_a_rounding_before_the_radius_is_seen(monkeypatch):
    """The planted fault is what once was: 1e-9 of the depth were lost beside graded layers."""

    def ending_at(density, reach):
        first = density.first_shell
        shells = int(np.ceil(np.log2(max(reach / first, 1.0)))) + 1
        grid = MappedGrid.between(first * np.concatenate([[0.0], 2.0 ** np.arange(shells)]), surface_fields.NODES)
        return MappedFunction(grid, density.outside(grid.nodes), 0.0)

    monkeypatch.setattr(surface_fields, "_remainder", ending_at)
    rows = displacement_campaign(build("mdr", {}), seed=1, count=7, numbers=(GRADED,))
    assert "displacement alone" in beyond(rows)


@pytest.mark.slow
def test_displacements_on_many_bodies_keep_their_stated_errors():
    rows = displacement_campaign(build("mdr", {}), seed=2, count=60)
    assert beyond(rows) == set()
    assert sum(row.quantity == "displacement" for row in rows) > 50


@pytest.mark.slow
@pytest.mark.parametrize("method", ["bem", "fem"])
def test_displacements_of_meshes_and_grids_keep_what_is_stated_of_their_contacts(method):
    rows = displacement_campaign(build(method, {}), seed=1, count=3)
    assert beyond(rows) == set()
    assert sum(row.quantity == "displacement" for row in rows) == 3
