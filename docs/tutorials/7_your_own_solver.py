"""
Your own solver, verified
=========================

A solver of your own is a frozen record with a name and three functions. It is compared with the methods of this project
on every scene that it supports.
"""

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from cases.referees.from_depth import Response, answer_from_depths
from contact import ContactPath, ContactRadii, Layer, Paraboloid, Scene, StageLog, Supported, Unsupported
from mdr import Mdr

# %%
# Hertz on the half-space, with a mistake on purpose: the force is computed with E where E / (1 - nu^2) belongs.


@dataclass(frozen=True)
class MyHertz:
    """Hertz' formulas for a paraboloid on the half-space."""

    name: ClassVar[str] = "my_hertz"

    def supports(self, scene):
        """Whether this code models the scene, and if not, the reason."""
        if scene.effects or not scene.layer.is_half_space:
            return Unsupported("this code models the elastic half-space only")
        if not isinstance(scene.indenter, Paraboloid) or not isinstance(scene.loading, ContactRadii):
            return Unsupported("this code models a paraboloid at a contact radius only")
        return Supported()

    def solve(self, scene):
        """Depth, force and stiffness at the prescribed contact radii."""
        a, curvature = scene.loading.values, 1.0 / scene.indenter.radius_of_curvature
        modulus = scene.layer.youngs_modulus
        log = StageLog()
        quantities = ("contact_radius", "indentation_depth", "normal_force", "contact_stiffness")
        return ContactPath(
            scene=scene,
            method=self.name,
            settings={},
            contact_radius=a,
            indentation_depth=curvature * a**2,
            normal_force=4 / 3 * modulus * curvature * a**3,
            contact_stiffness=2 * modulus * a,
            error_estimate=dict.fromkeys(quantities, np.full(a.size, 1e-14)),
            cost=log.cost(unknowns=1),
            stages=log.records,
        )

    def refined(self):
        """The same with half the discretisation length: a closed form has none."""
        return self


# %%
# The mistake is a relative error of the force of nu^2 at every radius. The depth is right.
half_space = Layer.half_space(youngs_modulus=1e6, poissons_ratio=0.3)
scene = Scene(layer=half_space, indenter=Paraboloid(radius_of_curvature=0.01), loading=ContactRadii([1e-4, 1e-3]))
mine, reference = MyHertz().solve(scene), Mdr().solve(scene)
for quantity in ("indentation_depth", "normal_force"):
    print(quantity, getattr(mine, quantity) / getattr(reference, quantity) - 1)

# %%
# A solver that has only a force at depths needs less: ``answer_from_depths`` inverts it where radii or forces are
# prescribed, and differentiates it for the stiffness. Most cases prescribe contact radii, so return those as well.


class FromDepth(MyHertz):
    """The right formula of Hertz, F = 4/3 E* sqrt(R) depth^1.5, given as a function of depth [m]."""

    name: ClassVar[str] = "from_depth"

    def solve(self, scene):
        """Depth, force and stiffness at the prescribed radii, depths or forces."""
        radius, modulus = scene.indenter.radius_of_curvature, scene.layer.contact_modulus

        def respond(depth):
            force = 4 / 3 * modulus * np.sqrt(radius) * depth**1.5
            return Response(normal_force=force, contact_radius=np.sqrt(radius * depth))

        return answer_from_depths(scene, respond, StageLog(), method=self.name)


for quantity in ("indentation_depth", "normal_force", "contact_stiffness"):
    print(quantity, getattr(FromDepth().solve(scene), quantity) / getattr(reference, quantity) - 1)

# %%
# Registered under the entry point ``contact_verification.methods``, it can be named in every case. One line in
# continuous integration judges it, with a report that names the mistake::
#
#     contact-verify run --suite ci --method my_hertz
#
# The folder ``examples/hertz_half_space`` of the source is a complete package of this kind.
