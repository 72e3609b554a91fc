"""The case registry and the engine around it: what is claimed, how far methods agree, what accuracy costs.

- ``library``: the cases, one file each
- ``declare``, ``claims``: how a case is written, what it may claim, who solves it
- ``run``: carrying it out, once, anywhere, without loss; and judging what came out
- ``rules``, ``convergence``: the tests behind a verdict
- ``results``: the records of a run, how a check can end, the files
- ``gate``, ``race``: numbers and times against accepted ones
- ``cost``, ``ladders``, ``campaigns``: what accuracy costs, where methods break, whether stated errors hold
- ``evidence``, ``advice``: settings from measurements, and what a scene needs
- ``figures``: the figures of the paper
"""
