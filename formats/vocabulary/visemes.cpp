// Converts between controls, visemes and mouth shapes.
#include "formats/vocabulary/visemes.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <numeric>
#include <string_view>

namespace mien::formats {
namespace {

constexpr std::size_t kPoses = kVisemeCount - 1;  // all except silence

// A control of a pose; `right` differs from `left` for controls of both sides.
struct Part {
  std::size_t left, right;
  double value;
};

constexpr Part at(std::size_t control, double value) { return {control, control, value}; }

constexpr Part kJaw = at(control("jawOpen"), 1.0);
constexpr Part kClose = at(control("mouthClose"), 1.0);
constexpr Part kFunnel = at(control("mouthFunnel"), 1.0);
constexpr Part kPucker = at(control("mouthPucker"), 1.0);
constexpr Part kRollLower = at(control("mouthRollLower"), 1.0);
constexpr Part kRollUpper = at(control("mouthRollUpper"), 1.0);
constexpr Part kShrugUpper = at(control("mouthShrugUpper"), 1.0);
constexpr Part kShrugLower = at(control("mouthShrugLower"), 1.0);
constexpr Part kForward = at(control("jawForward"), 1.0);
constexpr Part kTongue = at(control("tongueOut"), 1.0);
constexpr Part kSmile = {control("mouthSmileLeft"), control("mouthSmileRight"), 1.0};
constexpr Part kStretch = {control("mouthStretchLeft"), control("mouthStretchRight"), 1.0};
constexpr Part kPress = {control("mouthPressLeft"), control("mouthPressRight"), 1.0};
constexpr Part kLowerDown = {control("mouthLowerDownLeft"), control("mouthLowerDownRight"), 1.0};
constexpr Part kUpperUp = {control("mouthUpperUpLeft"), control("mouthUpperUpRight"), 1.0};
constexpr Part kDimple = {control("mouthDimpleLeft"), control("mouthDimpleRight"), 1.0};

constexpr Part kMouth[] = {kJaw,        kClose,      kFunnel,  kPucker, kRollLower, kRollUpper,
                           kShrugUpper, kShrugLower, kForward, kTongue, kSmile,     kStretch,
                           kPress,      kLowerDown,  kUpperUp, kDimple};

constexpr Part operator*(double value, const Part& part) { return {part.left, part.right, value}; }

constexpr std::size_t kParts = std::size(kMouth);
using Pose = std::array<double, kParts>;  // one value per part of kMouth

constexpr bool has_sides(const Part& part) { return part.left != part.right; }

template <std::size_t N>
constexpr Pose pose(const Part (&parts)[N]) {
  Pose result{};
  for (std::size_t i = 0; i < kParts; ++i) {
    for (const Part& part : parts) {
      result[i] += part.left == kMouth[i].left ? part.value : 0.0;
    }
  }
  return result;
}

// Our own poses, after the movement of articulators (chart of the International Phonetic
// Association), in the order of kVisemeNames without silence. All are linearly independent, so that
// mixtures are unique.
constexpr std::array<Pose, kPoses> kPoseOfViseme = {
    pose({0.5 * kPress, 0.35 * kRollLower, 0.35 * kRollUpper, 0.1 * kClose}),            // PP
    pose({0.55 * kRollLower, 0.3 * kUpperUp, 0.06 * kJaw}),                              // FF
    pose({0.5 * kTongue, 0.18 * kJaw, 0.2 * kLowerDown}),                                // TH
    pose({0.14 * kJaw, 0.35 * kLowerDown, 0.3 * kUpperUp}),                              // DD
    pose({0.26 * kJaw, 0.1 * kStretch, 0.35 * kDimple}),                                 // kk
    pose({0.5 * kFunnel, 0.3 * kForward, 0.25 * kUpperUp, 0.08 * kJaw}),                 // CH
    pose({0.45 * kStretch, 0.35 * kLowerDown, 0.03 * kJaw}),                             // SS
    pose({0.16 * kJaw, 0.3 * kShrugUpper, 0.15 * kLowerDown}),                           // nn
    pose({0.35 * kPucker, 0.3 * kFunnel, 0.12 * kJaw, 0.3 * kShrugLower}),               // RR
    pose({0.65 * kJaw, 0.2 * kLowerDown, 0.1 * kUpperUp}),                               // aa
    pose({0.35 * kJaw, 0.15 * kSmile, 0.35 * kStretch, 0.2 * kDimple, 0.2 * kUpperUp}),  // E
    pose({0.2 * kJaw, 0.45 * kSmile}),                                                   // ih
    pose({0.42 * kJaw, 0.5 * kFunnel, 0.1 * kPucker}),                                   // oh
    pose({0.14 * kJaw, 0.75 * kPucker, 0.15 * kFunnel}),                                 // ou
};

// In the order of kVisemeNames.
constexpr std::string_view kShapeOfViseme = "XAGHBBBBBEDCBEF";
constexpr std::string_view kVisemeOfShape[] = {"PP", "DD", "E",  "aa", "oh",
                                               "ou", "FF", "TH", "sil"};

using Weights = std::array<double, kPoses>;
using Chosen = std::array<bool, kPoses>;

// The normal equations of the poses: products of all pairs.
constexpr std::array<Weights, kPoses> kGram = [] {
  std::array<Weights, kPoses> products{};
  for (std::size_t i = 0; i < kPoses; ++i) {
    for (std::size_t j = 0; j < kPoses; ++j) {
      for (std::size_t k = 0; k < kParts; ++k) {
        products[i][j] +=
            kPoseOfViseme[i][k] * kPoseOfViseme[j][k] * (has_sides(kMouth[k]) ? 2.0 : 1.0);
      }
    }
  }
  return products;
}();

// Least squares over the chosen poses, with others 0, by Cholesky decomposition.
Weights solve(const Weights& target, const Chosen& chosen) {
  std::array<std::size_t, kPoses> index{};
  std::size_t n = 0;
  for (std::size_t i = 0; i < kPoses; ++i) {
    if (chosen[i]) {
      index[n++] = i;
    }
  }
  std::array<Weights, kPoses> lower{};
  Weights y{};
  for (std::size_t i = 0; i < n; ++i) {
    double known = target[index[i]];
    for (std::size_t j = 0; j <= i; ++j) {
      double sum = kGram[index[i]][index[j]];
      for (std::size_t k = 0; k < j; ++k) {
        sum -= lower[i][k] * lower[j][k];
      }
      lower[i][j] = i == j ? std::sqrt(sum) : sum / lower[j][j];
    }
    for (std::size_t k = 0; k < i; ++k) {
      known -= lower[i][k] * y[k];
    }
    y[i] = known / lower[i][i];
  }
  Weights solution{};
  for (std::size_t left = n; left > 0; --left) {
    const std::size_t i = left - 1;
    double sum = y[i];
    for (std::size_t k = i + 1; k < n; ++k) {
      sum -= lower[k][i] * solution[index[k]];
    }
    solution[index[i]] = sum / lower[i][i];
  }
  return solution;
}

// Non-negative least squares (Lawson and Hanson, Solving Least Squares Problems, 1974, chapter 23).
// `mouth`: the sum of both sides of each part.
Weights mixture(const Pose& mouth) {
  constexpr double kTolerance = 1e-12;
  constexpr int kMaxSteps = 10 * static_cast<int>(kPoses);
  Weights target{}, weights{};
  for (std::size_t i = 0; i < kPoses; ++i) {
    target[i] = std::inner_product(mouth.begin(), mouth.end(), kPoseOfViseme[i].begin(), 0.0);
  }
  Chosen chosen{};
  for (int step = 0; step < kMaxSteps; ++step) {
    std::size_t best = kPoses;
    double steepest = kTolerance;
    for (std::size_t i = 0; i < kPoses; ++i) {
      double gradient = target[i];
      for (std::size_t j = 0; j < kPoses; ++j) {
        gradient -= kGram[i][j] * weights[j];
      }
      if (!chosen[i] && gradient > steepest) {
        steepest = gradient;
        best = i;
      }
    }
    if (best == kPoses) {
      break;
    }
    chosen[best] = true;
    for (Weights wanted = solve(target, chosen);; wanted = solve(target, chosen)) {
      double way = 1.0;  // step towards the solution, limited so that no weight becomes negative
      for (std::size_t i = 0; i < kPoses; ++i) {
        if (chosen[i] && wanted[i] <= 0.0) {
          way = std::min(way, weights[i] / (weights[i] - wanted[i]));
        }
      }
      for (std::size_t i = 0; i < kPoses; ++i) {
        weights[i] += way * (wanted[i] - weights[i]);
      }
      if (way >= 1.0) {
        break;
      }
      for (std::size_t i = 0; i < kPoses; ++i) {
        if (chosen[i] && wanted[i] <= 0.0 && weights[i] <= kTolerance) {
          chosen[i] = false;
          weights[i] = 0.0;
        }
      }
    }
  }
  return weights;
}

}  // namespace

std::array<double, kVisemeCount> visemes_of(const std::array<double, kControlCount>& controls) {
  std::array<double, kVisemeCount> visemes;
  visemes.fill(kNoNumber);
  Pose mouth{};
  bool any = false;
  for (std::size_t k = 0; k < kParts; ++k) {
    const double left = controls[kMouth[k].left], right = controls[kMouth[k].right];
    mouth[k] = or_zero(left) + (has_sides(kMouth[k]) ? or_zero(right) : 0.0);
    any = any || driven(left) || driven(right);
  }
  if (!any) {
    return visemes;
  }
  const Weights weights = mixture(mouth);
  double sum = 0.0;
  for (const double weight : weights) {
    sum += weight;
  }
  const double scale = 1.0 / std::max(1.0, sum);
  for (std::size_t i = 0; i < kPoses; ++i) {
    visemes[i + 1] = std::clamp(weights[i] * scale, 0.0, 1.0);
  }
  visemes[0] = std::max(0.0, 1.0 - sum);
  return visemes;
}

std::array<std::size_t, 2> leading_controls(std::size_t viseme) {
  if (viseme == 0 || viseme > kPoses) {
    return {kControlCount, kControlCount};
  }
  const Pose& moved = kPoseOfViseme[viseme - 1];
  const auto largest = std::max_element(moved.begin(), moved.end()) - moved.begin();
  const Part& part = kMouth[static_cast<std::size_t>(largest)];
  return {part.left, part.right};
}

std::array<double, kControlCount> controls_of_visemes(
    std::span<const double, kVisemeCount> visemes) {
  std::array<double, kControlCount> controls;
  controls.fill(kNoNumber);
  if (std::none_of(visemes.begin(), visemes.end(), driven)) {
    return controls;
  }
  for (std::size_t i = 0; i < kParts; ++i) {
    double sum = 0.0;
    for (std::size_t k = 0; k < kPoses; ++k) {
      sum += or_zero(visemes[k + 1]) * kPoseOfViseme[k][i];
    }
    controls[kMouth[i].left] = controls[kMouth[i].right] = std::min(sum, 1.0);
  }
  return controls;
}

char mouth_shape_of(std::span<const double, kVisemeCount> visemes) {
  constexpr double kSilent = 0.75;
  std::size_t strongest = 0;
  for (std::size_t i = 1; i < kVisemeCount; ++i) {
    if (strongest == 0 ? driven(visemes[i]) : or_zero(visemes[i]) > visemes[strongest]) {
      strongest = i;
    }
  }
  const bool silent = or_zero(visemes[0]) > kSilent || strongest == 0 || visemes[strongest] == 0.0;
  return silent ? 'X' : kShapeOfViseme[strongest];
}

std::array<double, kVisemeCount> visemes_of_mouth_shape(char shape) {
  std::array<double, kVisemeCount> visemes{};
  const std::size_t which = kMouthShapes.find(shape);
  visemes[index_of(kVisemeOfShape[std::min(which, kMouthShapes.size() - 1)], kVisemeNames)] = 1.0;
  return visemes;
}

}  // namespace mien::formats
