"""Fields inside the body at single points, against formulas of their own.

- ``referee``: both parts of the fields at a point, in extended precision
- ``layer``: what a layer adds to a half-space, by elimination at every wavenumber
- ``campaign``: random scenes with points close to rims, edges, interfaces and the axis, each judged alone
"""
