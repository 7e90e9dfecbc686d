package org.mien.sample

import android.Manifest
import android.os.Bundle
import android.widget.LinearLayout
import android.widget.TextView
import androidx.activity.ComponentActivity
import androidx.activity.result.contract.ActivityResultContracts
import androidx.camera.core.CameraSelector
import androidx.camera.core.ImageAnalysis
import androidx.camera.core.Preview
import androidx.camera.lifecycle.ProcessCameraProvider
import androidx.camera.view.PreviewView
import androidx.core.content.ContextCompat
import java.util.concurrent.Executors
import org.mien.FaceResult
import org.mien.Tracker
import org.mien.Weights

/** Shows the front camera, and the controls of the face in it. */
class MainActivity : ComponentActivity() {
    private val worker = Executors.newSingleThreadExecutor()
    private val permission = registerForActivityResult(ActivityResultContracts.RequestPermission()) { granted ->
        if (granted) startCamera() else values.text = "Allow this app to use the camera, in the settings of Android."
    }
    private lateinit var weights: Weights
    private lateinit var tracker: Tracker
    private lateinit var preview: PreviewView
    private lateinit var values: TextView

    override fun onCreate(state: Bundle?) {
        super.onCreate(state)
        preview = PreviewView(this)
        values = TextView(this)
        setContentView(LinearLayout(this).apply {
            orientation = LinearLayout.VERTICAL
            addView(values)
            addView(preview)
        })
        weights = Weights.read(assets.open("mien/basenet.mien"), assets.open("mien/proposal.mien"))  // in mien.aar
        tracker = Tracker(weights, Tracker.Options())
    }

    override fun onStart() {
        super.onStart()
        permission.launch(Manifest.permission.CAMERA)
    }

    override fun onDestroy() {
        worker.execute {  // after the last image
            tracker.close()
            weights.close()
        }
        worker.shutdown()
        super.onDestroy()
    }

    private fun startCamera() {
        val provider = ProcessCameraProvider.getInstance(this)
        provider.addListener(Runnable {
            val images = ImageAnalysis.Builder().setBackpressureStrategy(ImageAnalysis.STRATEGY_KEEP_ONLY_LATEST).build()
            images.setAnalyzer(worker, FaceAnalyzer(tracker) { face -> runOnUiThread { show(face) } })
            val seen = Preview.Builder().build()
            seen.setSurfaceProvider(preview.surfaceProvider)
            provider.get().unbindAll()
            provider.get().bindToLifecycle(this, CameraSelector.DEFAULT_FRONT_CAMERA, seen, images)
        }, ContextCompat.getMainExecutor(this))
    }

    private fun show(face: FaceResult) {
        values.text = if (face.hasFace()) SHOWN.joinToString("\n") { "%.2f %s".format(face.controls().get(it), it) } else "No face."
    }

    private companion object {
        val SHOWN = listOf("jawOpen", "eyeBlinkLeft", "eyeBlinkRight", "mouthSmileLeft", "mouthSmileRight", "mouthPucker")
    }
}
