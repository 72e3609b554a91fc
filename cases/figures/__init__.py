"""The data behind the figures of the paper, one pure function a file: `figure_03.figure()` and so on."""
