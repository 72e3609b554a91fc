"""chi of a stack from one linear system for the Papkovich-Neuber constants of all layers, in 120 digits."""

from __future__ import annotations

import mpmath as mp


def fields(k, nu, G, z, h):
    """Rows U, W, Q, P for the four constants of a layer; f = exp(-kz) or exp(k(z - h)), for phi_3 and for phi_0."""
    down, up = mp.e ** (-k * z), mp.e ** (k * (z - h))
    columns = []
    for f, df in ((down, -k * down), (up, k * up)):
        ddf = k * k * f
        # Of phi_3 = f, then of phi_0 = f.
        columns.append(
            (
                k * z * f / (2 * G),
                ((3 - 4 * nu) * f - z * df) / (2 * G),
                k * ((1 - 2 * nu) * f - z * df),
                -(2 * (1 - nu) * df - z * ddf),
            )
        )
        columns.append((k * f / (2 * G), -df / (2 * G), -k * df, ddf))
    return [list(row) for row in zip(*columns, strict=True)]


def chi(k, sheets, base, digits=120):
    """From (thickness, E, nu, slips below) of each layer and (E, nu) of an elastic base, or None for a rigid one."""
    with mp.workdps(digits):
        k = mp.mpf(k)
        sheets = [(mp.mpf(h), mp.mpf(E) / (2 * (1 + mp.mpf(nu))), mp.mpf(nu), slips) for h, E, nu, slips in sheets]
        size = 4 * len(sheets) + (2 if base else 0)
        rows, right = [], []

        def row(entries, value=0):
            full = [mp.mpf(0)] * size
            for start, part in entries:
                full[start : start + len(part)] = part
            rows.append(full)
            right.append(mp.mpf(value))

        h, G, nu, _ = sheets[0]
        top = fields(k, nu, G, mp.mpf(0), h)
        row([(0, top[2])])
        row([(0, top[3])], 1)
        for i, (h, G, nu, slips) in enumerate(sheets):
            low = fields(k, nu, G, h, h)
            if i + 1 < len(sheets):
                H, g, mu, _ = sheets[i + 1]
                below = fields(k, mu, g, mp.mpf(0), H)
            elif base:
                mu = mp.mpf(base[1])
                g = mp.mpf(base[0]) / (2 * (1 + mu))
                below = [part[:2] for part in fields(k, mu, g, mp.mpf(0), mp.mpf(1))]
            else:
                row([(4 * i, low[2] if slips else low[0])])
                row([(4 * i, low[1])])
                continue
            negative = [[-x for x in part] for part in below]
            pairs = [(low[1], negative[1]), (low[3], negative[3])]
            pairs += [(low[2], None), (None, below[2])] if slips else [(low[0], negative[0]), (low[2], negative[2])]
            for one, other in pairs:
                entries = [(4 * i, one)] if one else []
                entries += [(4 * i + 4, other)] if other else []
                row(entries)
        constants = mp.lu_solve(mp.matrix(rows), mp.matrix(right))
        W = sum(c * entry for c, entry in zip(constants[:4], top[1], strict=True))
        h, G, nu, _ = sheets[0]
        return k * 2 * G / (1 - nu) / 2 * W
