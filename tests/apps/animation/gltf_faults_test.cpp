// Tests of every error message of the glTF reader.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "apps/animation/animation.h"
#include "tests/apps/animation/animation_faults.h"

namespace mien::animation {
namespace {

using testing::HasSubstr;

constexpr const char* kInvalidIndex = "invalid index";
constexpr const char* kOutOfRange = "out of range";
constexpr const char* kExceedsBuffer = "exceeds its buffer";

const std::vector<Change> kGltfChanges = {
    {"{\"asset", "[{\"asset", "',' or ']'"},
    {"\"animations\"", "\"nothing\"", "no animation"},
    {"\"animations\":[", "\"animations\":[],\"other\":[", "no animation"},
    {"\"animations\":[", "\"animations\":{},\"other\":[", "no animation"},
    {"\"uri\"", "\"url\"", "the buffer has no data in this file"},
    {"\"data:", "\"file:", "no folder to search"},
    {";base64,", ";base32,", "uri: invalid base64"},
    {";base64,", ";base64,?", "uri: invalid base64"},
    {"\"bufferView\":0", "\"bufferView\":9", kInvalidIndex},
    {"\"bufferView\":0", "\"bufferView\":-1", kInvalidIndex},
    {"\"bufferView\":0,", "", "bufferView: missing"},
    {"\"bufferView\":0", "\"bufferView\":0.5", "bufferView: missing"},
    {"\"bufferViews\"", "\"views\"", kInvalidIndex},
    {"\"buffer\":0", "\"buffer\":1", kInvalidIndex},
    {"\"componentType\":5126", "\"componentType\":5123", "integers must be normalized"},
    {"\"componentType\":5126", "\"componentType\":5125", "expected 5126 (float)"},
    {"\"componentType\":5126", "\"componentType\":\"x\"", "expected 5126 (float)"},
    {"{\"buffer\":0,", "{\"extensions\":{\"EXT_meshopt_compression\":{}},\"buffer\":0,",
     "compressed with EXT_meshopt_compression"},
    {"\"count\":2", "\"count\":-2", kOutOfRange},
    {"\"count\":2", "\"count\":5000000000", kOutOfRange},
    {"\"count\":2", "\"count\":2,\"byteOffset\":-4", kOutOfRange},
    {"\"count\":2", "\"count\":2,\"byteOffset\":4", kExceedsBuffer},
    {"\"count\":2", "\"count\":2,\"sparse\":{}", "sparse accessors are not supported"},
    {"\"count\":2", "\"count\":0", "does not match the number of times"},
    {"\"count\":4", "\"count\":3", "does not match the number of times"},
    {"\"count\":4", "\"count\":40", kExceedsBuffer},
    {"\"byteOffset\":8", "\"byteOffset\":-8", kOutOfRange},
    {"\"byteLength\":8", "\"byteLength\":-8", kOutOfRange},
    {"\"byteLength\":16", "\"byteLength\":1600", kExceedsBuffer},
    {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":-4", kOutOfRange},
    {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":2", kExceedsBuffer},
    {"\"byteLength\":8", "\"byteLength\":8,\"byteStride\":4", ""},
    {"\"input\":0", "\"input\":7", kInvalidIndex},
    {"\"output\":1", "\"output\":7", kInvalidIndex},
    {"\"output\":1", "\"output\":1,\"interpolation\":\"STEP\"", ""},
    {"\"output\":1", "\"output\":1,\"interpolation\":\"CUBICSPLINE\"", "does not match"},
    {"\"channels\"", "\"canals\"", "no channels or samplers"},
    {"\"samplers\"", "\"samples\"", "no channels or samplers"},
    {"\"sampler\":0", "\"sampler\":-1", "no sampler or target"},
    {"\"sampler\":0", "\"sampler\":2", "no sampler or target"},
    {"\"sampler\":0", "\"sampler\":null", "no sampler or target"},
    {"\"sampler\":0,", "", "no sampler or target"},
    {"\"target\"", "\"aim\"", "no sampler or target"},
    {"\"node\":0", "\"node\":3", kInvalidIndex},
    {"\"node\":0,", "", ""},
    {"\"path\":\"weights\"", "\"way\":\"weights\"", ""},
    {"\"node\":1", "\"node\":2", ""},
    {"\"name\":\"the_Head\"", "\"name\":\"eye\"", ""},
    {"\"name\":\"the_Head\"", "\"title\":\"head\"", ""},
    {"\"path\":\"rotation\"", "\"path\":\"scale\"", ""},
    {"\"mesh\":0", "\"mesh\":1", kInvalidIndex},
    {"\"extras\"", "\"more\"", "extras.targetNames: missing"},
    {"\"targetNames\":[", "\"targetNames\":[],\"x\":[", "extras.targetNames: missing"},
    {"\"jawOpen\",\"mouthSmile_L\"", "\"a\",\"b\"", ""},
    {"\"samplers\"", "\"extras\":{},\"samplers\"", ""},
    {"\"samplers\"", "\"extras\":{\"mien\":{\"start_ns\":\"x\"}},\"samplers\"",
     "start_ns: expected an integer"},
    {"\"samplers\"", "\"extras\":{\"mien\":{\"start_ns\":9000000000000000000}},\"samplers\"",
     "start_ns: out of range"},
    {"\"samplers\"",
     "\"extras\":{\"mien\":{\"start_ns\":5,\"states\":\"sl\",\"not_driven\":[\"jawOpen\","
     "\"unknownControl\"]}},\"samplers\"",
     ""}};

TEST(AnimationFaults, Gltf) {
  expect_changes(AnimationFormat::kGltf, gltf_of(gltf_numbers()), kGltfChanges);
}

TEST(AnimationFaults, GltfWithOtherNumbers) {
  const auto with = [](std::size_t which, float number) {
    std::vector<float> numbers = gltf_numbers();
    numbers[which] = number;
    return gltf_of(numbers);
  };
  expect_errors(AnimationFormat::kGltf,
                {{with(1, -1), "times must increase"},
                 {with(1, 0), "times must increase"},
                 {with(1, 5e9f), "times must increase"},
                 {with(0, -5e9f), "times must increase"},
                 {with(3, std::numeric_limits<float>::infinity()), "is not a finite number"}});
  EXPECT_EQ(error_of(AnimationFormat::kGltf, with(9, 0.0f)), "");
  // Neither weights nor a head.
  const std::string eyes = changed(
      changed(gltf_of(gltf_numbers()), "\"path\":\"weights\"", "\"path\":\"x\""), "the_Head", "x");
  EXPECT_THAT(error_of(AnimationFormat::kGltf, eyes),
              HasSubstr("neither face weights nor a head are animated"));
  // A head with translation only.
  Clip clip;
  const std::string moves =
      changed(changed(gltf_of(gltf_numbers()), "\"path\":\"weights\"", "\"path\":\"x\""),
              "\"path\":\"rotation\"", "\"path\":\"translation\"");
  EXPECT_EQ(error_of(AnimationFormat::kGltf, moves, &clip), "");
  ASSERT_EQ(clip.frames.size(), 2u);
  EXPECT_TRUE(clip.frames.unpacked()[1].position_m);
  EXPECT_FALSE(clip.frames.unpacked()[1].head);
}

TEST(AnimationFaults, Glb) {
  const auto word = [](std::uint32_t value) {
    std::string bytes;
    for (int i = 0; i < 4; ++i) {
      bytes += static_cast<char>(value >> (8 * i));
    }
    return bytes;
  };
  const std::string json = "{}  ";
  const auto file = [&](std::uint32_t version, std::uint32_t more, std::uint32_t kind,
                        std::uint32_t size, const std::string& rest) {
    const std::string body = word(size) + word(kind) + json + rest;
    return "glTF" + word(version) + word(static_cast<std::uint32_t>(12 + body.size()) + more) +
           body;
  };
  constexpr std::uint32_t kJson = 0x4E4F534A, kBin = 0x004E4942;
  expect_errors(AnimationFormat::kGlb,
                {{"glTF", "the file ends within its header"},
                 {file(1, 0, kJson, 4, ""), "expected glTF version 2"},
                 {file(2, 1, kJson, 4, ""), "wrong file length"},
                 {file(2, 0, kBin, 4, ""), "the first chunk is not JSON"},
                 {file(2, 0, kJson, 5, ""), "the chunk exceeds the file"},
                 {file(2, 0, kJson, 4, word(9) + word(kBin)), "the chunk exceeds the file"},
                 {file(2, 0, kJson, 4, word(0) + word(kBin)), "no animation"},
                 {file(2, 0, kJson, 4, word(0) + word(7)), "no animation"},
                 {file(2, 0, kJson, 4, ""), "no animation"}});
}

}  // namespace
}  // namespace mien::animation
