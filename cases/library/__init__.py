"""The cases: one file each, a short paper that is also a test."""
