"""The commands, which `reports.command_line` declares and imports when they are called."""
