"""Where the methods break: random scenes by the thousand, each answer against one that shares no code with it.

- ``units``: the same scene in another system of units
- ``random_scenes``: seeded scenes over the whole range of every parameter
- ``referee``, ``referee_profiles``: an answer to elastic scenes that shares no code with any method
- ``campaign``: random scenes against their referee, coverage and sharpness of stated errors
- ``pressures``, ``pressure_referee``: pressure fields against their own referee, their integral and single radii
"""
