"""Images of synthetic heads: a small CPU rasterizer and the scene."""
