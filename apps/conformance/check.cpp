// Runs a case and compares the results.
#include "apps/conformance/check.h"

#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/conformance/crash_guard.h"
#include "apps/conformance/guarded_buffer.h"
#include "apps/conformance/registers.h"
#include "apps/conformance/unwritten.h"

namespace mien::conformance {
namespace {

using Contents = std::vector<std::vector<std::byte>>;

// One call of a kernel with its own buffers.
class Trial {
 public:
  Trial(const Case& test, Placement place) : test_(test) {
    Addresses addresses;
    for (const Buffer& one : test.buffers) {
      memory_.push_back(
          std::make_unique<GuardedBuffer>(one.content, element_bytes(one.element), place));
      if (one.role == Role::kWritten || one.role == Role::kScratch) {
        count_as_unwritten({memory_.back()->data(), one.content.size()});
      }
      addresses.add(memory_.back()->data());
    }
    arguments_ = test.bind(addresses);
  }

  // Runs the kernel; returns faults other than wrong results.
  Finding run(kernels::AnyKernel kernel) {
    kernel_ = kernel;
    const char* crash = run_guarded([](void* self) { static_cast<Trial*>(self)->call(); }, this);
    if (crash != nullptr) {
      return {Fault::kCrashes, crash};
    }
    if (changed_registers_ != 0) {
      return {Fault::kClobbersRegister, "does not restore " + register_names(changed_registers_)};
    }
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      const std::string which = "buffer " + std::to_string(i);
      if (!memory_[i]->border_intact()) {
        return {Fault::kTouchesBorder, "writes outside " + which};
      }
      if (test_.buffers[i].role == Role::kRead && contents(i) != test_.buffers[i].content) {
        return {Fault::kChangesInput, "changes " + which};
      }
    }
    return {};
  }

  [[nodiscard]] Contents results() const {
    Contents all;
    for (std::size_t i = 0; i < memory_.size(); ++i) {
      all.push_back(contents(i));
    }
    return all;
  }

 private:
  void call() {
    if (register_convention() != nullptr) {
      changed_registers_ = call_checked(kernel_, arguments_.bytes);
    } else {
      test_.call(kernel_, arguments_);
    }
  }

  [[nodiscard]] std::vector<std::byte> contents(std::size_t i) const {
    const std::span<const std::byte> bytes = memory_[i]->content();
    return {bytes.begin(), bytes.end()};
  }

  const Case& test_;
  std::vector<std::unique_ptr<GuardedBuffer>> memory_;
  Arguments arguments_;
  kernels::AnyKernel kernel_ = nullptr;
  std::uint32_t changed_registers_ = 0;
};

template <class T>
double element_as(const std::vector<std::byte>& bytes, std::size_t i) {
  T value;
  std::memcpy(&value, bytes.data() + i * sizeof value, sizeof value);
  return static_cast<double>(value);
}

double element(Element kind, const std::vector<std::byte>& bytes, std::size_t i) {
  switch (kind) {
    case Element::kByte:
      return element_as<std::uint8_t>(bytes, i);
    case Element::kInt8:
      return element_as<std::int8_t>(bytes, i);
    case Element::kHalf:
      return element_as<std::uint16_t>(bytes, i);
    case Element::kInt16:
      return element_as<std::int16_t>(bytes, i);
    case Element::kFloat:
      return element_as<float>(bytes, i);
    case Element::kInt64:
      return element_as<std::int64_t>(bytes, i);
  }
  return 0.0;
}

// 0 for equal infinities; infinity for NaN.
double relative_to_bound(double got, double expected, double bound) {
  if (got == expected) {
    return 0.0;
  }
  const double error = std::abs(got - expected);
  if (bound > 0.0) {
    return error <= bound ? error / bound : std::max(error / bound, 1.001);
  }
  return HUGE_VAL;
}

std::string difference(std::size_t buffer, std::size_t index, double got, double expected,
                       double bound) {
  char text[160];
  std::snprintf(text, sizeof text, "buffer %zu, element %zu: %.9g instead of %.9g +- %.2g", buffer,
                index, got, expected, bound);
  return text;
}

// Compares all results with the double-precision reference.
void compare(const Case& test, const Contents& results, Finding& finding) {
  for (std::size_t b = 0; b < results.size(); ++b) {
    const Buffer& buffer = test.buffers[b];
    for (std::size_t i = 0; i < buffer.expected.size(); ++i) {
      const double got = element(buffer.element, results[b], i);
      const Approx& expected = buffer.expected[i];
      const double relative_error = relative_to_bound(got, expected.value, expected.error);
      if (!(relative_error <= 1.0) && finding.fault == Fault::kNone) {
        finding.fault = Fault::kWrongResult;
        finding.text = difference(b, i, got, expected.value, expected.error);
      }
      finding.worst_share =
          std::max(finding.worst_share, std::isnan(relative_error) ? HUGE_VAL : relative_error);
    }
  }
}

// Compares two kernels. Both may be off by the bound.
void compare_kernels(const Case& test, const Contents& results, const Contents& reference,
                     Finding& finding) {
  for (std::size_t b = 0; b < results.size() && finding.fault == Fault::kNone; ++b) {
    const Buffer& buffer = test.buffers[b];
    for (std::size_t i = 0; i < buffer.expected.size(); ++i) {
      const double got = element(buffer.element, results[b], i);
      const double expected = element(buffer.element, reference[b], i);
      const double bound = 2.0 * buffer.expected[i].error;
      if (!(relative_to_bound(got, expected, bound) <= 1.0)) {
        finding.fault = Fault::kDiffersFromRef;
        finding.text = difference(b, i, got, expected, bound);
        return;
      }
    }
  }
}

}  // namespace

const char* name(Fault fault) {
  switch (fault) {
    case Fault::kNone:
      return "ok";
    case Fault::kWrongResult:
      return "wrong result";
    case Fault::kDiffersFromRef:
      return "differs from ref";
    case Fault::kTouchesBorder:
      return "touches border";
    case Fault::kChangesInput:
      return "changes input";
    case Fault::kClobbersRegister:
      return "clobbers register";
    case Fault::kCrashes:
      return "crashes";
    case Fault::kNoCases:
      return "no cases";
  }
  return "";
}

Finding check(const Case& test, kernels::AnyKernel kernel, kernels::AnyKernel reference) {
  double worst_share = 0.0;
  for (const Placement place : kPlacements) {
    Trial trial(test, place);
    Finding finding = trial.run(kernel);
    if (finding.fault == Fault::kNone) {
      compare(test, trial.results(), finding);
    }
    if (finding.fault == Fault::kNone && reference != nullptr && place == Placement::kAtEnd) {
      Trial of_reference(test, place);
      if (of_reference.run(reference).fault == Fault::kNone) {
        compare_kernels(test, trial.results(), of_reference.results(), finding);
      }
    }
    finding.worst_share = worst_share = std::max(worst_share, finding.worst_share);
    if (finding.fault != Fault::kNone) {
      finding.text += "; " + test.shape + "; " + name(place);
      return finding;
    }
  }
  return {Fault::kNone, "", worst_share};
}

}  // namespace mien::conformance
