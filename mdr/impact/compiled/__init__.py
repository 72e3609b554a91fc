"""The steps of `collocation` in plain loops that numba compiles; the same motions but for roundings."""
