// usage: main MODELS_DIR; succeeds if a tracker with these weights detects no face in a black
// image.
#include <mien/engine.h>
#include <mien/mien.hpp>

#include <vector>

int main(int argc, char** argv) {
  const mien::LoadedWeights loaded = mien::load_weights(argc == 2 ? argv[1] : "");
  mien::Tracker tracker;
  if (!loaded || mien::WeightsContent(loaded.weights).network_count() == 0 ||
      tracker.create(mien::Config(loaded.weights)) != MIEN_OK) {
    return 1;
  }
  const std::vector<unsigned char> black(64 * 64);
  mien::Image image;
  image.format = MIEN_IMAGE_GRAY8;
  image.width = image.height = image.row_stride_bytes[0] = 64;
  image.planes[0] = black.data();
  mien::Result result;
  return tracker.push_video(image, 0) == MIEN_OK && tracker.get_result(result) == MIEN_OK &&
                 result.frames == 1 && !result.has_face()
             ? 0
             : 2;
}
