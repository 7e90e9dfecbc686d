// The list of resources to clean up.
#include "apps/mien/system/termination.h"

namespace mien::app {
namespace {

Leftover* newest = nullptr;

}  // namespace

void TerminationLock::add(Leftover& leftover) {
  leftover.older_ = newest;
  newest = &leftover;
}

void TerminationLock::remove(Leftover& leftover) {
  for (Leftover** at = &newest; *at != nullptr; at = &(*at)->older_) {
    if (*at == &leftover) {
      *at = leftover.older_;
      return;
    }
  }
}

void TerminationLock::discard_all() noexcept {
  for (Leftover* leftover = newest; leftover != nullptr; leftover = leftover->older_) {
    leftover->discard();
  }
}

}  // namespace mien::app
