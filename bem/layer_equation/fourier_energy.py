"""Energy of a density in wavenumber space: <phi, A phi> = (2/pi) int_0^inf chi(k) phi^(k)^2 dk.

On thin incompressible layers A = I - K is nearly singular: chi(h/a) is 1e-9 at a/h = 1000. As a difference of two
numbers the energy would lose those nine digits; as an integral over chi > 0 it loses none. It is used to improve
solutions that have lost them: F = <1, A^-1 1> is the largest value of ``2 <1, phi> - <phi, A phi>``, so that an error
of phi enters by its square.

Densities are given on equal panels by values at Gauss nodes. ``phi^(k) = int_0^a phi cos(kt) dt`` at thousands of k
comes from FFTs over the panels, one for each pair of a node in t and an offset in k, panels of the same phase first
added up. Beyond `LARGEST_WAVENUMBER` chi = 1, and phi^ is known from the density and its derivatives at the edge, by
partial integration.
"""

from __future__ import annotations

from functools import cache, lru_cache

import numpy as np
from numpy.polynomial import chebyshev
from numpy.typing import NDArray

from bem.kernels.layer import compliance_kernel
from bem.polynomials.gauss_panels import chebyshev_from_nodes, gauss_nodes, lagrange_matrix
from contact.records.validation import FloatArray
from contact.scene.layer import Support

# Wavenumber times thickness beyond which chi counts as 1.
LARGEST_WAVENUMBER = 40.0
# Gauss nodes of a unit panel in t: they integrate cos(40 t) to 1e-13.
NODES = 28
# Gauss nodes of a panel in k, an even number, and the largest phase 2 a k over it: a rule of n nodes leaves
# J_2n(phase/2) of a wave, and J_96(16 pi) = 3e-19. So 6 to 8 nodes a turn meet each thickness of the radius.
WAVENUMBERS = 48
PANEL_PHASE = 32 * np.pi


def energy_matrix(densities: FloatArray, width: float, support: Support, poissons_ratio: float) -> FloatArray:
    """<phi_i, A phi_j> of densities on equal panels of [0, a].

    Args:
        densities: Values at the panels' Gauss nodes, shape (densities, panels, nodes).
        width: Width of the panels, in layer thicknesses; a whole number.
        support: Support of the layer.
        poissons_ratio: nu.

    Returns:
        Symmetric matrix, shape (densities, densities).
    """
    unit = _on_unit_panels(densities, int(width))
    size, turns = _panels_of_a_turn(unit.shape[1]), _whole_turns()
    step = 2 * np.pi / size
    transform = _transforms(unit, turns, size)
    weights = step * gauss_nodes(WAVENUMBERS)[1][:, None] * _compliances(turns, size, support, poissons_ratio)
    # Offset by offset: one sum of them all would lose ten roundings.
    energy: FloatArray = np.sum((transform * weights[:, None]) @ transform.swapaxes(1, 2), axis=0)
    return 2 / np.pi * (energy + _tail(densities, width, step * (turns * size)))


def _panels_of_a_turn(radius: int) -> int:
    """Panels of a period 2 pi in k, a power of two or half as many again, wherein FFTs are fast."""
    needed = 4 * np.pi * radius / PANEL_PHASE
    power = int(np.ceil(np.log2(needed)))
    return int(min(size for size in (2.0**power, 1.5 * 2.0 ** (power - 1)) if size >= needed)) if power > 1 else 2


# Densities of one layer come in seven sizes, of which the largest takes 0.3 MB.
@lru_cache(maxsize=8)
def _compliances(turns: int, size: int, support: Support, poissons_ratio: float) -> FloatArray:
    """chi at all wavenumbers, a row for each offset."""
    step = 2 * np.pi / size
    k = step * np.arange(turns * size)
    return compliance_kernel(k + step * gauss_nodes(WAVENUMBERS)[0][:, None], support, poissons_ratio)


def _on_unit_panels(densities: FloatArray, parts: int) -> FloatArray:
    """The same polynomials at the nodes of panels of unit width, shape (densities, panels parts, NODES)."""
    points = (np.arange(parts)[:, None] + gauss_nodes(NODES)[0]) / parts
    values = densities @ lagrange_matrix(densities.shape[2], points.ravel()).T
    return values.reshape(len(densities), -1, NODES)


def _transforms(unit: FloatArray, turns: int, size: int) -> FloatArray:
    """int phi cos(kt) dt at k = offset + (2 pi/size) (0 .. turns size - 1).

    On panel p, t = p + node: the sums of phi exp(ikp) over the panels have the period 2 pi in k. So k is a place in the
    first period and a number of turns, and the phase exp(ik node) a product. Gauss nodes are symmetric: sums at one
    offset are the conjugates of those at its mirror image, in reversed order.

    Returns:
        Shape (offsets, densities, turns size).
    """
    nodes, weights = gauss_nodes(NODES)
    shares = gauss_nodes(WAVENUMBERS)[0]
    half, offsets = _panel_sums(unit, shares[: WAVENUMBERS // 2], size), 2 * np.pi / size * shares
    sums = np.concatenate([half, half[::-1, ..., ::-1].conj()]) * _phases(size)
    nodal = _turns(turns) * (weights * np.exp(1j * np.multiply.outer(offsets, nodes)))[:, None, :]
    return np.asarray((nodal[:, None] @ sums).real.reshape(len(shares), len(unit), -1))


def _panel_sums(unit: FloatArray, shares: FloatArray, size: int) -> NDArray[np.complex128]:
    """Sums of phi exp(ikp) over the panels p at k = (2 pi/size) (share + 0 .. size - 1), a row for each node.

    Panels that are `size` apart have the same phase but for the offset's.

    Returns:
        Shape (offsets, densities, NODES, size).
    """
    by_node = np.pad(unit, ((0, 0), (0, -unit.shape[1] % size), (0, 0))).swapaxes(1, 2)
    folds = by_node.reshape(len(unit) * NODES, -1, size).swapaxes(0, 1)
    turn = np.exp(2j * np.pi * np.multiply.outer(shares, np.arange(len(folds))))
    together = turn.real @ folds.reshape(len(folds), -1) + 1j * (turn.imag @ folds.reshape(len(folds), -1))
    within = np.exp(2j * np.pi / size * np.multiply.outer(shares, np.arange(size)))
    turned = together.reshape(len(shares), -1, size) * within[:, None]
    return size * np.fft.ifft(turned).reshape(len(shares), len(unit), NODES, size)


@cache
def _phases(size: int) -> NDArray[np.complex128]:
    """exp(ik node) over the first period of k, shape (NODES, size)."""
    return np.exp(2j * np.pi / size * np.multiply.outer(gauss_nodes(NODES)[0], np.arange(size)))


@cache
def _turns(turns: int) -> NDArray[np.complex128]:
    """exp(2 pi i turn node), shape (turns, NODES)."""
    return np.exp(2j * np.pi * np.multiply.outer(np.arange(turns), gauss_nodes(NODES)[0]))


def _tail(densities: FloatArray, width: float, k: float) -> FloatArray:
    """int_k^inf phi_i^ phi_j^ dk from derivatives at the edge, for whole a and k a multiple of 2 pi.

    phi^ = sin(ka) (phi/k - phi''/k^3 + phi''''/k^5) + cos(ka) (phi'/k^2 - phi'''/k^4) + ...
    So sin(2ka) = 0 and cos(2ka) = 1 at the end; of what swings, orders beyond k^-3 are left out.
    """
    a = width * densities.shape[1]
    p0, p1, p2, p3, p4 = _edge_derivatives(densities, width, 4)
    steady = _pair(p0, p0) / k + (_pair(p1, p1) - 2 * _pair(p0, p2)) / (3 * k**3)
    steady += (_pair(p2, p2) + 2 * _pair(p0, p4) - 2 * _pair(p1, p3)) / (5 * k**5)
    swinging = _pair(p0, p1) / (a * k**3) - _pair(p0, p0) / (2 * a**2 * k**3)
    tail: FloatArray = (steady + swinging) / 2
    return tail


def tail_left_out(density: FloatArray, width: float) -> float:
    """Bound of what `_tail` leaves out of the energy of one density.

    Twice the orders that follow, k^-5 of what swings and k^-7 of the rest: each further one is smaller again.

    Args:
        density: Values at the panels' Gauss nodes, shape (panels, nodes).
        width: Width of the panels, in layer thicknesses.
    """
    a, k = width * len(density), 2 * np.pi * _whole_turns()
    p0, p1, p2, p3, p4, p5, p6 = _edge_derivatives(density[None], width, 6)[:, 0]
    swinging = (p0 * p3 + p1 * p2) / (a * k**5)
    steady = (p3**2 + 2 * (p1 * p5 - p2 * p4 - p0 * p6)) / (7 * k**7)
    return 2 * float(abs(swinging) + abs(steady)) / np.pi


def _whole_turns() -> int:
    """Whole periods 2 pi of k up to `LARGEST_WAVENUMBER`."""
    return int(np.ceil(LARGEST_WAVENUMBER / (2 * np.pi)))


def _edge_derivatives(densities: FloatArray, width: float, orders: int) -> FloatArray:
    """Derivatives of each density at the edge, from itself to the highest order, shape (orders + 1, densities)."""
    derivatives = [densities[:, -1] @ chebyshev_from_nodes(densities.shape[2]).T]
    for _ in range(orders):
        derivatives.append(np.asarray(chebyshev.chebder(derivatives[-1], axis=1), dtype=np.float64))
    # Every Chebyshev polynomial is 1 at the edge.
    return np.array([(2 / width) ** n * derivative.sum(axis=1) for n, derivative in enumerate(derivatives)])


def _pair(left: FloatArray, right: FloatArray) -> FloatArray:
    """Symmetrised outer product."""
    product: FloatArray = np.multiply.outer(left, right)
    return (product + product.T) / 2
