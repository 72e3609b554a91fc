"""Detachment cell by cell with the criterion of Pohrt and Popov (2015).

Enters: a pressed grid and a work of adhesion. Leaves: the path along which single cells let go. Read `solver` first.
"""
