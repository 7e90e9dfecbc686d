// JSON lines on standard output, for the next program in a pipe.
#pragma once

#include <memory>

#include "apps/mien/senders/sender.h"

namespace mien::app {

// Writes complete lines without waiting: a slow reader misses lines.
std::unique_ptr<Sender> line_sender();

}  // namespace mien::app
