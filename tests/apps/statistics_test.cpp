// Tests of matching and statistics with values computed by hand.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "apps/animation/base64.h"
#include "apps/mien/compare/page.h"
#include "apps/mien/compare/statistics.h"

namespace mien::tests {
namespace {

using app::Curves;
using app::Difference;
using app::Differences;
using app::match_frames;

const double kNan = std::nan("");
constexpr std::size_t kControl = 17;
constexpr std::size_t kOtherControl = 3;

Curves curves_at(const std::vector<double>& times_ms) {
  Curves curves(times_ms.size());
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].t_ms = times_ms[i];
    curves[i].controls.fill(kNan);
  }
  return curves;
}

// Ten frames per second.
Curves curves_of(const std::vector<double>& values) {
  Curves curves = curves_at(std::vector<double>(values.size()));
  for (std::size_t i = 0; i < curves.size(); ++i) {
    curves[i].t_ms = 100.0 * static_cast<double>(i);
    curves[i].controls[kControl] = values[i];
  }
  return curves;
}

Differences differences(const Curves& a, const Curves& b) {
  return app::differences(a, b, match_frames(a, b));
}

std::vector<std::pair<std::size_t, std::size_t>> pairs(const Curves& a, const Curves& b) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (const app::FramePair& pair : match_frames(a, b)) {
    pairs.emplace_back(pair.a, pair.b);
  }
  return pairs;
}

using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pair;

TEST(Matching, SameTimes) {
  EXPECT_THAT(pairs(curves_at({0, 40, 80}), curves_at({0, 40, 80})),
              ElementsAre(Pair(0, 0), Pair(1, 1), Pair(2, 2)));
}

TEST(Matching, OneFileStartsLaterOrHasAGap) {
  EXPECT_THAT(pairs(curves_at({0, 40, 80, 120}), curves_at({41, 119})),
              ElementsAre(Pair(1, 0), Pair(3, 1)));
}

TEST(Matching, DifferentRatesMatchAtTheSlowerOne) {
  const Curves fast = curves_at({0, 20, 40, 60, 80}), slow = curves_at({0, 40, 80});
  EXPECT_THAT(pairs(fast, slow), ElementsAre(Pair(0, 0), Pair(2, 1), Pair(4, 2)));
  EXPECT_THAT(pairs(slow, fast), ElementsAre(Pair(0, 0), Pair(1, 2), Pair(2, 4)));
}

TEST(Matching, LessThanHalfAFrameApart) {
  EXPECT_THAT(pairs(curves_at({0, 40}), curves_at({20, 60})), IsEmpty());
  EXPECT_THAT(pairs(curves_at({0, 40}), curves_at({19, 59})), ElementsAre(Pair(0, 0), Pair(1, 1)));
  EXPECT_THAT(pairs(curves_at({0, 40}), curves_at({500, 540})), IsEmpty());
  EXPECT_THAT(pairs(curves_at({0}), curves_at({15})), ElementsAre(Pair(0, 0)));
  EXPECT_THAT(pairs(curves_at({0}), curves_at({18})), IsEmpty());
}

TEST(Matching, NoFrameIsInTwoPairs) {
  EXPECT_THAT(pairs(curves_at({0, 0, 40, 40}), curves_at({0, 40})),
              ElementsAre(Pair(0, 0), Pair(2, 1)));
}

TEST(Statistics, OfKnownNumbers) {
  const Differences found =
      differences(curves_of({0.0, 0.2, 0.4, 0.6}), curves_of({0.1, 0.2, 0.8, 0.5}));
  EXPECT_EQ(found.matched_frames, 4u);
  const Difference& d = found.controls[kControl];
  EXPECT_EQ(d.frames, 4u);
  EXPECT_NEAR(d.mean_abs, 0.6 / 4, 1e-12);
  EXPECT_NEAR(d.max_abs.value, 0.4, 1e-12);
  EXPECT_EQ(d.max_abs.t_ms, 200.0);
  EXPECT_NEAR(d.mean_a, 0.3, 1e-12);
  EXPECT_NEAR(d.mean_b, 0.4, 1e-12);
  // deviations of A: -.3 -.1 .1 .3, of B: -.3 -.2 .4 .1
  ASSERT_TRUE(d.correlation);
  EXPECT_NEAR(*d.correlation, 0.18 / std::sqrt(0.20 * 0.30), 1e-12);
  EXPECT_EQ(d.jitter_a, 0.0);
  EXPECT_NEAR(d.jitter_b, 0.3 / 4, 1e-12);
}

TEST(Statistics, OnlyWhereBothFilesHaveTheControl) {
  const Differences found =
      differences(curves_of({0.5, kNan, 0.5, 0.5}), curves_of({0.25, 0.9, kNan, 0.75}));
  const Difference& d = found.controls[kControl];
  EXPECT_EQ(d.frames, 2u);
  EXPECT_NEAR(d.mean_abs, 0.25, 1e-12);
  EXPECT_NEAR(d.mean_b, 0.5, 1e-12);
  EXPECT_FALSE(d.correlation) << "A does not move";
  EXPECT_EQ(found.controls[kOtherControl].frames, 0u);
  EXPECT_EQ(found.all.frames, 2u);
}

TEST(Statistics, CorrelationOfEqualAndOppositeMovement) {
  const Curves up = curves_of({0.1, 0.4, 0.2, 0.3});
  EXPECT_NEAR(*differences(up, curves_of({0.3, 0.9, 0.5, 0.7})).all.correlation, 1.0, 1e-12);
  EXPECT_NEAR(*differences(up, curves_of({0.9, 0.6, 0.8, 0.7})).all.correlation, -1.0, 1e-12);
}

TEST(Statistics, AllIsOverControlsAndFrames) {
  Curves a = curves_of({0.0, 0.0, 0.0, 0.0}), b = curves_of({0.1, 0.1, 0.1, 0.1});
  a[1].controls[kOtherControl] = 0.0;
  b[1].controls[kOtherControl] = 0.6;
  const Differences found = differences(a, b);
  EXPECT_EQ(found.all.frames, 5u);
  EXPECT_NEAR(found.all.mean_abs, 1.0 / 5, 1e-12);
  EXPECT_NEAR(found.all.max_abs.value, 0.6, 1e-12);
  EXPECT_EQ(found.all.max_abs.t_ms, 100.0);
  EXPECT_EQ(found.max_abs_control, kOtherControl);
  EXPECT_FALSE(found.all.correlation);
}

// The values of the self-test of models/training/mien_training/evaluate/metrics.py.
TEST(Statistics, JitterMatchesTheEvaluation) {
  EXPECT_EQ(app::jitter({0, 0, 0, 0, 0, 0}), 0.0);
  EXPECT_EQ(app::jitter({0, 1, 2, 3, 4, 5}), 0.0);
  EXPECT_NEAR(app::jitter({0, 1, 0, 1, 0, 1}), 4.0 / 6, 1e-12);
  EXPECT_NEAR(app::jitter({0, 0, 1}), 1.0 / 3, 1e-12);
  EXPECT_EQ(app::jitter({}), 0.0);
}

TEST(Statistics, JitterRestartsAfterAGap) {
  EXPECT_EQ(app::jitter({0, 1, kNan, 0, 1}), 0.0);
  EXPECT_NEAR(app::jitter({0, 1, 0, kNan, 5, 6}), 1.0 / 5, 1e-12);
}

TEST(Statistics, HeadPoseInDegrees) {
  Curves a = curves_of({0, 0, 0}), b = a;
  const double degree = std::numbers::pi / 180.0;
  a[0].head = {10 * degree, 0, 0};
  b[0].head = {-20 * degree, 0, 0};
  a[1].head = {0, 179 * degree, 0};
  b[1].head = {0, -171 * degree, 0};
  a[2].head = {0, 0, 0};  // and no head in B
  const app::HeadDifference head = differences(a, b).head;
  EXPECT_EQ(head.frames, 2u);
  EXPECT_NEAR(head.pitch.mean_abs_deg, 15.0, 1e-9);
  EXPECT_NEAR(head.yaw.mean_abs_deg, 5.0, 1e-9) << "the smaller angle";
  EXPECT_NEAR(head.roll.mean_abs_deg, 0.0, 1e-9);
  EXPECT_NEAR(head.rotation.mean_abs_deg, 20.0, 1e-9);
  EXPECT_NEAR(head.rotation.max_abs_deg.value, 30.0, 1e-9);
  EXPECT_EQ(head.rotation.max_abs_deg.t_ms, 0.0);
}

// Ry(a) Rx(b) against the identity: cos(angle / 2) = cos(a / 2) cos(b / 2).
TEST(Statistics, HeadRotationIsOneAngle) {
  Curves a = curves_of({0}), b = a;
  a[0].head = {0.4, 0.6, 0};
  b[0].head = {0, 0, 0};
  const double expected = 2.0 * std::acos(std::cos(0.2) * std::cos(0.3)) * 180.0 / std::numbers::pi;
  EXPECT_NEAR(differences(a, b).head.rotation.mean_abs_deg, expected, 1e-9);
}

TEST(Base64, VectorsOfRfc4648) {
  EXPECT_EQ(animation::base64(""), "");
  EXPECT_EQ(animation::base64("f"), "Zg==");
  EXPECT_EQ(animation::base64("fo"), "Zm8=");
  EXPECT_EQ(animation::base64("foo"), "Zm9v");
  EXPECT_EQ(animation::base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(animation::base64("\xFB\xFF\xFE"), "+//+");
}

TEST(ComparePage, FileNamesAreEscaped) {
  app::Comparison comparison;
  comparison.a = {"</script><script>alert(1)", curves_of({0, 1})};
  comparison.b = {"@VIDEO@ @DATA@ \xFF", curves_of({0, 1})};
  comparison.differences = differences(comparison.a.curves, comparison.b.curves);
  comparison.video = "foo";
  const std::string page = app::compare_page(comparison);
  EXPECT_EQ(page.find("</script><script>alert"), std::string::npos);
  EXPECT_NE(page.find("\\u003c/script>\\u003cscript>alert(1)"), std::string::npos);
  EXPECT_NE(page.find("\"@VIDEO@ @DATA@ "), std::string::npos);
  EXPECT_NE(page.find(">Zm9v</script>"), std::string::npos);
  for (const char* mark : {"@STYLE@", "@SCRIPT@"}) {
    EXPECT_EQ(page.find(mark), std::string::npos) << mark;
  }
  EXPECT_NE(page.find("#stage {"), std::string::npos);
}

}  // namespace
}  // namespace mien::tests
