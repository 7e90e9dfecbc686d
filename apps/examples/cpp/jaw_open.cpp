// Prints how far the mouth of the face in an image is open, 0 to 1.
//
// usage: jaw_open MODELS IMAGE.ppm
//   MODELS: the folder with basenet.mien and proposal.mien
//   IMAGE.ppm: created by, for example, ffmpeg -i face.jpg face.ppm
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <mien/mien.hpp>
#include <string>
#include <vector>

namespace {

// Reads a binary PPM of 8 bits. The image refers to `pixels`, which are empty on error.
mien::Image read_image(const char* path, std::vector<char>& pixels) {
  mien::Image image;
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  int maximum = 0;
  file >> magic >> image.width >> image.height >> maximum;
  file.get();
  if (!file || magic != "P6" || maximum != 255 || image.width <= 0 || image.width > 16384 ||
      image.height <= 0 || image.height > 16384) {
    return image;
  }
  pixels.resize(static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height) * 3);
  if (!file.read(pixels.data(), static_cast<std::streamsize>(pixels.size()))) {
    pixels.clear();
  }
  image.format = MIEN_IMAGE_RGB;
  image.planes[0] = pixels.data();
  image.row_stride_bytes[0] = image.width * 3;
  return image;
}

int fail(const std::string& message) {
  std::fprintf(stderr, "jaw_open: %s\n", message.c_str());
  return 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) {
    std::fputs("usage: jaw_open MODELS IMAGE.ppm\n", stderr);
    return 2;
  }
  std::vector<char> pixels;
  const mien::Image image = read_image(argv[2], pixels);
  if (pixels.empty()) {
    return fail(std::string(argv[2]) + ": cannot be read as a binary PPM of 8 bits");
  }
  const mien::LoadedWeights loaded = mien::load_weights(argv[1]);
  if (!loaded) {
    return fail(loaded.message);
  }
  mien::Tracker tracker;
  mien::Error error;
  if (tracker.create(mien::Config(loaded.weights), &error) != MIEN_OK) {
    return fail(error.message());
  }
  mien::Result result;
  mien_status status = tracker.push_video(image, 0);  // a video passes the time of each image
  if (status == MIEN_OK) {
    status = tracker.get_result(result);
  }
  if (status != MIEN_OK) {
    return fail(mien::message(status));
  }
  if (!result.has_face()) {
    std::puts("no face");
    return 0;
  }
  std::printf("jawOpen %.2f\n", static_cast<double>(result.control(MIEN_CONTROL_JAW_OPEN)));
  return 0;
}
