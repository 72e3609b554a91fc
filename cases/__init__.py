"""The case registry and the engine around it: what is claimed, how far methods agree, what accuracy costs.

- ``library``: the cases, one file each
- ``case``, ``claims``, ``methods``, ``registry``: how a case is written, what it may claim, who solves it
- ``runner``, ``executors``, ``solve``, ``store``, ``keys``: carrying it out, once, anywhere, without loss
- ``verdicts``, ``rules``, ``norms``, ``tolerance``, ``convergence``, ``work``: judging what came out
- ``results``, ``results_files``, ``status``, ``stamp``: the records of a run and how a check can end
"""
