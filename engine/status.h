// What can go wrong between weight bytes and a running network.
#pragma once

#include <cstdint>

namespace mien::engine {

enum class [[nodiscard]] Status : std::int32_t{
    kOk = 0,
    kBadFile = 1,            // the weight file breaks a rule of its format
    kNoSuchNetwork = 2,      // or constant
    kShapeMismatch = 3,      // a layer's declared output is not what its input gives
    kWrongInput = 4,         // the network does not run on that input shape
    kUnsupportedLayout = 5,  // the operation cannot read an interleaved image
    kNoKernel = 6,           // no tier of the CPU mask has a kernel for a layer
    kMemoryTooSmall = 7,
    kMisaligned = 8,
    kTooLarge = 9,  // a map would exceed formats::kMaxMapElems, or all of them the address space
    kOutOfMemory = 10,
};

// One line of English, static.
[[nodiscard]] const char* message(Status status);

}  // namespace mien::engine
