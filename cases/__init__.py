"""Cases, claims, runs, baselines: what is verified and how far it holds."""
