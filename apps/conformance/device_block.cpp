// Linux and Android describe processors in /proc/cpuinfo and /sys/devices/system/cpu.
#include "apps/conformance/device_block.h"

#include <mien/mien.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "apps/conformance/cpu_text.h"

namespace mien::conformance {
namespace {

constexpr const char* kUnknown = "please fill in";

// The fastest tier of a network, in seconds.
std::optional<double> fastest(const Report& report, const std::string& network) {
  std::optional<double> best;
  for (const Row& row : report.rows) {
    if (row.name == "network/" + network && row.timing) {
      best = std::min(best.value_or(row.timing->seconds), row.timing->seconds);
    }
  }
  return best;
}

std::string time_of(const Report& report, const std::vector<std::string>& networks) {
  double sum = 0.0;
  for (const std::string& network : networks) {
    const std::optional<double> seconds = fastest(report, network);
    if (!seconds) {
      return "not measured: " + network;
    }
    sum += *seconds;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3f ms", sum * 1e3);
  return text;
}

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line, '\0');  // of /proc/device-tree, without a line break
  return line.substr(0, line.find('\n'));
}

std::string device() {
  for (const char* path : {"/proc/device-tree/model", "/sys/devices/virtual/dmi/id/product_name"}) {
    if (std::string name = first_line(path); !name.empty()) {
      return name;
    }
  }
  return kUnknown;
}

// "4 x Cortex..., 1.8 GHz; 4 x ..." in the order of the system.
std::string processors() {
  std::ifstream file("/proc/cpuinfo");
  std::vector<std::string> kinds = processor_names(file);
  for (std::size_t i = 0; i < kinds.size(); ++i) {
    const std::string folder = "/sys/devices/system/cpu/cpu" + std::to_string(i);
    kinds[i] += frequency_text(first_line(folder + "/cpufreq/cpuinfo_max_freq"));
  }
  return kinds.empty() ? kUnknown : counted(kinds);
}

}  // namespace

std::string device_block(const Report& report) {
  const std::vector<std::string> level_1{"basenet_encoder", "basenet_landmarks",
                                         "basenet_face_probability", "basenet_controls_decoder",
                                         "basenet_pose_decoder"};
  std::vector<std::string> level_4 = level_1;
  level_4.insert(level_4.end(),
                 {"hifinet_encoder", "hifinet_landmarks", "hifinet_controls_decoder"});
  std::string tiers;
  for (const auto& [tier, gflops] : report.peak_gflops) {
    tiers += (tiers.empty() ? "" : ", ") + tier;
  }
  return "| | |\n|---|---|\n| device | " + device() + " |\n| processors | " + processors() +
         " |\n| networks of level 1 | " + time_of(report, level_1) +
         " |\n| networks of level 4 | " + time_of(report, level_4) + " |\n| mien-conformance " +
         mien_version() + " | " + std::to_string(report.rows.size()) + " checked, " +
         std::to_string(report.failures()) + " failed; " + tiers + " |\n";
}

}  // namespace mien::conformance
