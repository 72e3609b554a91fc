"""Adhesive contact and detachment."""
