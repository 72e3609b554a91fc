"""Strains that another program prints: a road of three layers under a wheel, with and without slip below the first."""

import numpy as np
import pytest

from contact import ElasticBase, LayerStack, Sublayer
from mdr.inside import Fields
from tests.mdr.test_inside import UnderUniformPressure, UniformPressure

# Benchmark AMADEUS (Belgian Road Research Centre 2000): thicknesses and radius in mm, moduli and pressure in MPa.
THICKNESSES, MODULI, RATIOS = (260.0, 500.0), (5000.0, 200.0, 50.0), (0.35, 0.40, 0.45)
PRESSURE, RADIUS = 0.7, 150.8
# BISAR, as printed in the validation example of ALVA, in millionths: strain along the radius at the bottom of the first
# layer, then strain along the depth at the tops of the second and the third; below the centre and the rim of the load.
PRINTED = {
    "bonded": ((-100.5, 251.7, 185.0), (-61.9, 192.2, 177.5)),
    "slipping": ((-120.0, 1.0, 217.0), (-78.0, -10.0, 205.0)),
}


def strains(r, z, *, below, slips):
    """Radial and axial strain at a point just above or below an interface."""
    sublayers = tuple(
        Sublayer(thickness=h, youngs_modulus=E, poissons_ratio=nu)
        for h, E, nu in zip(THICKNESSES, MODULI, RATIOS, strict=False)
    )
    base = ElasticBase(youngs_modulus=MODULI[2], poissons_ratio=RATIOS[2], interface="bonded")
    layer = LayerStack(sublayers=sublayers, interfaces=("unbonded" if slips else "bonded",), support=base)
    sheet = 0 if not below else 1 if z == THICKNESSES[0] else 2
    body = UnderUniformPressure(layer, UniformPressure(layer, RADIUS))
    depth = z * (1.0 + (1e-13 if below else -1e-13))
    found = Fields(*body.at(np.array([r]), np.array([depth]))[0][:, 0])
    rr, tt, zz = found.radial_stress, found.hoop_stress, found.axial_stress
    E, nu = MODULI[sheet], RATIOS[sheet]
    return [PRESSURE / E * (own - nu * (rr + tt + zz - own)) * 1e6 for own in (rr, zz)]


@pytest.mark.parametrize("kind", PRINTED)
@pytest.mark.parametrize(("place", "r"), [(0, 0.0), (1, RADIUS)])
def test_strains_of_bisar_within_a_last_digit(kind, place, r):
    """As rounded as they are printed; KENLAYER prints 185.3 where this one has 185.13 and BISAR 185.0."""
    slips = kind == "slipping"
    digits = 0 if slips else 1
    first, second = THICKNESSES[0], sum(THICKNESSES)
    found = (
        strains(r, first, below=False, slips=slips)[0],
        strains(r, first, below=True, slips=slips)[1],
        strains(r, second, below=True, slips=slips)[1],
    )
    # Tension is positive here, compression there.
    assert [round(-float(strain), digits) for strain in found] == pytest.approx(
        PRINTED[kind][place], rel=0, abs=1.001 * 10.0**-digits
    )
