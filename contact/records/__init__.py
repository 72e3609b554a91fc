"""Validated records and the errors that bad input raises.

Input: values of a user. Output: frozen, checked records, or one `InvalidInput` with value, place and remedy. Read
`record` first.
"""
