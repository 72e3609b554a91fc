"""The interior of the layer in one equilibrium: fields at any point with a stated error, and files for ParaView.

Enters: solutions of several degrees on one mesh. Leaves: continuous fields and their errors. Read `section` first, then
`interior`.
"""
