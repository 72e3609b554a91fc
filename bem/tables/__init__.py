"""Tables of flat-punch data: made on the grid, kept in files, read between their rows.

Enters: grid settings or a file. Leaves: the interface of `bem.layer_equation.protocol`, with the table's own stated
errors. Read `table` first.
"""
