"""The table of methods and what is known of them: settings, shared inputs, uncertain inputs; the list of cases."""
