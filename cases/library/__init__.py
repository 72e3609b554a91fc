"""The cases, one file each; Python walks the folder to find them."""
