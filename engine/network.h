// One network of a weight file, ready to run in the caller's memory.
#pragma once

#include <mien/mien.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <string_view>

#include "engine/arena.h"
#include "engine/model.h"
#include "engine/session.h"

namespace mien::engine {

// The shapes that the caller expects of a network.
struct NetworkForm {
  std::string_view name;
  Shape input;
  std::array<std::int32_t, 2> output_channels;  // 0: no such output; all outputs share h and w
};

class Network {
 public:
  // Takes the network's memory from `arena`; only measures if the arena does. All networks of an
  // arena share the memory of their intermediate maps, so only one may run at a time.
  [[nodiscard]] mien_status load(const Model& model, const NetworkForm& form,
                                 std::uint32_t cpu_mask, Arena& arena);

  // The following require a loaded network.
  void reset() { session_->reset(); }
  void run() { session_->run(); }
  // Copies a vector to the input, runs, and returns the first output.
  std::span<const float> run(std::span<const float> vector) {
    std::copy(vector.begin(), vector.end(), session_->input().begin());
    session_->run();
    return session_->output(0);
  }

  [[nodiscard]] std::span<float> input() { return session_->input(); }
  [[nodiscard]] const Shape& input_shape() const { return session_->input_shape(); }
  // `run` in parts, to time each step.
  [[nodiscard]] std::uint32_t step_count() const { return session_->step_count(); }
  void run_step(std::uint32_t i) { session_->run_step(i); }
  [[nodiscard]] Session::StepLayers step_layers(std::uint32_t i) const {
    return session_->step_layers(i);
  }
  [[nodiscard]] std::uint32_t output_count() const { return session_->output_count(); }
  [[nodiscard]] std::span<const float> output(std::uint32_t i) const { return session_->output(i); }
  [[nodiscard]] const Shape& output_shape(std::uint32_t i) const {
    return session_->output_shape(i);
  }

 private:
  Session* session_ = nullptr;
};

}  // namespace mien::engine
