"""Where the methods break: random scenes by the thousand, each answer against another one.

- ``units``: the same scene in another system of units
- ``random_scenes``: seeded scenes over the whole range of every parameter
- ``referee``: the direct integral equation on more nodes, which shares only the layer's kernel with MDR
- ``referee_profiles``: slopes of half-space profiles in closed form, written a second time
- ``campaign``: random scenes against their referee, coverage and sharpness of stated errors
- ``pressures``, ``pressure_referee``: pressure fields against their own referee, their integral and single radii
- ``displacements``: beside contacts, alone and in a list, against the direct integral equation
"""
