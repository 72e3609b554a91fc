"""The method of dimensionality reduction."""
