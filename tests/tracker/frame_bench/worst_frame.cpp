// Measures the slowest frames while a face is tracked, disappears and returns. Prints a line of
// Markdown for each level.
// usage: mien_worst_frame MODELS FRAMES WIDTH HEIGHT [ROUNDS]
// FRAMES: raw NV12 of video range with a face on every frame. The face is visible for 240 frames
// and hidden for 60 in turn: then the image is upside down, which is as expensive for detection.
// The minimum of several replays counts for each frame, because the tracker does the same work each
// time and other programs on the machine do not.
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <memory>
#include <mien/mien.hpp>
#include <string>
#include <vector>

namespace {

constexpr std::int64_t kFrameNs = 33'333'333;
constexpr int kShown = 240;
constexpr int kHidden = 60;
constexpr int kReplays = 5;

// A file in memory aligned for weights.
class File {
 public:
  explicit File(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    const std::vector<char> bytes((std::istreambuf_iterator<char>(file)), {});
    memory_.resize(bytes.size() + MIEN_ALIGNMENT);
    void* begin = memory_.data();
    std::size_t memory = memory_.size();
    std::memcpy(std::align(MIEN_ALIGNMENT, bytes.size(), begin, memory), bytes.data(),
                bytes.size());
    bytes_ = {static_cast<const std::byte*>(begin), bytes.size()};
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  [[nodiscard]] std::span<const std::byte> span() const { return bytes_; }

 private:
  std::vector<char> memory_;
  std::span<const std::byte> bytes_;
};

// CPU time of the thread, which does not include other programs.
double processor_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) * 1e6 + static_cast<double>(now.tv_nsec) * 1e-3;
}

double percentile(std::vector<double> values, double share) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

mien_image picture(const File& clip, std::size_t frame, int width, int height, bool hidden) {
  const auto* luma = reinterpret_cast<const unsigned char*>(clip.span().data()) +
                     frame * static_cast<std::size_t>(width * height * 3 / 2);
  mien_image image;
  mien_image_default(&image);
  image.format = MIEN_IMAGE_NV12;
  image.full_range = 0;
  image.width = width;
  image.height = height;
  image.planes[0] = luma + (hidden ? (height - 1) * width : 0);
  image.planes[1] = luma + width * height + (hidden ? (height / 2 - 1) * width : 0);
  image.row_stride_bytes[0] = image.row_stride_bytes[1] = hidden ? -width : width;
  return image;
}

struct Times {
  std::vector<double> all_us;
  std::vector<double> found_after;  // frames
};

Times run(mien::Tracker& tracker, const File& clip, int width, int height, int rounds) {
  const std::size_t frames = clip.span().size() / static_cast<std::size_t>(width * height * 3 / 2);
  Times times;
  mien::Result result;
  int missed = 0;
  for (int i = 0; i < rounds * (kShown + kHidden); ++i) {
    const bool hidden = i % (kShown + kHidden) >= kShown;
    const mien_image image =
        picture(clip, static_cast<std::size_t>(i) % frames, width, height, hidden);
    const double began_us = processor_us();
    const mien_status pushed = tracker.push_video(image, i * kFrameNs);
    const double spent_us = processor_us() - began_us;
    if (pushed != MIEN_OK || tracker.get_result(result) != MIEN_OK) {
      std::abort();
    }
    if (i > 0) {  // the first runs a whole detection
      times.all_us.push_back(spent_us);
    }
    missed = hidden || result.has_face() ? missed : missed + 1;
    if (!hidden && (result.flags & MIEN_RESULT_FOUND) != 0) {
      times.found_after.push_back(missed + 1);
      missed = 0;
    }
  }
  return times;
}

Times min_of_replays(mien::Tracker& tracker, const File& clip, int width, int height, int rounds) {
  Times min = run(tracker, clip, width, height, rounds);
  for (int replay = 1; replay < kReplays; ++replay) {
    (void)tracker.reset();
    const std::vector<double> again = run(tracker, clip, width, height, rounds).all_us;
    std::transform(again.begin(), again.end(), min.all_us.begin(), min.all_us.begin(),
                   [](double a, double b) { return std::min(a, b); });
  }
  return min;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "usage: mien_worst_frame MODELS FRAMES WIDTH HEIGHT [ROUNDS]\n");
    return 2;
  }
  const mien::LoadedWeights loaded = mien::load_weights(argv[1]);
  if (!loaded) {
    std::fprintf(stderr, "mien_worst_frame: %s\n", loaded.message.c_str());
    return 1;
  }
  const File clip(argv[2]);
  const int width = std::atoi(argv[3]), height = std::atoi(argv[4]);
  std::printf(
      "| level | median, us | p99 | p99.9 | largest | p99.9 of the median | frames until found "
      "again, mean | "
      "most |\n|---|---|---|---|---|---|---|---|\n");
  for (int level = 1; level <= 4; ++level) {
    mien::Config config(loaded.weights);
    config.audio = 0;
    config.lod = level;
    mien::Tracker tracker;
    if (tracker.create(config) != MIEN_OK) {
      return 1;
    }
    const Times times =
        min_of_replays(tracker, clip, width, height, argc > 5 ? std::atoi(argv[5]) : 20);
    double sum = 0.0;
    for (const double frames : times.found_after) {
      sum += frames;
    }
    const double median = percentile(times.all_us, 0.5), tail = percentile(times.all_us, 0.999);
    std::printf("| %d | %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %.0f |\n", level, median,
                percentile(times.all_us, 0.99), tail, percentile(times.all_us, 1.0), tail / median,
                sum / static_cast<double>(times.found_after.size()),
                percentile(times.found_after, 1.0));
  }
  return 0;
}
