"""Errors of the stiffness on one and the same mesh as Poisson's ratio goes to one half."""

from functools import cache

import numpy as np

from bem.direct_method import IntegralEquationMethod
from contact import FlatPunch, IndentationDepths, Layer, Scene
from fem_reference.assembly import PAIRS
from fem_reference.materials import uniform
from fem_reference.mesh import Section, section_mesh
from fem_reference.verification import uniform_layer


@cache
def one_mesh() -> Section:
    """The mesh around a flat punch as wide as the layer is thick; lengths by the thickness.

    Cells grow from the edge of the contact by a half, and the outer edge lies ten thicknesses beyond it.
    """
    return section_mesh(uniform(0.5), 11.0, ((1.0, 1e-5),), 0.5)


def punch_stiffness(pair: str, poissons_ratio: float) -> float:
    """k_N/(E* h) of the flat punch at a/h = 1, from the reactions."""
    problem = uniform_layer(one_mesh(), PAIRS[pair], poissons_ratio)
    pressed = 2 * problem.top_nodes(1.0) + 1
    solver = problem.solver(np.concatenate([problem.supported_unknowns, pressed]))
    values = np.zeros((len(solver.held), 1))
    values[-len(pressed) :] = 1.0
    return float(solver.reactions(solver.solve_displaced(values), pressed).sum())


@cache
def exact_stiffness(poissons_ratio: float) -> float:
    """The same by the direct integral equation, which has no mesh."""
    layer = Layer(thickness=1.0, youngs_modulus=1.0, poissons_ratio=poissons_ratio)
    scene = Scene(layer=layer, indenter=FlatPunch(radius=1.0), loading=IndentationDepths([0.1]))
    path = IntegralEquationMethod().solve(scene)
    return float(path.contact_stiffness[0]) / layer.contact_modulus


def stiffness_error(pair: str, poissons_ratio: float) -> float:
    """Relative error of the stiffness."""
    return abs(punch_stiffness(pair, poissons_ratio) / exact_stiffness(poissons_ratio) - 1)
