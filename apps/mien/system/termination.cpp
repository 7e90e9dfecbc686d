#include "apps/mien/system/termination.h"

namespace mien::app {
namespace {

Leftover* newest = nullptr;

}  // namespace

void TerminationLock::add(Leftover& one) {
  one.older_ = newest;
  newest = &one;
}

void TerminationLock::remove(Leftover& one) {
  for (Leftover** at = &newest; *at != nullptr; at = &(*at)->older_) {
    if (*at == &one) {
      *at = one.older_;
      return;
    }
  }
}

void TerminationLock::discard_all() noexcept {
  for (Leftover* one = newest; one != nullptr; one = one->older_) {
    one->discard();
  }
}

}  // namespace mien::app
