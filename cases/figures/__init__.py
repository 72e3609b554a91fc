"""The paper's figures as pure functions: `figure_08.figure()` computes all numbers of Fig. 8, ink not included.

Curves are dense, each with its method and an error band; the caption says where the paper's statement is looser than
the numbers. Ranges are those of the paper's text, since its axes are printed as pictures.
"""
