"""Closed surfaces and the tetrahedra inside them: checked, filled, improved and refined."""
