"""Accepted numbers, the gate that compares a run with them, and the only way to change them.

- ``records``: what is accepted, one file a case and method
- ``gate``: every number and counter of a run against its record; missing and extra ones fail by name
- ``spread``: how far a number moves when its inputs move by one unit in the last place
- ``accept``: the only writer, with its refusals; ``history``: who accepted what and why
- ``against``: another revision and this one, timed alternately
"""
