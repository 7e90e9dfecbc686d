// Tests of the mirror, which `mien live --mirror` applies to every outgoing frame.
#include "apps/animation/mirror.h"

#include <gtest/gtest.h>

namespace mien::animation {
namespace {

TEST(Mirror, ExchangesTheSidesOfControls) {
  Frame frame;
  for (std::size_t i = 0; i < formats::kControlCount; ++i) {
    frame.controls[i] = static_cast<double>(i) / formats::kControlCount;
  }
  const Frame turned = mirrored(frame);
  for (const auto& [name, other] : {std::pair{"eyeBlinkLeft", "eyeBlinkRight"},
                                    {"jawLeft", "jawRight"},
                                    {"mouthLeft", "mouthRight"},
                                    {"jawOpen", "jawOpen"}}) {
    EXPECT_EQ(turned.controls[formats::index_of(name, formats::kArkitNames)],
              frame.controls[formats::index_of(other, formats::kArkitNames)])
        << name;
    EXPECT_EQ(turned.controls[formats::index_of(other, formats::kArkitNames)],
              frame.controls[formats::index_of(name, formats::kArkitNames)])
        << other;
  }
  EXPECT_EQ(mirrored(turned).controls, frame.controls);
}

TEST(Mirror, TurnsHeadAndEyesToTheOtherSide) {
  Frame frame;
  frame.controls = {};
  frame.head = Angles{0.1, 0.2, 0.3};
  frame.position_m = {1.0, 2.0, 3.0};
  frame.eyes = {Angles{0.1, 0.2, 0.0}, Angles{0.3, 0.4, 0.0}};
  frame.facs = {1.0};
  const Frame turned = mirrored(frame);
  EXPECT_EQ(turned.head->pitch, 0.1);
  EXPECT_EQ(turned.head->yaw, -0.2);
  EXPECT_EQ(turned.head->roll, -0.3);
  EXPECT_EQ(*turned.position_m, (std::array<double, 3>{-1.0, 2.0, 3.0}));
  EXPECT_EQ((*turned.eyes)[0].pitch, 0.3);
  EXPECT_EQ((*turned.eyes)[0].yaw, -0.4);
  EXPECT_EQ((*turned.eyes)[1].yaw, -0.2);
  EXPECT_TRUE(turned.facs.empty()) << "values of the other side";
}

}  // namespace
}  // namespace mien::animation
