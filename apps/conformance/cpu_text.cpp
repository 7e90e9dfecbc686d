#include "apps/conformance/cpu_text.h"

#include <cstdio>
#include <cstdlib>

namespace mien::conformance {
namespace {

struct Field {
  std::string key, value;
};

Field split(const std::string& line) {
  const std::size_t colon = line.find(':');
  if (colon == std::string::npos) {
    return {};
  }
  const std::size_t begin = line.find_first_not_of(" \t", colon + 1);
  return {line.substr(0, line.find_first_of("\t:")),  // Linux pads keys with tabs
          begin == std::string::npos ? "" : line.substr(begin)};
}

}  // namespace

std::vector<std::string> processor_names(std::istream& cpuinfo) {
  std::vector<std::string> names;
  std::string implementer;
  for (std::string line; std::getline(cpuinfo, line);) {
    const auto [key, value] = split(line);
    if (key == "processor") {
      names.emplace_back("processor");
    } else if (names.empty()) {
      continue;
    } else if (key == "model name") {
      names.back() = value;
    } else if (key == "CPU implementer") {
      implementer = value;
    } else if (key == "CPU part") {
      names.back() = "implementer ";
      names.back().append(implementer).append(" part ").append(value);
    }
  }
  return names;
}

std::string frequency_text(const std::string& kilohertz) {
  const long value = std::strtol(kilohertz.c_str(), nullptr, 10);
  if (value <= 0) {
    return "";
  }
  char text[48];
  std::snprintf(text, sizeof text, ", %.1f GHz", static_cast<double>(value) / 1e6);
  return text;
}

std::string counted(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t begin = 0, end = 0; begin < names.size(); begin = end) {
    while (end < names.size() && names[end] == names[begin]) {
      ++end;
    }
    text += (text.empty() ? "" : "; ") + std::to_string(end - begin) + " x " + names[begin];
  }
  return text;
}

}  // namespace mien::conformance
