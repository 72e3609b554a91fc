"""The case registry and the engine around it: what is claimed, how far methods agree, what accuracy costs.

- ``results``, ``status``: the records of a run and how a check can end
"""
