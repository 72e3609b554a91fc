"""Problems that need no other method: whether elements solve their equations at their orders, and are stable.

- ``manufactured``: solutions made up beforehand, and the errors that an element pair makes of them
- ``inf_sup``: how well displacements control the pressure, measured
"""
