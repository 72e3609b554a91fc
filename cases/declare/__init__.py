"""The table of methods with their settings and shared inputs, uncertain inputs of scenes, and the list of cases."""
