"""What people and continuous integration see; computes nothing."""
