"""Reference numbers of the library: written formulas in extended precision, and the numbers they gave.

- ``layer_equation``: flat punches and profiles on layers, `mpmath`
- ``sphere_impact``: the springs of Fig. 12 in time, `mpmath`
- ``table``: which numbers there are; ``python -m benchmarks.references.table`` computes them all

Cases read `reference_numbers.toml` of their library only, so that a run needs no `mpmath`; nightly tests compute every
number again.
"""
