"""How a comparison of numbers is judged: pure functions, one rule a file.

- ``judgement``: the end of a comparison, and the worst of several
- ``exact``, ``agreement``, ``order``, ``invariant``, ``regression``
"""
