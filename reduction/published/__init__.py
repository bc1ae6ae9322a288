"""Printed numbers of the five reports, and their recomputation."""
