"""Rows of a table that were solved once are not solved again, and do not depend on what was asked first."""

import dataclasses

import numpy as np
import pytest

from bem.grid.calibrated_disc import PixelDisc
from bem.tables import from_grid, grid_rows
from bem.tables.from_grid import FftTable
from contact import Layer

LAYER = Layer(thickness=1e-3, youngs_modulus=1e6, poissons_ratio=0.3)
SETTINGS = FftTable(cells=64, ratios=40, radii=60)


@pytest.fixture
def solved(monkeypatch):
    """Cells of every disc that is solved, from empty memories."""
    cells, right = [], PixelDisc.on_layer

    def counted(disc, *arguments, **others):
        cells.append(disc.cells)
        return right(disc, *arguments, **others)

    monkeypatch.setattr(PixelDisc, "on_layer", counted)
    forget()
    yield cells
    forget()


def forget():
    from_grid._build.cache_clear()
    grid_rows.grid_rows.cache_clear()


def test_a_longer_table_continues_the_shorter_one_bit_by_bit(solved):
    tables = []
    for ratios in ((300.0,), (0.5, 4.0, 300.0), (300.0, 4.0)):
        forget()
        tables.append([SETTINGS.solution(LAYER, ratio) for ratio in ratios])
    whole, grown, cut = tables
    assert solved.count(64) == 3 * len(whole[0].ratios)
    pairs = ((grown[2], whole[0]), (cut[1], grown[1]))
    for one, other in pairs:
        for name in ("ratios", "stiffness", "pressure", "error", "pressure_error", "mean_error"):
            np.testing.assert_array_equal(getattr(one, name), getattr(other, name), err_msg=name)


def test_the_halved_grid_of_finer_tables_is_the_coarser_one(solved):
    SETTINGS.solution(LAYER, 4.0)
    before = len(solved)
    SETTINGS.refined().solution(LAYER, 4.0)
    assert set(solved[before:]) == {128}
    SETTINGS.solution(dataclasses.replace(LAYER, poissons_ratio=0.4), 4.0)
    assert len(solved) == 2 * before + before // 3
