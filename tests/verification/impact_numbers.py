"""Dimensionless groups that decide an impact, Eqs. (53) and (54)."""

from __future__ import annotations


def half_space_number(
    *, viscosity: float, radius: float, velocity: float, mass: float, long_term_modulus: float
) -> float:
    """chi_HS = eta (R v0 / (M^2 G_inf^3))^(1/5), Eq. (53)."""
    return float(viscosity * (radius * velocity / (mass**2 * long_term_modulus**3)) ** 0.2)


def unbonded_thin_layer_number(
    *, viscosity: float, radius: float, velocity: float, mass: float, long_term_modulus: float, thickness: float
) -> float:
    """chi_TL = eta (R v0 / (h M G_inf^2))^(1/3), Eq. (54)."""
    return float(viscosity * (radius * velocity / (thickness * mass * long_term_modulus**2)) ** (1.0 / 3.0))


def bonded_thin_layer_number(
    *, viscosity: float, radius: float, velocity: float, mass: float, long_term_modulus: float, thickness: float
) -> float:
    """chi_TL of a bonded incompressible layer, Eq. (54)."""
    return float(viscosity * ((radius * velocity) ** 2 / (thickness**3 * mass * long_term_modulus**3)) ** 0.25)
