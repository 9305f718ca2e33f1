"""Shared by all modules: arrays, argument checks, file errors, units, immutability."""
