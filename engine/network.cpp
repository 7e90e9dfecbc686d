// Loads networks and maps engine errors to mien_status.
#include "engine/network.h"

namespace mien::engine {
namespace {

using formats::FileStatus;

mien_status status_of(FileStatus status) {
  switch (status) {
    case FileStatus::kOk:
      return MIEN_OK;
    case FileStatus::kMisaligned:
      return MIEN_ERROR_ALIGNMENT;
    case FileStatus::kTruncated:
      return MIEN_ERROR_WEIGHTS_TRUNCATED;
    case FileStatus::kBadMagic:
      return MIEN_ERROR_WEIGHTS_NOT_MIEN;
    case FileStatus::kUnsupportedVersion:
      return MIEN_ERROR_WEIGHTS_VERSION;
    case FileStatus::kBadChecksum:
      return MIEN_ERROR_WEIGHTS_CHECKSUM;
    default:
      return MIEN_ERROR_WEIGHTS_MALFORMED;
  }
}

mien_status status_of(Status status) {
  switch (status) {
    case Status::kOk:
      return MIEN_OK;
    case Status::kBadFile:
    case Status::kShapeMismatch:
      return MIEN_ERROR_WEIGHTS_MALFORMED;
    case Status::kNoSuchNetwork:
      return MIEN_ERROR_WEIGHTS_INCOMPLETE;
    case Status::kWrongInput:
      return MIEN_ERROR_WEIGHTS_SHAPE;
    case Status::kUnsupportedLayout:
    case Status::kNoKernel:
      return MIEN_ERROR_UNSUPPORTED_LAYER;
    case Status::kTooLarge:
    case Status::kOutOfMemory:
      return MIEN_ERROR_OUT_OF_MEMORY;
    default:
      return MIEN_ERROR_INTERNAL;
  }
}

// Whether the network, whose shapes are already validated, has the expected outputs. Not inlined,
// because its 12 KB of shapes would stay on the stack while a session is created.
[[gnu::noinline]] bool outputs_fit(const Model& model, const formats::NetworkRecord& network,
                                   const NetworkForm& form) {
  ShapeWalk walk(model.file().layers(network), form.input);
  while (walk.next()) {
  }
  const Shape& first = walk.shape_of(formats::output_value(network, 0));
  for (std::uint32_t i = 0; i < form.output_channels.size(); ++i) {
    if (form.output_channels[i] == 0) {
      continue;
    }
    if (i >= network.output_count) {
      return false;
    }
    const Shape& output = walk.shape_of(formats::output_value(network, i));
    if (output.c != form.output_channels[i] || output.h != first.h || output.w != first.w) {
      return false;
    }
  }
  return true;
}

}  // namespace

mien_status open_model(const void* file, std::size_t bytes, Model& model) {
  formats::Validation fault;
  const Status status = model.open({static_cast<const std::byte*>(file), bytes}, &fault);
  return status == Status::kBadFile ? status_of(fault.status) : status_of(status);
}

mien_status Network::load(const Model& model, const NetworkForm& form, std::uint32_t cpu_mask,
                          Arena& arena) {
  const SessionRequest request = {&model, form.name, form.input, cpu_mask};
  SessionSize size;
  const Status sized = session_size(request, size);
  if (sized != Status::kOk) {
    return status_of(sized);
  }
  if (!outputs_fit(model, *model.network(form.name), form)) {
    return MIEN_ERROR_WEIGHTS_SHAPE;
  }
  const std::span<std::byte> own = arena.take(size.session_bytes);
  const std::span<std::byte> shared = arena.share(size.arena_bytes);
  return arena.measuring() ? MIEN_OK : status_of(Session::init(request, own, shared, session_));
}

}  // namespace mien::engine
