"""The folder of a run: atomic files, a lock, and the schema of their contents."""
