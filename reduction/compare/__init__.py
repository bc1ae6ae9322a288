"""A measured hose curve against its prediction, and the calibration of named parameters."""
