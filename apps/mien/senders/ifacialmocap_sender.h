// Emulates a phone with iFacialMocap, which streams to every program that sends it a hello.
#pragma once

#include <memory>

#include "apps/mien/senders/destination.h"
#include "apps/mien/senders/sender.h"

namespace mien::app {

// Listens at the destination, by default 127.0.0.1:49983. The option "to" names a receiver that
// needs no hello. Throws Failure.
std::unique_ptr<Sender> ifacialmocap_sender(const Destination& destination);

}  // namespace mien::app
