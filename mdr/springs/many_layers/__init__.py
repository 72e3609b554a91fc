"""Contacts of one indenter with many layers, solved at once."""
