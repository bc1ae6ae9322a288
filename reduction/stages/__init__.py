"""The stages of a reduction: arrays in, arrays out."""
