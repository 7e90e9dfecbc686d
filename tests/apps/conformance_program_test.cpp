// Tests of mien-conformance as a program: options, tables, JSON and exit codes.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "kernels/registry.h"
#include "tests/apps/program.h"

namespace mien::tests {
namespace {

using nlohmann::json;
using testing::HasSubstr;
using testing::Not;

class ConformanceProgram : public Program {};

TEST_F(ConformanceProgram, ChecksMatchingKernels) {
  const Outcome outcome = run("--filter 'max_*'");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("max_pool"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("pointwise")));
  EXPECT_THAT(outcome.output, HasSubstr(" 0 failed"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("\033["))) << "colours in a file";
}

TEST_F(ConformanceProgram, DescribesTheDeviceForOthers) {
  const Outcome outcome = run("--bench --block --tier ref --filter 'ma*'");
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  EXPECT_THAT(outcome.output, HasSubstr("| processors |"));
  EXPECT_THAT(outcome.output, HasSubstr("| networks of level 1 | not measured: basenet_encoder |"));
  EXPECT_THAT(outcome.output, HasSubstr("| 2 checked, 0 failed; ref |"));
  EXPECT_THAT(outcome.output, Not(HasSubstr("GFLOP/s")));
  EXPECT_EQ(run("--block").code, 2);
}

TEST_F(ConformanceProgram, ListsEveryKernelOfThisCpu) {
  const Outcome outcome = run("--list");
  EXPECT_EQ(outcome.code, 0);
  std::size_t kernels_here = 0;
  for (const kernels::Entry& entry : kernels::all_kernels()) {
    if ((kernels::detect_cpu() & kernels::bit(entry.tier)) != 0) {
      EXPECT_THAT(outcome.output, HasSubstr(std::string(entry.family)));
      ++kernels_here;
    }
  }
  EXPECT_GE(lines(outcome.output), kernels_here);
  EXPECT_THAT(outcome.output, HasSubstr("network/mini_encoder"));
}

TEST_F(ConformanceProgram, OneTierOnly) {
  const Outcome outcome = run("--list --tier ref");
  EXPECT_THAT(outcome.output, HasSubstr(" ref\n"));
  EXPECT_EQ(lines(outcome.output), lines(run("--list --tier ref --filter '*'").output));
  EXPECT_THAT(outcome.output, Not(HasSubstr("avx2")));
}

TEST_F(ConformanceProgram, JsonHasTheResultsOfTheTable) {
  const Outcome outcome =
      run("--bench --tier ref --filter 'ma*' --repeat 2 --seed 9 --json " + path("result.json"));
  ASSERT_EQ(outcome.code, 0) << outcome.errors;
  const json result = json::parse(contents(path("result.json")));
  EXPECT_EQ(result["mien_conformance"], 1);
  EXPECT_EQ(result["seed"], 9);
  EXPECT_EQ(result["repeat"], 2);
  EXPECT_EQ(result["failures"], 0);
  EXPECT_GT(result["peak_gflops"]["ref"].get<double>(), 0.0);
  ASSERT_EQ(result["results"].size(), 2u);  // max_pool, matrix_vector
  for (const json& one : result["results"]) {
    EXPECT_EQ(one["tier"], "ref");
    EXPECT_EQ(one["cases"], 80);
    EXPECT_EQ(one["result"], "ok");
    EXPECT_LE(one["worst_share"].get<double>(), 1.0);
    EXPECT_GT(one["seconds"].get<double>(), 0.0);
    EXPECT_EQ(one.contains("gflops"), one["name"] == "matrix_vector");
    EXPECT_THAT(outcome.output, HasSubstr(one["name"].get<std::string>()));
  }
}

TEST_F(ConformanceProgram, JsonOnStandardOutputIsTheOnlyOutput) {
  const Outcome outcome = run("--filter softmax --json -");
  ASSERT_EQ(outcome.code, 0);
  EXPECT_EQ(json::parse(outcome.output)["results"][0]["name"], "softmax");
}

TEST_F(ConformanceProgram, NetworksOfAFolder) {
  MIEN_NEEDS("trained models", have_models());
  const Outcome outcome = run("--list --filter 'network/basenet_*'" + models());
  EXPECT_EQ(outcome.code, 0) << outcome.errors;
  const bool other_tiers = kernels::detect_cpu() != kernels::bit(kernels::Tier::kRef);
  EXPECT_EQ(outcome.output.find("network/basenet_encoder") != std::string::npos, other_tiers);
}

TEST_F(ConformanceProgram, ABrokenModelIsAClearFailure) {
  std::ofstream(path("basenet.mien")) << "not a model";
  const Outcome outcome = run("--models " + path(""));
  EXPECT_EQ(outcome.code, 8);
  EXPECT_THAT(outcome.errors, HasSubstr("basenet.mien: "));
}

TEST_F(ConformanceProgram, ExitCodes) {
  EXPECT_EQ(run("--no-such-option").code, 2);
  EXPECT_EQ(run("--repeat 0").code, 2);
  EXPECT_EQ(run("--tier mmx").code, 2);
  EXPECT_EQ(run("--filter 'no such kernel'").code, 3);
  EXPECT_EQ(run("--filter softmax --json /no/such/folder/x.json").code, 6);
  for (std::uint32_t tier = 0; tier < kernels::kTierCount; ++tier) {
    if ((kernels::detect_cpu() & (1u << tier)) == 0) {
      const std::string name = kernels::name(static_cast<kernels::Tier>(tier));
      const Outcome outcome = run("--tier " + name);
      EXPECT_EQ(outcome.code, 5) << name;
      EXPECT_THAT(outcome.errors, HasSubstr(name));
    }
  }
  EXPECT_EQ(run("--help").code, 0);
  EXPECT_EQ(run("--version").code, 0);
}

TEST_F(ConformanceProgram, ATrimmedBuildFails) {
#ifdef MIEN_TRIMMED_PROGRAM
  const std::string command = "'" MIEN_TRIMMED_PROGRAM "' 2>" + path("errors");
  EXPECT_EQ(WEXITSTATUS(std::system(command.c_str())), 4);
  EXPECT_THAT(contents(path("errors")), HasSubstr("no reference kernels"));
#else
  GTEST_SKIP() << "skipped: this CPU has only the reference tier";
#endif
}

}  // namespace
}  // namespace mien::tests
