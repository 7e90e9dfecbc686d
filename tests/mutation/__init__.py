"""Mutation testing of the library's C++ code: scripts/mutate.sh."""
