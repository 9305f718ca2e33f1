"""Shared by all modules: arrays, checks of arguments, errors of files, units, immutability."""
