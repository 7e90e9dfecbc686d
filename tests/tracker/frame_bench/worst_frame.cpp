// Measures the slowest frames while a face is tracked, disappears and returns. Prints a line of
// Markdown for each level.
// usage: mien_worst_frame MODELS FRAMES WIDTH HEIGHT [ROUNDS]
// FRAMES: raw NV12 of video range with a face on every frame. The face is visible for 240 frames
// and hidden for 60, alternately: hidden means that the blocks of the image are shuffled, so that
// detection finds parts of faces everywhere, which is expensive.
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

double percentile(std::vector<double> values, double fraction) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(fraction * static_cast<double>(values.size() - 1))];
}

constexpr std::size_t kBlock = 32;  // pixels
constexpr std::size_t kStep = 37;   // coprime to the number of blocks

// Shuffles the blocks of a plane; incomplete blocks stay.
void exchange_blocks(const unsigned char* from, std::size_t row_bytes, std::size_t rows,
                     std::size_t block_rows, unsigned char* to) {
  std::copy_n(from, row_bytes * rows, to);
  const std::size_t columns = row_bytes / kBlock, count = columns * (rows / block_rows);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t source = i * kStep % count;
    for (std::size_t y = 0; y < block_rows; ++y) {
      std::copy_n(
          from + (source / columns * block_rows + y) * row_bytes + source % columns * kBlock,
          kBlock, to + (i / columns * block_rows + y) * row_bytes + i % columns * kBlock);
    }
  }
}

class Pictures {
 public:
  Pictures(const File& clip, std::size_t width, std::size_t height)
      : clip_(clip), width_(width), height_(height), hidden_(width * height * 3 / 2) {}

  [[nodiscard]] std::size_t count() const { return clip_.span().size() / hidden_.size(); }

  // Valid until the next call.
  mien_image picture(std::size_t frame, bool hidden) {
    const auto* luma = reinterpret_cast<const unsigned char*>(clip_.span().data()) +
                       frame % count() * hidden_.size();
    if (hidden) {
      exchange_blocks(luma, width_, height_, kBlock, hidden_.data());
      exchange_blocks(luma + width_ * height_, width_, height_ / 2, kBlock / 2,
                      hidden_.data() + width_ * height_);
      luma = hidden_.data();
    }
    mien_image image;
    mien_image_default(&image);
    image.format = MIEN_IMAGE_NV12;
    image.full_range = 0;
    image.width = static_cast<std::int32_t>(width_);
    image.height = static_cast<std::int32_t>(height_);
    image.planes[0] = luma;
    image.planes[1] = luma + width_ * height_;
    image.row_stride_bytes[0] = image.row_stride_bytes[1] = image.width;
    return image;
  }

 private:
  const File& clip_;
  std::size_t width_, height_;
  std::vector<unsigned char> hidden_;
};

struct Times {
  std::vector<double> all_us;
  std::vector<bool> searched;       // the frame had no face
  std::vector<double> found_after;  // frames
};

double median_of_searched(const Times& times) {
  std::vector<double> searched;
  for (std::size_t i = 0; i < times.all_us.size(); ++i) {
    if (times.searched[i]) {
      searched.push_back(times.all_us[i]);
    }
  }
  return percentile(searched, 0.5);
}

Times run(mien::Tracker& tracker, Pictures& pictures, int rounds) {
  Times times;
  mien::Result result;
  int missed = 0;
  for (int i = 0; i < rounds * (kShown + kHidden); ++i) {
    const bool hidden = i % (kShown + kHidden) >= kShown;
    const mien_image image = pictures.picture(static_cast<std::size_t>(i), hidden);
    const double began_us = processor_us();
    const mien_status pushed = tracker.push_video(image, i * kFrameNs);
    const double spent_us = processor_us() - began_us;
    if (pushed != MIEN_OK || tracker.get_result(result) != MIEN_OK) {
      std::abort();
    }
    if (i > 0) {  // the first runs a whole detection
      times.all_us.push_back(spent_us);
      times.searched.push_back(!result.has_face());
    }
    missed = hidden || result.has_face() ? missed : missed + 1;
    if (!hidden && (result.flags & MIEN_RESULT_FOUND) != 0) {
      times.found_after.push_back(missed + 1);
      missed = 0;
    }
  }
  return times;
}

Times min_of_replays(mien::Tracker& tracker, Pictures& pictures, int rounds) {
  Times min = run(tracker, pictures, rounds);
  for (int replay = 1; replay < kReplays; ++replay) {
    (void)tracker.reset();
    const std::vector<double> again = run(tracker, pictures, rounds).all_us;
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
  Pictures pictures(clip, static_cast<std::size_t>(std::atoi(argv[3])),
                    static_cast<std::size_t>(std::atoi(argv[4])));
  std::printf(
      "| level | median, us | without a face, median | p99 | p99.9 | largest | p99.9 of the median "
      "| frames until found again, mean | most |\n|---|---|---|---|---|---|---|---|---|\n");
  for (int level = 1; level <= 4; ++level) {
    mien::Config config(loaded.weights);
    config.audio = 0;
    config.lod = level;
    mien::Tracker tracker;
    if (tracker.create(config) != MIEN_OK) {
      return 1;
    }
    const Times times = min_of_replays(tracker, pictures, argc > 5 ? std::atoi(argv[5]) : 20);
    double sum = 0.0;
    for (const double frames : times.found_after) {
      sum += frames;
    }
    const double median = percentile(times.all_us, 0.5), tail = percentile(times.all_us, 0.999);
    std::printf("| %d | %.0f | %.0f | %.0f | %.0f | %.0f | %.1f | %.1f | %.0f |\n", level, median,
                median_of_searched(times), percentile(times.all_us, 0.99), tail,
                percentile(times.all_us, 1.0), tail / median,
                sum / static_cast<double>(times.found_after.size()),
                percentile(times.found_after, 1.0));
  }
  return 0;
}
