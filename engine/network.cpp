// Loads networks.
#include "engine/network.h"

namespace mien::engine {
namespace {

// Checks that the network, whose shapes are already validated, has the expected outputs. Not
// inlined, because its 12 KB of shapes would stay on the stack while a session is created.
[[gnu::noinline]] mien_status check_outputs(const Model& model,
                                            const formats::NetworkRecord& network,
                                            const NetworkForm& form) {
  ShapeWalk walk(model.file().layers(network), form.input);
  while (walk.next()) {
  }
  const Shape& first = walk.shape_of(formats::output_value(network, 0));
  for (std::uint32_t i = 0; i < form.output_channels.size(); ++i) {
    if (form.output_channels[i] == 0) {
      continue;
    }
    const auto outputs = static_cast<std::int32_t>(network.output_count);
    if (i >= network.output_count) {
      return model.mismatch(network, "outputs", outputs, static_cast<std::int32_t>(i) + 1);
    }
    const Shape& output = walk.shape_of(formats::output_value(network, i));
    if (output.c != form.output_channels[i]) {
      return model.mismatch(network, "output channels", output.c, form.output_channels[i]);
    }
    if (output.h != first.h || output.w != first.w) {
      return model.fail(MIEN_ERROR_WEIGHTS_SHAPE, network, -1, "output size");
    }
  }
  return MIEN_OK;
}

}  // namespace

mien_status Network::load(const Model& model, const NetworkForm& form, std::uint32_t cpu_mask,
                          Arena& arena) {
  const SessionRequest request = {&model, form.name, form.input, cpu_mask};
  SessionSize size;
  mien_status status = session_size(request, size);
  if (status == MIEN_OK) {
    status = check_outputs(model, *model.network(form.name), form);
  }
  if (status != MIEN_OK) {
    return status;
  }
  const std::span<std::byte> own = arena.take(size.session_bytes);
  const std::span<std::byte> shared = arena.share(size.arena_bytes);
  return arena.measuring() ? MIEN_OK : Session::init(request, own, shared, session_);
}

}  // namespace mien::engine
