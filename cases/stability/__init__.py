"""Where the methods break: hard parameters walked in steps, random scenes by the thousand, hostile input.

- ``units``: the same scene in another system of units
- ``random_scenes``: seeded scenes over the whole range of every parameter
- ``hostile``: seeded input that nobody should trust
"""
