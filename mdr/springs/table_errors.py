"""Errors of what a flat-punch table gives, each quantity's own: differences to coarser tables, with their signs.

A table of a coarser grid, or of fewer rows, is off in stiffness, springs and profile together; in depth and force most
of that cancels. So the whole system is made of every coarser table, its differences are carried to each quantity to
first order, and only then their sizes are added up, each times the share that counts (`FlatPunchTable.variants`).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from bem.grid.error_model import TABLES
from contact import ContactRadii, IndentationDepths, Loading, NormalForces
from contact.records.validation import FloatArray
from mdr.springs.equivalent_system import EquivalentSystem
from mdr.springs.error_model import SPRING_ROUNDING


@dataclass(frozen=True, eq=False)
class TableDifferences:
    """What changes from a table to its variants at some contact radii, times the share that counts.

    Attributes:
        stiffness: Of k_N [N/m], shape (m, n).
        springs: Of c_N [Pa], likewise.
        profile: Of g [m].
        moment: Of the profile's moment [N].
    """

    stiffness: FloatArray
    springs: FloatArray
    profile: FloatArray
    moment: FloatArray

    @classmethod
    def at(cls, system: EquivalentSystem, radius: FloatArray) -> TableDifferences:
        """At contact radii [m], shape (n,); the last two rows are what no coarser table shows, of k and of q."""
        k, c, g, moment = (np.atleast_1d(values) for values in _values(system, radius))
        rows = [
            [share * (other - value) for other, value in zip(_values(variant, radius), (k, c, g, moment), strict=True)]
            for share, variant in system.variants
        ]
        linear, bending = system.flat_punch.linear_errors(np.atleast_1d(radius / system.length_unit))
        by_stiffness = TABLES.stiffness_floor + linear
        by_profile = bending + SPRING_ROUNDING + system.profile_truncation(radius)
        rows += [
            [by_stiffness * k, by_stiffness * c, 0 * g, 0 * moment],
            [0 * k, 0 * c, by_profile * g, by_profile * moment],
        ]
        return cls(*(np.array(column) for column in zip(*rows, strict=True)))


def _values(system: EquivalentSystem, radius: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    return (
        system.contact_stiffness(radius),
        system.spring_stiffness(radius),
        system.mdr_profile(radius),
        system.profile_moment(radius),
    )


def size(changes: FloatArray) -> FloatArray:
    """The sizes of all changes of one quantity added up, shape (n,)."""
    return np.asarray(np.sum(np.abs(changes), axis=0))


def elastic_errors(
    system: EquivalentSystem, loading: Loading, radius: FloatArray, depth: FloatArray, *, is_punch: bool
) -> dict[str, FloatArray]:
    """Absolute errors of an elastic contact's four quantities, zero for what is prescribed [m, m, N, N/m]."""
    changes = elastic_changes(system, loading, radius, depth, is_punch=is_punch)
    errors = {name: size(values) for name, values in changes.items()}
    # Whatever is prescribed, the others are read at a radius that is rounded.
    rounding = depth * system.position_rounding(radius)
    if not isinstance(loading, IndentationDepths):
        errors["indentation_depth"] += rounding
    if not isinstance(loading, NormalForces):
        errors["normal_force"] += rounding * system.contact_stiffness(radius)
    return errors


def elastic_changes(
    system: EquivalentSystem, loading: Loading, radius: FloatArray, depth: FloatArray, *, is_punch: bool
) -> dict[str, FloatArray]:
    """What `TableDifferences` make of an elastic contact's four quantities, shape (m, n) each [m, m, N, N/m].

    With F = k g - M at equilibrium, and dF = k d(delta) at a fixed radius.
    """
    change, k = TableDifferences.at(system, radius), system.contact_stiffness(radius)
    at_depth = change.stiffness * depth - change.moment
    none = np.zeros_like(change.stiffness)
    if isinstance(loading, ContactRadii):
        a, delta, force = none, change.profile, at_depth + k * change.profile
    elif isinstance(loading, IndentationDepths):
        a, delta, force = -change.profile, none, at_depth
    else:
        a, delta, force = -change.profile - at_depth / k, -at_depth / k, none
    if is_punch:
        a = none
    elif not isinstance(loading, ContactRadii):
        a = a / np.abs(system.mdr_profile_slope(radius))
    # d(k_N)/da is 2 c_N.
    stiffness = change.stiffness + 2.0 * system.spring_stiffness(radius) * a
    names = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
    return dict(zip(names, (a, delta, force, stiffness), strict=True))


def adhesive_errors(system: EquivalentSystem, radius: FloatArray, depth: FloatArray) -> FloatArray:
    """Absolute errors of delta [m] and F [N] of adhering equilibria with these radii, shape (2, n).

    The edge hangs by g - delta, which goes with c_N^(-1/2), Eq. (40).
    """
    change, k = TableDifferences.at(system, radius), system.contact_stiffness(radius)
    hanging = system.mdr_profile(radius) - depth
    delta = change.profile + 0.5 * hanging * change.springs / system.spring_stiffness(radius)
    return np.stack([size(delta), size(change.stiffness * depth + k * delta - change.moment)])


def relative_errors(system: EquivalentSystem, radius: FloatArray) -> dict[str, FloatArray]:
    """As `EquivalentSystem.relative_errors`."""
    change, k = TableDifferences.at(system, radius), system.contact_stiffness(radius)
    c, g, moment = system.spring_stiffness(radius), system.mdr_profile(radius), system.profile_moment(radius)
    stiffness, springs = size(change.stiffness) / k, size(change.springs) / c
    profile, force = (_over(size(values), by) for values, by in ((change.profile, g), (change.moment, moment)))
    return {
        "contact_radius": profile,
        "indentation_depth": profile,
        "normal_force": stiffness + np.maximum(profile, force),
        "contact_stiffness": stiffness,
        "spring_stiffness": springs,
    }


def _over(error: FloatArray, value: FloatArray) -> FloatArray:
    """Relative errors; zero of what is zero: under a flat end nothing is pressed in."""
    return np.asarray(np.divide(error, value, out=np.zeros_like(error), where=value > 0.0))
