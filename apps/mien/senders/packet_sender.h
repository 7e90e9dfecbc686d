// Senders whose every frame is one or more datagrams to one place.
#pragma once

#include <memory>

#include "apps/mien/senders/destination.h"
#include "apps/mien/senders/sender.h"

namespace mien::app {

// Each throws Failure, also for options that it does not have.
std::unique_ptr<Sender> vmc_sender(const Destination& destination);
std::unique_ptr<Sender> live_link_sender(const Destination& destination);
std::unique_ptr<Sender> openseeface_sender(const Destination& destination);
std::unique_ptr<Sender> opentrack_sender(const Destination& destination);
std::unique_ptr<Sender> json_sender(const Destination& destination);

}  // namespace mien::app
