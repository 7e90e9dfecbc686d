// Runs a network of a weight file a number of times, for counting instructions: the difference
// between two numbers of runs is what a run takes. Writes the layers and their
// multiply-accumulates. usage: run_network MODEL.mien NETWORK TIER RUNS fused|plain
#include <mien/engine.h>
#include <mien/mien.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <vector>

namespace {

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "run_network: %s\n", what);
  std::exit(1);
}

std::uint32_t mask_of(const char* tier) {
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
    const char* name = mien_cpu_tier_name(bit);
    if (name != nullptr && std::strcmp(name, tier) == 0 && (mien_cpu_tiers() & bit) != 0) {
      return 2 * bit - 1;  // what the tier lacks those before it have
    }
  }
  fail("this CPU lacks the tier");
}

struct alignas(MIEN_ALIGNMENT) Line {
  std::byte bytes[MIEN_ALIGNMENT];
};

void print_layers(const mien::WeightFile& file, const char* network) {
  for (std::int32_t n = 0; n < file.network_count(); ++n) {
    const mien::NetworkInfo info = file.network(n);
    for (std::int32_t i = 0; info.name == network && i < info.layers; ++i) {
      const mien::LayerInfo layer = file.layer(n, i);
      std::printf("%s %llu\n", layer.op, static_cast<unsigned long long>(layer.macs));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 6) {
    fail("usage: run_network MODEL.mien NETWORK TIER RUNS fused|plain");
  }
  std::ifstream stream(argv[1], std::ios::binary);
  const std::vector<char> content(std::istreambuf_iterator<char>(stream), {});
  std::vector<Line> lines(content.size() / sizeof(Line) + 1);
  std::memcpy(lines.data(), content.data(), content.size());
  mien::WeightFile file;
  if (file.open({lines[0].bytes, content.size()}) != mien::EngineStatus::kOk) {
    fail("not a weight file");
  }
  mien::NetworkRunner runner;
  mien::NetworkRunner::Options options;
  options.cpu_mask = mask_of(argv[3]) | (std::strcmp(argv[5], "fused") == 0 ? MIEN_CPU_FUSED : 0);
  const mien::EngineStatus status = runner.create(file, argv[2], options);
  if (status != mien::EngineStatus::kOk) {
    fail(message(status));
  }
  for (std::size_t i = 0; i < runner.input().size(); ++i) {
    runner.input()[i] = static_cast<float>(i * 37 % 101) / 50.0f - 1.0f;
  }
  for (int i = std::atoi(argv[4]); i > 0; --i) {
    runner.run();
  }
  print_layers(file, argv[2]);
}
