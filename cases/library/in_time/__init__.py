"""Impacts on elastic and relaxing layers."""
