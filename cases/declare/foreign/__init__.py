"""What a case adds for methods of other packages: scenes restated in what they take."""
