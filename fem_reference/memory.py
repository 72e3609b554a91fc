"""The top of a relaxing layer and its memory, for every Poisson's ratio, in modes of the condensed layer.

    u = M x,   (K + D G*) x = M^T p,   G* x = G_inf x + sum_j s_j + eta x',   s_j' = G_j x' - s_j / tau_j

M (n, r) are displacement moments of the modes.  K and D are their stiffnesses against changes of volume and of shape.
Where all moduli relax in proportion (incompressible, or elastic) K = 0, D = 1 and M M^T is the compliance at unit shear
modulus.  Else the modes span the answers to every pressure at a few effective shear moduli.

In a step dt in which x is linear in time each branch is exact, with alpha = exp(-dt/tau_j),

    s_1 = alpha s_0 + beta (x_1 - x_0),    beta = G_j (tau_j/dt) (1 - alpha),

and the dashpot takes the backward difference of second order for unequal steps, q = dt/dt_before,

    dt x'_1 = (1 + 2q)/(1 + q) x_1 - (1 + q) x_0 + q^2/(1 + q) x_(-1).

Units: lengths by the strip's radius, stresses by the instantaneous shear modulus, times in seconds.
"""

from __future__ import annotations

from dataclasses import replace
from typing import NamedTuple

import numpy as np

from contact.records.validation import FloatArray
from fem_reference.assembly import taylor_hood
from fem_reference.layer import DiscreteLayer
from fem_reference.materials import Parts, ShearRelaxation, uniform
from fem_reference.mesh import Section
from fem_reference.surface import STRIDE, STRIP_ORDER, strip_loads

# Effective shear moduli whose answers span those at all others.  Five leave 3e-5 of the compliance between 0.02 and
# 1e4, and less than 2e-7 below nu = 0.4; ten take twice the time.
SPANNING_MODULI = (1e-2, 1e-1, 1.0, 10.0, 1e3)
# Least energy of a mode over the largest; below, roundings decide.
LEAST_MODE = 1e-13


class Modes(NamedTuple):
    """A layer condensed to its top.

    Attributes:
        displacements: M, shape (n, r).
        volume: K, shape (r,).
        shear: D, shape (r,).
        resultants: force per pressure unknown, shape (n,).
        radii: vertices of the pressures, shape (n,).
        unknowns: size of the condensed system.
    """

    displacements: FloatArray
    volume: FloatArray
    shear: FloatArray
    resultants: FloatArray
    radii: FloatArray
    unknowns: int


class Top:
    """Modes x and branch stresses s_j of a layer that is at rest at first; it has a memory and serves one history.

    Args:
        modes: of the condensed layer.
        relaxation: of shear; branches without modulus are left out.

    Attributes:
        resultants: force per pressure unknown, shape (n,).
        viscosity: eta over the instantaneous modulus [s].
        dissipated_energy: energy lost so far.
        dashpot_force: share of the dashpot in the force after the last step, ``eta v . D x'`` with ``M v = w``.
    """

    def __init__(self, modes: Modes, relaxation: ShearRelaxation) -> None:
        unit, acts = relaxation.at_once, relaxation.moduli > 0
        self.resultants, self.viscosity = modes.resultants, relaxation.viscosity / unit
        self.dissipated_energy = self.dashpot_force = 0.0
        self._lever = np.linalg.lstsq(modes.displacements, modes.resultants)[0]
        self._modes, self._volume, self._shear = modes.displacements, modes.volume, modes.shear
        self._long_term = relaxation.long_term_modulus / unit
        self._moduli, self._times = relaxation.moduli[acts] / unit, relaxation.times[acts]
        self._now = self._before = self._memory = np.zeros_like(modes.volume)
        self._branches = np.zeros((len(self._moduli), len(modes.volume)))
        self._duration = self._last = 0.0
        self._modulus, self._unit = np.nan, modes.displacements @ modes.displacements.T

    def restart(self) -> None:
        """The rates jump: the dashpot's next step is an implicit Euler step."""
        self._last = 0.0

    def begin(self, duration: float) -> tuple[FloatArray, FloatArray]:
        """Matrix A and offset o of the displacement moments ``A p + o`` after a step [s], for end pressures p."""
        ratio = duration / self._times
        self._duration = duration
        self._alpha, self._beta = np.exp(-ratio), -self._moduli * np.expm1(-ratio) / ratio
        q = duration / self._last if self._last else 0.0
        per_time = self.viscosity / duration
        following, before = per_time * (1 + 2 * q) / (1 + q), per_time * q * q / (1 + q)
        tangent = float(self._beta.sum())
        self._memory = self._alpha @ self._branches - (tangent + following + before) * self._now + before * self._before
        modulus = self._long_term + tangent + following
        if modulus != self._modulus:
            self._modulus, self._stiffness = modulus, self._volume + self._shear * modulus
            relaxes_alike = not self._volume.any()
            self._matrix = self._unit / modulus if relaxes_alike else (self._modes / self._stiffness) @ self._modes.T
        return self._matrix, -(self._modes / self._stiffness) @ (self._shear * self._memory)

    def accept(self, pressure: FloatArray) -> None:
        """Advance the memory by the step begun, with these end pressures."""
        following = (self._modes.T @ pressure - self._shear * self._memory) / self._stiffness
        change = following - self._now
        self.dissipated_energy += self._dissipation(change)
        self.dashpot_force = self.viscosity / self._duration * float(self._lever @ (self._shear * change))
        self._branches = self._alpha[:, None] * self._branches + np.outer(self._beta, change)
        self._before, self._now, self._last = self._now, following, self._duration

    @property
    def stored_energy(self) -> float:
        """(K x^2 + G_inf D x^2 + sum_j D s_j^2 / G_j) / 2, that of the free surface that still relaxes included."""
        energy = (self._volume + self._long_term * self._shear) @ self._now**2
        return float(energy + (self._branches**2 @ self._shear) @ (1 / self._moduli)) / 2

    def _dissipation(self, change: FloatArray) -> float:
        """Energy lost in the branches and the dashpot during a step of constant rate."""
        rate, duration = change / self._duration, self._duration
        lost = self.viscosity * duration * float(rate @ (self._shear * rate))
        for s, modulus, time, alpha in zip(self._branches, self._moduli, self._times, self._alpha, strict=True):
            # s(t) = steady + transient exp(-t / tau).
            steady = modulus * time * rate
            transient = s - steady
            integral = duration * steady + 2 * time * (1 - alpha) * transient
            squares = float(steady @ (self._shear * integral))
            squares += time / 2 * (1 - alpha**2) * float(transient @ (self._shear * transient))
            lost += squares / (modulus * time)
        return lost


def proportional_modes(compliance: FloatArray, resultants: FloatArray, radii: FloatArray, unknowns: int) -> Modes:
    """Of a layer whose moduli relax in proportion; compliance at unit shear modulus, shape (n, n)."""
    ones = np.ones_like(resultants)
    factor = np.asarray(np.linalg.cholesky(compliance), dtype=float)
    return Modes(factor, 0.0 * ones, ones, resultants, radii, unknowns)


def compressible_modes(parts: Parts, section: Section) -> Modes:
    """Modes of a uniform layer with a constant bulk modulus, on a section with a strip of radius one.

    A layer of effective shear modulus G* and bulk modulus K has the matrix ``K_v + G* D``. It is solved as a layer of
    contact modulus one and scaled.
    """
    nu = parts.poissons_ratio
    bulk = 2 * (1 + nu) / (3 * (1 - 2 * nu))
    displacements, volume_forces = [], []
    for modulus in SPANNING_MODULI:
        effective = (3 * bulk - 2 * modulus) / (2 * (3 * bulk + modulus))
        material = replace(parts, parts=uniform(effective, parts.parts[0].thickness).parts)
        layer = DiscreteLayer(section, taylor_hood(STRIP_ORDER), material)
        loads, tractions = strip_loads(layer, STRIDE)
        count = layer.space.displacement_count
        deviator = layer.matrix[:count, :count] / float(layer.moduli.shear[0, 0])
        responses = layer.solver(layer.supported_unknowns).solve_loaded(loads)[:count]
        responses *= float(layer.moduli.shear[0, 0]) / modulus
        displacements.append(responses)
        volume_forces.append(loads[:count] - modulus * (deviator @ responses))
    u, forces = np.hstack(displacements), np.hstack(volume_forces)
    modes, volume, shear = _energy_modes(u, u.T @ forces, u.T @ np.asarray(deviator @ u))
    moments, resultants = (u.T @ loads[:count]).T @ modes, loads.sum(axis=0)
    return Modes(moments, volume, shear, resultants, tractions.radii, layer.space.size)


def _energy_modes(u: FloatArray, volume: FloatArray, shear: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Combinations of the columns of ``u`` that diagonalise both energies, whose sum is one for every mode."""
    volume, shear = (volume + volume.T) / 2, (shear + shear.T) / 2
    energy, vectors = np.linalg.eigh(volume + shear)
    keep = energy > LEAST_MODE * energy[-1]
    unit = vectors[:, keep] / np.sqrt(energy[keep])
    share, turned = np.linalg.eigh(unit.T @ shear @ unit)
    return unit @ turned, 1 - share, share
