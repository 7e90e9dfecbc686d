"""Converts ONNX files to weight files of mien (docs/convert.md), and writes weight files."""
