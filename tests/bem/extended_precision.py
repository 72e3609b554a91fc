"""Flat punches in extended precision: the layer's equation on panels one thickness wide, by a factorisation of its own.

It shares the kernel chi with the method and nothing else: nodes, sums, factorisation and solution are its own. Where a
platform's extended precision is double precision, it is no better than the method.
"""

import numpy as np

from tests.layer_kernel import one_minus_kernel

LD = np.longdouble
PI = LD("3.14159265358979323846264338327950288")
WAVE_NODES = 32


def rule(count):
    """Gauss nodes and weights on [0, 1]."""
    x = np.polynomial.legendre.leggauss(count)[0].astype(LD)

    def value_and_slope(x):
        before, value = np.ones_like(x), x.copy()
        for k in range(1, count):
            before, value = value, ((2 * k + 1) * x * value - k * before) / (k + 1)
        return value, count * (before - x * value) / ((1 - x) * (1 + x))

    for _ in range(3):
        value, slope = value_and_slope(x)
        x = x - value / slope
    _, slope = value_and_slope(x)
    return (1 + x) / 2, 1 / ((1 - x) * (1 + x) * slope**2)


def kernel(support, poissons_ratio):
    """Rates and weights of N(s) = Re sum w exp(-z s), the ray k = t exp(i 25 degrees)."""
    nodes, weights = rule(WAVE_NODES)
    ends = np.concatenate([[LD(0)], LD(2) ** np.arange(-13, 7)])
    ray = np.exp(np.clongdouble(1j) * (LD(25) * PI / 180))
    k = ray * (ends[:-1, None] + np.diff(ends)[:, None] * nodes).ravel()
    dk = ray * (np.diff(ends)[:, None] * weights).ravel()
    return -1j * k, one_minus_kernel(k, support, poissons_ratio) * dk


def contact_stiffness(support, poissons_ratio, panels, count=14):
    """k_bar at a/h = 1, 2 .. panels."""
    x, w = rule(count)
    rates, weights = kernel(support, poissons_ratio)
    root = np.sqrt(w)

    def transformed(distance):
        return (np.exp(-np.multiply.outer(distance, rates)) @ weights).real

    differences = [transformed(abs(x[:, None] - x))] + [transformed(b + x[:, None] - x) for b in range(1, panels)]
    sums = [transformed(b + x[:, None] + x) for b in range(2 * panels - 1)]
    lower, z, found = np.zeros((panels * count, panels * count), LD), np.zeros(panels * count, LD), []
    for p in range(panels):
        own = slice(p * count, (p + 1) * count)
        for q in range(p + 1):
            earlier = slice(q * count, (q + 1) * count)
            block = -root[:, None] * (differences[p - q] + sums[p + q]) / PI * root
            block -= lower[own, : q * count] @ lower[earlier, : q * count].T
            if q < p:
                lower[own, earlier] = _solved(lower[earlier, earlier], block.T).T
            else:
                lower[own, own] = _cholesky(block + np.eye(count, dtype=LD))
        z[own] = _solved(lower[own, own], (root - lower[own, : p * count] @ z[: p * count])[:, None])[:, 0]
        found.append(z[: own.stop] @ z[: own.stop] / (p + 1))
    return np.array(found)


def _cholesky(matrix):
    lower = np.zeros_like(matrix)
    for j in range(len(matrix)):
        lower[j, j] = np.sqrt(matrix[j, j] - lower[j, :j] @ lower[j, :j])
        lower[j + 1 :, j] = (matrix[j + 1 :, j] - lower[j + 1 :, :j] @ lower[j, :j]) / lower[j, j]
    return lower


def _solved(lower, right):
    solution = np.zeros_like(right)
    for j in range(len(lower)):
        solution[j] = (right[j] - lower[j, :j] @ solution[:j]) / lower[j, j]
    return solution


def flat_punch_pressure(support, poissons_ratio, ratio, rho, count=16):
    """p a/(E* delta) at r = rho a under a flat punch of radius a = ratio h, on panels of up to 3/4 of a thickness."""
    ratio = LD(ratio)
    panels, (tau, omega) = int(np.ceil(float(ratio) / 0.75)), rule(count)
    width = ratio / panels
    x, root = ((np.arange(panels)[:, None] + tau) * width).ravel(), np.sqrt(np.tile(omega * width, panels))
    rates, weights = kernel(support, poissons_ratio)

    def transformed(distance):
        return (np.exp(-np.multiply.outer(distance, rates)) @ weights).real

    differences = [transformed(width * abs(b + tau[:, None] - tau)) for b in range(panels)]
    sums = [transformed(width * (b + tau[:, None] + tau)) for b in range(2 * panels - 1)]
    K = np.block(
        [
            [(differences[p - q] if p >= q else differences[q - p].T) + sums[p + q] for q in range(panels)]
            for p in range(panels)
        ]
    )
    lower = _cholesky(np.eye(x.size, dtype=LD) - root[:, None] * K / PI * root)
    z = _solved(lower, root[:, None])
    # The factor turned by half a circle is that of the transposed system.
    phi = _solved(lower.T[::-1, ::-1], z[::-1])[::-1, 0] / root
    edge = 1 + ((transformed(ratio - x) + transformed(ratio + x)) / PI) @ (root**2 * phi)
    polynomials, _ = _legendre(count, 2 * tau - 1)
    orders = ((phi - 1).reshape(panels, count) * omega) @ polynomials.T * (2 * np.arange(count) + 1)
    found = [edge / np.sqrt((1 - r) * (1 + r)) - ratio * _abel(orders, width, r * ratio, tau, omega) for r in rho]
    return np.array(found) / PI


def _abel(orders, width, r, tau, omega):
    """int psi'(t)/sqrt(t^2 - r^2) dt of Legendre series on equal panels, over t^2 = r^2 + s^2 panel by panel."""
    total = LD(0)
    for panel in range(int(float(r / width)), len(orders)):
        low, high = (np.sqrt((t - r) * (t + r)) for t in (max(panel * width, r), (panel + 1) * width))
        for part in range(2):
            t = np.sqrt(r**2 + (low + (high - low) * (part + tau) / 2) ** 2)
            _, slopes = _legendre(len(tau), 2 * (t / width - panel) - 1)
            total += (high - low) / 2 * omega @ (orders[panel] @ slopes * 2 / width / t)
    return total


def _legendre(count, x):
    """P_n(x) and P_n'(x) for n < count."""
    values, slopes = [np.ones_like(x), x], [np.zeros_like(x), np.ones_like(x)]
    for n in range(1, count - 1):
        values.append(((2 * n + 1) * x * values[n] - n * values[n - 1]) / (n + 1))
        slopes.append(slopes[n - 1] + (2 * n + 1) * values[n])
    return np.array(values), np.array(slopes)
