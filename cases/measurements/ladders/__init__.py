"""Stress tests: one parameter is made harder step by step until a method stops with an error.

`ladders` runs one test by one method, `ladder_table` lists all tests, `ladder_study` runs and judges them.
"""
