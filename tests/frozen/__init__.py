"""Answers of earlier code to random scenes, which today's code must reproduce within both stated errors."""
