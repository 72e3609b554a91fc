"""Studies beside the cases: stress tests, advice, a requested accuracy, sweeps, fits with uncertain inputs.

Enters: methods and scenes. Leaves: records of `cases.studies`, or answers. `suites` lists what a whole suite adds.
"""
