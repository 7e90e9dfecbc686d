// usage: main MODELS_DIR; succeeds if a tracker made of these weights finds no face in black.
#include <mien/engine.h>
#include <mien/mien.hpp>

#include <fstream>
#include <string>
#include <vector>

// A file in aligned memory, filled up with zeros.
struct alignas(MIEN_ALIGNMENT) Line {
  char bytes[MIEN_ALIGNMENT];
};
struct Weights {
  explicit Weights(const std::string& path) {
    std::ifstream file(path, std::ios::binary | std::ios::ate);
    bytes = static_cast<std::size_t>(file.tellg());
    lines.resize(bytes / sizeof(Line) + 1);
    file.seekg(0).read(lines.front().bytes, static_cast<std::streamsize>(bytes));
  }
  std::span<const std::byte> span() const { return std::as_bytes(std::span(lines)).first(bytes); }
  std::size_t bytes = 0;
  std::vector<Line> lines;
};

int main(int argc, char** argv) {
  const std::string models = argc == 2 ? argv[1] : "";
  const Weights basenet(models + "/basenet.mien"), proposal(models + "/proposal.mien");
  mien::WeightFile file;
  mien::Tracker tracker;
  if (file.open(basenet.span()) != mien::EngineStatus::kOk ||
      tracker.create(mien::Config(basenet.span(), proposal.span())) != MIEN_OK) {
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
