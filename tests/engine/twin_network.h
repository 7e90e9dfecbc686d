// A network with random weights, built twice: in a weight file, and of plain layers as a reference.
#pragma once

#include <functional>
#include <map>
#include <random>
#include <vector>

#include "formats/mien_writer.h"
#include "tests/engine/plain_layers.h"

namespace mien::tests {

class TwinNetwork {
 public:
  using Index = formats::LayerIndex;
  using Options = formats::LayerOptions;

  // `writer` must outlive this object.
  TwinNetwork(formats::NetworkWriter& writer, formats::InputShape input, unsigned seed);

  // Each returns the new layer's value. Adds random slopes if `options` has PReLU.
  Index conv2d(Index x, std::uint32_t outputs, std::uint32_t kernel_h, std::uint32_t kernel_w,
               Options options = {});
  Index depthwise(Index x, std::uint32_t kernel_h, std::uint32_t kernel_w, Options options = {});
  Index pointwise(Index x, std::uint32_t outputs, Options options = {});
  Index fully_connected(Index x, std::uint32_t outputs, Options options = {});
  Index causal_conv(Index x, std::uint32_t outputs, Options options = {});
  Index lstm(Index x, std::uint32_t hidden);
  Index max_pool(Index x, std::uint32_t kernel_h, std::uint32_t kernel_w, Options options = {});
  Index add(Index a, Index b);
  Index activation(Index x, Options options);
  Index softmax(Index x);
  Index global_average_pool(Index x);
  Index concat(Index a, Index b);
  Index slice(Index x, std::uint16_t first_channel, std::uint32_t channels, Options options = {});
  Index multiply(Index a, Index b);
  Index divide(Index a, Index b);
  Index broadcast_add(Index a, Index b);
  Index resize(Index x, std::uint32_t height, std::uint32_t width, formats::ResizeGrid grid,
               formats::ResizeSampling sampling);
  Index rearrange(Index x, formats::ReadingOrder order, formats::InputShape shape);
  Index normalize(Index x, float epsilon);
  void output(Index x);

  // Only its shape is meaningful.
  [[nodiscard]] const Map& value(Index x) const { return probe_[x]; }
  [[nodiscard]] Index last() const { return static_cast<Index>(evaluations_.size()); }
  [[nodiscard]] const std::vector<Index>& outputs() const { return outputs_; }

  Map random_input();
  // Runs one step and returns all values; keeps the state of temporal layers for the next step.
  std::vector<Map> run(const Map& input);
  void reset();

 private:
  using Evaluate = std::function<Map(const std::vector<Map>&)>;

  formats::Array weights(std::vector<std::uint32_t> shape, std::size_t fan_in);
  Bias bias(std::size_t outputs);
  void add_slopes(Options& options, std::size_t channels);
  Index append(Index index, Evaluate evaluate);

  formats::NetworkWriter& writer_;
  std::mt19937 random_;
  std::vector<Evaluate> evaluations_;
  std::vector<Map> probe_;
  std::vector<Index> outputs_;
  std::map<Index, Map> previous_;
  std::map<Index, LstmState> cells_;
};

}  // namespace mien::tests
