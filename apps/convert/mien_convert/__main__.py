"""python3 -m mien_convert MODEL.onnx -o MODEL.mien"""
from .onnx_to_mien import main

main()
