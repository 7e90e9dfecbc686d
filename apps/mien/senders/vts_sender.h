// Sends to VTube Studio through its plugin API.
#pragma once

#include <memory>

#include "apps/mien/senders/destination.h"
#include "apps/mien/senders/sender.h"

namespace mien::app {

// Connects, asks the user for permission, and reconnects when VTube Studio restarts; none of this
// delays frames. The option "token" names the file of the permission. Throws Failure.
std::unique_ptr<Sender> vts_sender(const Destination& destination);

}  // namespace mien::app
