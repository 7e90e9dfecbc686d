import androidx.camera.core.ImageAnalysis
import androidx.camera.core.ImageProxy
import org.mien.FaceResult
import org.mien.Image
import org.mien.Tracker

/** For CameraX: ImageAnalysis.Builder().setBackpressureStrategy(STRATEGY_KEEP_ONLY_LATEST), front camera, YUV_420_888. */
class FaceAnalyzer(private val tracker: Tracker, private val show: (FaceResult) -> Unit) : ImageAnalysis.Analyzer {
    override fun analyze(proxy: ImageProxy) = proxy.use {
        val image = Image.yuv420(
            it.width, it.height,
            it.planes.map { plane -> plane.buffer }.toTypedArray(),
            it.planes.map { plane -> plane.rowStride }.toIntArray(),
            it.planes[1].pixelStride,
        ).rotated(it.imageInfo.rotationDegrees)
        show(tracker.track(image, it.imageInfo.timestamp))
    }
}
