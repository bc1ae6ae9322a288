"""Which archives this version understands: apart from the schema, whose rows import every stage."""

from __future__ import annotations

SCHEMA_VERSION = "1"
"""Changes when a name, dimension or meaning changes; additions leave it as it is."""
