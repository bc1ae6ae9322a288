"""Tangent, secant and chord moduli, segments, slips, elastomer laws."""
