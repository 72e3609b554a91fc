"""What was accepted stays accepted: baselines, the gate that compares with them, and the only way to change them.

Enters: a judged run, the folder of baselines. Leaves: the run with its regression claims, or new baselines. Read first:

- ``baseline``: what was accepted, on disk
- ``gate``: a run against the baselines, by the checks in ``comparison``; ``ladders``: the same for stability ladders
- ``spread``: how much an answer moves when nothing has changed; it sets the tolerance
- ``accept``: the only writer, from a ``proposal``, with its ``write_permission`` and its ``history``
"""
