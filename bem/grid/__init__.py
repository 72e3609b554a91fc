"""Contact on a square grid: FFT operator, conjugate gradients, contact edge, Eqs. (26)-(32).

Input: a layer, a gap on cell centres and a load. Output: pressures of the cells, contact radius, and flat-punch data of
a calibrated disc. Read `operators` first.
"""
