// Senders that send each frame as one or more datagrams.
#pragma once

#include <memory>

#include "apps/mien/senders/destination.h"
#include "apps/mien/senders/sender.h"

namespace mien::app {

// All throw Failure, also for unknown options.
std::unique_ptr<Sender> vmc_sender(const Destination& destination);
std::unique_ptr<Sender> live_link_sender(const Destination& destination);
std::unique_ptr<Sender> openseeface_sender(const Destination& destination);
std::unique_ptr<Sender> opentrack_sender(const Destination& destination);
std::unique_ptr<Sender> vrchat_sender(const Destination& destination);
std::unique_ptr<Sender> json_sender(const Destination& destination);

}  // namespace mien::app
