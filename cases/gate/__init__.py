"""What was accepted stays accepted: baselines, the gate that compares with them, and the only way to change them.

- ``baseline``: what was accepted, on disk; ``specification``: whether it is the same question
- ``gate``: a run against the baselines, by the ``checks`` of values, uncertainties, counts and claims
- ``spread``: how much an answer moves when nothing has changed; it sets the tolerance
- ``accept``: the only writer, from a ``proposal`` under ``circumstances``, with its ``history``
- ``race``: is this version slower than another? ``against`` a revision in its ``worktree``, timed by ``stopwatch``
"""
