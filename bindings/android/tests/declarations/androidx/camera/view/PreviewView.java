package androidx.camera.view;

import android.content.Context;
import android.view.View;
import androidx.camera.core.Preview;

public final class PreviewView extends View {
    public PreviewView(Context context) {}

    public Preview.SurfaceProvider getSurfaceProvider() {
        return null;
    }
}
