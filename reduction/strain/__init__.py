"""Stage: crosshead position to strain of the splice-free length; tension to stress."""
