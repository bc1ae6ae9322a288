"""One function a figure: an archive in, plain plotly dictionaries out."""
