// C API: custom networks.
#include <mien/mien.h>

#include <cstdint>

#include "engine/arena.h"
#include "engine/network.h"
#include "kernels/float_mode.h"
#include "tracker/api/allocate.h"
#include "tracker/api/versioned_struct.h"

struct mien_network {
  mien::engine::Model model;
  mien::engine::Network network;
  mien_allocator allocator;
};

namespace {

using mien::engine::Arena;
using mien::engine::Model;
using mien::engine::NetworkForm;
using mien::engine::Shape;

mien_status read_config(const mien_network_config* given, mien_network_config& config) {
  if (given == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  mien_network_config_default(&config);
  if (!mien::tracker::read_struct(*given, MIEN_SIZE_THROUGH(mien_network_config, file_bytes),
                                  config)) {
    return MIEN_ERROR_STRUCT_SIZE;
  }
  if (config.file == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  const bool one_callback =
      (config.allocator.allocate == nullptr) != (config.allocator.release == nullptr);
  const bool one_side = (config.height == 0) != (config.width == 0);
  return one_callback || one_side || config.height < 0 || config.width < 0 ? MIEN_ERROR_OUT_OF_RANGE
                                                                           : MIEN_OK;
}

// The form of the network and input that the configuration selects.
mien_status form_of(const mien_network_config& config, const Model& model, NetworkForm& form) {
  const auto* record =
      config.name == nullptr ? model.file().networks().data() : model.network(config.name);
  if (record == nullptr) {
    return MIEN_ERROR_WEIGHTS_INCOMPLETE;
  }
  const Shape declared = mien::engine::input_shape(*record);
  form.name = model.file().text(record->name);
  form.input = config.height == 0 ? declared : Shape{config.height, config.width, declared.c};
  form.output_channels = {0, 0};
  return MIEN_OK;
}

void write_shape(const Shape& shape, mien_shape* out) {
  if (out != nullptr) {
    *out = {shape.h, shape.w, shape.c};
  }
}

mien_status build(const mien_network_config& config, const Model& model, const NetworkForm& form,
                  mien_network** network) {
  Arena measure;
  (void)measure.take(sizeof(mien_network));
  mien_network parts{model, {}, config.allocator};
  mien_status status = parts.network.load(parts.model, form, config.cpu_mask, measure);
  if (status != MIEN_OK) {
    return status;
  }
  void* memory = mien::tracker::allocate(config.allocator, measure.need().total_bytes());
  if (memory == nullptr) {
    return MIEN_ERROR_OUT_OF_MEMORY;
  }
  Arena arena(static_cast<std::byte*>(memory), measure.need());
  auto* created = new (arena.take(sizeof(mien_network)).data()) mien_network(parts);
  status = created->network.load(created->model, form, config.cpu_mask, arena);
  if (status != MIEN_OK) {
    mien::tracker::release(config.allocator, memory);
    return status;
  }
  *network = created;
  return MIEN_OK;
}

}  // namespace

void mien_network_config_default(mien_network_config* config) {
  if (config != nullptr) {
    *config = {};
    config->struct_size = sizeof(mien_network_config);
    config->cpu_mask = MIEN_CPU_ALL & ~MIEN_CPU_HALF;
  }
}

mien_status mien_network_create(const mien_network_config* config, mien_network** network) {
  if (network == nullptr) {
    return MIEN_ERROR_NULL_ARGUMENT;
  }
  *network = nullptr;
  const mien::kernels::FloatMode float_mode;
  mien_network_config checked;
  mien_status status = read_config(config, checked);
  Model model;
  if (status == MIEN_OK) {
    status = mien::engine::open_model(checked.file, checked.file_bytes, model);
  }
  NetworkForm form;
  if (status == MIEN_OK) {
    status = form_of(checked, model, form);
  }
  return status == MIEN_OK ? build(checked, model, form, network) : status;
}

void mien_network_destroy(mien_network* network) {
  if (network != nullptr) {
    const mien_allocator allocator = network->allocator;
    mien::tracker::release(allocator, network);
  }
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
