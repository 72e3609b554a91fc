"""Reference numbers of the library of cases, from formulas in extended precision.

- ``layer_equation``: flat punches and profiles on layers, `mpmath`
- ``sphere_impact``: the springs of Fig. 12 in time, `mpmath`
- ``table``: list of all numbers; ``python -m benchmarks.references.table`` computes them

Cases read `reference_numbers.toml` of their library only, so that a run needs no `mpmath`; nightly tests compute every
number again.
"""
