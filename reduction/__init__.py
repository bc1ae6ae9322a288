"""Reduction of cyclic tension tests on compliant mooring elements."""

__version__ = "0.1.0"
