"""Running cases: tasks, executors, stored answers, judgement.

Enters: selected cases. Leaves: solved tasks and judged claims. Read `runner` first.
"""
