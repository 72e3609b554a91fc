"""A relaxing layer condensed to a strip of its surface, and its memory, at every Poisson's ratio.

The layer is a generalised Maxwell solid in shear with a constant bulk modulus:

    u = M x,   (K + D G*) x = M^T p,   G* x = G_inf x + sum_j s_j + eta x',   s_j' = G_j x' - s_j / tau_j

The pressures p (n,) are nodal values of the hat functions phi_i. The moments ``u_i = int phi_i u_z 2 pi r dr`` (n,)
make p . u their work. The columns of M (n, r) are the moments of r displacement modes of the whole layer with
amplitudes x. K and D (r,) are diagonals: the stiffness of each mode against changes of volume, and of shape at unit
shear modulus. G_inf, G_j and tau_j are those of `ShearRelaxation`, eta is the viscosity of its parallel dashpot, and
s_j (r,) are the contributions of the branches to G* x.

Where all moduli relax in proportion (incompressible, or elastic) K = 0, D = 1 and M M^T is the compliance at unit shear
modulus. Else the modes span the responses to every pressure at a few effective shear moduli.

In a step dt from x_0 to x_1 in which x is linear in time each branch is exact, with alpha = exp(-dt/tau_j),

    s_1 = alpha s_0 + beta (x_1 - x_0),    beta = G_j (tau_j/dt) (1 - alpha),

and the dashpot takes the backward difference of second order for unequal steps (BDF2), q = dt/dt_before,

    dt x'_1 = (1 + 2q)/(1 + q) x_1 - (1 + q) x_0 + q^2/(1 + q) x_(-1).

Both are linear in x_1, so that ``G* x_1 = G_step x_1 + memory``, with the effective shear modulus of the step

    G_step = G_inf + sum_j beta_j + (eta/dt) (1 + 2q)/(1 + q)

and a memory of known amplitudes and branches. A step hence is an elastic problem, ``u = A p + o`` (`Top.begin`).

Units: lengths by the strip's radius L, stresses by the instantaneous shear modulus G_0 = G_inf + sum_j G_j, times in
seconds.
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

# Effective shear moduli over G_0 whose displacements span those at all other moduli. With five the compliance
# errs by 3e-5 at moduli between 0.02 and 1e4, and by less than 2e-7 below nu = 0.4. Ten take twice the time.
SPANNING_MODULI = (1e-2, 1e-1, 1.0, 10.0, 1e3)
# Least energy of a mode over the largest. Modes of less energy are roundings and omitted.
LEAST_MODE = 1e-13


class Modes(NamedTuple):
    """A layer condensed to a strip of its surface, without memory; the symbols are those of the module.

    Attributes:
        displacements: M, moments of u_z per amplitude, shape (n, r).
        volume: diagonal of K, shape (r,).
        shear: diagonal of D, shape (r,).
        resultants: ``w_i = int phi_i 2 pi r dr``, the force is F = w . p, shape (n,).
        radii: vertices of the pressures over L, shape (n,).
        unknowns: size of the linear system before condensation.
    """

    displacements: FloatArray
    volume: FloatArray
    shear: FloatArray
    resultants: FloatArray
    radii: FloatArray
    unknowns: int


class Top:
    """A condensed layer with its amplitudes x and branches s_j, which are zero at first; one object per history.

    Each step is a call of `begin`, then of `accept`. Without `accept` a step has no effect and may be begun anew.

    Args:
        modes: modes of the condensed layer.
        relaxation: shear relaxation; branches of zero modulus are omitted.

    Attributes:
        resultants: w, force per nodal pressure, shape (n,).
        viscosity: eta / G_0 [s].
        dissipated_energy: energy dissipated since the start, over G_0 L^3.
        dashpot_force: share of the dashpot in the force after the last step, ``eta v . D (x_1 - x_0)/dt``, with the
            amplitudes v of a uniform displacement: ``M v = w``, so that ``F = w . p = v . (K + D G*) x``. Exact after
            Euler steps only.
    """

    def __init__(self, modes: Modes, relaxation: ShearRelaxation) -> None:
        unit, acts = relaxation.instantaneous_modulus, relaxation.moduli > 0
        self.resultants, self.viscosity = modes.resultants, relaxation.viscosity / unit
        self.dissipated_energy = self.dashpot_force = 0.0
        self._uniform = np.linalg.lstsq(modes.displacements, modes.resultants)[0]
        self._modes, self._volume, self._shear = modes.displacements, modes.volume, modes.shear
        self._long_term = relaxation.long_term_modulus / unit
        self._moduli, self._times = relaxation.moduli[acts] / unit, relaxation.times[acts]
        self._amplitudes = self._earlier = self._memory = np.zeros_like(modes.volume)
        self._branches = np.zeros((len(self._moduli), len(modes.volume)))
        self._duration = self._last_duration = 0.0
        self._modulus, self._unit = np.nan, modes.displacements @ modes.displacements.T

    def restart(self) -> None:
        """Start the next step after a jump of the rate x': q = 0 makes it an implicit Euler step of the dashpot.

        The difference of second order would mix the rates before and after the jump.
        """
        self._last_duration = 0.0

    def begin(self, duration: float) -> tuple[FloatArray, FloatArray]:
        """Matrix A and offset o of the moments ``u = A p + o`` at the end of a step [s], for the pressures p there.

        ``A = M (K + D G_step)^-1 M^T`` (n, n), ``o = -M (K + D G_step)^-1 D memory`` (n,).
        """
        ratio = duration / self._times
        self._duration = duration
        self._alpha, self._beta = np.exp(-ratio), -self._moduli * np.expm1(-ratio) / ratio
        q = duration / self._last_duration if self._last_duration else 0.0
        # Coefficients of x_1 and x_(-1) in eta x'_1. That of -x_0 is their sum: (1 + q)^2/(1 + q).
        rate = self.viscosity / duration
        current_share, earlier_share = rate * (1 + 2 * q) / (1 + q), rate * q * q / (1 + q)
        branch_modulus = float(self._beta.sum())
        self._memory = (
            self._alpha @ self._branches
            - (branch_modulus + current_share + earlier_share) * self._amplitudes
            + earlier_share * self._earlier
        )
        modulus = self._long_term + branch_modulus + current_share
        if modulus != self._modulus:
            self._modulus, self._stiffness = modulus, self._volume + self._shear * modulus
            relaxes_alike = not self._volume.any()
            self._matrix = self._unit / modulus if relaxes_alike else (self._modes / self._stiffness) @ self._modes.T
        return self._matrix, -(self._modes / self._stiffness) @ (self._shear * self._memory)

    def accept(self, pressure: FloatArray) -> None:
        """End the step of `begin`: compute amplitudes x_1 and branches s_j at its end, and add the dissipated energy.

        ``x_1 = (K + D G_step)^-1 (M^T p - D memory)`` and ``s_j = alpha_j s_j + beta_j (x_1 - x_0)``.

        Args:
            pressure: p / G_0 at the vertices at the end of the step, shape (n,).
        """
        amplitudes = (self._modes.T @ pressure - self._shear * self._memory) / self._stiffness
        change = amplitudes - self._amplitudes
        self.dissipated_energy += self._dissipation(change)
        self.dashpot_force = self.viscosity / self._duration * float(self._uniform @ (self._shear * change))
        self._branches = self._alpha[:, None] * self._branches + np.outer(self._beta, change)
        self._earlier, self._amplitudes, self._last_duration = self._amplitudes, amplitudes, self._duration

    @property
    def stored_energy(self) -> float:
        """Energy ``(x . K x + G_inf x . D x + sum_j s_j . D s_j / G_j) / 2`` over G_0 L^3.

        It does not vanish when contact is lost: the free surface still relaxes.
        """
        energy = (self._volume + self._long_term * self._shear) @ self._amplitudes**2
        return float(energy + (self._branches**2 @ self._shear) @ (1 / self._moduli)) / 2

    def _dissipation(self, change: FloatArray) -> float:
        """Energy / (G_0 L^3) dissipated at a constant rate: ``int sum_j s_j.D s_j / (G_j tau_j) + eta x'.D x' dt``.

        The integrals over the branches are exact.
        """
        rate, duration, alpha = change / self._duration, self._duration, self._alpha[:, None]
        moduli, times = self._moduli[:, None], self._times[:, None]
        # s(t) = steady + transient exp(-t / tau) solves s' = G x' - s / tau, from s_0 at t = 0.
        steady = moduli * times * rate
        transient = self._branches - steady
        integral = duration * steady + 2 * times * (1 - alpha) * transient
        squares = steady * integral + times / 2 * (1 - alpha**2) * transient**2
        dissipation = self.viscosity * duration * rate**2 + np.sum(squares / (moduli * times), axis=0)
        return float(dissipation @ self._shear)


def proportional_modes(compliance: FloatArray, resultants: FloatArray, radii: FloatArray, unknowns: int) -> Modes:
    """Modes of a layer whose moduli relax in proportion: K = 0, D = 1, and M the Cholesky factor of the compliance.

    Args:
        compliance: M M^T, moments of u_z per nodal pressure at unit shear modulus, shape (n, n).
        resultants: w, shape (n,).
        radii: vertices of the pressures over L, shape (n,).
        unknowns: size of the linear system before condensation.
    """
    ones = np.ones_like(resultants)
    factor = np.asarray(np.linalg.cholesky(compliance), dtype=float)
    return Modes(factor, 0.0 * ones, ones, resultants, radii, unknowns)


def compressible_modes(parts: Parts, section: Section) -> Modes:
    """Modes of a uniform layer with a constant bulk modulus, on a section with a strip of radius one.

    In an elastic layer of shear modulus G and bulk modulus K_b (in units of G_0) the displacements under nodal loads f
    solve ``(K_v + G D_v) u = f``: K_v is the stiffness against changes of volume, D_v against those of shape at unit
    shear modulus. Solutions at `SPANNING_MODULI` are the basis of the modes, and K_v u = f - G D_v u needs no inverse
    of the pressure's matrix. Each is solved as a layer of contact modulus one and of the ratio
    ``nu = (3 K_b - 2 G) / (2 (3 K_b + G))``, and scaled.
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
    modes, volume, shear = _energy_modes(u.T @ forces, u.T @ np.asarray(deviator @ u))
    moments, resultants = (u.T @ loads[:count]).T @ modes, loads.sum(axis=0)
    return Modes(moments, volume, shear, resultants, tractions.radii, layer.space.size)


def _energy_modes(volume: FloatArray, shear: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Coefficients (m, r) of m displacements in modes that diagonalise both energies, and their K and D (r,).

    Modes are normalised to K + D = 1. ``volume`` and ``shear`` (m, m) are the energies ``u^T K_v u`` and ``u^T D_v u``
    of the displacements u.
    """
    volume, shear = (volume + volume.T) / 2, (shear + shear.T) / 2
    energy, vectors = np.linalg.eigh(volume + shear)
    keep = energy > LEAST_MODE * energy[-1]
    unit = vectors[:, keep] / np.sqrt(energy[keep])
    share, rotation = np.linalg.eigh(unit.T @ shear @ unit)
    return unit @ rotation, 1 - share, share
