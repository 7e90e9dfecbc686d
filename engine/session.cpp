// Lays out sessions in memory and runs them.
#include "engine/session.h"

#include <cstring>
#include <new>

#include "engine/arena_plan.h"
#include "engine/step.h"

namespace mien::engine {

static_assert(kSessionAlignment == kArenaAlignment);

// Lays out a planned session in memory.
class SessionBuilder {
 public:
  explicit SessionBuilder(const Plan& plan) : plan_(plan) {}

  [[nodiscard]] SessionSize size() const;
  [[nodiscard]] mien_status build(const SessionRequest& request, std::span<std::byte> memory,
                                  std::span<std::byte> arena, Session*& session);

 private:
  std::byte* take(std::size_t bytes);
  std::span<float> take_floats(std::size_t elems);
  void place_values(Session& session, std::span<std::byte> arena);
  [[nodiscard]] mien_status make_steps(const SessionRequest& request, float* scratch,
                                       Session& session);

  const Plan& plan_;
  std::byte* free_ = nullptr;  // start of the unused memory
  float* maps_[formats::kMaxLayers + 1] = {};
};

// Adds up the sizes in the order in which build takes them.
SessionSize SessionBuilder::size() const {
  std::size_t bytes = aligned(sizeof(Session)) + aligned(plan_.step_count() * sizeof(Step)) +
                      aligned(plan_.input_elems() * sizeof(float));
  for (std::uint32_t i = 0; i < plan_.output_count(); ++i) {
    const std::uint32_t value = plan_.output(i);
    bytes += aligned(blocked_elems(plan_.value(value).shape) * sizeof(float));
  }
  bytes += aligned(plan_.state_elems() * sizeof(float)) + aligned(plan_.weights_bytes());
  return {bytes, plan_.arena_bytes()};
}

std::byte* SessionBuilder::take(std::size_t bytes) {
  std::byte* taken = free_;
  free_ += aligned(bytes);
  return taken;
}

std::span<float> SessionBuilder::take_floats(std::size_t elems) {
  return {reinterpret_cast<float*>(take(elems * sizeof(float))), elems};
}

mien_status SessionBuilder::build(const SessionRequest& request, std::span<std::byte> memory,
                                  std::span<std::byte> arena, Session*& session) {
  const SessionSize needed = size();
  if (memory.size() < needed.session_bytes || arena.size() < needed.arena_bytes) {
    return MIEN_ERROR_MEMORY_TOO_SMALL;
  }
  const auto is_aligned = [](const void* p) {
    return reinterpret_cast<std::uintptr_t>(p) % kSessionAlignment == 0;
  };
  if (!is_aligned(memory.data()) || !is_aligned(arena.data())) {
    return MIEN_ERROR_ALIGNMENT;
  }
  std::memset(memory.data(), 0, needed.session_bytes);
  free_ = memory.data();
  auto* created = new (take(sizeof(Session))) Session();
  created->steps_ = reinterpret_cast<Step*>(take(plan_.step_count() * sizeof(Step)));
  place_values(*created, arena);
  auto* scratch = reinterpret_cast<float*>(arena.data() + plan_.scratch_offset());
  const mien_status status = make_steps(request, scratch, *created);
  session = status == MIEN_OK ? created : nullptr;
  return status;
}

void SessionBuilder::place_values(Session& session, std::span<std::byte> arena) {
  session.input_shape_ = plan_.value(0).shape;
  session.input_ = take_floats(plan_.input_elems());
  maps_[0] = session.input_.data();
  for (std::uint32_t i = 0; i < plan_.output_count(); ++i) {
    const std::uint32_t value = plan_.output(i);
    const Shape& shape = plan_.value(value).shape;
    const std::span<float> own = take_floats(blocked_elems(shape));
    // If a value is two outputs, both share the memory.
    maps_[value] = maps_[value] == nullptr ? own.data() : maps_[value];
    session.outputs_[i] = {maps_[value], own.size()};
    session.output_shapes_[i] = shape;
  }
  session.output_count_ = plan_.output_count();
  for (std::uint32_t i = 1; i <= plan_.layer_count(); ++i) {
    if (plan_.value(i).in_arena) {
      maps_[i] = reinterpret_cast<float*>(arena.data() + plan_.value(i).arena_offset);
    }
  }
}

mien_status SessionBuilder::make_steps(const SessionRequest& request, float* scratch,
                                       Session& session) {
  session.state_ = take_floats(plan_.state_elems());
  float* state = session.state_.data();
  std::byte* weights = take(plan_.weights_bytes());
  const StepMaker maker(plan_, request.model->file(), request.cpu_mask, maps_, scratch);
  for (std::uint32_t i = 0; i < plan_.layer_count(); ++i) {
    if (plan_.is_fused_into_previous(i)) {
      continue;
    }
    Step& step = session.steps_[session.step_count_++];
    step.first_layer = i;
    step.layer_count = plan_.step_layers(i);
    const mien_status status = maker.make(i, {state, weights}, step);
    if (status != MIEN_OK) {
      return plan_.fail(status, i);
    }
    state += plan_.state_elems(i);
    weights += plan_.weights_bytes(i);
  }
  return MIEN_OK;
}

mien_status session_size(const SessionRequest& request, SessionSize& size) {
  size = {};
  Plan plan;
  const mien_status status = plan.make(request);
  if (status == MIEN_OK) {
    size = SessionBuilder(plan).size();
  }
  return status;
}

mien_status Session::init(const SessionRequest& request, std::span<std::byte> memory,
                          std::span<std::byte> arena, Session*& session) {
  session = nullptr;
  Plan plan;
  const mien_status status = plan.make(request);
  return status == MIEN_OK ? SessionBuilder(plan).build(request, memory, arena, session) : status;
}

void Session::run() {
  for (const Step *step = steps_, *end = steps_ + step_count_; step != end; ++step) {
    step->call(*step);
  }
}

void Session::run_step(std::uint32_t i) { steps_[i].call(steps_[i]); }

Session::StepLayers Session::step_layers(std::uint32_t i) const {
  return {steps_[i].first_layer, steps_[i].layer_count};
}

void Session::reset() {
  for (float& one : state_) {
    one = 0.0f;
  }
}

}  // namespace mien::engine
