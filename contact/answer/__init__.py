"""Answers of methods, and the interface of a method.

Input: arrays that a method computed. Output: a `Solution` with stated errors, stages and cost, used by cases and
reports. Read `solution` first.
"""
