"""Pictures of synthetic heads: a small CPU rasterizer and what it draws."""
