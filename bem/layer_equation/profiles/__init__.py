"""MDR profiles of a layer, g, from a half-space profile g_hs and what solves the layer's equation.

Enters: g_hs on a grid and flat-punch data. Leaves: g on the same grid. Read `edge_values` first, any layer; then
`thin_layers`, contacts more than 160 times as wide as the layer is thick; `half_space_slope` is
the slope of g_hs in closed form.
"""
