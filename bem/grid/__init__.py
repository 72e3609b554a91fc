"""Contact on a square grid: FFT operator, conjugate gradients, contact edge, Eqs. (26)-(32).

Enters: a layer, a gap on cell centres and a load. Leaves: pressures of the cells, the contact's radius, and flat-
punch data of a calibrated disc. Read `operators` first.
"""
