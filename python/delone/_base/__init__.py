"""What all parts stand on: arrays, checks of arguments, errors of files, units, immutability."""
