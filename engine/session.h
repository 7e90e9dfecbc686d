// A network ready to run, with kernels chosen and memory laid out. Running it is a loop over steps,
// without allocation, lock, exception or I/O.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "engine/plan.h"

namespace mien::engine {

struct Step;

inline constexpr std::size_t kSessionAlignment = 64;

struct SessionSize {
  std::size_t session_bytes = 0;  // steps, input, outputs, temporal state, quantized weights
  std::size_t arena_bytes = 0;    // intermediate maps; shareable by sessions that never run at once
};

// Computes sizes without looking up kernels: Session::init may still return
// MIEN_ERROR_UNSUPPORTED_LAYER.
[[nodiscard]] mien_status session_size(const SessionRequest& request, SessionSize& size);

class Session {
 public:
  // Creates a session in `memory` (session_bytes) with intermediate maps in `arena` (arena_bytes),
  // both kSessionAlignment-aligned. A session needs no destructor. On error `session` is nullptr.
  [[nodiscard]] static mien_status init(const SessionRequest& request, std::span<std::byte> memory,
                                        std::span<std::byte> arena, Session*& session);

  // [h][w][c] if the shape is interleaved, else blocked with zeros in unused lanes. Zero at first.
  [[nodiscard]] std::span<float> input() const { return input_; }
  [[nodiscard]] const Shape& input_shape() const { return input_shape_; }

  void run();

  // `run` in parts, to time each step.
  [[nodiscard]] std::uint32_t step_count() const { return step_count_; }
  void run_step(std::uint32_t i);
  // The layers first .. first + count - 1 that step i computes.
  struct StepLayers {
    std::uint32_t first, count;
  };
  [[nodiscard]] StepLayers step_layers(std::uint32_t i) const;

  // Outputs are blocked and valid until the next run of this session.
  [[nodiscard]] std::uint32_t output_count() const { return output_count_; }
  [[nodiscard]] std::span<const float> output(std::uint32_t i) const { return outputs_[i]; }
  [[nodiscard]] const Shape& output_shape(std::uint32_t i) const { return output_shapes_[i]; }

  // Sets the temporal state to zero.
  void reset();

 private:
  friend class SessionBuilder;

  Session() = default;

  Step* steps_ = nullptr;
  std::uint32_t step_count_ = 0;
  std::span<float> input_;
  Shape input_shape_;
  std::uint32_t output_count_ = 0;
  std::span<float> outputs_[formats::kMaxOutputs];
  Shape output_shapes_[formats::kMaxOutputs];
  std::span<float> state_;
};

}  // namespace mien::engine
