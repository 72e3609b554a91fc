"""Scenes of the impact section of Forsbach (2023): Fig. 12 and the flat punch of Fig. 11."""

from __future__ import annotations

import numpy as np

from contact import FlatPunch, Impact, KelvinVoigt, Layer, Paraboloid, Scene, StandardSolid

GLASSY_BRANCH = 7.5e6  # G_1 [Pa]
LONG_TERM = GLASSY_BRANCH / 9.0  # G_inf [Pa]
RELAXATION_TIME = 1e-3  # tau [s]
MASS = 0.02  # M [kg]
RADIUS_TIMES_VELOCITY = 1.27479e-3  # R v0 [m^2/s], which makes chi_HS = 2.65


def incompressible(thickness, shear_modulus):
    if np.isinf(thickness):
        return Layer.half_space(youngs_modulus=3.0 * shear_modulus, poissons_ratio=0.5)
    return Layer.incompressible(thickness=thickness, shear_modulus=shear_modulus)


def figure_12(thickness, radius=10e-3, scale=(1.0, 1.0, 1.0)):
    """The standard-solid sphere. `scale` multiplies the units of length, mass and time."""
    length, mass, time = scale
    stress = mass / (length * time**2)
    model = StandardSolid(
        long_term_shear_modulus=LONG_TERM * stress,
        maxwell_shear_modulus=GLASSY_BRANCH * stress,
        viscosity=GLASSY_BRANCH * RELAXATION_TIME * stress * time,
    )
    return Scene(
        layer=incompressible(thickness * length, (LONG_TERM + GLASSY_BRANCH) * stress),
        indenter=Paraboloid(radius_of_curvature=radius * length),
        loading=Impact(mass=MASS * mass, velocity=RADIUS_TIMES_VELOCITY / radius * length / time),
        effects=(model,),
    )


def kelvin_voigt_sphere(tau):
    """The half-space of REFERENCES in units rho = m = v0 = 1: F = delta^1.5 when elastic, and relaxation time tau."""
    modulus = 0.1875  # E* = 4 G = 3/4, so that 4/3 E* sqrt(R) = 1 with R = 1
    return Scene(
        layer=incompressible(np.inf, modulus),
        indenter=Paraboloid(radius_of_curvature=1.0),
        loading=Impact(mass=1.0, velocity=1.0),
        effects=(KelvinVoigt(shear_modulus=modulus, viscosity=modulus * tau),),
    )


def kelvin_voigt_punch(damping, *, mass=1.0, velocity=1.0):
    """A flat punch on the half-space with damping ratio D: k = 8 G a, D = eta/(2 G) sqrt(k/M)."""
    modulus, radius = 0.125, 1.0
    eta = damping * 2.0 * modulus * np.sqrt(mass / (8.0 * modulus * radius))
    return Scene(
        layer=incompressible(np.inf, modulus),
        indenter=FlatPunch(radius=radius),
        loading=Impact(mass=mass, velocity=velocity),
        effects=(KelvinVoigt(shear_modulus=modulus, viscosity=float(eta)),),
    )
