"""What each command does; `reports.command_line` declares them and imports these modules only when they are called."""
