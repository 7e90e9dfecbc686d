// A phone with iFacialMocap, played: it streams to whoever says hello.
#pragma once

#include <memory>

#include "apps/mien/senders/destination.h"
#include "apps/mien/senders/sender.h"

namespace mien::app {

// The destination is where it listens, 127.0.0.1:49983 unless it says something else; "to" is
// streamed to without a hello. Throws Failure.
std::unique_ptr<Sender> ifacialmocap_sender(const Destination& destination);

}  // namespace mien::app
