"""The folder of a run: files that appear whole, one run at a time, and what they must hold."""
