// JSON lines on standard output, for the next program in a pipe.
#pragma once

#include <memory>

#include "apps/mien/senders/sender.h"

namespace mien::app {

// Whole lines, each as soon as there is room for it: a reader that is slow misses some.
std::unique_ptr<Sender> line_sender();

}  // namespace mien::app
