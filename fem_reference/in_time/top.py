"""The top of a relaxing layer and its memory, for every Poisson's ratio, in modes of the condensed layer.

    u = M x,   (K + D G*) x = M^T p,   G* x = G_inf x + sum_j s_j + eta x',   s_j' = G_j x' - s_j / tau_j

M (n, r) are displacement moments of the modes.  K and D are their stiffnesses against changes of volume and of shape.
Where all moduli relax in proportion (incompressible, or elastic) K = 0, D = 1 and M M^T is the compliance at unit shear
modulus.  Else the modes span the answers to every pressure at a few effective shear moduli.
Units: lengths by the strip's radius, stresses by the instantaneous shear modulus, times in seconds.
"""

from __future__ import annotations

import numpy as np

from contact import Layer
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.assembly import scatter, shear_elements
from fem_reference.discrete_layer.elements import taylor_hood
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.elastic.surface_compliance import STRIP_ORDER, strip_loads, strip_vertices
from fem_reference.in_time.relaxation_step import RelaxationStep

# Effective shear moduli whose answers span those at all others.  Five leave 3e-5 of the compliance between 0.02 and
# 1e4, and less than 2e-7 below nu = 0.4; ten take twice the time.
SPANNING_MODULI = (1e-2, 1e-1, 1.0, 10.0, 1e3)
# Least energy of a mode over the largest; below, roundings decide.
LEAST_MODE = 1e-13


class Top:
    """Modes x and branch stresses s_j of a layer that is at rest at first; it has a memory and serves one history.

    Args:
        modes: M, shape (n, r).
        volume: K, shape (r,).
        shear: D, shape (r,).
        resultants: force per pressure unknown, shape (n,).
        branches: number of Maxwell branches.

    Attributes:
        resultants: as given.
        dissipated_energy: energy lost so far.
    """

    def __init__(
        self, modes: FloatArray, volume: FloatArray, shear: FloatArray, resultants: FloatArray, branches: int
    ) -> None:
        self.resultants = resultants
        self.dissipated_energy = 0.0
        self._modes, self._volume, self._shear = modes, volume, shear
        self._now = self._before = self._rate = self._memory = np.zeros_like(volume)
        self._branches = np.zeros((branches, len(volume)))
        self._step: RelaxationStep | None = None
        self._compliances: dict[float, tuple[FloatArray, FloatArray]] = {}

    def _compliance(self, modulus: float) -> tuple[FloatArray, FloatArray]:
        """Modes over their stiffness at an effective shear modulus, shape (n, r), and the compliance, shape (n, n)."""
        if modulus not in self._compliances:
            scaled = self._modes / (self._volume + self._shear * modulus)
            self._compliances[modulus] = scaled, scaled @ self._modes.T
        return self._compliances[modulus]

    def begin(self, step: RelaxationStep) -> tuple[FloatArray, FloatArray]:
        """Matrix A and offset o of the displacement moments ``A p + o`` at the end of the step, for end pressures p."""
        self._memory = step.decay @ self._branches - step.tangent.sum() * self._now
        if step.dashpot > 0:
            self._memory = self._memory + step.dashpot * step.rate_memory(self._now, self._before, self._rate)
        scaled, compliance = self._compliance(step.effective_modulus)
        return compliance, -scaled @ (self._shear * self._memory)

    def accept(self, step: RelaxationStep, pressure: FloatArray) -> None:
        """Advance the memory by the step begun, with these end pressures."""
        stiffness = self._volume + self._shear * step.effective_modulus
        following = (self._modes.T @ pressure - self._shear * self._memory) / stiffness
        change = following - self._now
        self.dissipated_energy += step.dissipation(self._branches, change, self._shear)
        self._branches = step.decay[:, None] * self._branches + np.outer(step.tangent, change)
        self._rate = step.rule[0] / step.duration * following + step.rate_memory(self._now, self._before, self._rate)
        self._before, self._now, self._step = self._now, following, step

    @property
    def stored_energy(self) -> float:
        """(K x^2 + G_inf D x^2 + sum_j D s_j^2 / G_j) / 2, that of the free surface that still relaxes included."""
        if self._step is None:
            return 0.0
        energy = (self._volume + self._step.long_term * self._shear) @ self._now**2
        return float(energy + (self._branches**2 @ self._shear) @ (1 / self._step.moduli)) / 2


def proportional_top(compliance: FloatArray, resultants: FloatArray, branches: int) -> Top:
    """Of a layer whose moduli relax in proportion; compliance at unit shear modulus, shape (n, n)."""
    ones = np.ones_like(resultants)
    return Top(np.asarray(np.linalg.cholesky(compliance), dtype=float), 0.0 * ones, ones, resultants, branches)


def compressible_top(layer: Layer, mesh: LayerMesh, branches: int, backend: str) -> tuple[Top, FloatArray, int]:
    """Of a layer with a constant bulk modulus on a section with a strip of radius one.

    Returns:
        The top, the vertices of the pressures, shape (n,), and the size of the condensed system.
    """
    nu = layer.poissons_ratio
    bulk = 2 * (1 + nu) / (3 * (1 - 2 * nu))
    displacements, volume_forces = [], []
    for modulus in SPANNING_MODULI:
        effective = (3 * bulk - 2 * modulus) / (2 * (3 * bulk + modulus))
        problem = LayerProblem(mesh, taylor_hood(STRIP_ORDER), effective, layer.support, backend)
        count, loads = problem.space.displacement_count, strip_loads(problem)
        deviator = scatter(shear_elements(problem.space, 1.0), problem.space.element_displacements, problem.space.size)
        responses = problem.solver(problem.supported_unknowns).solve_loaded(loads)[:count]
        responses *= problem.moduli.shear / modulus
        displacements.append(responses)
        volume_forces.append(loads[:count] - modulus * (deviator[:count, :count] @ responses))
    u, forces = np.hstack(displacements), np.hstack(volume_forces)
    modes, volume, shear = _energy_modes(u, u.T @ forces, u.T @ (deviator[:count, :count] @ u))
    radii = problem.positions[0, strip_vertices(problem)]
    top = Top((u.T @ loads[:count]).T @ modes, volume, shear, loads.sum(axis=0), branches)
    return top, radii, problem.space.size


def _energy_modes(u: FloatArray, volume: FloatArray, shear: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Combinations of the columns of ``u`` that diagonalise both energies, whose sum is one for every mode."""
    volume, shear = (volume + volume.T) / 2, (shear + shear.T) / 2
    energy, vectors = np.linalg.eigh(volume + shear)
    keep = energy > LEAST_MODE * energy[-1]
    unit = vectors[:, keep] / np.sqrt(energy[keep])
    share, turned = np.linalg.eigh(unit.T @ shear @ unit)
    return unit @ turned, 1 - share, share
