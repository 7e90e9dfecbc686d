#!/usr/bin/env python3
"""Quantizes the image encoders of export_onnx.py to 8 bits, with each engine's own tool and its best settings.

usage: quantize.py ENGINE DIR
onnxruntime: static QDQ with a scale for each output; openvino: NNCF; litert: AI Edge Quantizer. Faces of the demo clip
calibrate them. Writes NAME.ENGINE_int8.onnx, .xml or .tflite.
"""
import sys
from pathlib import Path

import numpy as np


def onnxruntime(stem, faces):
    from onnxruntime import quantization as q

    class Faces(q.CalibrationDataReader):
        def __init__(self):
            self.inputs = ({"image": face[None]} for face in faces)

        def get_next(self):
            return next(self.inputs, None)

    cleaned = f"{stem}.cleaned.onnx"
    q.shape_inference.quant_pre_process(f"{stem}.onnx", cleaned, skip_symbolic_shape=True)
    q.quantize_static(cleaned, f"{stem}.onnxruntime_int8.onnx", Faces(), quant_format=q.QuantFormat.QDQ,
                      per_channel=True, activation_type=q.QuantType.QUInt8, weight_type=q.QuantType.QInt8)
    Path(cleaned).unlink()


def openvino(stem, faces):
    import nncf
    import openvino as ov
    model = ov.Core().read_model(f"{stem}.onnx")
    data = nncf.Dataset([face[None] for face in faces])
    ov.save_model(nncf.quantize(model, data, subset_size=len(faces), preset=nncf.QuantizationPreset.MIXED),
                  f"{stem}.openvino_int8.xml", compress_to_fp16=False)


def litert(stem, faces):
    from ai_edge_quantizer import quantizer, recipe
    tool = quantizer.Quantizer(f"{stem}.tflite", recipe.static_wi8_ai8())
    calibration = tool.calibrate({"serving_default": [{"image": face[None].transpose(0, 2, 3, 1)} for face in faces]})
    tool.quantize(calibration).export_model(f"{stem}.litert_int8.tflite", overwrite=True)


def main():
    engine, folder = sys.argv[1], Path(sys.argv[2])
    quantize = {"onnxruntime": onnxruntime, "openvino": openvino, "litert": litert}[engine]
    for faces in sorted(folder.glob("*_encoder.npy")):
        quantize(faces.with_suffix(""), np.load(faces))


if __name__ == "__main__":
    main()
