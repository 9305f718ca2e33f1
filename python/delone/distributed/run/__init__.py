"""A run: the pieces of the source, the order of the tasks, and the executors."""
