// Tests of the texts about processors in mien-conformance.
#include "apps/conformance/cpu_text.h"

#include <gtest/gtest.h>

#include <sstream>

namespace mien::conformance {
namespace {

TEST(CpuText, ArmClustersAreToldApart) {
  std::istringstream cpuinfo(
      "processor\t: 0\nBogoMIPS\t: 38.40\nCPU implementer\t: 0x41\nCPU part\t: 0xd05\n\n"
      "processor\t: 1\nCPU implementer\t: 0x41\nCPU part\t: 0xd0b\n\nHardware\t: Phone\n");
  const std::vector<std::string> names = processor_names(cpuinfo);
  EXPECT_EQ(names, (std::vector<std::string>{"implementer 0x41 part 0xd05",
                                             "implementer 0x41 part 0xd0b"}));
}

TEST(CpuText, OtherProcessorsHaveNames) {
  std::istringstream cpuinfo("processor\t: 0\nmodel name\t: Fast CPU 3000\n\n:\nprocessor\t: 1\n");
  EXPECT_EQ(processor_names(cpuinfo), (std::vector<std::string>{"Fast CPU 3000", "processor"}));
  std::istringstream nothing("Hardware : Phone\n");
  EXPECT_TRUE(processor_names(nothing).empty());
}

TEST(CpuText, FrequenciesAreInKilohertz) {
  EXPECT_EQ(frequency_text("1804800"), ", 1.8 GHz");
  EXPECT_EQ(frequency_text(""), "");
  EXPECT_EQ(frequency_text("fast"), "");
}

TEST(CpuText, NeighboursAreCounted) {
  EXPECT_EQ(counted({"a", "a", "b"}), "2 x a; 1 x b");
  EXPECT_EQ(counted({}), "");
}

}  // namespace
}  // namespace mien::conformance
