"""Baselines of accepted numbers, the gate that compares a run with them, and the only writer of new ones.

Input: a judged run and the folder of baselines. Output: the run with regression verdicts, or new baselines.
"""
