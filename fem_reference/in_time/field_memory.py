"""The top of a viscoelastic layer with a constant finite bulk modulus: the memory is a field in the layer.

Shear relaxes, volume does not.  With D the matrix of ``2 dev : dev`` at unit shear modulus and one displacement field
z_j for each branch (``z_j' = G_j u' - z_j / tau_j``), a step solves

    (K_vol + G_eff D) u_1 = Q p - D memory,      memory = sum_j (alpha z_j - beta u_0) + eta (u'_1 at u_1 = 0).

The matrix is factorised once for each length of step.  Units as in `surface_memory`.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from contact import Layer
from contact.records.validation import FloatArray
from fem_reference.discrete_layer.assembly import pressure_mass_elements, scatter, shear_elements
from fem_reference.discrete_layer.elements import taylor_hood
from fem_reference.discrete_layer.mesh import LayerMesh
from fem_reference.discrete_layer.problem import LayerProblem
from fem_reference.discrete_layer.solving.restricted import RestrictedSolver
from fem_reference.elastic.surface_compliance import STRIP_ORDER, strip_loads, strip_vertices
from fem_reference.in_time.relaxation_step import RelaxationStep


@dataclass(frozen=True)
class _EffectiveLayer:
    """The layer with one effective shear modulus, factorised.

    Attributes:
        solver: of the layer in units of its own contact modulus.
        scale: that contact modulus.
        responses: unknowns under every pressure function, shape (size, n).
        compliance: displacement moments under every pressure function, shape (n, n).
    """

    solver: RestrictedSolver
    scale: float
    responses: FloatArray
    compliance: FloatArray

    def solve(self, loads: FloatArray, displacements: int) -> FloatArray:
        """Unknowns under loads (size, m); the first ``displacements`` rows are displacements, the others pressures."""
        solution = self.solver.solve_loaded(loads)
        solution[:displacements] /= self.scale
        return solution


class CompressibleSurface:
    """`ViscoelasticSurface` of a layer with finite bulk modulus.

    Args:
        layer: the layer; its moduli are the instantaneous ones.
        mesh: a section with a strip of radius one.
        branches: number of Maxwell branches.
        backend: linear solver.

    Attributes:
        radii: vertices of the pressures.
        resultants: w, shape (n,).
        unknowns: size of the system of one step.
    """

    def __init__(self, layer: Layer, mesh: LayerMesh, branches: int, backend: str) -> None:
        self._layer, self._mesh, self._backend = layer, mesh, backend
        nu = layer.poissons_ratio
        # K in units of the instantaneous shear modulus.
        self._bulk = 2 * (1 + nu) / (3 * (1 - 2 * nu))
        problem = self._problem(nu)
        space = problem.space
        self._displacements = space.displacement_count
        self._deviator = scatter(shear_elements(space, 1.0), space.element_displacements, space.size)
        self._pressure_mass = scatter(pressure_mass_elements(space), space.element_pressures, space.size)
        self._loads = strip_loads(problem)
        self.resultants = self._loads.sum(axis=0)
        self.radii = problem.positions[0, strip_vertices(problem)]
        self.unknowns = space.size
        self._effective: dict[float, _EffectiveLayer] = {}
        self._now, self._before = np.zeros(space.size), np.zeros(space.size)
        self._branches = np.zeros((branches, space.size))
        self._long_term, self._moduli = 0.0, np.zeros(branches)
        self._unloaded = np.zeros(space.size)
        self._dissipated = 0.0
        self._rate = np.zeros(space.size)

    def _problem(self, poissons_ratio: float) -> LayerProblem:
        return LayerProblem(self._mesh, taylor_hood(STRIP_ORDER), poissons_ratio, self._layer.support, self._backend)

    def _effective_layer(self, shear_modulus: float) -> _EffectiveLayer:
        if shear_modulus not in self._effective:
            nu = (3 * self._bulk - 2 * shear_modulus) / (2 * (3 * self._bulk + shear_modulus))
            problem = self._problem(nu)
            scale = shear_modulus / problem.moduli.shear
            solver = problem.solver(problem.supported_unknowns)
            responses = solver.solve_loaded(self._loads)
            responses[: self._displacements] /= scale
            compliance = self._loads.T @ responses
            layer = _EffectiveLayer(solver, scale, responses, (compliance + compliance.T) / 2)
            self._effective[shear_modulus] = layer
        return self._effective[shear_modulus]

    def begin(self, step: RelaxationStep) -> tuple[FloatArray, FloatArray]:
        """See `ViscoelasticSurface`."""
        memory = step.decay @ self._branches - step.tangent.sum() * self._now
        memory = memory + step.dashpot * step.rate_memory(self._now, self._before, self._rate)
        layer = self._effective_layer(step.effective_modulus)
        self._unloaded = layer.solve(-(self._deviator @ memory)[:, None], self._displacements)[:, 0]
        return layer.compliance, self._loads.T @ self._unloaded

    def accept(self, step: RelaxationStep, pressure: FloatArray) -> None:
        """See `ViscoelasticSurface`."""
        layer = self._effective_layer(step.effective_modulus)
        following = self._unloaded + layer.responses @ pressure
        change = following - self._now
        self._dissipated += step.dissipation(self._branches, change, self._deviator)
        self._branches = step.decay[:, None] * self._branches + np.outer(step.tangent, change)
        self._rate = step.rule[0] / step.duration * following + step.rate_memory(self._now, self._before, self._rate)
        self._before, self._now = self._now, following
        self._long_term, self._moduli = step.long_term, step.moduli

    @property
    def stored_energy(self) -> float:
        """Volume: int p^2 / (2 K); shear: G_inf u D u / 2 + sum_j z_j D z_j / (2 G_j)."""
        energy = float(self._now @ (self._pressure_mass @ self._now)) / self._bulk
        energy += self._long_term * float(self._now @ (self._deviator @ self._now))
        for z, modulus in zip(self._branches, self._moduli, strict=True):
            energy += float(z @ (self._deviator @ z)) / modulus
        return energy / 2

    @property
    def dissipated_energy(self) -> float:
        """Energy lost so far."""
        return self._dissipated
