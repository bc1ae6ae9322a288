"""Printed numbers again, from other printed numbers or from theory."""
