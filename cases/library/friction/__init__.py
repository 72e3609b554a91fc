"""Contact with friction: what sticks instead of slipping."""
