plugins {
    id("com.android.application") version "8.7.3"
    id("org.jetbrains.kotlin.android") version "2.0.21"
}

android {
    namespace = "org.mien.sample"
    compileSdk = 35
    defaultConfig {
        applicationId = "org.mien.sample"
        minSdk = 28
        targetSdk = 35
    }
    kotlin {
        jvmToolchain(17)
    }
}

dependencies {
    implementation(files("libs/mien.aar"))
    implementation("androidx.activity:activity:1.9.3")
    implementation("androidx.camera:camera-camera2:1.4.0")
    implementation("androidx.camera:camera-lifecycle:1.4.0")
    implementation("androidx.camera:camera-view:1.4.0")
    implementation("androidx.core:core:1.15.0")
}
