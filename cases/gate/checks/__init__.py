"""A run's numbers beside the accepted ones.

Enters: solutions of a run, accepted records. Leaves: one check for each quantity, counter and stated uncertainty, and a
claim for each accepted claim that is missing. Read `check` first, then `values`, `counts`, `uncertainties`, `claims`.
"""
