"""CalculiX, a finite element program of others: a graded mesh as a readable deck, run and read back. Read `method`."""
