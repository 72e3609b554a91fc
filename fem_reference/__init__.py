"""fem_reference"""
