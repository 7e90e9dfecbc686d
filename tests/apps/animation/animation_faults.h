// Expects error messages of the animation readers, for invalid files and for changes of valid ones.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstdint>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "apps/animation/base64.h"

namespace mien::animation {

// The error message for a file; empty if it was read.
inline std::string error_of(AnimationFormat format, const std::string& text, Clip* clip = nullptr) {
  Clip read;
  Fault fault;
  const bool good = read_animation(format, text, {}, read, fault);
  EXPECT_EQ(good, fault.what.empty());
  EXPECT_TRUE(good || read.frames.empty()) << "the clip stays unchanged";
  if (clip != nullptr) {
    *clip = read;
  }
  return fault.what;
}

struct InvalidFile {
  std::string text;
  std::string error;
};

inline void expect_errors(AnimationFormat format, const std::vector<InvalidFile>& files) {
  for (const InvalidFile& file : files) {
    EXPECT_THAT(error_of(format, file.text), testing::HasSubstr(file.error)) << file.text;
  }
}

// A change of a valid file.
struct Change {
  std::string from;
  std::string to;
  std::string error;  // empty: the file stays valid
};

inline std::string changed(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

inline void expect_changes(AnimationFormat format, const std::string& good,
                           const std::vector<Change>& changes) {
  EXPECT_EQ(error_of(format, good), "");
  for (const Change& change : changes) {
    const std::string error = error_of(format, changed(good, change.from, change.to));
    if (change.error.empty()) {
      EXPECT_EQ(error, "") << change.from << " -> " << change.to;
    } else {
      EXPECT_THAT(error, testing::HasSubstr(change.error)) << change.from << " -> " << change.to;
    }
  }
}

// A face with two blend shapes and a head, at 0 and 1 s.
inline std::vector<float> gltf_numbers() {
  return {0, 1, 0.5f, 0, 0, 1, 1, 0, 0, 0, 0, 1, 0, 0.6f, 0, 0.8f};
}

inline std::string gltf_of(const std::vector<float>& numbers) {
  std::string bytes;
  for (const float number : numbers) {
    const auto bits = std::bit_cast<std::uint32_t>(number);
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(bits >> (8 * i));
    }
  }
  return R"({"asset":{"version":"2.0"},"nodes":[{"name":"face","mesh":0},{"name":"the_Head"},{"name":"leftEye"}],)"
         R"("meshes":[{"extras":{"targetNames":["jawOpen","mouthSmile_L"]}}],)"
         R"("animations":[{"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}},)"
         R"({"sampler":1,"target":{"node":1,"path":"rotation"}}],)"
         R"("samplers":[{"input":0,"output":1},{"input":0,"output":2}]}],)"
         R"("accessors":[{"bufferView":0,"componentType":5126,"count":2},)"
         R"({"bufferView":1,"componentType":5126,"count":4},{"bufferView":2,"componentType":5126,"count":2}],)"
         R"("bufferViews":[{"buffer":0,"byteLength":8},{"buffer":0,"byteOffset":8,"byteLength":16},)"
         R"({"buffer":0,"byteOffset":24,"byteLength":32}],)"
         R"("buffers":[{"uri":"data:application/octet-stream;base64,)" +
         base64(bytes) + R"("}]})";
}

}  // namespace mien::animation
