// Runs a network of a weight file a number of times, for counting instructions: the cost of a run
// is the difference between two such programs. Writes the layers and their multiply-accumulates.
// usage: run_network MODEL.mien NETWORK TIER RUNS
#include <mien/engine.h>
#include <mien/mien.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace {

[[noreturn]] void fail(const char* what) {
  std::fprintf(stderr, "run_network: %s\n", what);
  std::exit(1);
}

std::uint32_t mask_of(const char* tier) {
  for (std::uint32_t bit = 1; bit != 0; bit <<= 1) {
    const char* name = mien_cpu_tier_name(bit);
    if (name != nullptr && std::strcmp(name, tier) == 0 && (mien_cpu_tiers() & bit) != 0) {
      return 2 * bit - 1;  // lower tiers have the kernels that the tier lacks
    }
  }
  fail("this CPU lacks the tier");
}

void print_layers(const mien::WeightsContent& file, const char* network) {
  for (std::int32_t n = 0; n < file.network_count(); ++n) {
    const mien::NetworkInfo info = file.network(n);
    for (std::int32_t i = 0; std::strcmp(info.name, network) == 0 && i < info.layers; ++i) {
      const mien::LayerInfo layer = file.layer(n, i);
      std::printf("%s %llu\n", layer.op, static_cast<unsigned long long>(layer.macs));
    }
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5) {
    fail("usage: run_network MODEL.mien NETWORK TIER RUNS");
  }
  const mien::LoadedWeights loaded = mien::load_weights(argv[1]);
  if (!loaded) {
    fail(loaded.message.c_str());
  }
  mien::NetworkConfig config(loaded.weights, argv[2]);
  config.cpu_mask = mask_of(argv[3]) | MIEN_CPU_FUSED;
  mien::Network runner;
  mien::Error error;
  if (runner.create(config, &error) != MIEN_OK) {
    fail(error.message().c_str());
  }
  for (std::size_t i = 0; i < runner.input().size(); ++i) {
    runner.input()[i] = static_cast<float>(i * 37 % 101) / 50.0f - 1.0f;
  }
  for (int i = std::atoi(argv[4]); i > 0; --i) {
    runner.run();
  }
  print_layers(mien::WeightsContent(loaded.weights), argv[2]);
}
