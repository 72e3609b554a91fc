"""Scenes and answers in files: TOML, its schema, and HDF5.

Enters: a path or an open file. Leaves: the same records that Python code builds, or one clear error. Read
`scene_file` first.
"""
