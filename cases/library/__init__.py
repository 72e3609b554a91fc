"""cases/library"""
