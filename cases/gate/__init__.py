"""What was accepted stays accepted: baselines, the gate that compares with them, and the only way to change them.

Enters: a judged run, the folder of baselines. Leaves: the run with its regression verdicts, or new baselines.
"""
