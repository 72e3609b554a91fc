"""Flat-punch tables in HDF5 files: our own with provenance and hash, and others in a plain layout of four arrays.

The plain layout is `ratios` (a/h), `radii` (r/a), `k_bar` and `p_bar`, the last with one row for each ratio. It is our
own: the files of the supplement to Forsbach (2023), https://www.mdpi.com/article/10.3390/machines11040474/s1, were not
seen and may need to be rewritten so. Our own files hold the same four, the stated errors, the kernel, with all
sublayers of a stack, and where the numbers come from.
"""

from __future__ import annotations

import hashlib
import json
from dataclasses import replace
from functools import lru_cache
from importlib.metadata import version
from pathlib import Path
from typing import Any, Final, Self

import numpy as np
from scipy.integrate import simpson

from bem.grid.influence import kernel_of, point_response
from bem.tables.table import FlatPunchTable
from bem.tables.tabulated_layer import Tabulable, described, same_kernel, tabulable
from contact import ElasticLayer, InvalidInput, Layer, LayerStack
from contact.files.scene_file import layer_of, table_of
from contact.files.storage import read_tree, write_tree
from contact.records.record import Record, record
from contact.records.validation import FloatArray
from contact.scene.layer import Support

SCHEMA: Final = "contact-verification/flat-punch-table/3"
# A foreign table that misses a limit by more, relative, is refused: it is of another kernel or normalisation.
LIMIT_TOLERANCE: Final = 0.05
ERRORS: Final = ("error", "pressure_error", "mean_error")
NUMERICAL_LIBRARIES: Final = ("numpy", "scipy")


def write_table(path: str | Path, table: FlatPunchTable) -> None:
    """Write a table with its provenance, the versions of the numerical libraries and a hash of its arrays."""
    write_tree(
        path,
        {
            "schema": SCHEMA,
            "support": table.support,
            "poissons_ratio": table.poissons_ratio,
            "sha256": _digest(table),
            "provenance": table.provenance | {f"{name} version": version(name) for name in NUMERICAL_LIBRARIES},
            **({"stack": json.dumps(table_of(table.stack))} if table.stack else {}),
            **_arrays(table),
        },
    )


def read_table(path: str | Path) -> FlatPunchTable:
    """Read a table that `write_table` wrote.

    Raises:
        InvalidInput: If the file is no such table or its arrays do not match its hash.
    """
    tree = read_tree(path)
    if tree.get("schema") != SCHEMA:
        raise InvalidInput(f"{path}: schema {tree.get('schema')!r}; this version reads {SCHEMA!r}")
    kernel = {name: tree[name] for name in ("support", "poissons_ratio", "provenance", *ERRORS)}
    table = _table(path, tree, stack=_stack(tree), **kernel)
    if _digest(table) != tree["sha256"]:
        raise InvalidInput(
            f"{path}: the arrays do not match the stored hash {tree['sha256'][:12]}; the file is damaged"
        )
    return table


def read_foreign_table(
    path: str | Path, *, support: Support, poissons_ratio: float, relative_error: float | None = None
) -> FlatPunchTable:
    """Read and validate a table in the plain layout of four arrays.

    Checked: shapes, order and signs; int_0^1 p_bar rho d(rho) = 1/2; the half-space and thin-layer limits of k_bar;
    that k_bar grows with a/h.

    Args:
        path: HDF5 file with arrays `ratios`, `radii`, `k_bar` and `p_bar`. A last radius of 1 is left out, because
            p_bar is singular there.
        support: The kernel that the table claims to be of.
        poissons_ratio: nu of that kernel.
        relative_error: The table's error if its source states one; otherwise the largest defect found here.

    Raises:
        InvalidInput: Naming the check that failed, its value and what was expected.
    """
    tree = read_tree(path)
    origin: dict[str, str | int | float] = {"file": Path(path).name, "method": "as supplied"}
    table = _table(path, tree, support=support, poissons_ratio=poissons_ratio, provenance=origin)
    defect = max(_check_normalisation(path, table), _check_limits(path, table))
    falling = np.flatnonzero(np.diff(table.stiffness) <= 0.0)
    if falling.size:
        place = table.ratios[falling[0]]
        raise InvalidInput(f"{path}: k_bar must grow with a/h, but falls after a/h = {place:g}")
    error = defect if relative_error is None else relative_error
    everywhere = np.full(table.pressure.shape, error)
    return replace(table, error=everywhere[:, 0], pressure_error=everywhere[:, 0], mean_error=everywhere)


@record
class TableFile(Record):
    """A stored table as a `FlatPunchSource`.

    Attributes:
        path: HDF5 file, ours or in the plain layout.
        support: For a file in the plain layout: its kernel.
        poissons_ratio: For a file in the plain layout: nu of its kernel.
    """

    path: str
    support: Support | None = None
    poissons_ratio: float | None = None

    def solution(self, layer: ElasticLayer, max_ratio: float) -> FlatPunchTable:
        """The stored table.

        Raises:
            InvalidInput: If it is of another kernel, or ends below `max_ratio`.
            UnsupportedSceneError: If the layer is graded.
        """
        asked, table = tabulable(layer), _stored(self)
        own = table.stack or _plain(table.support, table.poissons_ratio)
        if not same_kernel(own, asked):
            raise InvalidInput(
                f"{self.path} is for {described(own)}, not for {described(asked)}; build one with FftTable"
            )
        # Asking for the error refuses a ratio beyond the table.
        table.relative_error(max_ratio)
        return table

    def refined(self) -> Self:
        """There is no finer file.

        Raises:
            InvalidInput: Always.
        """
        raise InvalidInput(f"{self.path} cannot be refined; build a table with FftTable instead")


def _plain(support: Support, poissons_ratio: float) -> Tabulable:
    """One layer with this kernel."""
    return tabulable(Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio, support=support))


@lru_cache(maxsize=8)
def _stored(file: TableFile) -> FlatPunchTable:
    if file.support is None or file.poissons_ratio is None:
        return read_table(file.path)
    return read_foreign_table(file.path, support=file.support, poissons_ratio=file.poissons_ratio)


def _stack(tree: dict[str, Any]) -> LayerStack | None:
    """The stack of a stored table, None of one layer."""
    layer = layer_of(json.loads(tree["stack"])) if "stack" in tree else None
    return layer if isinstance(layer, LayerStack) else None


def _arrays(table: FlatPunchTable) -> dict[str, FloatArray]:
    return {
        "ratios": table.ratios,
        "radii": table.radii,
        "k_bar": table.stiffness,
        "p_bar": table.pressure,
        **{name: getattr(table, name) for name in ERRORS},
    }


def _digest(table: FlatPunchTable) -> str:
    stack = json.dumps(table_of(table.stack)) if table.stack else ""
    header = f"{table.support} {table.poissons_ratio!r}{stack}".encode()
    return hashlib.sha256(header + b"".join(a.astype("<f8").tobytes() for a in _arrays(table).values())).hexdigest()


def _table(
    path: str | Path,
    tree: dict[str, Any],
    *,
    support: Support,
    poissons_ratio: float,
    provenance: dict[str, str | int | float],
    stack: LayerStack | None = None,
    **errors: FloatArray,
) -> FlatPunchTable:
    missing = [name for name in ("ratios", "radii", "k_bar", "p_bar") if name not in tree]
    if missing:
        raise InvalidInput(f"{path}: a flat-punch table needs ratios, radii, k_bar and p_bar; {missing[0]} is missing")
    ratios, radii, stiffness = (np.ravel(tree[name]).astype(np.float64) for name in ("ratios", "radii", "k_bar"))
    pressure = np.asarray(tree["p_bar"], dtype=np.float64)
    if radii[-1] == 1.0:
        radii, pressure = radii[:-1], pressure[:, :-1]
    return FlatPunchTable(
        support=support,
        poissons_ratio=poissons_ratio,
        ratios=ratios,
        radii=radii,
        stiffness=stiffness,
        pressure=pressure,
        provenance=provenance,
        error=errors.get("error", np.zeros(len(pressure))),
        pressure_error=errors.get("pressure_error", np.zeros(len(pressure))),
        mean_error=errors.get("mean_error", 0.0 * pressure),
        stack=stack,
    )


def _check_normalisation(path: str | Path, table: FlatPunchTable) -> float:
    """Largest relative defect of int_0^1 p_bar rho d(rho) = int_0^(pi/2) q sin(theta) d(theta) = 1/2."""
    theta = np.linspace(0.0, np.pi / 2, 2001)
    q = table.smooth_pressure(np.sin(theta), table.ratios[:, None])
    integral = simpson(q * np.sin(theta), x=theta, axis=1)
    worst = int(np.argmax(np.abs(integral - 0.5)))
    defect = float(np.abs(2.0 * integral[worst] - 1.0))
    if defect > LIMIT_TOLERANCE:
        raise InvalidInput(
            f"{path}: int p_bar rho d(rho) must be 1/2, but is {integral[worst]:.4g} at a/h = "
            f"{table.ratios[worst]:g}; normalise p_bar by Eq. (10)"
        )
    return defect


def _check_limits(path: str | Path, table: FlatPunchTable) -> float:
    """Relative defect of k_bar at the thick end; the thin end is only checked, its limit being reached slowly.

    k_bar = 1/(1 - c a/h) holds to 1e-4 below a/h = 0.05, and the limits of thin layers to 10 h/a above a/h = 100,
    except for 0.45 < nu < 0.5.
    """
    first, last = float(table.ratios[0]), table.max_ratio
    thick = 1.0 / (
        1.0
        + 2.0
        / np.pi
        * float(point_response(kernel_of(_plain(table.support, table.poissons_ratio)))(np.array([1e-3]))[0])
        * first
    )
    defect = abs(float(table.stiffness[0]) / thick - 1.0) if first <= 0.05 else 0.0
    if defect > LIMIT_TOLERANCE:
        raise InvalidInput(f"{path}: k_bar({first:g}) is {table.stiffness[0]:.6g}, but must be near {thick:.6g}")
    thin = _thin_layer_stiffness(table)
    near_limit = last >= 100.0 and (table.support == "unbonded" or not 0.45 < table.poissons_ratio < 0.5)
    if near_limit and abs(table.stiffness[-1] / thin - 1.0) > LIMIT_TOLERANCE + 10.0 / last:
        raise InvalidInput(f"{path}: k_bar({last:g}) is {table.stiffness[-1]:.6g}, but must be near {thin:.6g}")
    return defect


def _thin_layer_stiffness(table: FlatPunchTable) -> float:
    """k_bar of a thin layer at the largest ratio, Eqs. (16), (18), (21)."""
    xi, compliance = table.max_ratio, kernel_of(_plain(table.support, table.poissons_ratio)).zero_mode
    return 3.0 * np.pi / 64.0 * xi**3 if compliance == 0.0 else np.pi / 4.0 * xi / compliance
