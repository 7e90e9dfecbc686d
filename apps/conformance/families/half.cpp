#include <cmath>

#include "apps/conformance/families/common.h"

namespace mien::conformance {
namespace {

using kernels::FloatToHalfArgs;
using kernels::HalfToFloatArgs;

constexpr std::uint32_t kInfinity = 0x7C00;  // as a half; NaNs lie above

// The value of a half that is not a NaN, by the definition of the format (IEEE 754, 3.4).
double value_of(std::uint32_t half) {
  const auto exponent = static_cast<int>((half >> 10) & 31);
  const double fraction = half & 1023;
  double magnitude =
      exponent == 0 ? std::ldexp(fraction, -24) : std::ldexp(1024 + fraction, exponent - 25);
  magnitude = exponent == 31 ? HUGE_VAL : magnitude;
  return (half & 0x8000) != 0 ? -magnitude : magnitude;
}

// All halves but NaNs.
std::vector<std::uint16_t> all_halves() {
  std::vector<std::uint16_t> halves;
  for (std::uint32_t half = 0; half < 0x10000; ++half) {
    if ((half & 0x7FFF) <= kInfinity) {
      halves.push_back(static_cast<std::uint16_t>(half));
    }
  }
  return halves;
}

Case widening(const std::vector<std::uint16_t>& halves) {
  std::vector<Approx> y;
  y.reserve(halves.size());
  for (const std::uint16_t half : halves) {
    y.push_back(exact(value_of(half)));
  }
  const auto n = static_cast<std::int32_t>(halves.size());
  Case test;
  test.shape = std::to_string(n) + " elements";
  test.buffers = {reads(halves), writes(Element::kFloat, y)};
  test.bind = [=](const Places& places) {
    return arguments(HalfToFloatArgs{places.halves(0), places.floats(1), n});
  };
  test.call = call<HalfToFloatArgs>;
  return test;
}

struct Rounding {
  float from;
  std::uint32_t to;  // a half
};

// Both sides and the middle of every gap between halves: ties go to the even one. Behind the
// largest finite half comes infinity, as if there were one more.
std::vector<Rounding> all_roundings() {
  std::vector<Rounding> all;
  for (std::uint32_t low = 0; low < kInfinity; ++low) {
    const double next = low + 1 == kInfinity ? 65536.0 : value_of(low + 1);
    const auto middle = static_cast<float>((value_of(low) + next) / 2);
    all.push_back({static_cast<float>(value_of(low)), low});
    all.push_back({middle, low + (low & 1u)});
    all.push_back({std::nextafter(middle, 0.0f), low});
    all.push_back({std::nextafter(middle, HUGE_VALF), low + 1});
  }
  all.push_back({1e30f, kInfinity});
  all.push_back({HUGE_VALF, kInfinity});
  all.push_back({1e-30f, 0});
  for (std::size_t i = 0, n = all.size(); i < n; ++i) {
    all.push_back({-all[i].from, all[i].to | 0x8000u});
  }
  return all;
}

Case narrowing(const std::vector<Rounding>& roundings) {
  std::vector<float> x;
  std::vector<Approx> y;
  for (const Rounding& one : roundings) {
    x.push_back(one.from);
    y.push_back(exact(one.to));
  }
  const auto n = static_cast<std::int32_t>(x.size());
  Case test;
  test.shape = std::to_string(n) + " elements";
  test.buffers = {reads(x), writes(Element::kHalf, y)};
  test.bind = [=](const Places& places) {
    return arguments(FloatToHalfArgs{places.floats(0), places.halves(1), n});
  };
  test.call = call<FloatToHalfArgs>;
  return test;
}

// Everything at once in the first case; then pieces, for the tails.
template <class T>
std::vector<T> piece(RandomValues& random, std::vector<T> all) {
  if (random.case_number() == 0) {
    return all;
  }
  const int n = random.size(150);
  const int first = random.between(0, static_cast<int>(all.size()) - n);
  return {all.begin() + first, all.begin() + first + n};
}

}  // namespace

template <>
Case random_case<HalfToFloatArgs>(RandomValues& random) {
  return widening(piece(random, all_halves()));
}

template <>
Case typical_case<HalfToFloatArgs>(RandomValues& random) {
  return widening(random.halves(4096));
}

template <>
Case random_case<FloatToHalfArgs>(RandomValues& random) {
  return narrowing(piece(random, all_roundings()));
}

template <>
Case typical_case<FloatToHalfArgs>(RandomValues&) {
  std::vector<Rounding> some = all_roundings();
  some.resize(4096);
  return narrowing(some);
}

}  // namespace mien::conformance
