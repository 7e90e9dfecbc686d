// Runs a network on each map of an array.
#include "apps/mien/networks/run.h"

#include <mien/engine.h>

#include <deque>

#include "apps/mien/networks/array_shape.h"
#include "apps/mien/networks/model_files.h"
#include "apps/mien/networks/tiers.h"
#include "apps/mien/outputs/distinct_files.h"
#include "apps/mien/outputs/output_file.h"
#include "apps/mien/system/failure.h"
#include "formats/npy.h"

namespace mien::app {
namespace {

std::string network_names(const WeightsContent& file) {
  std::string names;
  for (std::int32_t i = 0; i < file.network_count(); ++i) {
    names.append(i == 0 ? "" : ", ").append(file.network(i).name);
  }
  return names;
}

NetworkInfo chosen_network(const WeightsContent& file, const RunOptions& options) {
  if (options.network.empty() && file.network_count() == 1) {
    return file.network(0);
  }
  for (std::int32_t i = 0; i < file.network_count(); ++i) {
    if (options.network == file.network(i).name) {
      return file.network(i);
    }
  }
  throw Failure(kExitUsage, "--network: unknown network in " + options.model + " (got '" +
                                options.network + "', expected one of " + network_names(file) +
                                ")");
}

formats::NpyArray read_array(const Blob& blob, const std::string& path) {
  formats::NpyArray array;
  const auto status =
      formats::read_npy({static_cast<const std::byte*>(blob.data()), blob.size()}, &array);
  if (status != formats::NpyStatus::kOk) {
    throw Failure(kExitNoInput, path + ": " + formats::message(status));
  }
  return array;
}

// The index of element (y, x, c) in an array of a map.
class ElementIndex {
 public:
  ElementIndex(const TensorShape& shape, MapLayout layout) {
    const auto h = static_cast<std::size_t>(shape.height);
    const auto w = static_cast<std::size_t>(shape.width);
    const auto c = static_cast<std::size_t>(shape.channels);
    const bool first = layout == MapLayout::kChannelsFirst;
    channel_ = first ? h * w : 1;
    pixel_ = first ? 1 : c;
  }
  // `pixel`: y * width + x.
  [[nodiscard]] std::size_t at(std::size_t pixel, std::size_t channel) const {
    return pixel * pixel_ + channel * channel_;
  }

 private:
  std::size_t channel_, pixel_;
};

struct MapSize {
  explicit MapSize(const TensorShape& shape)
      : pixels(static_cast<std::size_t>(shape.height) * static_cast<std::size_t>(shape.width)),
        channels(static_cast<std::size_t>(shape.channels)) {}
  [[nodiscard]] std::size_t elems() const { return pixels * channels; }
  // The index in the engine's layout, blocks of 8 channels; see mien_network in
  // include/mien/mien.h.
  [[nodiscard]] std::size_t blocked(std::size_t pixel, std::size_t channel) const {
    return (channel / 8 * pixels + pixel) * 8 + channel % 8;
  }
  std::size_t pixels, channels;
};

void set_input(const formats::NpyArray& array, std::uint64_t step, MapLayout layout,
               Network& runner) {
  const TensorShape shape = runner.input_shape();
  const MapSize size(shape);
  const ElementIndex places(shape, layout);
  const bool interleaved = size.channels <= 4 && size.pixels > 1;
  const std::span<float> input = runner.input();
  for (std::size_t p = 0; p < size.pixels; ++p) {
    for (std::size_t c = 0; c < size.channels; ++c) {
      input[interleaved ? p * size.channels + c : size.blocked(p, c)] =
          array.value(step * size.elems() + places.at(p, c));
    }
  }
}

void write_output(const Network& runner, std::int32_t index, MapLayout layout, OutputFile& file) {
  const TensorShape shape = runner.output_shape(index);
  const MapSize size(shape);
  const ElementIndex places(shape, layout);
  std::vector<float> values(size.elems());
  for (std::size_t p = 0; p < size.pixels; ++p) {
    for (std::size_t c = 0; c < size.channels; ++c) {
      values[places.at(p, c)] = runner.output(index)[size.blocked(p, c)];
    }
  }
  file.write({reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)});
}

void write_header(const std::vector<std::uint64_t>& shape, OutputFile& file) {
  const formats::NpyHeader header = formats::npy_header(shape);
  file.write({header.bytes, sizeof header.bytes});
}

// Resets the network at the start of each stream. Of the axes before the map, the last counts time
// steps and the others count streams.
void run_steps(const formats::NpyArray& array, const ArrayShape& shape, MapLayout layout,
               Network& runner, std::deque<OutputFile>& files) {
  for (std::uint64_t step = 0; step < shape.steps(); ++step) {
    if (step % shape.steps_per_stream() == 0) {
      runner.reset();
    }
    set_input(array, step, layout, runner);
    runner.run();
    for (std::int32_t i = 0; i < runner.output_count(); ++i) {
      write_output(runner, i, layout, files[static_cast<std::size_t>(i)]);
    }
  }
}

}  // namespace

void run_network(const RunOptions& options) {
  const OpenedWeights model({options.model});
  const Blob data(options.input, kExitNoInput);
  const WeightsContent file(model.weights());
  const NetworkInfo network = chosen_network(file, options);
  if (static_cast<std::size_t>(network.outputs) != options.outputs.size()) {
    throw Failure(kExitUsage, "--output: wrong number of arrays (got " +
                                  std::to_string(options.outputs.size()) + ", expected " +
                                  std::to_string(network.outputs) + ")");
  }
  require_distinct_files({options.model, options.input}, options.outputs);
  const formats::NpyArray array = read_array(data, options.input);
  const ArrayShape shape(array.shape(), network, options.layout);
  if (!shape.fits()) {
    throw Failure(kExitNoInput, options.input + ": " + shape.mismatch());
  }
  NetworkConfig config(model.weights(), network.name);
  config.height = shape.map().height;
  config.width = shape.map().width;
  if (!options.tier.empty()) {
    config.cpu_mask = cpu_mask(options.tier);
  }
  Network runner;
  Error error;
  if (runner.create(config, &error) != MIEN_OK) {
    throw Failure(kExitModel, options.model + ": " + error.message());
  }
  std::deque<OutputFile> files;
  for (std::int32_t i = 0; i < runner.output_count(); ++i) {
    files.emplace_back(options.outputs[static_cast<std::size_t>(i)]);
    write_header(shape.output(runner.output_shape(i)), files.back());
  }
  run_steps(array, shape, options.layout, runner, files);
  for (OutputFile& one : files) {
    one.finish();
  }
}

}  // namespace mien::app
