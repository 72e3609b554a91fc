"""Many depths or forces on one scene, from contacts solved at a few radii."""
