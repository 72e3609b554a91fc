"""Effects beyond elastic contact, one file each; a file is loaded only when a scene asks for its effect."""
