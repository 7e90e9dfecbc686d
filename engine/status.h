// Status codes of the engine, from opening a weight file to running a network.
#pragma once

#include <cstdint>

namespace mien::engine {

enum class [[nodiscard]] Status : std::int32_t{
    kOk = 0,
    kBadFile = 1,            // the weight file violates its format
    kNoSuchNetwork = 2,      // or no such constant
    kShapeMismatch = 3,      // a layer's declared output shape does not match its input
    kWrongInput = 4,         // the network does not accept the input shape
    kUnsupportedLayout = 5,  // the operation cannot read an interleaved image
    kNoKernel = 6,           // no tier of the CPU mask has a kernel for a layer
    kMemoryTooSmall = 7,
    kMisaligned = 8,
    kTooLarge = 9,  // a map exceeds formats::kMaxMapElems, or all maps exceed the address space
    kOutOfMemory = 10,
};

// A static string of one line.
[[nodiscard]] const char* message(Status status);

}  // namespace mien::engine
