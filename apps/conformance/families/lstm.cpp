// Cases of lstm, with the expected results.
#include "apps/conformance/families/dense.h"

namespace mien::conformance {
namespace {

using kernels::LstmArgs;

Approx flushed(Approx x) { return {x.value, x.error + static_cast<double>(kernels::kLstmFlush)}; }

// Cell state: an average of gate values, near [-1, 1] for any input.
std::vector<float> state(RandomValues& random, int count) {
  std::vector<float> values(static_cast<std::size_t>(count));
  for (float& one : values) {
    one = static_cast<float>(random.between(-1500, 1500)) * 1e-3f;
  }
  return values;
}

struct Step {
  std::vector<Approx> c, h;
};

// `gate(o)`: output o of the gates before its activation.
template <class Gate>
Step one_step(int hidden, const std::vector<float>& c, Gate gate) {
  Step step;
  for (int j = 0; j < hidden; ++j) {
    const Approx i = sigmoid(gate(j)), f = sigmoid(gate(hidden + j)),
                 g = tanh(gate(2 * hidden + j)), o = sigmoid(gate(3 * hidden + j));
    const Approx before = exact(static_cast<double>(c[static_cast<std::size_t>(j)]));
    step.c.push_back(flushed(f * before + i * g));
    step.h.push_back(flushed(o * tanh(step.c.back())));
  }
  return step;
}

Case make(RandomValues& random, int in_elems, int hidden) {
  const std::vector<float> x = random.plain(in_elems), h = state(random, hidden),
                           c = state(random, hidden);
  const std::vector<std::uint16_t> weights = random.panels(4 * hidden, in_elems + hidden),
                                   bias = random.bias(4 * hidden);
  std::vector<float> both = x;
  both.insert(both.end(), h.begin(), h.end());
  const Step step = one_step(hidden, c, [&](int o) {
    return dense_output(both, weights, bias, 4 * hidden, o, random.arithmetic());
  });
  Case test;
  test.shape = std::to_string(in_elems) + ", hidden " + std::to_string(hidden);
  test.buffers = {reads(x),
                  updates(h, step.h),
                  updates(c, step.c),
                  reads(weights),
                  reads(bias),
                  writes(Element::kFloat, step.h),
                  scratch(as_size(4 * hidden))};
  test.bind = [=](const Addresses& buffers) {
    return arguments(LstmArgs{buffers.floats(0), buffers.floats(1), buffers.floats(2),
                              buffers.halves(3), buffers.halves(4), buffers.floats(5),
                              buffers.floats(6), in_elems, hidden});
  };
  test.call = call<LstmArgs>;
  test.macs = static_cast<std::uint64_t>(in_elems + hidden) * as_size(4 * hidden);
  return test;
}

}  // namespace

template <>
Case random_case<LstmArgs>(RandomValues& random) {
  return make(random, 8 * random.size(17), 8 * random.size(13));
}

template <>
Case typical_case<LstmArgs>(RandomValues& random) {
  return make(random, 96, 96);
}

}  // namespace mien::conformance
