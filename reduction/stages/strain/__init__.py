"""Position to strain of the splice-free length; load to stress."""
