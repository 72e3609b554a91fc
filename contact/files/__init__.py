"""Scenes and answers in files: TOML, its schema, and HDF5.

Input: a path or an open file. Output: the same records that Python code builds, or one error with a remedy. Read
`scene_file` first.
"""
