"""A run: the source in pieces, the tasks in their order, and who performs them."""
