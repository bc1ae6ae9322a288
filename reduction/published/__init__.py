"""Every printed number of the five reports, as printed and as corrected."""
