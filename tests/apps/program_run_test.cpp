// Tests of `mien run` with the networks of apps/conformance/golden, and with invalid arrays.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>

#include "formats/npy.h"
#include "tests/apps/program.h"

namespace mien::tests {
namespace {

const std::string kGolden = kSource + "/apps/conformance/golden/";
const std::string kModel = kGolden + "mini.mien";

using Shape = std::vector<std::uint64_t>;

struct Array {
  Shape shape;
  std::vector<float> values;
};

class ProgramRun : public Program {
 protected:
  std::string save(const std::string& name, const Array& array) const {
    const formats::NpyHeader header = formats::npy_header(array.shape);
    std::ofstream file(path(name), std::ios::binary);
    file.write(header.bytes, sizeof header.bytes);
    file.write(reinterpret_cast<const char*>(array.values.data()),
               static_cast<std::streamsize>(array.values.size() * sizeof(float)));
    return path(name);
  }
  Array load(const std::string& name) const {
    const std::string bytes = contents(path(name));
    formats::NpyArray view;
    EXPECT_EQ(formats::read_npy(std::as_bytes(std::span(bytes)), &view), formats::NpyStatus::kOk);
    Array array{{view.shape().begin(), view.shape().end()}, {}};
    for (std::uint64_t i = 0; i < view.elems(); ++i) {
      array.values.push_back(view.value(i));
    }
    return array;
  }
  Outcome run_on(const std::string& input, const std::string& more) const {
    return run("run " + kModel + " --input " + input + " " + more);
  }
};

std::vector<float> golden_floats(const std::string& name) {
  const std::string bytes = contents(kGolden + name + ".f32");
  std::vector<float> values(bytes.size() / sizeof(float));
  std::memcpy(values.data(), bytes.data(), bytes.size());
  return values;
}

void expect_near(const std::vector<float>& got, const std::vector<float>& want) {
  ASSERT_EQ(got.size(), want.size());
  for (std::size_t i = 0; i < got.size(); ++i) {
    EXPECT_NEAR(got[i], want[i], 1e-3f) << i;
  }
}

// [h][w][c] to [c][h][w].
std::vector<float> channels_first(const std::vector<float>& map, std::size_t channels) {
  const std::size_t pixels = map.size() / channels;
  std::vector<float> turned(map.size());
  for (std::size_t i = 0; i < map.size(); ++i) {
    turned[i % channels * pixels + i / channels] = map[i];
  }
  return turned;
}

TEST_F(ProgramRun, MatchesPyTorch) {
  const std::vector<float> image = golden_floats("encoder_input");
  const std::string input = save("x.npy", {{1, 3, 27, 27}, channels_first(image, 3)});
  for (const char* tier : {"ref", "avx2"}) {
    const Outcome done = run_on(
        input, "--network encoder --output " + path("y.npy") + " --tier " + std::string(tier));
    if (done.code == 9) {
      continue;  // not on this CPU
    }
    ASSERT_EQ(done.code, 0) << done.errors;
    const Array output = load("y.npy");
    EXPECT_EQ(output.shape, (Shape{1, 256}));
    expect_near(output.values, golden_floats("encoder_output"));
  }
}

TEST_F(ProgramRun, AcceptsChannelsLast) {
  const std::string input = save("x.npy", {{27, 27, 3}, golden_floats("encoder_input")});
  const Outcome done = run_on(input, "--network encoder --layout hwc --output " + path("y.npy"));
  ASSERT_EQ(done.code, 0) << done.errors;
  EXPECT_EQ(load("y.npy").shape, Shape{256});
  expect_near(load("y.npy").values, golden_floats("encoder_output"));
}

TEST_F(ProgramRun, RunsTimeStepsAndResetsBetweenStreams) {
  std::vector<float> steps = golden_floats("temporal_input");
  const std::vector<float> want = golden_floats("temporal_output");
  const std::uint64_t count = steps.size() / 12;
  ASSERT_EQ(
      run_on(save("x.npy", {{count, 12}, steps}), "--network temporal --output " + path("y.npy"))
          .code,
      0);
  EXPECT_EQ(load("y.npy").shape, (Shape{count, 10}));
  expect_near(load("y.npy").values, want);
  steps.insert(steps.end(), steps.begin(), steps.end());
  ASSERT_EQ(run_on(save("two.npy", {{2, count, 12}, steps}),
                   "--network temporal --output " + path("z.npy"))
                .code,
            0);
  const Array both = load("z.npy");
  EXPECT_EQ(both.shape, (Shape{2, count, 10}));
  const auto half = static_cast<std::ptrdiff_t>(want.size());
  EXPECT_TRUE(
      std::equal(both.values.begin(), both.values.begin() + half, both.values.begin() + half));
}

TEST_F(ProgramRun, RunsOnLargerMapsWithSeveralOutputs) {
  const std::string input = save("x.npy", {{3, 14, 20}, std::vector<float>(3 * 14 * 20, 0.5f)});
  const Outcome done =
      run_on(input, "--network pnet --output " + path("a.npy") + " --output " + path("b.npy"));
  ASSERT_EQ(done.code, 0) << done.errors;
  const Array first = load("a.npy"), second = load("b.npy");
  ASSERT_EQ(first.shape.size(), 3u);
  EXPECT_GT(first.shape[2], 1u);
  EXPECT_EQ(first.shape[1], second.shape[1]);
}

TEST_F(ProgramRun, AnEmptyStreamGivesAnEmptyArray) {
  ASSERT_EQ(
      run_on(save("x.npy", {{0, 12}, {}}), "--network temporal --output " + path("y.npy")).code, 0);
  EXPECT_EQ(load("y.npy").shape, (Shape{0, 10}));
}

void expect_one_line(const Outcome& failed, int code, const std::string& part) {
  EXPECT_EQ(failed.code, code) << failed.errors;
  EXPECT_EQ(lines(failed.errors), 1u) << failed.errors;
  EXPECT_NE(failed.errors.find(part), std::string::npos) << failed.errors;
}

TEST_F(ProgramRun, WrongUsage) {
  const std::string input = save("x.npy", {{12}, std::vector<float>(12)});
  const std::string output = " --output " + path("y.npy");
  EXPECT_EQ(run("run").code, 2);
  EXPECT_EQ(run_on(input, "").code, 2);
  EXPECT_EQ(run_on(input, output + " --network temporal --layout nhwc").code, 2);
  expect_one_line(run_on(input, output), 2, "expected one of encoder, pnet, temporal");
  expect_one_line(run_on(input, output + " --network nobody"), 2, "--network");
  expect_one_line(run_on(input, output + output + " --network temporal"), 2, "(got 2, expected 1)");
  expect_one_line(run_on(input, output + " --network temporal --tier x"), 2, "unknown tier");
  const std::string map = save("map.npy", {{3, 12, 12}, std::vector<float>(432)});
  expect_one_line(run_on(map, output + output + " --network pnet"), 2, "duplicate output path");
  EXPECT_FALSE(fs::exists(path("y.npy")));
  EXPECT_TRUE(std::none_of(
      fs::directory_iterator(folder_), fs::directory_iterator(),
      [](const auto& entry) { return entry.path().filename().string().starts_with(".partial"); }));
}

TEST_F(ProgramRun, RejectsInvalidInputs) {
  const std::string end = "--network temporal --output " + path("y.npy");
  expect_one_line(run_on(path("nothing.npy"), end), 3, "cannot be opened");
  expect_one_line(run_on(folder_.string(), end), 3, "cannot be");
  expect_one_line(run_on(kModel, end), 3, "not a .npy file");
  expect_one_line(run_on(save("x.npy", {{3, 13}, std::vector<float>(39)}), end), 3,
                  "wrong shape (got (3, 13), expected as last axes (12))");
  expect_one_line(run_on(save("x.npy", {{}, {1.0f}}), end), 3, "wrong shape (got ()");
  std::ofstream(path("cut.npy"), std::ios::binary)
      << contents(save("x.npy", {{12}, std::vector<float>(12)})).substr(0, 300);
  expect_one_line(run_on(path("cut.npy"), end), 3, "truncated inside the array");
  const std::string small = save("small.npy", {{3, 11, 12}, std::vector<float>(396)});
  expect_one_line(
      run_on(small, "--network pnet --output " + path("y.npy") + " --output " + path("z.npy")), 3,
      "(3, 12, 12) or larger");
  EXPECT_FALSE(fs::exists(path("y.npy")));
}

TEST_F(ProgramRun, TransposedInputsAreRejected) {
  const std::string end = "--network encoder --output " + path("y.npy");
  const std::vector<float> values(3 * 27 * 27);
  for (const Shape& shape : {Shape{27, 27, 3}, Shape{27, 3, 27}, Shape{1, 27, 27, 3},
                             Shape{3 * 27 * 27}, Shape{1, 3, 27 * 27}}) {
    expect_one_line(run_on(save("x.npy", {shape, values}), end), 3,
                    "expected as last axes (3, 27, 27)");
  }
  const std::string large = save("large.npy", {{20, 14, 3}, std::vector<float>(840)});
  expect_one_line(
      run_on(large, "--network pnet --output " + path("y.npy") + " --output " + path("z.npy")), 3,
      "(3, 12, 12) or larger");
  EXPECT_FALSE(fs::exists(path("y.npy")));
}

TEST_F(ProgramRun, RejectsInvalidModelsAndOutputs) {
  const std::string input = save("x.npy", {{12}, std::vector<float>(12)});
  std::ofstream(path("bad.mien")) << "not a weight file";
  expect_one_line(
      run("run " + path("bad.mien") + " --input " + input + " --output " + path("y.npy")), 8,
      "bad.mien");
  expect_one_line(run_on(input, "--network temporal --output /nowhere/y.npy"), 7, "/nowhere/y.npy");
  for (const auto& entry : fs::directory_iterator(folder_)) {
    EXPECT_EQ(entry.path().filename().string().find(".partial"), std::string::npos) << entry.path();
  }
}

}  // namespace
}  // namespace mien::tests
