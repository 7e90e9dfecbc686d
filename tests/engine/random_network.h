// A valid network of random layers, whose values have long and overlapping lifetimes.
#pragma once

#include <algorithm>
#include <array>
#include <functional>
#include <initializer_list>
#include <utility>
#include <vector>

#include "tests/engine/twin_network.h"

namespace mien::tests {

class RandomNetwork {
 public:
  // Chooses an index below the given number.
  using Choose = std::function<std::size_t(std::size_t)>;

  RandomNetwork(formats::NetworkWriter& writer, formats::InputShape input, unsigned seed,
                Choose choose)
      : twin(writer, input, seed), choose_(std::move(choose)), reads_{0} {
    const int layers = between(4, 24);
    note(twin.conv2d(0, channels(), 3, 3, options()), {0});
    while (twin.last() < static_cast<Index>(layers)) {
      add_layer();
    }
    for (auto i = between(0, 2); i > 0; --i) {
      promote(pick());
    }
    gather_loose_ends();
  }

  TwinNetwork twin;

 private:
  using Index = TwinNetwork::Index;
  using Options = TwinNetwork::Options;
  using LayerActivation = formats::LayerActivation;

  template <class Int>
  Int between(Int low, Int high) {
    return static_cast<Int>(low +
                            static_cast<Int>(choose_(static_cast<std::size_t>(high - low) + 1)));
  }
  std::uint32_t channels() { return between(1u, 20u); }

  Options options() {
    const LayerActivation kinds[] = {LayerActivation::kNone, LayerActivation::kLeakyRelu,
                                     LayerActivation::kPrelu, LayerActivation::kTanh};
    Options options;
    options.activation = kinds[between(0, 3)];
    options.alpha = options.activation == LayerActivation::kLeakyRelu ? 0.25f : 0.0f;
    return options;
  }

  // Any value except the image; preferably one without a reader.
  Index pick() {
    const std::vector<Index> loose = loose_ends();
    if (!loose.empty() && between(0, 2) > 0) {
      return loose[between(std::size_t{0}, loose.size() - 1)];
    }
    return between(Index{1}, twin.last());
  }

  std::vector<Index> loose_ends() const {
    std::vector<Index> loose;
    for (Index value = 1; value <= twin.last(); ++value) {
      if (reads_[value] == 0) {
        loose.push_back(value);
      }
    }
    return loose;
  }

  void note(Index, std::initializer_list<Index> read) {
    reads_.push_back(0);
    for (const Index value : read) {
      ++reads_[value];
    }
  }

  void add_layer() {
    const Index x = pick();
    const Map& map = twin.value(x);
    const bool is_vector = map.h == 1 && map.w == 1;
    const int choice = between(0, 14);
    if (choice >= 12) {
      return choice == 14 && map.h >= 3 && map.w >= 3 ? add_block(x) : add_converted(x);
    }
    if (choice >= 10) {
      return add_part(x);
    }
    if (choice <= 3 && add_sum(x)) {
      return;
    }
    if (is_vector) {
      note(choice % 3 == 0   ? twin.lstm(x, 8 * between(1u, 2u))
           : choice % 3 == 1 ? twin.causal_conv(x, channels(), options())
                             : twin.fully_connected(x, channels(), options()),
           {x});
    } else {
      note(add_map_layer(x, map, choice), {x});
    }
  }

  Index add_map_layer(Index x, const Map& map, int choice) {
    Options padded = options();
    padded.padding = {1, 1, 1, 1};
    Options unpadded = options();
    if (map.h > 8 && between(0, 1) == 0) {
      unpadded.stride_x = unpadded.stride_y = 2;
    }
    switch (map.h < 3 || map.w < 3 ? 9 : choice) {
      case 4:
        return twin.depthwise(x, 3, 3, unpadded);
      case 5:
        return twin.depthwise(x, 3, 3, padded);
      case 6:
        return twin.conv2d(x, channels(), 3, 3, padded);
      case 7:
        return twin.max_pool(x, 2, 2);
      case 8:
        return twin.softmax(x);
      case 9:
        return twin.fully_connected(x, channels(), options());
      default:
        return twin.pointwise(x, static_cast<std::uint32_t>(map.c), options());
    }
  }

  // An inverted residual block, whose last layer may have 8-bit inputs.
  void add_block(Index x) {
    Options relu6, bounded;
    relu6.activation = LayerActivation::kRelu6;
    bounded.input_bound = between(0, 1) == 0 ? 6.0f : 0.0f;
    const Index expanded = twin.pointwise(x, channels(), relu6);
    note(expanded, {x});
    const Index filtered = twin.depthwise(expanded, 3, 3, relu6);
    note(filtered, {expanded});
    note(twin.pointwise(filtered, channels(), bounded), {filtered});
  }

  // Adds the nearest value that fits; often a residual around a pointwise layer.
  bool add_sum(Index x) {
    for (Index other = twin.last(); other > 0; --other) {
      const Map &a = twin.value(x), &b = twin.value(other);
      if (other != x && a.c == b.c && b.h >= a.h && b.w >= a.w && (b.h - a.h) % 2 == 0 &&
          (b.w - a.w) % 2 == 0) {
        note(twin.add(x, other), {x, other});
        return true;
      }
    }
    return false;
  }

  // Concatenates x with a value of the same size, or takes a part of x.
  void add_part(Index x) {
    const Map& map = twin.value(x);
    for (Index other = twin.last(); other > 0; --other) {
      const Map& b = twin.value(other);
      if (other != x && b.h == map.h && b.w == map.w && map.c + b.c <= 40) {
        note(twin.concat(x, other), {x, other});
        return;
      }
    }
    if (map.h > 4 && between(0, 3) == 0) {
      note(twin.global_average_pool(x), {x});
      return;
    }
    const auto first = between(std::size_t{0}, map.c - 1);
    Options margins;
    margins.padding = {static_cast<std::uint16_t>(map.h > 2), 0, 0,
                       static_cast<std::uint16_t>(map.w > 2)};
    const auto kept = static_cast<std::uint32_t>(map.c - first);
    note(twin.slice(x, static_cast<std::uint16_t>(first), kept, margins), {x});
  }

  // A layer type that only converted networks contain.
  void add_converted(Index x) {
    const Map& map = twin.value(x);
    switch (between(0, 4)) {
      case 0:
        return note(add_resize(x), {x});
      case 1:
        return note(add_rearrange(x, map), {x});
      case 2:
        return note(twin.normalize(x, 0.9f), {x});
      case 3:
        return note(add_curve(x), {x});
      default:
        return add_combination(x, map);
    }
  }

  Index add_resize(Index x) {
    const auto grid = static_cast<formats::ResizeGrid>(between(0, 2));
    const auto sampling = static_cast<formats::ResizeSampling>(between(0, 4));
    const auto height = between(1u, 15u);
    return twin.resize(x, height, between(1u, 15u), grid, sampling);
  }

  Index add_rearrange(Index x, const Map& map) {
    std::array<std::size_t, 3> sizes = {map.h, map.w, map.c};
    std::swap(sizes[0], sizes[between(std::size_t{0}, std::size_t{2})]);
    std::swap(sizes[1], sizes[between(std::size_t{1}, std::size_t{2})]);
    const auto order = static_cast<formats::ReadingOrder>(between(0, 5));
    return twin.rearrange(
        x, order,
        {static_cast<std::uint32_t>(sizes[0]), static_cast<std::uint32_t>(sizes[1]),
         static_cast<std::uint32_t>(sizes[2])});
  }

  Index add_curve(Index x) {
    const LayerActivation kinds[] = {LayerActivation::kHardSwish, LayerActivation::kSwish,
                                     LayerActivation::kGelu, LayerActivation::kGeluTanh,
                                     LayerActivation::kErf};
    return activated(x, kinds[between(0, 4)]);
  }

  Index activated(Index x, LayerActivation kind) {
    Options options;
    options.activation = kind;
    return twin.activation(x, options);
  }

  // Multiplies, divides or adds x and the nearest value of the same size or with axes to broadcast,
  // possibly x itself. A factor is in 0..1, a divisor in 1/e..e.
  void add_combination(Index x, const Map& map) {
    const auto fits = [](std::size_t size, std::size_t whole) {
      return size == whole || size == 1;
    };
    Index other = twin.last();
    while (other > 1 && !(fits(twin.value(other).h, map.h) && fits(twin.value(other).w, map.w) &&
                          fits(twin.value(other).c, map.c))) {
      --other;
    }
    const Map& b = twin.value(other);
    other = fits(b.h, map.h) && fits(b.w, map.w) && fits(b.c, map.c) ? other : x;
    const int kind = between(0, 2);
    if (kind == 0) {
      return note(twin.broadcast_add(x, other), {x, other});
    }
    const Index bounded =
        activated(other, kind == 1 ? LayerActivation::kSigmoid : LayerActivation::kTanh);
    note(bounded, {other});
    if (kind == 1) {
      return note(twin.multiply(x, bounded), {x, bounded});
    }
    const Index divisor = activated(bounded, LayerActivation::kExp);
    note(divisor, {bounded});
    note(twin.divide(x, divisor), {x, divisor});
  }

  void promote(Index value) {
    const auto& outputs = twin.outputs();
    if (std::find(outputs.begin(), outputs.end(), value) == outputs.end()) {
      twin.output(value);
      ++reads_[value];
    }
  }

  // Every value must be read or be an output; at most four outputs are possible.
  void gather_loose_ends() {
    while (loose_ends().size() > 2) {
      const Index a = loose_ends()[0], b = loose_ends()[1];
      const Index first = twin.fully_connected(a, 8);
      note(first, {a});
      const Index second = twin.fully_connected(b, 8);
      note(second, {b});
      note(twin.add(first, second), {first, second});
    }
    for (const Index value : loose_ends()) {
      promote(value);
    }
  }

  Choose choose_;
  std::vector<int> reads_;
};

}  // namespace mien::tests
