"""What the gate compares, one file each: values, stated uncertainties, counts of work, claims; each is a `check`."""
