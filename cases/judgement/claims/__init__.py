"""What a case may claim; each kind says which tasks it needs and judges their answers.

- ``declared``: what every claim states: tolerance, reason, origin of the expected number
- ``exact``, ``agreement``, ``field_agreement``, ``order``, ``twin``, ``residual``
"""
