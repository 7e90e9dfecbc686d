// C API: custom networks.
#include <mien/mien.h>

#include <cstddef>
#include <cstdint>
#include <new>

#include "engine/arena.h"
#include "engine/network.h"
#include "kernels/float_mode.h"
#include "tracker/api/allocate.h"
#include "tracker/api/report.h"
#include "tracker/api/versioned_struct.h"
#include "tracker/api/weights_references.h"
#include "tracker/encoders/weights.h"

struct mien_network {
  mien::engine::Network network;
  mien_allocator allocator = {};
  const mien_weights* weights = nullptr;
  bool allocated = false;  // by the allocator; false: memory of the caller
};

namespace {

using mien::engine::Arena;
using mien::engine::Model;
using mien::engine::NetworkForm;
using mien::engine::Shape;
using mien::tracker::fail;
using mien::tracker::report;

mien_status read_config(const mien_network_config* given, mien_network_config& config,
                        mien_error_detail& error) {
  if (given == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "config");
  }
  mien_network_config_default(&config);
  if (!mien::tracker::read_struct(*given, MIEN_SIZE_THROUGH(mien_network_config, weights),
                                  config)) {
    return fail(error, MIEN_ERROR_STRUCT_SIZE, "struct_size");
  }
  if (config.weights == nullptr) {
    return fail(error, MIEN_ERROR_NULL_ARGUMENT, "weights");
  }
  if (!mien::tracker::is_valid(config.allocator)) {
    return fail(error, MIEN_ERROR_OUT_OF_RANGE, "allocator");
  }
  const bool one_side = (config.height == 0) != (config.width == 0);
  if (config.height < 0 || (one_side && config.height == 0)) {
    return fail(error, MIEN_ERROR_OUT_OF_RANGE, "height");
  }
  return config.width < 0 || one_side ? fail(error, MIEN_ERROR_OUT_OF_RANGE, "width") : MIEN_OK;
}

// A network, with the shape of the input that the configuration selects.
struct Selection {
  Model model;
  NetworkForm form;
};

mien_status select(const mien_network_config& config, Selection& selection,
                   mien_error_detail& error) {
  for (const mien_weights::File& file : *config.weights) {
    const auto* record = config.name == nullptr ? &file.model.file().networks().front()
                                                : file.model.network(config.name);
    if (record != nullptr) {
      selection.model = file.model;
      selection.model.describe_errors(&error, file.index);
      const Shape declared = mien::engine::input_shape(*record);
      selection.form.name = file.model.file().text(record->name);
      selection.form.input =
          config.height == 0 ? declared : Shape{config.height, config.width, declared.c};
      selection.form.output_channels = {0, 0};
      return MIEN_OK;
    }
  }
  fail(error, MIEN_ERROR_WEIGHTS_INCOMPLETE, "name");
  mien::formats::set_name(error, config.name);
  return MIEN_ERROR_WEIGHTS_INCOMPLETE;
}

// Validates everything and measures the required memory.
mien_status prepare(const mien_network_config* given, mien_network_config& config,
                    Selection& selection, Arena::Need& need, mien_error_detail& error) {
  mien_status status = read_config(given, config, error);
  if (status == MIEN_OK) {
    status = select(config, selection, error);
  }
  if (status != MIEN_OK) {
    return status;
  }
  Arena measure;
  (void)measure.take(sizeof(mien_network));
  mien::engine::Network network;
  status = network.load(selection.model, selection.form, config.cpu_mask, measure);
  need = status == MIEN_OK ? measure.need() : Arena::Need();
  return status;
}

mien_status build(const mien_network_config& config, const Selection& selection, void* memory,
                  const Arena::Need& need, mien_network** network) {
  Arena arena(static_cast<std::byte*>(memory), need);
  auto* created = new (arena.take(sizeof(mien_network)).data()) mien_network;
  const mien_status status =
      created->network.load(selection.model, selection.form, config.cpu_mask, arena);
  if (status != MIEN_OK) {
    return status;
  }
  created->allocator = config.allocator;
  created->weights = config.weights;
  mien::tracker::acquire(*config.weights);
  *network = created;
  return MIEN_OK;
}

mien_status create(const mien_network_config* given, mien_network** network,
                   mien_error_detail& error) {
  mien_network_config config;
  Selection selection;
  Arena::Need need;
  mien_status status = prepare(given, config, selection, need, error);
  if (status != MIEN_OK) {
    return status;
  }
  void* memory = mien::tracker::allocate(config.allocator, need.total_bytes());
  if (memory == nullptr) {
    return fail(error, MIEN_ERROR_OUT_OF_MEMORY);
  }
  status = build(config, selection, memory, need, network);
  if (status != MIEN_OK) {
    mien::tracker::release(config.allocator, memory);
    return status;
  }
  (*network)->allocated = true;
  return MIEN_OK;
}

mien_status create_in(const mien_network_config* given, void* memory, std::size_t memory_bytes,
                      mien_network** network, mien_error_detail& error) {
  mien_network_config config;
  Selection selection;
  Arena::Need need;
  mien_status status = mien::tracker::check_memory(memory, error);
  if (status == MIEN_OK) {
    status = prepare(given, config, selection, need, error);
  }
  if (status == MIEN_OK) {
    status = mien::tracker::check_size(memory_bytes, need.total_bytes(), error);
  }
  return status == MIEN_OK ? build(config, selection, memory, need, network) : status;
}

void write_shape(const Shape& shape, mien_shape* out) {
  if (out != nullptr) {
    *out = {shape.h, shape.w, shape.c};
  }
}

}  // namespace

void mien_network_config_default(mien_network_config* config) {
  if (config != nullptr) {
    *config = {};
    config->struct_size = sizeof(mien_network_config);
    config->cpu_mask = MIEN_CPU_ALL & ~MIEN_CPU_HALF;
  }
}

mien_status mien_network_required_bytes(const mien_network_config* config, size_t* bytes,
                                        mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (bytes == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  const mien::kernels::FloatMode float_mode;
  mien_network_config checked;
  Selection selection;
  Arena::Need need;
  const mien_status status = prepare(config, checked, selection, need, detail);
  *bytes = need.total_bytes();
  return report(status, detail, error);
}

mien_status mien_network_create(const mien_network_config* config, mien_network** network,
                                mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (network == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  *network = nullptr;
  const mien::kernels::FloatMode float_mode;
  return report(create(config, network, detail), detail, error);
}

mien_status mien_network_create_in(const mien_network_config* config, void* memory,
                                   size_t memory_bytes, mien_network** network,
                                   mien_error_detail* error) {
  mien_error_detail detail = mien::formats::detail_of(MIEN_OK);
  if (network == nullptr) {
    return report(MIEN_ERROR_NULL_ARGUMENT, detail, error);
  }
  *network = nullptr;
  const mien::kernels::FloatMode float_mode;
  return report(create_in(config, memory, memory_bytes, network, detail), detail, error);
}

void mien_network_destroy(mien_network* network) {
  if (network == nullptr) {
    return;
  }
  const mien_allocator allocator = network->allocator;
  const mien_weights& weights = *network->weights;
  if (network->allocated) {
    mien::tracker::release(allocator, network);
  }
  mien::tracker::release(weights);
}

float* mien_network_input(mien_network* network, mien_shape* shape) {
  if (network == nullptr) {
    return nullptr;
  }
  write_shape(network->network.input_shape(), shape);
  return network->network.input().data();
}

mien_status mien_network_run(mien_network* network) {
  if (network == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const mien::kernels::FloatMode float_mode;
  network->network.run();
  return MIEN_OK;
}

int32_t mien_network_output_count(const mien_network* network) {
  return network == nullptr ? 0 : static_cast<std::int32_t>(network->network.output_count());
}

const float* mien_network_output(const mien_network* network, int32_t index, mien_shape* shape) {
  if (index < 0 || index >= mien_network_output_count(network)) {
    return nullptr;
  }
  const auto i = static_cast<std::uint32_t>(index);
  write_shape(network->network.output_shape(i), shape);
  return network->network.output(i).data();
}

void mien_network_reset(mien_network* network) {
  if (network != nullptr) {
    network->network.reset();
  }
}

int32_t mien_network_step_count(const mien_network* network) {
  return network == nullptr ? 0 : static_cast<std::int32_t>(network->network.step_count());
}

int32_t mien_network_step_layers(const mien_network* network, int32_t step, int32_t* first) {
  const bool known = step >= 0 && step < mien_network_step_count(network);
  const mien::engine::Session::StepLayers layers =
      known ? network->network.step_layers(static_cast<std::uint32_t>(step))
            : mien::engine::Session::StepLayers{0, 0};
  if (first != nullptr) {
    *first = static_cast<std::int32_t>(layers.first);
  }
  return static_cast<std::int32_t>(layers.count);
}

mien_status mien_network_run_step(mien_network* network, int32_t step) {
  if (network == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  if (step < 0 || step >= mien_network_step_count(network)) {
    return MIEN_ERROR_OUT_OF_RANGE;
  }
  const mien::kernels::FloatMode float_mode;
  network->network.run_step(static_cast<std::uint32_t>(step));
  return MIEN_OK;
}
