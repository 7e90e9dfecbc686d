// Tests of several faces, with discs as faces: ids, new faces, and faces that leave.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <vector>

#include "tests/tracker/blob_tracker.h"
#include "tracker/detection/tiles.h"

namespace mien::tests {
namespace {

struct Disc {
  float x, y;
  float diameter = 50.0f;
};

Picture discs(const std::vector<Disc>& discs) {
  Picture picture(320, 240);
  for (const Disc& disc : discs) {
    picture.disc(disc.x, disc.y, disc.diameter);
  }
  return picture;
}

class SeveralTracker : public BlobTracker {
 public:
  explicit SeveralTracker(std::int32_t max_faces, std::int32_t lod = 1)
      : BlobTracker({}, [=](mien_tracker_config& config) {
          config.max_faces = max_faces;
          config.lod = lod;
        }) {}

  std::vector<Result> push_all(const std::vector<Disc>& scene) {
    (void)push(discs(scene));
    std::vector<Result> results(static_cast<std::size_t>(tracker().face_count()));
    for (std::size_t i = 0; i < results.size(); ++i) {
      EXPECT_EQ(tracker().get_face(static_cast<std::int32_t>(i), results[i]), MIEN_OK);
      expect_valid(results[i]);
    }
    return results;
  }
};

float middle_x(const Result& result) { return result.box[0] + result.box[2] / 2; }

std::vector<Result> tracked(const std::vector<Result>& results) {
  std::vector<Result> kept;
  std::copy_if(results.begin(), results.end(), std::back_inserter(kept),
               [](const Result& result) { return result.has_face(); });
  return kept;
}

TEST(SeveralFaces, DetectsAllFacesOfTheFirstImage) {
  SeveralTracker tracker(3);
  const std::vector<Result> results = tracker.push_all({{60, 120}, {160, 80}, {260, 170}});
  ASSERT_EQ(results.size(), 3u);
  std::set<std::uint32_t> ids;
  std::set<int> places;
  for (const Result& result : results) {
    EXPECT_TRUE(result.has_face());
    EXPECT_EQ(result.proposal_runs, 1u);
    ids.insert(result.face_id);
    places.insert(static_cast<int>(std::lround(middle_x(result) / 10)));
  }
  EXPECT_EQ(ids, (std::set<std::uint32_t>{1, 2, 3}));
  EXPECT_EQ(places, (std::set<int>{6, 16, 26}));
}

TEST(SeveralFaces, TracksAtMostMaxFaces) {
  for (std::int32_t max_faces = 1; max_faces <= 3; ++max_faces) {
    SeveralTracker tracker(max_faces);
    for (int frame = 0; frame < 40; ++frame) {
      EXPECT_EQ(tracker.push_all({{60, 120}, {160, 80}, {260, 170}, {60, 210, 30}}).size(),
                static_cast<std::size_t>(max_faces));
    }
  }
}

TEST(SeveralFaces, IdsStayWithTheirFaces) {
  SeveralTracker tracker(2);
  std::uint32_t left = 0;
  for (int frame = 0; frame < 120; ++frame) {
    const float phase = 0.05f * static_cast<float>(frame);
    const std::vector<Disc> scene = {{80 + 25 * std::sin(phase), 120},
                                     {240 + 25 * std::cos(phase), 130 + 20 * std::sin(phase)}};
    const std::vector<Result> results = tracker.push_all(scene);
    ASSERT_EQ(results.size(), 2u) << frame;
    EXPECT_LT(results[0].face_id, results[1].face_id);
    const bool first_is_left = middle_x(results[0]) < middle_x(results[1]);
    const std::uint32_t id = results[first_is_left ? 0 : 1].face_id;
    left = frame == 0 ? id : left;
    EXPECT_EQ(id, left) << frame;
  }
}

TEST(SeveralFaces, DetectsNewFacesWithinOneRoundOfTiles) {
  for (const Disc newcomer : {Disc{250, 60, 24}, Disc{240, 150, 60}, Disc{200, 120, 110}}) {
    SeveralTracker tracker(2);
    const Disc first = {50, 120, 45};
    for (int frame = 0; frame < 7; ++frame) {
      ASSERT_EQ(tracker.push_all({first}).size(), 1u);
    }
    int waited = 0;
    while (tracker.push_all({first, newcomer}).size() < 2 && waited < 100) {
      ++waited;
    }
    EXPECT_LT(waited, 32) << newcomer.diameter;
    const Result result = tracker.push_all({first, newcomer})[1];
    EXPECT_NEAR(middle_x(result), newcomer.x, 0.05f * newcomer.diameter);
    EXPECT_EQ(result.face_id, 2u);
    EXPECT_EQ(result.proposal_runs, 1u) << "one detection in the whole image";
  }
}

TEST(SeveralFaces, OneDiscIsOneFace) {
  SeveralTracker tracker(4);
  for (int frame = 0; frame < 100; ++frame) {
    const float x = 160 + 70 * std::sin(0.04f * static_cast<float>(frame));
    EXPECT_EQ(tracker.push_all({{x, 120, 90}}).size(), 1u) << frame;
  }
}

// A small face beside one close to the camera: half of the larger crop lies between them.
TEST(SeveralFaces, TracksASmallFaceBesideALargeOne) {
  const Disc large = {110, 120, 100}, small = {183, 120, 20};
  SeveralTracker tracker(2);
  for (int frame = 0; frame < 40; ++frame) {
    const std::vector<Result> results = tracked(tracker.push_all({large, small}));
    ASSERT_EQ(results.size(), 2u) << frame;
    EXPECT_NEAR(middle_x(results[0]) + middle_x(results[1]), large.x + small.x, 8.0f);
    EXPECT_GT(std::abs(middle_x(results[0]) - middle_x(results[1])), 60.0f);
  }
}

TEST(SeveralFaces, FacesThatLeaveFadeAndAreForgotten) {
  SeveralTracker tracker(2);
  ASSERT_EQ(tracker.push_all({{80, 120}, {240, 120}}).size(), 2u);
  std::vector<Result> results;
  for (int frame = 0; frame < 12; ++frame) {
    results = tracker.push_all({{240, 120}});
  }
  ASSERT_EQ(results.size(), 2u) << "the lost face still fades";
  ASSERT_EQ(tracked(results).size(), 1u);
  EXPECT_NEAR(middle_x(tracked(results)[0]), 240, 3);
  for (int frame = 0; frame < 70; ++frame) {
    results = tracker.push_all({{240, 120}});
  }
  ASSERT_EQ(results.size(), 1u);
  EXPECT_TRUE(results[0].has_face());
}

TEST(SeveralFaces, FacesThatReturnSoonKeepTheirId) {
  SeveralTracker tracker(2);
  const std::vector<Result> before = tracker.push_all({{80, 120}, {240, 120}});
  ASSERT_EQ(before.size(), 2u);
  const std::uint32_t id = before[middle_x(before[0]) < 160 ? 0 : 1].face_id;
  for (int frame = 0; frame < 15; ++frame) {
    (void)tracker.push_all({{240, 120}});
  }
  std::vector<Result> after;
  for (int frame = 0; frame < 32; ++frame) {
    after = tracked(tracker.push_all({{95, 125}, {240, 120}}));
  }
  ASSERT_EQ(after.size(), 2u);
  EXPECT_EQ(after[middle_x(after[0]) < 160 ? 0 : 1].face_id, id);
}

TEST(SeveralFaces, ANewFaceGetsANewId) {
  SeveralTracker tracker(1);
  EXPECT_EQ(tracker.push_all({{80, 120}})[0].face_id, 1u);
  for (int frame = 0; frame < 10; ++frame) {
    (void)tracker.push_all({});
  }
  EXPECT_EQ(tracker.push_until_found(discs({{250, 120}})).face_id, 2u) << "another place";
  for (int frame = 0; frame < 100; ++frame) {
    (void)tracker.push_all({});
  }
  EXPECT_EQ(tracker.push_until_found(discs({{250, 120}})).face_id, 3u) << "after a long time";
}

TEST(SeveralFaces, TheOlderOfTwoThatMeetStays) {
  SeveralTracker tracker(2);
  std::vector<Result> results = tracker.push_all({{80, 120}, {240, 120}});
  ASSERT_EQ(results.size(), 2u);
  for (int frame = 0; frame <= 40; ++frame) {
    const float d = 80 - 2 * static_cast<float>(frame);
    results = tracker.push_all({{160 - d, 120}, {160 + d, 120}});
  }
  ASSERT_EQ(tracked(results).size(), 1u);
  EXPECT_EQ(tracked(results)[0].face_id, 1u);
}

// The animation of a face does not depend on other faces.
TEST(SeveralFaces, FacesDoNotAffectEachOther) {
  for (const std::int32_t lod : {1, 2, 4}) {
    SeveralTracker alone(1, lod), together(2, lod);
    for (int frame = 0; frame < 30; ++frame) {
      const Disc watched = {90, 120 + 10 * std::sin(0.2f * static_cast<float>(frame)), 60};
      const std::vector<Result> single = alone.push_all({watched});
      const std::vector<Result> both = together.push_all({watched, {250, 130, 40}});
      ASSERT_EQ(both.size(), 2u);
      const Result& same = both[middle_x(both[0]) < 160 ? 0 : 1];
      for (int i = 0; i < MIEN_CONTROL_COUNT; ++i) {
        ASSERT_NEAR(same.controls[i], single[0].controls[i], 2e-3f) << "frame " << frame;
      }
    }
  }
}

TEST(SeveralFaces, ResetRemovesAllFaces) {
  SeveralTracker tracker(2);
  (void)tracker.push_all({{80, 120}, {240, 120}});
  ASSERT_EQ(tracker.tracker().reset(), MIEN_OK);
  EXPECT_EQ(tracker.tracker().face_count(), 0);
  EXPECT_EQ(tracker.push_all({{80, 120}})[0].face_id, 1u);
}

TEST(SeveralFaces, RejectsInvalidIndices) {
  SeveralTracker tracker(2);
  Result result;
  EXPECT_EQ(tracker.tracker().get_face(0, result), MIEN_ERROR_OUT_OF_RANGE);
  (void)tracker.push_all({{80, 120}});
  EXPECT_EQ(tracker.tracker().get_face(0, result), MIEN_OK);
  EXPECT_EQ(tracker.tracker().get_face(1, result), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(tracker.tracker().get_face(-1, result), MIEN_ERROR_OUT_OF_RANGE);
  EXPECT_EQ(mien_tracker_get_face(nullptr, 0, &result), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_get_face(tracker.tracker().get(), 0, nullptr), MIEN_ERROR_NULL_ARGUMENT);
  EXPECT_EQ(mien_tracker_face_count(nullptr), 0);
}

TEST(Tiles, CoverAnAreaAnywhereInTheImage) {
  const tracker::Tiles tiles({{100, 200}, 60, 40}, 40, 10);
  ASSERT_EQ(tiles.count(), 2u);
  EXPECT_EQ(tiles.square(0).center.x, 120);
  EXPECT_EQ(tiles.square(1).center.x, 140);
  EXPECT_EQ(tiles.square(1).center.y, 220);
}

TEST(Tiles, EveryWindowLiesWithinOneTile) {
  for (const auto& [width, height, side] :
       {std::tuple{160.0f, 90.0f, 57.0f}, {160.0f, 160.0f, 57.0f}, {40.0f, 90.0f, 57.0f}}) {
    const tracker::Tiles tiles({{}, width, height}, side, 12.0f);
    for (float y = 0; y + 12 <= height; y += 1.7f) {
      for (float x = 0; x + 12 <= width; x += 1.7f) {
        bool whole = false;
        for (std::uint32_t i = 0; i < tiles.count(); ++i) {
          const tracker::Square tile = tiles.square(i);
          const float left = tile.center.x - tile.side / 2, top = tile.center.y - tile.side / 2;
          whole = whole || (x >= left - 0.01f && x + 12 <= left + side + 0.01f &&
                            y >= top - 0.01f && y + 12 <= top + side + 0.01f);
        }
        EXPECT_TRUE(whole) << x << ", " << y << " of " << width << " x " << height;
      }
    }
  }
}

}  // namespace
}  // namespace mien::tests
