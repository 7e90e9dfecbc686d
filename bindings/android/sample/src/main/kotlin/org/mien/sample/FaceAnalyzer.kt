package org.mien.sample

import androidx.camera.core.ImageAnalysis
import androidx.camera.core.ImageProxy
import org.mien.FaceResult
import org.mien.Image
import org.mien.Tracker

/** Tracks the face in each image of CameraX in its default format, YUV_420_888. */
class FaceAnalyzer(private val tracker: Tracker, private val show: (FaceResult) -> Unit) : ImageAnalysis.Analyzer {
    override fun analyze(proxy: ImageProxy) {
        try {
            val image = Image.yuv420(
                proxy.width, proxy.height,
                proxy.planes.map { it.buffer }.toTypedArray(),
                proxy.planes.map { it.rowStride }.toIntArray(),
                proxy.planes[1].pixelStride
            ).rotated(proxy.imageInfo.rotationDegrees)
            show(tracker.track(image, proxy.imageInfo.timestamp))
        } finally {
            proxy.close()
        }
    }
}
