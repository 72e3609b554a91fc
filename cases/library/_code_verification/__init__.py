"""Whether the finite elements solve their equations: known solutions, stability of element pairs, constant strains.

Enters: what `fem_reference.verification` measures. Leaves: one case of the report, beside those of contacts.

- ``locking``: errors on one mesh as Poisson's ratio goes to one half
- ``finite_elements``: the case
"""
